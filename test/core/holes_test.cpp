// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/holes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
  std::vector<HoleDescription> found;
  IndexRows found_cells;

  void find(const ScanView& scan, const HoleParams& params = {}) {
    worlds::measure(scan.points, worlds::field_params(), stages);
    find_holes({stages.field, stages.grid, scan.origins}, params, workspace, stages.cells,
               stages.ground, found, found_cells);
  }
  void find(const Points& points, const HoleParams& params = {}) { find(points.view(), params); }
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
// between 0.3 and 0.55 of the depth is ln(0.55 / 0.3) / -ln(0.55) = 1.01 times that which lies
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

// A quarter of each of four cells is floor: a depth of 10 cm is 2.5 cm on average, less than
// `least_depth`. A hole of 4 cm, as deep on average as 1 cm, is none, and has no lowest points.
TEST(Holes, AHoleThatFillsNoCellIsFound) {
  const auto hole_of = [](double depth) {
    return holes_in(ground_of([depth](double x, double y) {
      return std::abs(x - 2.2) < 0.1 && std::abs(y - 1.2) < 0.1 ? -depth : 0.0;
    }));
  };
  const Holes holes = hole_of(0.1);
  ASSERT_EQ(holes.found.size(), 1U);
  EXPECT_NEAR(holes.found[0].centre.x, 2.2, 0.1);
  EXPECT_NEAR(holes.found[0].centre.y, 1.2, 0.1);
  EXPECT_NEAR(holes.found[0].depth, 0.1, 0.01);
  EXPECT_TRUE(hole_of(0.04).found.empty());
}

// The floor has the 16 points of a cell, and 4 in the cell beside, which lies 2.5 cm deep on
// average and is no candidate.
TEST(Holes, PointsInCellsAtItsEdgeCountAsFloor) {
  const Points points = ground_of(
      [](double x, double y) { return x > 2.0 && x < 2.25 && y > 1.0 && y < 1.2 ? -0.1 : 0.0; });
  HoleParams params;
  params.least_points = 20;
  const Holes holes = holes_in(points, params);
  ASSERT_EQ(holes.found.size(), 1U);
  EXPECT_EQ(holes.found[0].points, 20);
  params.least_points = 21;
  EXPECT_TRUE(holes_in(points, params).found.empty());
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
  EXPECT_TRUE(holes_in(noisy(points, 0.005, 273), params).cells().empty()) << "rim_depth";
  EXPECT_FALSE(holes_in(noisy(points, 0.005, 273)).cells().empty()) << "rim_depth";
  params = {};
  params.rings_depth = 0.0;
  EXPECT_TRUE(holes_in(noisy(points, 0.005, 273), params).cells().empty()) << "rings_depth";
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
  find_holes({used.stages.field, used.stages.grid, {}}, {}, used.workspace, used.stages.cells,
             used.stages.ground, used.found, used.found_cells);
  EXPECT_EQ(bench::allocations(), before);
}

// From here on: scans of a sensor whose rings meet the ground, its place known.

constexpr double kSensorHeight = 0.81;

/// 32 beams from -30.67 deg to 10.67 deg, and 16 from -15 deg to 15 deg, 0.2 deg apart.
worlds::LidarModel many_rings() {
  worlds::LidarModel model;
  model.beams = 32;
  model.lowest_deg = -30.67;
  model.highest_deg = 10.67;
  model.azimuth_step_deg = 0.2;
  return model;
}
worlds::LidarModel few_rings() {
  worlds::LidarModel model = many_rings();
  model.beams = 16;
  model.lowest_deg = -15.0;
  model.highest_deg = 15.0;
  return model;
}

struct RingScan {
  Points points;
  std::array<float, 3> origin{0.0F, 0.0F, static_cast<float>(kSensorHeight)};
  [[nodiscard]] ScanView view() const { return {points.view(), {&origin, nullptr}}; }
};

template <class Height>
RingScan scan_of(const worlds::LidarModel& model, Height&& height) {
  return {worlds::ring_scan(model, kSensorHeight, height)};
}

Holes holes_in_scan(const RingScan& scan, const HoleParams& params = {}) {
  Holes result;
  result.find(scan.view(), params);
  return result;
}

/// A square hole with upright walls, 0.8 m wide.
double pothole(double x, double y, double from, double depth) {
  return x > from && x < from + 0.8 && std::abs(y - 0.3) < 0.4 ? -depth : 0.0;
}

// 0.1 m deep, 0.8 m wide. Tolerances: the near part of the floor is out of sight, at 4 m for 0.5 m,
// so the extent along the beams and the middle are off by up to that; a cell is 0.2 m.
TEST(HolesInRings, APotholeIsFoundWithItsPlaceAndSize) {
  for (const double from : {2.5, 3.0, 3.5}) {
    const Holes holes = holes_in_scan(
        scan_of(many_rings(), [from](double x, double y) { return pothole(x, y, from, 0.1); }));
    ASSERT_EQ(holes.found.size(), 1U) << from;
    const HoleDescription& hole = holes.found[0];
    EXPECT_NEAR(hole.centre.x, from + 0.4, 0.3) << from;
    EXPECT_NEAR(hole.centre.y, 0.3, 0.1) << from;
    EXPECT_NEAR(hole.length, 0.8, 0.3) << from;
    EXPECT_NEAR(hole.depth, 0.1, 0.01) << from;
    EXPECT_GE(hole.rings, 1) << from;
    EXPECT_GT(hole.confidence, 0.5) << from;
    EXPECT_LE(hole.confidence, 1.0) << from;
    EXPECT_EQ(holes.stages.ground.rule[static_cast<std::size_t>(hole.slot)], GroundRule::kLow);
  }
}

// The beams of -9 deg go on to the floor at 5.6 m; those of -11 and -7 deg miss the hole.
TEST(HolesInRings, OneRingIsEnough) {
  const Holes holes = holes_in_scan(
      scan_of(few_rings(), [](double x, double y) { return pothole(x, y, 4.9, 0.08); }));
  ASSERT_EQ(holes.found.size(), 1U);
  EXPECT_EQ(holes.found[0].rings, 1);
}

// As deep as the pothole, and not much wider: a ring takes many steps from its rim to its floor.
TEST(HolesInRings, ADipIsNone) {
  for (const double sigma : {0.3, 0.5, 0.8}) {
    for (const double x0 : {3.0, 4.0, 6.0}) {
      const auto dip = [=](double x, double y) {
        const double r = std::hypot(x - x0, y - 0.3) / sigma;
        return -0.1 * std::exp(-0.5 * r * r);
      };
      EXPECT_TRUE(holes_in_scan(scan_of(many_rings(), dip)).found.empty()) << sigma << " " << x0;
      EXPECT_TRUE(holes_in_scan(scan_of(few_rings(), dip)).found.empty()) << sigma << " " << x0;
    }
  }
}

// The same pothole in ground that bends: 0.25 m down over 5 m, then up again.
TEST(HolesInRings, APotholeInRollingGroundIsFound) {
  worlds::LidarModel model = many_rings();
  model.beams = 64;
  const Holes holes = holes_in_scan(scan_of(model, [](double x, double y) {
    return 0.125 * (std::cos(x * M_PI / 5.0) - 1.0) + pothole(x, y, 3.0, 0.12);
  }));
  ASSERT_EQ(holes.found.size(), 1U);
  EXPECT_NEAR(holes.found[0].centre.x, 3.4, 0.3);
}

// All of a hollow lies below the mean of the ground around it: as one piece, it is no hole.
TEST(HolesInRings, APotholeInAHollowIsFound) {
  for (const int beams : {32, 64}) {
    for (const double radius : {2.0, 2.5, 4.0}) {
      worlds::LidarModel model = many_rings();
      model.beams = beams;
      const auto hollow = [radius](double x, double y) {
        return 0.03 * std::min(std::pow(x - 3.8, 2) + std::pow(y - 0.3, 2), radius * radius);
      };
      EXPECT_TRUE(holes_in_scan(scan_of(model, hollow)).found.empty()) << beams << " " << radius;
      const Holes holes = holes_in_scan(scan_of(
          model, [&hollow](double x, double y) { return hollow(x, y) + pothole(x, y, 3.4, 0.1); }));
      ASSERT_EQ(holes.found.size(), 1U) << beams << " " << radius;
      EXPECT_NEAR(holes.found[0].centre.x, 3.8, 0.3) << beams << " " << radius;
      EXPECT_NEAR(holes.found[0].centre.y, 0.3, 0.2) << beams << " " << radius;
    }
  }
}

// The ground bends by 3 cm within half a metre. Rings that end at walls on both sides, and nothing
// as low around, say more than that does.
TEST(HolesInRings, UnevenGroundAroundAHoleThatIsSeenOnAllSidesIsNoReasonAgainstIt) {
  worlds::LidarModel model = many_rings();
  model.beams = 64;
  const auto uneven = [](double x, double y) {
    return 0.03 * std::sin(5.0 * x) * std::sin(6.0 * y);
  };
  HoleParams params;
  params.uneven_depth = 0.0;
  const RingScan scan = scan_of(
      model, [&uneven](double x, double y) { return uneven(x, y) + pothole(x, y, 2.75, 0.12); });
  EXPECT_EQ(holes_in_scan(scan, params).found.size(), 1U);
  EXPECT_TRUE(holes_in_scan(scan_of(model, uneven), params).found.empty());
}

// A lane that is lower than the ground on both sides, and goes on to the left and to the right:
// it is far longer than what is seen of it, but narrower than `widest`. What lies beyond a step
// down, or below the edge of a terrace, has no rim behind.
TEST(HolesInRings, StepsDownAreNone) {
  for (const double depth : {0.1, 0.2, 0.3, 0.5}) {
    for (const double from : {3.0, 3.9, 5.2}) {
      const auto step = [=](double x, double) { return x > from ? -depth : 0.0; };
      EXPECT_TRUE(holes_in_scan(scan_of(many_rings(), step)).found.empty()) << depth << from;
      const auto across = [=](double, double y) { return y > from ? -depth : 0.0; };
      EXPECT_TRUE(holes_in_scan(scan_of(many_rings(), across)).found.empty()) << depth << from;
    }
  }
}

TEST(HolesInRings, EveryParameterCounts) {
  const RingScan scan =
      scan_of(many_rings(), [](double x, double y) { return pothole(x, y, 3.0, 0.1); });
  ASSERT_EQ(holes_in_scan(scan).found.size(), 1U);
  HoleParams params;
  const RingScan at_step = scan_of(many_rings(), [](double x, double y) {
    return pothole(x, y, 3.0, 0.1) - (y > 0.9 ? 0.08 : 0.0);
  });
  EXPECT_TRUE(holes_in_scan(at_step).found.empty()) << "closed";
  params.closed = 0.3;
  EXPECT_FALSE(holes_in_scan(at_step, params).found.empty()) << "closed";
  params = {};
  params.seen = 1.01;
  EXPECT_TRUE(holes_in_scan(scan, params).found.empty()) << "seen";
  params = {};
  params.walled = 1.5;
  EXPECT_TRUE(holes_in_scan(scan, params).found.empty()) << "walled";
  RingScan bumpy = scan_of(many_rings(), [](double x, double y) {
    return pothole(x, y, 3.0, 0.1) + 0.008 * std::sin(4.0 * x) * std::sin(5.0 * y);
  });
  EXPECT_EQ(holes_in_scan(bumpy).found.size(), 1U) << "uneven_depth";
  params = {};
  params.uneven_depth = 0.0;
  EXPECT_TRUE(holes_in_scan(bumpy, params).found.empty()) << "uneven_depth";
}

TEST(HolesInRings, ASecondTimeDoesNotAllocate) {
  const RingScan scan =
      scan_of(many_rings(), [](double x, double y) { return pothole(x, y, 3.0, 0.1); });
  Holes used = holes_in_scan(scan);
  ASSERT_EQ(used.found.size(), 1U);
  const ScanView view = scan.view();
  const std::size_t before = bench::allocations();
  find_holes({used.stages.field, used.stages.grid, view.origins}, {}, used.workspace,
             used.stages.cells, used.stages.ground, used.found, used.found_cells);
  EXPECT_EQ(bench::allocations(), before);
}

}  // namespace
}  // namespace mrpt_terrain
