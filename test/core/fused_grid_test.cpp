// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "allocation_counter.h"
#include "fused_state.h"
#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using test::bytes_of;
using worlds::add_point;

FusionParams growing() {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  params.cell_size = params.layer_height = 0.25;
  return params;
}

Eigen::Isometry3d at(double x, double y, double z = 0.0, double yaw = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

/// Random points about the robot, most of them in the grid.
Points cloud(std::uint64_t seed, int n, double range = 8.0) {
  RandomGenerator random(seed);
  Points points;
  for (int k = 0; k < n; ++k) {
    add_point(points, range * (2.0 * random.uniform() - 1.0),
              range * (2.0 * random.uniform() - 1.0),
              random.uniform() < 0.7 ? 0.02 * random.uniform() : 3.0 * random.uniform());
  }
  return points;
}

FusedCell cell_at(const FusedGrid& grid, const FusionParams& params, MapCell where) {
  FusedCell cell;
  EXPECT_TRUE(read_cell(grid.now(), where, params, cell));
  return cell;
}

std::vector<HeightBin> bins_at(const FusedGrid& grid, MapCell where) {
  std::vector<HeightBin> bins;
  const Tile* tile = grid.now().tiles.find(tile_of(where));
  if (tile != nullptr) {
    for_each_bin(*tile, place_in_tile(where), [&](const HeightBin& b) { bins.push_back(b); });
  }
  return bins;
}

TEST(FuseScan, TwoCellsByHand) {
  const FusionParams params = growing();
  FusedGrid grid(params);
  FusionWorkspace workspace;
  Points points;
  points.push_back(0.125F, 0.125F, 0.0625F);
  points.push_back(0.1875F, 0.125F, 0.125F);
  points.push_back(0.125F, 0.125F, 1.0F);
  points.push_back(-0.0625F, 0.0625F, -0.0625F);
  // The robot stands at (1, 2, 3) and looks along y: (x, y) of the robot is (1 - y, 2 + x).
  const FusionCounts counts =
      fuse_scan({points.view(), at(1.0, 2.0, 3.0, worlds::kPi / 2), 7.0}, params, workspace, grid);
  EXPECT_EQ(counts.fused, 4U);
  EXPECT_EQ(counts.cells, 2U);
  EXPECT_EQ(grid.now().time, 7.0);
  EXPECT_EQ(grid.now().scans, 1U);

  const std::vector<HeightBin> bins = bins_at(grid, {3, 8});  // x 0.75 to 1, y 2 to 2.25
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_EQ(bins[0].layer, 12);
  EXPECT_EQ(bins[0].count, 2U);
  EXPECT_EQ(bins[0].z_min, 0.0625F);
  EXPECT_EQ(bins[0].z_max, 0.125F);
  EXPECT_EQ(bins[0].mean_x, 0.0F);
  EXPECT_EQ(bins[0].mean_y, 0.03125F);
  EXPECT_EQ(bins[0].mean_z, 0.09375F);
  EXPECT_EQ(bins[0].m_yy, 2 * 0.03125F * 0.03125F);
  EXPECT_EQ(bins[0].m_yz, 2 * 0.03125F * 0.03125F);
  EXPECT_EQ(bins[0].m_zz, 2 * 0.03125F * 0.03125F);
  EXPECT_EQ(bins[0].m_xx, 0.0F);
  EXPECT_EQ(bins[0].last_seen, 7.0);
  EXPECT_EQ(bins[1].layer, 16);
  EXPECT_EQ(bins[1].count, 1U);
  EXPECT_EQ(bins[1].z_min, 0.0F);
  ASSERT_EQ(bins_at(grid, {3, 7}).size(), 1U);
  EXPECT_EQ(bins_at(grid, {3, 7})[0].layer, 11) << "2.9375 lies in 2.75 to 3";
}

TEST(FuseScan, CountsWhatItLeavesOut) {
  FusionParams params = growing();
  params.max_range = 5.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  Points points;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  points.push_back(nan, 0.0F, 0.0F);
  points.push_back(0.0F, 0.0F, nan);
  points.push_back(0.0F, std::numeric_limits<float>::infinity(), 0.0F);
  points.push_back(0.0F, 0.0F, 4.0F);   // at max_height
  points.push_back(0.0F, 0.0F, -8.1F);  // below min_height
  points.push_back(5.5F, 0.0F, 0.0F);
  points.push_back(0.0F, -1e30F, 0.0F);
  points.push_back(0.0F, 0.0F, 3.99F);
  const FusionCounts counts =
      fuse_scan({points.view(), at(10.0, 0.0), 1.0}, params, workspace, grid);
  EXPECT_EQ(counts.not_finite, 3U);
  EXPECT_EQ(counts.too_high, 1U);
  EXPECT_EQ(counts.too_low, 1U);
  EXPECT_EQ(counts.outside, 2U);
  EXPECT_EQ(counts.fused, 1U);
  EXPECT_EQ(counts.no_room, 0U);
}

TEST(FuseScan, NoPointsOrOneOrEqualOnes) {
  const FusionParams params = growing();
  for (const int n : {0, 1, 2, 3}) {
    FusedGrid grid(params);
    FusionWorkspace workspace;
    Points points;
    for (int k = 0; k < n; ++k) points.push_back(1.1F, 1.1F, 0.1F);
    fuse_scan({points.view(), at(0.0, 0.0), 1.0}, params, workspace, grid);
    EXPECT_EQ(grid.now().scans, 1U);
    FusedCell cell;
    EXPECT_EQ(read_cell(grid.now(), {4, 4}, params, cell), n > 0);
    if (n == 0) continue;
    EXPECT_NEAR(cell.height, 0.1, 1e-5);
    EXPECT_NEAR(cell.variance, 0.0, 1e-12);
    EXPECT_EQ(cell.h_min, cell.h_max);
    EXPECT_EQ(cell.moments.n, n);
  }
}

TEST(FuseScan, EqualsAPassOverAllPoints) {
  FusionParams params = growing();
  params.renew_scans = 0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  std::map<std::tuple<int, int, int>, std::vector<Eigen::Vector3d>> all;
  for (int k = 0; k < 12; ++k) {
    const Points points = cloud(static_cast<std::uint64_t>(k), 4000);
    const Eigen::Isometry3d pose = at(1000.0 + 0.7 * k, -500.0, 20.0, 0.1 * k);
    fuse_scan({points.view(), pose, 1.0 * k}, params, workspace, grid);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = pose * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
      const Eigen::Vector3d cell = (p / 0.25).array().floor();
      all[{static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}]
          .push_back(p);
    }
  }
  EXPECT_EQ(memory_of(grid).bins, all.size());
  for (const auto& [key, points] : all) {
    const MapCell where{std::get<0>(key), std::get<1>(key)};
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
    bool found = false;
    for (const HeightBin& bin : bins_at(grid, where)) {
      if (bin.layer != std::get<2>(key)) continue;
      found = true;
      const Moments m = moments_of(bin, grid.now().lattice);
      const Position2 centre = grid.now().lattice.centre_of(where);
      ASSERT_EQ(m.n, static_cast<double>(points.size()));
      // A point is rounded by 2^-17 m at most, a mean of 0.25 m by 2^-27 m a scan.
      EXPECT_NEAR(m.mean_x + centre.x, mean.x(), 9e-6);
      EXPECT_NEAR(m.mean_y + centre.y, mean.y(), 9e-6);
      EXPECT_NEAR(m.mean_z, mean.z(), 9e-6);
      // |sum of 2 d e| <= 2 sqrt(sum of d^2) sqrt(n) 2^-17 (Cauchy and Schwarz).
      const double tolerance =
          std::sqrt(scatter.trace() * m.n) / 65536 + 1e-6 * scatter.trace() + 1e-9;
      EXPECT_NEAR(m.m_xx, scatter(0, 0), tolerance);
      EXPECT_NEAR(m.m_xy, scatter(0, 1), tolerance);
      EXPECT_NEAR(m.m_xz, scatter(0, 2), tolerance);
      EXPECT_NEAR(m.m_yy, scatter(1, 1), tolerance);
      EXPECT_NEAR(m.m_yz, scatter(1, 2), tolerance);
      EXPECT_NEAR(m.m_zz, scatter(2, 2), tolerance);
    }
    EXPECT_TRUE(found);
  }
}

TEST(FuseScan, DoesNotDependOnTheOrderOfThePoints) {
  const FusionParams params = growing();
  FusedGrid a(params);
  FusedGrid b(params);
  FusionWorkspace workspace;
  for (int k = 0; k < 25; ++k) {
    const Points points = cloud(static_cast<std::uint64_t>(k), 3000, 3.0);
    const Points other = worlds::shuffled(points, 99);
    const Eigen::Isometry3d pose = at(0.31 * k, 0.17 * k, 0.0, 0.2 * k);
    fuse_scan({points.view(), pose, 1.0 * k}, params, workspace, a);
    fuse_scan({other.view(), pose, 1.0 * k}, params, workspace, b);
  }
  EXPECT_GT(bytes_of(a.now()).size(), 100000U);
  EXPECT_TRUE(bytes_of(a.now()) == bytes_of(b.now()));
}

TEST(FuseScan, ShiftingTheMapByWholeCellsShiftsTheResult) {
  const FusionParams params = growing();
  FusedGrid here(params);
  FusedGrid there(params);
  FusionWorkspace workspace;
  const MapCell shift{-4001, 12345};
  for (int k = 0; k < 8; ++k) {
    // Positions and coordinates are short binary numbers, so that shifting them rounds nothing.
    Points points = cloud(static_cast<std::uint64_t>(k), 3000, 4.0);
    for (auto* axis : {&points.x, &points.y, &points.z}) {
      for (float& v : *axis) v = std::round(v * 4096.0F) / 4096.0F;
    }
    const double x = 0.5 * k;
    fuse_scan({points.view(), at(x, 0.0), 1.0 * k}, params, workspace, here);
    fuse_scan({points.view(), at(x + shift.i * 0.25, shift.j * 0.25), 1.0 * k}, params, workspace,
              there);
  }
  EXPECT_TRUE(bytes_of(here.now(), shift) == bytes_of(there.now()));
}

TEST(FuseScan, ARollingMapIsTheGrowingOneWithinItsWindow) {
  FusionParams params = growing();
  FusionParams rolling = params;
  rolling.extent = FusionExtent::kRolling;
  rolling.length = 16.0;
  rolling.width = 12.0;
  FusedGrid all(params);
  FusedGrid window(rolling);
  FusionWorkspace workspace;
  for (int k = 0; k < 60; ++k) {
    const Points points = cloud(static_cast<std::uint64_t>(k), 2000);
    // Ahead, aside, back to where it was, and a jump: what left must not come back.
    const double x = k < 40 ? 0.83 * k : 0.83 * (80 - k) + (k > 55 ? 100.0 : 0.0);
    const Eigen::Isometry3d pose = at(x, -0.41 * k, 0.0, 0.3 * k);
    fuse_scan({points.view(), pose, 1.0 * k}, rolling, workspace, window);
    const MapCellRect kept = window.now().window;
    move_window(kept, all);
    fuse_scan({points.view(), pose, 1.0 * k}, params, workspace, all);
    move_window(kept, all);
    ASSERT_TRUE(bytes_of(all.now()) == bytes_of(window.now())) << "scan " << k;
    ASSERT_GE(pose.translation().x(), kept.low.i * 0.25 + 6.9) << "the robot is in the middle";
    ASSERT_LE(pose.translation().x(), kept.high.i * 0.25 - 6.9);
  }
  EXPECT_GT(memory_of(window).cells, 500U);
}

TEST(FuseScan, CellsThatLeftTheWindowAreForgotten) {
  FusionParams params = growing();
  params.extent = FusionExtent::kRolling;
  params.length = params.width = 10.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  const Points points = cloud(1, 5000);
  fuse_scan({points.view(), at(0.0, 0.0), 0.0}, params, workspace, grid);
  EXPECT_TRUE(bins_at(grid, {19, 0}).size() > 0U);
  EXPECT_TRUE(bins_at(grid, {20, 0}).empty()) << "the window reaches 5 m";
  fuse_scan({Points{}.view(), at(6.0, 0.0), 1.0}, params, workspace, grid);
  EXPECT_TRUE(bins_at(grid, {3, 0}).empty());
  EXPECT_FALSE(bins_at(grid, {4, 0}).empty());
  fuse_scan({Points{}.view(), at(0.0, 0.0), 2.0}, params, workspace, grid);
  EXPECT_TRUE(bins_at(grid, {3, 0}).empty()) << "and does not come back";
  fuse_scan({Points{}.view(), at(1000.0, 0.0), 3.0}, params, workspace, grid);
  EXPECT_EQ(memory_of(grid).tiles, 0U);
}

TEST(FuseScan, ALayerKnowsTheLastScansThatHitIt) {
  FusionParams params = growing();
  params.renew_scans = 4;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  Points old;
  old.push_back(0.1F, 0.1F, 0.2F);
  Points fresh;
  fresh.push_back(0.1F, 0.1F, 0.01F);
  for (int k = 0; k < 3; ++k) fuse_scan({old.view(), at(0, 0), 1.0 * k}, params, workspace, grid);
  for (int k = 3; k < 7; ++k) {
    fuse_scan({fresh.view(), at(0, 0), 1.0 * k}, params, workspace, grid);
    EXPECT_NEAR(cell_at(grid, params, {0, 0}).h_max, 0.2, 1e-4);
  }
  fuse_scan({fresh.view(), at(0, 0), 7.0}, params, workspace, grid);
  // The first four scans are gone without a trace; the last four are there.
  const FusedCell cell = cell_at(grid, params, {0, 0});
  EXPECT_NEAR(cell.h_max, 0.01, 1e-4);
  EXPECT_NEAR(cell.height, 0.01, 1e-4);
  EXPECT_NEAR(cell.variance, 0.0, 1e-9);
  EXPECT_EQ(cell.moments.n, 4.0);
  for (int k = 8; k < 400; ++k) {
    fuse_scan({fresh.view(), at(0, 0), 1.0 * k}, params, workspace, grid);
    const double n = cell_at(grid, params, {0, 0}).moments.n;
    EXPECT_GE(n, 4.0);
    EXPECT_LT(n, 8.0);
  }
}

TEST(FuseScan, WhatWasNotSeenForLongIsForgotten) {
  FusionParams params = growing();
  params.max_age = 5.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  Points a;
  a.push_back(0.1F, 0.1F, 0.1F);
  a.push_back(2.1F, 0.1F, 0.1F);
  Points b;
  b.push_back(0.1F, 0.1F, 1.1F);
  fuse_scan({a.view(), at(0, 0), 0.0}, params, workspace, grid);
  fuse_scan({b.view(), at(0, 0), 5.0}, params, workspace, grid);
  EXPECT_EQ(bins_at(grid, {0, 0}).size(), 2U);
  EXPECT_EQ(cell_at(grid, params, {0, 0}).last_seen, 5.0);
  fuse_scan({b.view(), at(0, 0), 5.5}, params, workspace, grid);
  EXPECT_EQ(bins_at(grid, {0, 0}).size(), 1U) << "cells that are touched forget at once";
  FusedCell cell;
  EXPECT_FALSE(read_cell(grid.now(), {8, 0}, params, cell)) << "others are not read any more";
  EXPECT_EQ(bins_at(grid, {8, 0}).size(), 1U);
  forget_before(5.5 - params.max_age, grid);
  EXPECT_TRUE(bins_at(grid, {8, 0}).empty());
  EXPECT_EQ(memory_of(grid).bins, 1U);
}

TEST(FuseScan, LongRunsFarFromTheOriginLoseNoDigits) {
  FusionParams params = growing();
  params.renew_scans = 0;
  params.max_height = 2000.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  RandomGenerator random(5);
  // One point a scan: the hardest case, because every scan is rounded.
  const double far = 200000.0;
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kScans = 1000000;
  Points points;
  points.resize(1);
  for (int k = 0; k < kScans; ++k) {
    const double z = 0.125 + 0.01 * worlds::normal_deviate(random);
    points.z[0] = static_cast<float>(z);
    points.x[0] = static_cast<float>(0.125 + 0.05 * (random.uniform() - 0.5));
    points.y[0] = 0.125F;
    fuse_scan({points.view(), at(far, -far, 1000.0), 0.1 * k}, params, workspace, grid);
    sum += z;
    squares += (z - 0.125) * (z - 0.125);
  }
  const MapCell where{800000, -800000};
  ASSERT_EQ(bins_at(grid, where).size(), 1U);
  const FusedCell cell = cell_at(grid, params, where);
  EXPECT_EQ(cell.moments.n, kScans);
  const double mean = sum / kScans;
  EXPECT_NEAR(cell.height, 1000.0 + mean, 2e-5);
  const double variance = squares / kScans - (mean - 0.125) * (mean - 0.125);
  EXPECT_NEAR(cell.variance / variance, 1.0, 1e-3);
  EXPECT_NEAR(cell.moments.m_xx / kScans, 0.05 * 0.05 / 12, 1e-6);
}

TEST(FuseScan, ASteadyDriveDoesNotAllocate) {
  FusionParams params;
  params.length = params.width = 14.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  const Points points = cloud(3, 5000, 7.0);
  FusedSnapshot published;
  const auto drive = [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      fuse_scan({points.view(), at(0.4 * k, 0.1 * k), 0.1 * k}, params, workspace, grid);
      if (k % 2 == 0) published = grid.snapshot();
    }
  };
  drive(0, 400);
  const std::size_t before = bench::allocations();
  drive(400, 600);
  EXPECT_EQ(bench::allocations(), before);
}

TEST(FusedGrid, ClearForgetsAllButTheLattice) {
  const FusionParams params = growing();
  FusedGrid grid(params);
  FusionWorkspace workspace;
  const Points points = cloud(1, 100);
  fuse_scan({points.view(), at(0, 0), 1.0}, params, workspace, grid);
  grid.clear();
  EXPECT_EQ(memory_of(grid).cells, 0U);
  EXPECT_EQ(grid.now().scans, 0U);
  EXPECT_EQ(grid.now().lattice, MapLattice(0.25, 0.25));
}

}  // namespace
}  // namespace mrpt_terrain
