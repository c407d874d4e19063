// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/elevation_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::add_point;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// A grid built in fresh memory.
struct Built {
  ElevationGrid grid;
  PointSlots point_slots;
  ProjectionCounts counts;
};
Built built(const Points& points, const GridParams& params) {
  Built result;
  ElevationGridWorkspace workspace;
  result.counts =
      build_elevation_grid(points.view(), params, workspace, result.grid, result.point_slots);
  return result;
}

GridParams metre_cells(double length, double width) { return {length, width, 1.0, 1.5}; }

Points random_points(std::size_t n, double half_extent, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const auto coordinate = [&] { return half_extent * (2.0 * random.uniform() - 1.0); };
    const double x = coordinate();
    const double y = coordinate();
    add_point(points, x, y, 2.0 * random.uniform() - 0.3);
  }
  return points;
}

void expect_same_heights(const ElevationGrid& a, const ElevationGrid& b) {
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.slot_of, b.slot_of);
  EXPECT_EQ(a.h_min, b.h_min);
  EXPECT_EQ(a.h_max, b.h_max);
}

// Literal: 5 x 4 cells of 1 m, three of them observed.
TEST(ElevationGrid, FiveByFourCellsByHand) {
  Points points;
  add_point(points, 2.4, 1.9, 1.0);     // cell (4, 3)
  add_point(points, -2.4, -1.9, 0.25);  // cell (0, 0)
  add_point(points, 0.2, 0.3, -0.5);    // cell (2, 2)
  add_point(points, -2.2, -1.2, 0.75);  // cell (0, 0)
  add_point(points, -2.0, -1.5, 0.5);   // cell (0, 0)
  add_point(points, 2.2, 1.7, 0.5);     // cell (4, 3)
  const Built b = built(points, metre_cells(5.0, 4.0));
  ASSERT_EQ(b.grid.observed(), 3U);
  const GridGeometry& geometry = b.grid.geometry;
  EXPECT_EQ(geometry.index_of(b.grid.cell[0]), (CellIndex{0, 0}));
  EXPECT_EQ(geometry.index_of(b.grid.cell[1]), (CellIndex{2, 2}));
  EXPECT_EQ(geometry.index_of(b.grid.cell[2]), (CellIndex{4, 3}));
  EXPECT_EQ(b.grid.h_min, (std::vector<float>{0.25F, -0.5F, 0.5F}));
  EXPECT_EQ(b.grid.h_max, (std::vector<float>{0.75F, -0.5F, 1.0F}));
  EXPECT_EQ(b.grid.h_mean, (std::vector<float>{0.5F, -0.5F, 0.75F}));
  EXPECT_EQ(b.grid.h_diff(0), 0.5F);
  EXPECT_EQ(b.grid.sums[0].n, 3.0);
  EXPECT_EQ(b.grid.sums[0].zz, 0.0625 + 0.5625 + 0.25);
  EXPECT_EQ(b.point_slots, (PointSlots{2, 0, 1, 0, 0, 2}));
  EXPECT_EQ(b.counts.in_map, 6U);
  EXPECT_EQ(b.grid.slot_at({4, 3}), 2);
  EXPECT_EQ(b.grid.slot_at({1, 0}), kUnobserved);
  EXPECT_EQ(b.grid.slot_at({-1, 0}), kUnobserved);
  EXPECT_EQ(b.grid.slot_at({5, 0}), kUnobserved);
}

TEST(ElevationGrid, PointsAreCountedByWhatBecameOfThem) {
  Points points;
  add_point(points, 0.0, 0.0, 0.0);
  points.push_back(kNan, 0.0F, 0.0F);
  points.push_back(0.0F, kInf, 0.0F);
  points.push_back(0.0F, 0.0F, -kInf);
  points.push_back(9.0F, 0.0F, kInf);  // not a number comes before too high and outside
  add_point(points, 0.0, 0.0, 1.5);    // "below 1.5 m"
  add_point(points, 9.0, 0.0, 7.0);    // too high comes before outside
  add_point(points, 2.5, 0.0, 0.0);
  const Built b = built(points, metre_cells(5.0, 5.0));
  EXPECT_EQ(b.counts.in_map, 1U);
  EXPECT_EQ(b.counts.not_finite, 4U);
  EXPECT_EQ(b.counts.too_high, 2U);
  EXPECT_EQ(b.counts.outside_map, 1U);
  const std::vector<UnknownReason> expected = {
      UnknownReason::kNone,      UnknownReason::kNotFinite, UnknownReason::kNotFinite,
      UnknownReason::kNotFinite, UnknownReason::kNotFinite, UnknownReason::kTooHigh,
      UnknownReason::kTooHigh,   UnknownReason::kOutsideMap};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(reason_of(b.point_slots[i]), expected[i]) << "point " << i;
  }
}

TEST(ElevationGrid, PointsJustBelowTheGreatestHeightCount) {
  Points points;
  points.push_back(0.0F, 0.0F, std::nextafter(1.5F, 0.0F));
  EXPECT_EQ(built(points, GridParams{}).counts.in_map, 1U);
}

// Oracle: cells found with the formula of the paper, their heights sorted.
TEST(ElevationGrid, EqualsCellByCellStatistics) {
  for (const double size : {0.1, 0.15, 0.4}) {
    const GridParams params{4.0, 3.0, size, 1.2};
    const Points points = random_points(5000, 2.2, 11);
    const Built b = built(points, params);
    std::map<std::pair<int, int>, std::vector<float>> heights;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int l = static_cast<int>(std::floor((double{points.x[i]} + 2.0) / size));
      const int w = static_cast<int>(std::floor((double{points.y[i]} + 1.5) / size));
      const bool inside = l >= 0 && l < 4.0 / size && w >= 0 && w < 3.0 / size - 1e-9;
      if (inside && points.z[i] < 1.2F) heights[{l, w}].push_back(points.z[i]);
    }
    ASSERT_EQ(b.grid.observed(), heights.size()) << "cell size " << size;
    std::size_t slot = 0;
    for (auto& [cell, h] : heights) {
      std::sort(h.begin(), h.end());
      EXPECT_EQ(b.grid.geometry.index_of(b.grid.cell[slot]), (CellIndex{cell.first, cell.second}));
      EXPECT_EQ(b.grid.h_min[slot], h.front());
      EXPECT_EQ(b.grid.h_max[slot], h.back());
      EXPECT_EQ(b.grid.sums[slot].n, static_cast<double>(h.size()));
      const double mean = std::accumulate(h.begin(), h.end(), 0.0) / static_cast<double>(h.size());
      // One rounding to float of a number below 2.
      EXPECT_NEAR(b.grid.h_mean[slot], mean, 1.2e-7);
      ++slot;
    }
  }
}

// Oracle: moments of a slot equal those of its points taken from the list of slots.
TEST(ElevationGrid, MomentsAreThoseOfThePointsOfTheSlot) {
  const Points points = random_points(2000, 2.0, 12);
  const Built b = built(points, metre_cells(4.0, 4.0));
  for (std::size_t slot = 0; slot < b.grid.observed(); ++slot) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    double n = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (b.point_slots[i] != static_cast<Slot>(slot)) continue;
      const Eigen::Vector3d p(points.x[i], points.y[i], points.z[i]);
      mean += p;
      second += p * p.transpose();
      n += 1.0;
    }
    const Moments moments = b.grid.moments(slot);
    ASSERT_EQ(moments.n, n);
    EXPECT_LT((moments.mean() - mean / n).norm(), 1e-13);
    const Eigen::Matrix3d covariance = second / n - mean * mean.transpose() / (n * n);
    EXPECT_LT((moments.covariance() - covariance).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ElevationGrid, SlotsAreSortedAndInverseToCells) {
  const Built b = built(random_points(3000, 2.5, 13), GridParams{});
  ASSERT_GT(b.grid.observed(), 1000U);
  for (std::size_t slot = 0; slot < b.grid.observed(); ++slot) {
    const std::int32_t id = value_of(b.grid.cell[slot]);
    EXPECT_EQ(b.grid.slot_of[static_cast<std::size_t>(id)], static_cast<Slot>(slot));
    if (slot > 0) {
      EXPECT_GT(id, value_of(b.grid.cell[slot - 1]));
    }
  }
  const auto observed = std::count_if(b.grid.slot_of.begin(), b.grid.slot_of.end(),
                                      [](Slot slot) { return slot != kUnobserved; });
  EXPECT_EQ(static_cast<std::size_t>(observed), b.grid.observed());
}

TEST(ElevationGrid, OrderOfThePointsDoesNotMatter) {
  const Points points = random_points(4000, 2.6, 14);
  std::vector<std::size_t> order;
  const Points mixed = worlds::shuffled(points, 15, &order);
  const Built a = built(points, GridParams{});
  const Built b = built(mixed, GridParams{});
  expect_same_heights(a.grid, b.grid);
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(b.point_slots[i], a.point_slots[order[i]]);
  }
  // A mean is rounded to float after a sum whose order matters at 1e-15 only.
  for (std::size_t slot = 0; slot < a.grid.observed(); ++slot) {
    EXPECT_NEAR(a.grid.h_mean[slot], b.grid.h_mean[slot], 1.2e-7);
  }
}

// Coordinates are multiples of 1/64 m and cells 1/4 m wide, so that shifting is exact.
TEST(ElevationGrid, ShiftByWholeCellsShiftsTheCells) {
  RandomGenerator random(16);
  Points points;
  for (int i = 0; i < 500; ++i) {
    const double x = (static_cast<int>(random.below(128)) - 64) / 64.0;
    const double y = (static_cast<int>(random.below(128)) - 64) / 64.0;
    add_point(points, x, y, random.below(64) / 64.0);
  }
  const GridParams params{8.0, 8.0, 0.25, 1.5};
  const Built a = built(points, params);
  const Built b = built(worlds::shifted(points, 0.75F, -0.5F), params);
  ASSERT_EQ(a.grid.observed(), b.grid.observed());
  for (std::size_t slot = 0; slot < a.grid.observed(); ++slot) {
    const CellIndex before = a.grid.geometry.index_of(a.grid.cell[slot]);
    const CellIndex after = b.grid.geometry.index_of(b.grid.cell[slot]);
    EXPECT_EQ(after, (CellIndex{before.l + 3, before.w - 2}));
  }
  EXPECT_EQ(a.grid.h_min, b.grid.h_min);
  EXPECT_EQ(a.grid.h_max, b.grid.h_max);
  EXPECT_EQ(a.grid.h_mean, b.grid.h_mean);
  EXPECT_EQ(a.point_slots, b.point_slots);
}

TEST(ElevationGrid, MemoryOfOtherScansAndSizesLeavesNoTrace) {
  const Points wide = random_points(6000, 6.0, 17);
  const Points scan = random_points(3000, 2.5, 18);
  const Built fresh = built(scan, GridParams{});
  ElevationGridWorkspace workspace;
  Built reused;
  for (const GridParams& params :
       {GridParams{12.0, 10.0, 0.1, 1.5}, GridParams{0.5, 0.5, 0.5, 1.5}, GridParams{}}) {
    reused.counts =
        build_elevation_grid(wide.view(), params, workspace, reused.grid, reused.point_slots);
    reused.counts =
        build_elevation_grid(scan.view(), GridParams{}, workspace, reused.grid, reused.point_slots);
    expect_same_heights(fresh.grid, reused.grid);
    EXPECT_EQ(fresh.grid.h_mean, reused.grid.h_mean);
    EXPECT_EQ(fresh.point_slots, reused.point_slots);
    EXPECT_EQ(fresh.counts.in_map, reused.counts.in_map);
  }
}

TEST(ElevationGrid, NoPointsGiveAnEmptyGrid) {
  const Built b = built(Points{}, GridParams{});
  EXPECT_EQ(b.grid.observed(), 0U);
  EXPECT_EQ(b.counts.in_map + b.counts.not_finite + b.counts.too_high + b.counts.outside_map, 0U);
  EXPECT_EQ(b.grid.slot_at({0, 0}), kUnobserved);
}

TEST(ElevationGrid, OneCellHoldsEverything) {
  const Built b = built(random_points(100, 0.5, 19), {1.0, 1.0, 1.0, 5.0});
  ASSERT_EQ(b.grid.observed(), 1U);
  EXPECT_EQ(b.grid.sums[0].n, 100.0);
}

// 1 m in cells of 0.3 m: the last row reaches from 0.4 to 0.7 m, beyond L/2.
TEST(ElevationGrid, LastRowOfAnUnevenMapIsWhole) {
  Points points;
  add_point(points, 0.49, 0.0, 0.0);
  add_point(points, 0.69, 0.0, 0.0);
  add_point(points, 0.71, 0.0, 0.0);
  const Built b = built(points, {1.0, 1.0, 0.3, 1.5});
  EXPECT_EQ(b.point_slots[0], b.point_slots[1]);
  EXPECT_EQ(reason_of(b.point_slots[2]), UnknownReason::kOutsideMap);
}

TEST(ElevationGrid, HugeCoordinatesStayFinite) {
  Points points;
  points.push_back(1e30F, 0.0F, 0.0F);
  points.push_back(0.0F, -1e30F, 0.0F);
  points.push_back(0.0F, 0.0F, -1e30F);
  points.push_back(0.01F, 0.01F, std::numeric_limits<float>::lowest());
  const Built b = built(points, GridParams{});
  EXPECT_EQ(b.counts.outside_map, 2U);
  ASSERT_EQ(b.grid.observed(), 1U);
  EXPECT_TRUE(std::isfinite(b.grid.h_mean[0]));
  EXPECT_TRUE(std::isfinite(b.grid.h_diff(0)));
  EXPECT_TRUE(b.grid.moments(0).covariance().allFinite());
}

}  // namespace
}  // namespace mrpt_terrain
