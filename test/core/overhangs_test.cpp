// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/overhangs.h"

#include <gtest/gtest.h>

#include <cstddef>

#include "field_worlds.h"

namespace mrpt_terrain {
namespace {

constexpr worlds::Rect kPatch{-6.0, 6.0, -6.0, 6.0};
constexpr worlds::Rect kThing{2.0, 3.0, 1.0, 2.0};

/// Level ground with a point every 5 cm, and over kThing a layer of points at a height.
Points ground_with_layer(double height) {
  Points points;
  worlds::add_flat(points, kPatch, 0.05, 0.0);
  worlds::add_flat(points, kThing, 0.05, height);
  return points;
}

/// Cells of kThing by what they are to a wheel.
struct Cells {
  int ground = 0, above = 0;
};
Cells cells_under(const Points& points, double robot_height) {
  DescriptionParams params = worlds::field_params();
  params.overhangs.robot_height = robot_height;
  DescriptionWorkspace workspace;
  Description description;
  describe(points.view(), params, workspace, description);
  Cells cells;
  const ElevationGrid& grid = description.grid;
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
    if (!worlds::inside(kThing, centre.x, centre.y)) continue;
    cells.ground += description.cells.support[slot] == Support::kGround ? 1 : 0;
    cells.above += description.cells.support[slot] == Support::kAbove ? 1 : 0;
  }
  return cells;
}

// 25 cells of 0.2 m.
TEST(Overhangs, ARobotFitsUnderABranchButNotUnderASign) {
  EXPECT_EQ(cells_under(ground_with_layer(2.2), 1.2).ground, 25);
  EXPECT_EQ(cells_under(ground_with_layer(1.0), 1.2).above, 25);
}

TEST(Overhangs, ATableIsFreeForALowRobotOnly) {
  const Points table = ground_with_layer(0.75);
  EXPECT_EQ(cells_under(table, 0.6).ground, 25);
  EXPECT_EQ(cells_under(table, 0.8).above, 25);
}

// A pole in one cell under the layer: that cell is no longer free.
TEST(Overhangs, WhatStandsUnderneathCounts) {
  Points points = ground_with_layer(2.2);
  for (int k = 1; k < 20; ++k) worlds::add_point(points, 2.5, 1.5, 0.1 * k);
  const Cells cells = cells_under(points, 1.2);
  EXPECT_EQ(cells.above, 1);
  EXPECT_EQ(cells.ground, 24);
}

// The upper part of a wall whose lower part is hidden, as is the ground: nothing says that it
// hangs.
TEST(Overhangs, GroundMustBeSeen) {
  Points points;
  worlds::add_flat(points, {-6.0, 1.0, -6.0, 6.0}, 0.05, 0.0);
  worlds::add_flat(points, kThing, 0.05, 2.2);
  EXPECT_EQ(cells_under(points, 1.2).ground, 0);
}

// What hangs is still described.
TEST(Overhangs, TheThingIsStillFound) {
  DescriptionParams params = worlds::field_params();
  params.overhangs.robot_height = 1.2;
  DescriptionWorkspace workspace;
  Description description;
  describe(ground_with_layer(2.2).view(), params, workspace, description);
  ASSERT_EQ(description.things.size(), 1U);
  EXPECT_NEAR(description.things[0].height.h_d, 2.2, 0.01);
}

}  // namespace
}  // namespace mrpt_terrain
