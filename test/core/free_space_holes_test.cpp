// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/free_space_holes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "field_worlds.h"

namespace mrpt_terrain {
namespace {

/// Level ground at z = `height` of the scan's frame, seen all around.
GroundSurface level_ground(double height) {
  Points points;
  worlds::add_surface(points, {-6.0, 6.0, -6.0, 6.0}, 0.1,
                      [height](double, double) { return height; });
  worlds::FieldStages stages;
  worlds::measure(points, worlds::field_params(), stages);
  return stages.field.surface;
}

/// Cells of 0.2 m and layers of 0.1 m that are free from z = 1 m down to `low(x, y)` in a square of
/// 8 m about the map's origin.
template <class Low>
FreeSpaceGrid free_down_to(Low&& low) {
  FreeSpaceGrid grid;
  grid.lattice = MapLattice(0.2, 0.1);
  for (std::int32_t i = -20; i < 20; ++i) {
    for (std::int32_t j = -20; j < 20; ++j) {
      const Position2 at = grid.lattice.centre_of({i, j});
      grid.begin_cell({i, j});
      grid.add_span({static_cast<std::int32_t>(std::lround(low(at.x, at.y) / 0.1)), 10});
    }
  }
  return grid;
}

struct Found {
  FreeSpaceHoleWorkspace workspace;
  std::vector<HoleDescription> holes;
  IndexRows cells;
};
Found holes_in(const FreeSpaceGrid& free, const GroundSurface& ground,
               const Eigen::Isometry3d& T_map_scan = Eigen::Isometry3d::Identity(),
               const FreeSpaceHoleParams& params = {}) {
  Found found;
  find_free_space_holes(free, ground, T_map_scan, params, found.workspace, found.holes,
                        found.cells);
  return found;
}

bool in_trench(double x, double y) { return x > 1.0 && x < 2.2 && std::abs(y) < 1.6; }

// Six by sixteen cells of 0.2 m, free down to 0.5 m below the ground.
TEST(FreeSpaceHoles, WhatBeamsHavePassedThroughIsFound) {
  const auto trench = [](double x, double y) { return in_trench(x, y) ? -0.5 : 0.0; };
  const Found found = holes_in(free_down_to(trench), level_ground(0.0));
  ASSERT_EQ(found.holes.size(), 1U);
  const HoleDescription& hole = found.holes[0];
  EXPECT_EQ(hole.kind, HoleKind::kFreeSpace);
  EXPECT_NEAR(hole.centre.x, 1.6, 1e-3);
  EXPECT_NEAR(hole.centre.y, 0.0, 1e-3);
  EXPECT_NEAR(hole.length, 3.2, 0.01);
  EXPECT_NEAR(hole.width, 1.2, 0.01);
  EXPECT_NEAR(hole.depth, 0.5, 1e-3);
  EXPECT_EQ(found.cells.row(0).size(), 6U * 16U);
  EXPECT_EQ(hole.slot, -1);
}

// The same with a scan elsewhere in the map, turned and 2 m up.
TEST(FreeSpaceHoles, TheFrameOfTheScanIsThatOfTheHole) {
  Eigen::Isometry3d T_map_scan = Eigen::Isometry3d::Identity();
  T_map_scan.translation() = Eigen::Vector3d(0.6, -0.4, 2.0);
  T_map_scan.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto trench = [](double x, double y) { return in_trench(x, y) ? -0.5 : 0.0; };
  const Found found = holes_in(free_down_to(trench), level_ground(-2.0), T_map_scan);
  ASSERT_EQ(found.holes.size(), 1U);
  // (1.6, 0) of the map, from (0.6, -0.4): 1 m along -y of the scan, 0.4 m along its x.
  EXPECT_NEAR(found.holes[0].centre.x, 0.4, 1e-3);
  EXPECT_NEAR(found.holes[0].centre.y, -1.0, 1e-3);
  EXPECT_NEAR(found.holes[0].depth, 0.5, 1e-3);
}

// Rays along the ground free the layer that it lies in, and one below where voxels are coarse.
TEST(FreeSpaceHoles, GrazingRaysAreNone) {
  for (const double low : {0.1, 0.0, -0.1, -0.2}) {
    const Found found =
        holes_in(free_down_to([low](double, double) { return low; }), level_ground(0.0));
    EXPECT_TRUE(found.holes.empty()) << low;
  }
}

// Space that is free deep below, but not up to the ground, is another storey.
TEST(FreeSpaceHoles, ATunnelBelowIsNone) {
  FreeSpaceGrid grid;
  grid.lattice = MapLattice(0.2, 0.1);
  for (std::int32_t i = 0; i < 10; ++i) {
    for (std::int32_t j = 0; j < 10; ++j) {
      grid.begin_cell({i, j});
      grid.add_span({-30, -10});
      grid.add_span({0, 10});
    }
  }
  EXPECT_TRUE(holes_in(grid, level_ground(0.0)).holes.empty());
}

TEST(FreeSpaceHoles, EveryParameterCounts) {
  const FreeSpaceGrid grid =
      free_down_to([](double x, double y) { return in_trench(x, y) ? -0.5 : 0.0; });
  const GroundSurface ground = level_ground(0.0);
  FreeSpaceHoleParams params;
  params.least_depth = 0.6;
  EXPECT_TRUE(holes_in(grid, ground, Eigen::Isometry3d::Identity(), params).holes.empty());
  params = {};
  params.least_area = 4.0;
  EXPECT_TRUE(holes_in(grid, ground, Eigen::Isometry3d::Identity(), params).holes.empty());
}

TEST(FreeSpaceHoles, NothingKnownNothingFound) {
  FreeSpaceGrid grid;
  grid.lattice = MapLattice(0.2, 0.1);
  EXPECT_TRUE(holes_in(grid, level_ground(0.0)).holes.empty());
}

}  // namespace
}  // namespace mrpt_terrain
