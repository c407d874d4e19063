// SPDX-License-Identifier: BSD-3-Clause
// Field mode on fused grids: the last scan and what the cells remember.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "allocation_counter.h"
#include "field_worlds.h"
#include "fused_worlds.h"
#include "mrpt_terrain/core/describe_fused.h"
#include "remembered_points.h"

namespace mrpt_terrain {
namespace {

using worlds::Rect;

constexpr std::array<float, 3> kSensor{0.0F, 0.0F, 0.81F};

struct Robot {
  FusionParams fusion;
  DescriptionParams params = worlds::field_params();
  FusedGrid grid{fusion};
  FusionWorkspace fusing;
  FusedDescriptionWorkspace workspace;
  FusedDescription result;
  double time = 0.0;

  void fuse(const Points& points, const Eigen::Isometry3d& pose) {
    time += 0.1;
    fuse_scan({points.view(), pose, time}, fusion, fusing, grid);
  }
  const FusedDescription& describe(const Points& points, const Eigen::Isometry3d& pose) {
    BeamOrigins origins;
    origins.origins = &kSensor;
    describe_fused(grid.now(), {{points.view(), pose, time}, origins, 1}, {params, fusion},
                   workspace, result);
    return result;
  }
};

Eigen::Isometry3d at(double x, double y, double z = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

constexpr Rect kBox{3.0, 3.6, 1.0, 1.6};
constexpr Rect kHole{1.9, 2.7, -0.4, 0.4};

worlds::Scene box_and_hole() {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid(kBox, 0.0, 0.5, 1));
  scene.holes.push_back(worlds::box_solid(kHole, -0.15, 0.0, 2));
  return scene;
}

Points scan_of(const worlds::Scene& scene, std::uint64_t seed, double half_angle = 180.0) {
  RandomGenerator random(seed, 0);
  return worlds::drive_scan(scene, worlds::thirty_two_beams(0.005), 0.0, 0.0, random, half_angle)
      .points;
}

/// Class of the cell at a place of the window.
TerrainClass class_at(const Description& d, double x, double y) {
  CellIndex cell;
  if (!d.grid.geometry.cell_at(x, y, cell)) return TerrainClass::kNone;
  const Slot slot = d.grid.slot_at(cell);
  return slot == kUnobserved ? TerrainClass::kNone
                             : d.cells.terrain_class[static_cast<std::size_t>(slot)];
}

Position2 middle_of(const Rect& r) { return {0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1)}; }

// A scan that the map has taken first adds nothing to itself.
TEST(DescribeFusedField, OfOneScanIsTheDescriptionOfTheScan) {
  Robot robot;
  const Points points = scan_of(box_and_hole(), 1);
  const Eigen::Isometry3d pose = at(12.0, -40.0, 3.0);
  robot.fuse(points, pose);
  const Description& fused = robot.describe(points, pose).description;
  ASSERT_NEAR(robot.result.frame.x, 12.0, 1e-9) << "else the cells differ";
  Description single;
  DescriptionWorkspace workspace;
  BeamOrigins origins;
  origins.origins = &kSensor;
  describe({points.view(), origins}, robot.params, workspace, single);
  EXPECT_EQ(fused.grid.cell, single.grid.cell);
  EXPECT_EQ(fused.labels.support, single.labels.support);
  EXPECT_EQ(fused.labels.reason, single.labels.reason);
  EXPECT_EQ(fused.labels.cluster, single.labels.cluster);
  EXPECT_EQ(fused.cells.support, single.cells.support);
  EXPECT_EQ(fused.projection.in_map, single.projection.in_map);
  EXPECT_EQ(fused.projection.outside_map, single.projection.outside_map);
  EXPECT_EQ(fused.holes.size(), single.holes.size());
  ASSERT_EQ(fused.things.size(), single.things.size());
  ASSERT_GE(fused.things.size(), 2U);
  for (std::size_t k = 0; k < single.things.size(); ++k) {
    EXPECT_EQ(fused.things[k].terrain_class, single.things[k].terrain_class);
    EXPECT_EQ(fused.things[k].points, single.things[k].points);
    EXPECT_EQ(fused.things[k].box.length, single.things[k].box.length);
  }
}

// The robot turns away from a box and a hole; a box behind it comes into sight.
TEST(DescribeFusedField, WhatIsOutOfSightIsRemembered) {
  Robot robot;
  worlds::Scene scene = box_and_hole();
  for (std::uint64_t k = 1; k <= 3; ++k) robot.fuse(scan_of(scene, k, 60.0), at(0, 0));
  Points behind = scan_of(scene, 4, 180.0);
  Points seen;
  for (std::size_t i = 0; i < behind.size(); ++i) {
    if (behind.x[i] < 0.0F) seen.push_back(behind.x[i], behind.y[i], behind.z[i]);
  }
  robot.fuse(seen, at(0, 0));
  const Description& d = robot.describe(seen, at(0, 0)).description;
  const Position2 box = middle_of(kBox), hole = middle_of(kHole);
  const double edge = kBox.x0 + 0.1;  // the sensor looks over its top at nothing but its front
  EXPECT_EQ(class_at(d, edge, box.y), TerrainClass::kObstacle);
  EXPECT_EQ(class_at(d, hole.x, hole.y), TerrainClass::kPothole);
  EXPECT_EQ(d.labels.support.size(), seen.size()) << "labels are of the scan's points alone";
  EXPECT_EQ(robot.result.cells.height.size(), d.grid.observed());
  for (const ClusterDescription& thing : d.things) {
    if (std::abs(thing.centroid.x - box.x) > 0.5 || std::abs(thing.centroid.y - box.y) > 0.5)
      continue;
    EXPECT_NEAR(thing.box.high, 0.5, 0.06);
  }
  Description single;
  DescriptionWorkspace workspace;
  describe(seen.view(), robot.params, workspace, single);
  EXPECT_EQ(class_at(single, edge, box.y), TerrainClass::kNone) << "the scan alone knows nothing";
}

// A scan whose pose was 15 cm too high leaves a second ground; the next one sees where it is.
TEST(DescribeFusedField, GroundUnderAWrongPoseIsNoThing) {
  Robot robot;
  const worlds::Scene empty;
  robot.fuse(scan_of(empty, 1), at(0, 0, 0.25));
  const Points last = scan_of(empty, 2);
  robot.fuse(last, at(0, 0, 0.1));
  const Description& d = robot.describe(last, at(0, 0, 0.1)).description;
  std::size_t of_things = 0, near = 0;
  for (std::size_t slot = 0; slot < d.grid.observed(); ++slot) {
    const Position2 centre = d.grid.geometry.centre_of(d.grid.geometry.index_of(d.grid.cell[slot]));
    if (std::hypot(centre.x, centre.y) > 4.0) continue;  // four points of the scan in a cell
    ++near;
    of_things += d.cells.terrain_class[slot] != TerrainClass::kNone ? 1 : 0;
  }
  EXPECT_GT(near, 500U);
  EXPECT_LT(static_cast<double>(of_things), 0.1 * static_cast<double>(near));
}

// Costs and likelihoods read the sums of the cells: those of all scans.
TEST(DescribeFusedField, SumsOfCellsAreThoseOfAllPoints) {
  Robot robot;
  std::size_t points = 0;
  for (std::uint64_t k = 1; k <= 3; ++k) {
    const Points scan = scan_of(box_and_hole(), k);
    points += scan.size();
    robot.fuse(scan, at(0, 0));
  }
  const Points last = scan_of(box_and_hole(), 3);
  const Description& d = robot.describe(last, at(0, 0)).description;
  double held = 0.0;
  for (std::size_t slot = 0; slot < d.grid.observed(); ++slot) {
    held += d.grid.sums[slot].n;
    ASSERT_NEAR(d.grid.h_mean[slot], d.grid.sums[slot].z / d.grid.sums[slot].n, 1e-5);
  }
  // Some points lie beyond the window of 30 m.
  EXPECT_GT(held, 0.8 * static_cast<double>(points));
  EXPECT_LE(held, static_cast<double>(points));
}

// The ages of the map are those of the description.
TEST(DescribeFusedField, WhatIsTooOldIsForgotten) {
  Robot robot;
  robot.fusion.max_age = 1.0;
  robot.fuse(scan_of(box_and_hole(), 1, 60.0), at(0, 0));
  robot.time += 5.0;
  const Points none;
  robot.fuse(none, at(0, 0));
  EXPECT_EQ(robot.describe(none, at(0, 0)).description.grid.observed(), 0U);
}

TEST(DescribeFusedField, WithoutPointsTheWindowIsWhatIsRemembered) {
  Robot robot;
  robot.fuse(scan_of(box_and_hole(), 1), at(0, 0));
  const Points none;
  robot.fuse(none, at(0, 0));
  const Description& d = robot.describe(none, at(0, 0)).description;
  EXPECT_GT(d.grid.observed(), 500U);
  EXPECT_TRUE(d.labels.support.empty());
  EXPECT_EQ(class_at(d, kBox.x0 + 0.1, middle_of(kBox).y), TerrainClass::kObstacle);
}

// The points that stand for a bin have its mean and covariance. Oracle: those of the points.
TEST(DescribeFusedField, RememberedPointsHaveMeanAndCovarianceOfTheirBin) {
  for (const int n : {1, 2, 3, 4, 7, 60}) {
    Robot robot;
    RandomGenerator random(static_cast<std::uint64_t>(n), 7);
    Points points;
    // In the middle of a cell and a layer, so that nothing is cut at their borders.
    for (int k = 0; k < n; ++k) {
      const double x = 0.05 + 0.1 * random.uniform(), y = 0.06 + 0.08 * random.uniform();
      const double z = 0.03 + 0.14 * random.uniform();
      points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
    robot.fuse(points, at(0, 0));
    const Points none;
    robot.fuse(none, at(0, 0));
    const WindowFrame frame =
        window_around(robot.grid.now().lattice, robot.params.grid, Eigen::Vector3d::Zero());
    RememberedWorkspace workspace;
    Points remembered;
    append_remembered(robot.grid.now(), frame, robot.fusion, 0, workspace, remembered);
    ASSERT_EQ(remembered.size(), static_cast<std::size_t>(n < 3 ? n : 4));
    MomentSums expected, found;
    for (std::size_t i = 0; i < points.size(); ++i)
      expected.add(points.x[i], points.y[i], points.z[i]);
    for (std::size_t i = 0; i < remembered.size(); ++i)
      found.add(remembered.x[i], remembered.y[i], remembered.z[i]);
    const Moments a = moments_from(expected), b = moments_from(found);
    EXPECT_NEAR(b.mean_x + frame.x, a.mean_x, 2e-5) << n;
    EXPECT_NEAR(b.mean_z, a.mean_z, n < 5 ? 1e-2 : 2e-5) << n << ": heights stay in the bin's";
    const Eigen::Matrix3d c = a.covariance(), e = b.covariance();
    EXPECT_NEAR(e(0, 0), c(0, 0), 1e-6) << n;
    EXPECT_NEAR(e(0, 1), c(0, 1), 1e-6) << n;
    EXPECT_NEAR(e(1, 1), c(1, 1), 1e-6) << n;
    if (n < 5) continue;
    EXPECT_NEAR(e(0, 2), c(0, 2), 1e-6) << n;
    EXPECT_NEAR(e(1, 2), c(1, 2), 1e-6) << n;
    EXPECT_NEAR(e(2, 2), c(2, 2), 1e-6) << n;
  }
}

// Ground needs two points only: in each cell on one diagonal.
TEST(DescribeFusedField, FlatBinsAreRememberedByTwoPoints) {
  Robot robot;
  RandomGenerator random(1, 8);
  Points points;
  for (int k = 0; k < 50; ++k)
    points.push_back(static_cast<float>(0.2 * random.uniform()),
                     static_cast<float>(0.2 * random.uniform()),
                     static_cast<float>(0.08 + 0.02 * random.uniform()));
  robot.fuse(points, at(0, 0));
  const Points none;
  robot.fuse(none, at(0, 0));
  const WindowFrame frame =
      window_around(robot.grid.now().lattice, robot.params.grid, Eigen::Vector3d::Zero());
  RememberedWorkspace workspace;
  Points remembered;
  append_remembered(robot.grid.now(), frame, robot.fusion, 0, workspace, remembered);
  ASSERT_EQ(remembered.size(), 2U);
  MomentSums expected;
  for (std::size_t i = 0; i < points.size(); ++i)
    expected.add(points.x[i], points.y[i], points.z[i]);
  const Moments m = moments_from(expected);
  const auto mean = [](const std::vector<float>& v) { return 0.5 * double{v[0] + v[1]}; };
  EXPECT_NEAR(mean(remembered.x) + frame.x, m.mean_x, 2e-5);
  EXPECT_NEAR(mean(remembered.y) + frame.y, m.mean_y, 2e-5);
  EXPECT_NEAR(mean(remembered.z), m.mean_z, 2e-5);
  EXPECT_NEAR(0.5 * std::abs(double{remembered.x[0] - remembered.x[1]}),
              std::sqrt(m.covariance()(0, 0)), 1e-4);
}

TEST(DescribeFusedField, TheSameMapGivesTheSameBytes) {
  Robot robot;
  for (std::uint64_t k = 1; k <= 3; ++k)
    robot.fuse(scan_of(box_and_hole(), k), at(0.13 * static_cast<double>(k), 0.0));
  const Points last = scan_of(box_and_hole(), 3);
  const FusedDescription first = robot.describe(last, at(0.39, 0.0));
  Robot fresh;
  fresh.time = robot.time;
  describe_fused(robot.grid.snapshot(), {{last.view(), at(0.39, 0.0), robot.time}, {}, 0},
                 {robot.params, robot.fusion}, fresh.workspace, fresh.result);
  describe_fused(robot.grid.now(), {{last.view(), at(0.39, 0.0), robot.time}, {}, 0},
                 {robot.params, robot.fusion}, robot.workspace, robot.result);
  EXPECT_EQ(fresh.result.description.labels.support, robot.result.description.labels.support);
  EXPECT_EQ(fresh.result.description.grid.h_mean, robot.result.description.grid.h_mean);
  EXPECT_EQ(first.description.grid.h_mean, robot.result.description.grid.h_mean);
  EXPECT_EQ(fresh.result.cells.height, robot.result.cells.height);
}

TEST(DescribeFusedField, ASteadyDriveDoesNotAllocate) {
  Robot robot;
  const Points points = scan_of(box_and_hole(), 1);
  for (int k = 0; k < 3; ++k) {
    robot.fuse(points, at(0.0, 0.0));
    robot.describe(points, at(0.0, 0.0));
  }
  const std::size_t before = bench::allocations();
  robot.describe(points, at(0.0, 0.0));
  EXPECT_EQ(bench::allocations() - before, 0U);
}

}  // namespace
}  // namespace mrpt_terrain
