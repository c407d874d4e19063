// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "allocation_counter.h"
#include "field_worlds.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using worlds::FieldStages;
using worlds::radians;
using worlds::Rect;

constexpr Rect kPatch{-6.0, 6.0, -6.0, 6.0};
constexpr Rect kPothole{2.0, 2.6, 1.0, 1.6};  // covers nine cells of the grid

struct Holes {
  FieldStages stages;
  HoleWorkspace workspace;

  void find(const Points& points, const HoleParams& params = {}) {
    worlds::measure(points, worlds::field_params(), stages);
    find_holes(stages.field, stages.grid, params, workspace, stages.cells, stages.ground);
  }
  /// Slots whose cells the holes consist of.
  [[nodiscard]] std::vector<std::size_t> cells() const {
    std::vector<std::size_t> result;
    for (std::size_t slot = 0; slot < stages.ground.rule.size(); ++slot) {
      if (stages.ground.rule[slot] == GroundRule::kLow) result.push_back(slot);
    }
    return result;
  }
  [[nodiscard]] Position2 centre_of(std::size_t slot) const {
    const GridGeometry& geometry = stages.grid.geometry;
    return geometry.centre_of(geometry.index_of(stages.grid.cell[slot]));
  }
  [[nodiscard]] float depth_of(std::size_t slot) const {
    return stages.cells.rim[slot] - stages.cells.floor[slot];
  }
};

Holes holes_in(const Points& points, const HoleParams& params = {}) {
  Holes result;
  result.find(points, params);
  return result;
}

/// Level ground of another height where `height` says so.
template <class Height>
Points ground_of(Height&& height) {
  Points points;
  worlds::add_surface(points, kPatch, 0.05, height);
  return points;
}

/// Noise along z.
Points noisy(Points points, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  for (float& z : points.z) z += static_cast<float>(sigma * worlds::normal_deviate(random));
  return points;
}

// Tolerance: the rim is the mean of level ground, the floor that of the cell's points, without
// noise both are exact but for the reference, which lies between rim and floor near the walls and
// takes part in the rim's mean where it is less than 2 cm low: below 1 cm. Cells at the walls hold
// points of these, too, so the cell in the middle is measured.
TEST(Holes, APotholeIsFoundWithItsDepth) {
  const Holes holes = holes_in(worlds::patch_with_hole(kPatch, kPothole, 0.1));
  const std::vector<std::size_t> cells = holes.cells();
  EXPECT_EQ(cells.size(), 9U);
  float deepest = 0.0F;
  for (const std::size_t slot : cells) {
    const Position2 centre = holes.centre_of(slot);
    EXPECT_TRUE(worlds::inside(kPothole, centre.x, centre.y)) << centre.x << " " << centre.y;
    deepest = std::max(deepest, holes.depth_of(slot));
  }
  EXPECT_NEAR(deepest, 0.1, 0.01);
}

// The same depths on ground that is not level, and with the noise of a good sensor.
TEST(Holes, TiltAndNoiseDoNotMatter) {
  const Points level = worlds::patch_with_hole(kPatch, kPothole, 0.1);
  for (const double degrees : {-10.0, -3.0, 0.0, 3.0, 10.0}) {
    for (const double sigma : {0.0, 0.005}) {
      const Points points = worlds::tilted(noisy(level, sigma, 271), radians(degrees), 0.2);
      const Holes holes = holes_in(points);
      // Tilted cells and the hole's edges no longer coincide.
      EXPECT_GE(holes.cells().size(), 6U) << degrees << " " << sigma;
      EXPECT_LE(holes.cells().size(), 16U) << degrees << " " << sigma;
      float deepest = 0.0F;
      for (const std::size_t slot : holes.cells())
        deepest = std::max(deepest, holes.depth_of(slot));
      EXPECT_NEAR(deepest, 0.1, 0.015) << degrees << " " << sigma;
    }
  }
}

TEST(Holes, LevelAndTiltedGroundHasNone) {
  const Points level = ground_of([](double, double) { return 0.0; });
  for (const double degrees : {0.0, 5.0, 15.0}) {
    for (const double sigma : {0.0, 0.01, 0.02}) {
      const Points points = worlds::tilted(noisy(level, sigma, 272), radians(degrees));
      EXPECT_TRUE(holes_in(points).cells().empty()) << degrees << " " << sigma;
    }
  }
}

// As deep as the pothole, but without walls. Analytic: of a bell exp(-r^2 / 2 s^2), the area
// between 0.3 and 0.65 of the depth is ln(0.65 / 0.3) / -ln(0.65) = 1.8 times that which lies
// deeper, more than `wall_share`.
TEST(Holes, ABellShapedDipIsNone) {
  for (const double sigma : {0.5, 0.8, 1.5}) {
    const Points points = ground_of([sigma](double x, double y) {
      const double r = std::hypot(x - 2.0, y - 1.0) / sigma;
      return -0.1 * std::exp(-0.5 * r * r);
    });
    EXPECT_TRUE(holes_in(points).cells().empty()) << sigma;
  }
}

// A parabola has an edge (of 9 deg with a radius of 1.2 m) and deep parts as large as those between
// rim and floor: what tells it from a pothole is that little rim is left when it is wide.
TEST(Holes, AWideParabolicDipIsNone) {
  for (const double radius : {1.2, 2.0, 4.0}) {
    const Points points = ground_of([radius](double x, double y) {
      const double r = std::hypot(x - 2.0, y - 1.0) / radius;
      return r < 1.0 ? -0.1 * (1.0 - r * r) : 0.0;
    });
    EXPECT_TRUE(holes_in(points).cells().empty()) << radius;
  }
}

// Ground is lower behind a kerb, and it goes on there; wherever the cells lie about the edge.
TEST(Holes, AStepDownIsNone) {
  for (const double depth : {0.05, 0.1, 0.15, 0.2, 0.25}) {
    for (const double from : {2.0, 2.05, 2.1, 2.2, 2.3, 3.1}) {
      const Points points = ground_of([&](double x, double) { return x > from ? -depth : 0.0; });
      EXPECT_TRUE(holes_in(points).cells().empty()) << depth << " " << from;
    }
  }
}

// What is seen ends at the far side of the hole: it may as well be a step.
TEST(Holes, ARimOnOneSideOnlyIsNotEnough) {
  const Rect hole{2.0, 2.4, -6.0, 6.0};
  for (const double depth : {0.1, 0.2}) {
    const Points whole = worlds::patch_with_hole(kPatch, hole, depth);
    EXPECT_FALSE(holes_in(whole).cells().empty()) << depth;
    const Points one_side = worlds::patch_with_hole({-6.0, 2.4, -6.0, 6.0}, hole, depth);
    EXPECT_TRUE(holes_in(one_side).cells().empty()) << depth;
  }
}

TEST(Holes, ARoadBetweenKerbsIsNone) {
  const Points points = ground_of([](double, double y) { return std::abs(y) < 3.5 ? 0.0 : 0.12; });
  EXPECT_TRUE(holes_in(points).cells().empty());
}

// `least_depth` and `mean_depth` are 3 cm and more.
TEST(Holes, AHoleOfTwoCentimetresIsNone) {
  EXPECT_TRUE(holes_in(worlds::patch_with_hole(kPatch, kPothole, 0.02)).cells().empty());
  EXPECT_FALSE(holes_in(worlds::patch_with_hole(kPatch, kPothole, 0.06)).cells().empty());
}

// Half a metre wide, right through the patch.
TEST(Holes, ADitchIsFound) {
  const Holes holes = holes_in(worlds::patch_with_hole(kPatch, {2.0, 2.6, -6.0, 6.0}, 0.15));
  const std::vector<std::size_t> cells = holes.cells();
  EXPECT_GE(cells.size(), 3 * 50U) << "of 3 by 60 cells";
  for (const std::size_t slot : cells) {
    EXPECT_GT(holes.centre_of(slot).x, 2.0);
    EXPECT_LT(holes.centre_of(slot).x, 2.6);
  }
}

// Each of the limits alone takes the pothole out.
TEST(Holes, EveryParameterCounts) {
  const Points points = worlds::patch_with_hole(kPatch, kPothole, 0.1);
  HoleParams params;
  params.least_depth = 0.12;
  EXPECT_TRUE(holes_in(points, params).cells().empty()) << "least_depth";
  params = {};
  params.mean_depth = 0.12;
  EXPECT_TRUE(holes_in(points, params).cells().empty()) << "mean_depth";
  params = {};
  params.least_points = 1000;
  EXPECT_TRUE(holes_in(points, params).cells().empty()) << "least_points";
  params = {};
  params.wall_share = 0.0;
  EXPECT_TRUE(holes_in(points, params).cells().empty()) << "wall_share";
  params = {};
  params.widest = 0.5;
  EXPECT_TRUE(holes_in(points, params).cells().empty()) << "widest";
  params = {};
  params.rim_depth = 0.0;
  params.rim_sigma = 0.0;
  EXPECT_TRUE(holes_in(noisy(points, 0.005, 273), params).cells().empty()) << "rim";
  EXPECT_FALSE(holes_in(noisy(points, 0.005, 273)).cells().empty()) << "rim";
}

// Points above the ground, over the hole and beside it, are neither floor nor rim.
TEST(Holes, WhatStandsBesideAHoleAndHangsOverItDoesNotHideIt) {
  Points points = worlds::patch_with_hole(kPatch, kPothole, 0.1);
  worlds::add_flat(points, {1.0, 2.6, 1.0, 1.6}, 0.1, 1.2);
  RandomGenerator random(274);
  worlds::add_wall(points, 2.95, 0.0, 3.0, 2.0, 0.05, 0.0, random);
  const Holes holes = holes_in(points);
  EXPECT_EQ(holes.cells().size(), 9U);
  for (const std::size_t slot : holes.cells()) EXPECT_GT(holes.stages.cells.above[slot], 0);
}

// Two holes are told apart, and the rim of cells elsewhere is the ground.
TEST(Holes, TwoHolesAndTheGroundBetweenThem) {
  Points points = worlds::patch_with_hole({-6.0, 0.0, -6.0, 6.0}, {-2.6, -2.0, 1.0, 1.6}, 0.1);
  worlds::append(points, worlds::patch_with_hole({0.0, 6.0, -6.0, 6.0}, kPothole, 0.06));
  const Holes holes = holes_in(points);
  int left = 0, right = 0;
  for (const std::size_t slot : holes.cells()) ++(holes.centre_of(slot).x < 0.0 ? left : right);
  EXPECT_EQ(left, 9);
  EXPECT_EQ(right, 9);
  for (std::size_t slot = 0; slot < holes.stages.cells.size(); ++slot) {
    EXPECT_NEAR(holes.stages.cells.rim[slot], 0.0, 0.01) << slot;
  }
}

// Degenerate input: no points at all, and one.
TEST(Holes, NoGroundNoHoles) {
  EXPECT_TRUE(holes_in(Points{}).cells().empty());
  Points one;
  one.push_back(1.0F, 1.0F, -0.1F);
  const Holes holes = holes_in(one);
  EXPECT_TRUE(holes.cells().empty());
  EXPECT_EQ(holes.stages.cells.rim.size(), 1U);
}

TEST(Holes, UsedMemoryLeavesNoTraceAndASecondTimeDoesNotAllocate) {
  const Points points = worlds::patch_with_hole(kPatch, kPothole, 0.1);
  const Holes fresh = holes_in(points);
  Holes used;
  used.find(worlds::patch_with_hole(kPatch, {-3.0, -2.0, -2.0, -1.0}, 0.2));
  used.find(points);
  EXPECT_EQ(used.cells(), fresh.cells());
  EXPECT_EQ(used.stages.cells.rim, fresh.stages.cells.rim);
  const std::size_t before = bench::allocations();
  find_holes(used.stages.field, used.stages.grid, {}, used.workspace, used.stages.cells,
             used.stages.ground);
  EXPECT_EQ(bench::allocations(), before);
}

}  // namespace
}  // namespace mrpt_terrain
