// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_costs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "allocation_counter.h"
#include "field_worlds.h"
#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/core/unseen_cells.h"

namespace mrpt_terrain {
namespace {

using worlds::kPi;
using worlds::radians;
using worlds::Rect;

constexpr Rect kPatch{-6.0, 6.0, -6.0, 6.0};
constexpr Rect kThing{2.0, 3.0, 1.0, 2.0};  // 25 cells of 0.2 m

/// A described scan with its costs.
struct World {
  Points points;
  RobotParams robot;
  DescriptionWorkspace workspace;
  Description description;
  CostWorkspace cost_workspace;
  CellCosts costs;

  explicit World(Points scan, const RobotParams& given = {},
                 const DescriptionParams& params = worlds::field_params())
      : points(std::move(scan)), robot(given) {
    describe(points.view(), params, workspace, description);
    measure();
  }
  void measure() {
    compute_cell_costs(description, described_points(points.view(), workspace), robot,
                       cost_workspace, costs);
  }
  [[nodiscard]] Cost at(double x, double y) const {
    return cost_at(description.grid, costs, {x, y}, robot);
  }
  [[nodiscard]] Cost toward(double heading, double x, double y) const {
    return cost_at(description.grid, costs, {x, y}, robot, heading);
  }
  /// Cells whose centres lie in a rectangle and that are lethal.
  [[nodiscard]] int lethal_in(const Rect& rect) const {
    int lethal = 0;
    for (std::size_t slot = 0; slot < costs.size(); ++slot) {
      const Position2 centre = centre_of(slot);
      const bool inside = worlds::inside(rect, centre.x, centre.y);
      const Cost cost = cost_of(costs, static_cast<Slot>(slot), robot);
      lethal += inside && cost.status == CostStatus::kLethal ? 1 : 0;
    }
    return lethal;
  }
  [[nodiscard]] Position2 centre_of(std::size_t slot) const {
    const GridGeometry& geometry = description.grid.geometry;
    return geometry.centre_of(geometry.index_of(description.grid.cell[slot]));
  }
};

Points ground_with(const Rect& rect, double height) {
  Points points;
  worlds::add_flat(points, kPatch, 0.05, 0.0);
  worlds::add_flat(points, rect, 0.05, height);
  return points;
}

Points ground_with_box(double height) {
  Points points;
  worlds::add_surface(points, kPatch, 0.05, [&](double x, double y) {
    return worlds::inside(kThing, x, y) ? height : 0.0;
  });
  worlds::add_box(points, kThing, height, 0.04);
  return points;
}

// The box is lethal, and nothing else: the ground beside it is as level as elsewhere.
TEST(FieldCosts, CellsBesideAThingAreNotLethal) {
  const World world(ground_with_box(0.5));
  EXPECT_EQ(world.lethal_in(kThing), 25);
  // Points on the sides of the box belong to the cells beyond where they lie on the edges.
  EXPECT_EQ(world.lethal_in({-6.0, 6.0, -6.0, 6.0}) - world.lethal_in({1.8, 3.2, 0.8, 2.2}), 0);
  EXPECT_LT(world.at(1.9, 1.5).cost, 0.25) << "but for the foot of its sides";
  EXPECT_NEAR(world.at(2.5, 1.5).parts.obstacle, 0.5 / 0.08, 0.01 / 0.08);
  // Those of the grid alone are.
  CostWorkspace workspace;
  CellCosts alone;
  compute_cell_costs(world.description.grid, world.robot, workspace, alone);
  EXPECT_EQ(cost_at(world.description.grid, alone, {1.9, 1.5}, world.robot).status,
            CostStatus::kLethal);
}

// The robot is 0.4 m high and needs 0.1 m more.
TEST(FieldCosts, FreeUnderWhatHangsAboveTheRobot) {
  for (const double height : {0.55, 1.0, 2.2, 2.9}) {
    const World world(ground_with(kThing, height));
    EXPECT_EQ(world.lethal_in(kPatch), 0) << height;
    EXPECT_LT(world.at(2.5, 1.5).cost, 0.05) << height;
    EXPECT_EQ(world.at(2.5, 1.5).status, CostStatus::kOk);
  }
  for (const double height : {0.3, 0.48}) {
    const World world(ground_with(kThing, height));
    EXPECT_EQ(world.lethal_in(kThing), 25) << height;
    EXPECT_EQ(world.lethal_in(kPatch), 25) << height;
  }
  RobotParams tall;
  tall.height = 1.5;
  EXPECT_EQ(World(ground_with(kThing, 1.0), tall).lethal_in(kPatch), 25);
}

// Where the ground under it was not seen, nothing is known; beside something that stands it is
// taken for its upper part. Where the ground was seen beside, the cell is free, but costs what is
// hidden.
TEST(FieldCosts, WhatHangsOverUnseenGround) {
  Points points;
  worlds::add_flat(points, {-6.0, 1.0, -6.0, 6.0}, 0.05, 0.0);
  worlds::add_flat(points, kThing, 0.05, 1.2);
  const World alone(points);
  EXPECT_EQ(alone.lethal_in(kPatch), 0);
  EXPECT_EQ(alone.at(2.5, 1.5).status, CostStatus::kUnknown);
  EXPECT_EQ(alone.at(2.5, 1.5).cost, alone.robot.cost_occluded);
  worlds::add_flat(points, {2.0, 2.2, 1.0, 2.0}, 0.05, 0.3);
  // The five cells that stand and the five behind them.
  EXPECT_EQ(World(points).lethal_in(kThing), 10);

  Points beside;
  worlds::add_flat(beside, kPatch, 0.05, 0.0);
  Points hidden;
  const Rect cell{2.4, 2.6, 1.4, 1.6};
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (!worlds::inside(cell, double{beside.x[i]}, double{beside.y[i]}))
      hidden.push_back(beside.x[i], beside.y[i], beside.z[i]);
  }
  worlds::add_flat(hidden, {2.41, 2.59, 1.41, 1.59}, 0.05, 1.2);
  const World world(hidden);
  const Cost under = world.at(2.5, 1.5);
  EXPECT_EQ(under.status, CostStatus::kOk);
  EXPECT_EQ(under.parts.unknown, world.robot.cost_occluded);
  EXPECT_EQ(under.cost, world.robot.cost_occluded);
}

TEST(FieldCosts, RampsAreGroundAndHaveHeadings) {
  Points points;
  const Rect ramp{2.0, 5.0, -1.5, 1.5};
  const double gradient = std::tan(radians(12.0));
  worlds::add_surface(points, kPatch, 0.05, [&](double x, double y) {
    return worlds::inside(ramp, x, y) ? gradient * (x - ramp.x0) : 0.0;
  });
  const World world(points);
  for (double x = 2.5; x < 4.6; x += 0.2) {
    for (const double y : {-0.9, -0.1, 0.5}) {
      const Cost up = world.toward(0.0, x, y);
      ASSERT_EQ(up.status, CostStatus::kOk) << x << ", " << y;
      ASSERT_NEAR(up.parts.slope, 12.0 / 20.0, 0.02) << x << ", " << y;
      ASSERT_NEAR(world.toward(kPi / 2, x, y).parts.slope, 12.0 / 15.0, 0.02) << x << ", " << y;
      ASSERT_LT(up.parts.step, 0.2) << x << ", " << y;
    }
  }
  // Its high end, 0.64 m, is a step on both sides.
  EXPECT_EQ(world.at(4.9, 0.1).status, CostStatus::kLethal);
}

// A pothole of 0.6 m x 0.6 m, 10 cm deep.
World with_hole(double wheel_radius) {
  RobotParams robot;
  robot.wheel_radius = wheel_radius;
  return World(worlds::patch_with_hole(kPatch, {2.0, 2.6, 1.0, 1.6}, 0.1), robot);
}

TEST(FieldCosts, HolesAreLethalForSmallWheelsOnly) {
  const World small = with_hole(0.1);
  // The patch ends on all sides, too.
  const std::vector<HoleDescription>& holes = small.description.holes;
  ASSERT_EQ(std::count_if(holes.begin(), holes.end(),
                          [](const HoleDescription& h) { return h.kind == HoleKind::kFloor; }),
            1);
  EXPECT_EQ(small.at(2.3, 1.3).status, CostStatus::kLethal);
  EXPECT_NEAR(small.at(2.3, 1.3).parts.pothole, 0.1 / 0.08, 0.02 / 0.08);
  // 1.5 m of radius over a way of 0.6 m: 1.5 - sqrt(1.5^2 - 0.3^2) = 3 cm.
  const World large = with_hole(1.5);
  const Cost over = large.at(2.3, 1.3);
  EXPECT_EQ(over.status, CostStatus::kOk);
  EXPECT_NEAR(over.parts.pothole, 0.0303 / 0.08, 0.012 / 0.08);
  // The rim is level: the hole is no step of the ground around.
  EXPECT_EQ(large.lethal_in(kPatch), 0);
}

// Where the patch ends, nothing is seen: its cells have no slots.
TEST(FieldCosts, MissingGroundBehindAnEdgeIsLethal) {
  const World world = with_hole(0.1);
  const Description& description = world.description;
  const GridGeometry& geometry = description.grid.geometry;
  std::size_t missing = 0;
  for (std::size_t k = 0; k < description.holes.size(); ++k) {
    if (description.holes[k].kind != HoleKind::kDrop) continue;
    for (const std::int32_t cell : description.hole_cells.row(k)) {
      const CellIndex index = geometry.index_of(CellId{cell});
      if (description.grid.slot_at(index) != kUnobserved) continue;
      const Position2 centre = geometry.centre_of(index);
      const Cost cost = world.at(centre.x, centre.y);
      ASSERT_EQ(cost.status, CostStatus::kLethal) << centre.x << " " << centre.y;
      EXPECT_EQ(cost.parts.pothole, 1.0);
      ++missing;
    }
  }
  EXPECT_GT(missing, 50U);
  RobotParams brave;
  brave.least_confidence = 1.0;
  EXPECT_TRUE(World(worlds::patch_with_hole(kPatch, {2.0, 2.6, 1.0, 1.6}, 0.1), brave)
                  .costs.missing.empty());
}

// A wheel let down in small steps until it touches one of the edges or the floor.
double drop_by_force(double depth, double extent, double radius) {
  double drop = 0.0;
  while (drop < depth) {
    const double centre = radius - drop;  // above the rim
    const double to_edge = std::hypot(0.5 * extent, centre);
    // Once the centre is below the rim, it is the sides that matter: the wheel is as wide as that.
    if (centre >= 0.0 ? to_edge < radius : 0.5 * extent < radius) break;
    drop += 1e-5;
  }
  return drop;
}

TEST(FieldCosts, OracleWheelIsLetDownIntoHoles) {
  for (const double radius : {0.05, 0.1, 0.3}) {
    for (const double extent : {0.02, 0.1, 0.19, 0.25, 0.59, 0.61, 2.0}) {
      for (const double depth : {0.01, 0.05, 0.2}) {
        EXPECT_NEAR(wheel_drop(depth, extent, radius), drop_by_force(depth, extent, radius), 3e-5)
            << radius << ", " << extent << ", " << depth;
      }
    }
  }
}

TEST(FieldCosts, WayAcrossAHoleByHand) {
  const HoleExtent ditch{0.2F, 2.0F, 0.3F, static_cast<float>(kPi / 2), 1.0F};
  EXPECT_NEAR(ditch.extent_along(kPi / 2), 2.0, 1e-6);
  EXPECT_NEAR(ditch.extent_along(-kPi / 2), 2.0, 1e-6);
  EXPECT_NEAR(ditch.extent_along(0.0), 0.3, 1e-6);
  // Points of the ellipse (x / 0.15)^2 + y^2 = 1 at 45 deg.
  EXPECT_NEAR(ditch.extent_along(kPi / 4), 2.0 / std::sqrt(0.5 / (0.15 * 0.15) + 0.5), 1e-5);
  EXPECT_EQ((HoleExtent{0.2F, 2.0F, 0.0F, 0.0F, 1.0F}.extent_along(0.0)), 0.0);
}

/// One cell, by hand.
CellCosts one_cell() {
  CellCosts costs;
  costs.gradient_x = costs.gradient_y = costs.step = costs.roughness = {0.0F};
  costs.status = {FeatureStatus::kOk};
  costs.obstacle = {0.0F};
  costs.likely = {1.0F};
  costs.hole = {-1};
  costs.doubt = {0.0F};
  costs.ground = {UnseenReason::kSeen};
  return costs;
}

TEST(FieldCosts, PartsByHand) {
  RobotParams robot;
  robot.max_step = 0.1;
  robot.ground_clearance = 0.05;
  CellCosts costs = one_cell();
  EXPECT_EQ(cost_of(costs, 0, robot).cost, 0.0);
  costs.obstacle = {0.03F};
  costs.doubt = {0.04F};
  costs.ground = {UnseenReason::kOccluded};
  const Cost cost = cost_of(costs, 0, robot, 0.3);
  EXPECT_NEAR(cost.parts.of(CostPart::kObstacle), 0.6, 1e-6) << "the clearance is less";
  EXPECT_NEAR(cost.parts.of(CostPart::kDoubt), 0.4, 1e-6);
  EXPECT_EQ(cost.parts.of(CostPart::kUnknown), robot.cost_occluded);
  EXPECT_NEAR(cost.cost, 0.6, 1e-6);
  costs.doubt = {5.0F};
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kOk) << "doubt alone is not lethal";
  EXPECT_EQ(cost_of(costs, 0, robot).parts.doubt, 0.9);
}

TEST(FieldCosts, HeadingDecidesAtADitch) {
  CellCosts costs = one_cell();
  costs.holes = {{0.2F, 2.0F, 0.3F, 0.0F, 1.0F}};
  costs.hole = {0};
  RobotParams robot;
  robot.wheel_radius = 0.3;
  robot.max_step = 0.1;
  // Across: 0.3 - sqrt(0.09 - 0.0225) = 4.02 cm.
  EXPECT_NEAR(cost_of(costs, 0, robot, kPi / 2).cost, 0.402, 1e-3);
  EXPECT_EQ(cost_of(costs, 0, robot, 0.0).status, CostStatus::kLethal);
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kLethal);
  for (int k = 0; k < 360; ++k) {
    EXPECT_LE(cost_of(costs, 0, robot, radians(k)).parts.pothole,
              cost_of(costs, 0, robot).parts.pothole + 1e-12);
  }
}

TEST(FieldCosts, WhatIsNotLikelyCostsWithoutStopping) {
  CellCosts costs = one_cell();
  RobotParams robot;
  robot.least_confidence = 0.2;
  costs.obstacle = {0.5F};
  costs.likely = {0.2F};
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kLethal);
  costs.likely = {0.1F};
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kOk);
  EXPECT_NEAR(cost_of(costs, 0, robot).cost, 0.5, 1e-6);
  robot.least_confidence = 0.0;
  costs.likely = {0.0F};
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kLethal);
}

/// Hills with things on them, a curb and noise.
Points busy_ground(std::uint64_t seed, double curb = 0.0) {
  RandomGenerator random(seed);
  Points points;
  const auto height = [curb](double x, double y) {
    return 0.3 * std::sin(0.4 * x) + 0.05 * y + (x < -2.05 ? curb : 0.0);
  };
  worlds::add_surface(points, kPatch, 0.06, [&](double x, double y) {
    return height(x, y) + 0.01 * worlds::normal_deviate(random);
  });
  for (int k = 0; k < 12; ++k) {
    const double x = -5.0 + 10.0 * random.uniform(), y = -5.0 + 10.0 * random.uniform();
    const double low = k % 3 == 0 ? 0.7 : 0.05, high = low + 0.2 + random.uniform();
    for (int i = 0; i < 60; ++i) {
      worlds::add_point(points, x + 0.3 * random.uniform(), y + 0.3 * random.uniform(),
                        height(x, y) + low + (high - low) * random.uniform());
    }
  }
  return points;
}

// Points of a cell of the description that were ground when its cells were counted; those of decks
// and, later, of sides that the reference climbs are other points in the labels.
double counted_ground(const Description& description, std::size_t slot) {
  return description.grid.sums[slot].n - description.field.above[slot] -
         description.field.below[slot];
}

// Whether two cells hold the same ground.
bool same_ground(const Description& description, Slot slot, const ElevationGrid& alone,
                 Slot slot_alone) {
  if (slot == kUnobserved || slot_alone == kUnobserved) return slot == slot_alone;
  const auto here = static_cast<std::size_t>(slot), there = static_cast<std::size_t>(slot_alone);
  return description.field.deck[here] < 0 &&
         counted_ground(description, here) == alone.sums[there].n;
}

// The ground is what the labels say: a grid of these points alone has the same slopes, steps and
// roughness wherever no cell nearby holds other points only.
TEST(FieldCosts, OracleGridOfTheGroundAlone) {
  constexpr int kReach = 3;  // cells; steps are measured from planes of the neighbours' neighbours
  const World world(busy_ground(7));
  const Description& description = world.description;
  Points ground;
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    if (description.labels.support[i] == Support::kGround)
      ground.push_back(world.points.x[i], world.points.y[i], world.points.z[i]);
  }
  ElevationGrid grid;
  ElevationGridWorkspace workspace;
  PointSlots slots;
  build_elevation_grid(ground.view(), worlds::field_params().grid, workspace, grid, slots);
  CostWorkspace cost_workspace;
  CellCosts alone;
  compute_cell_costs(grid, world.robot, cost_workspace, alone);
  int compared = 0, mixed = 0;
  for (std::size_t slot = 0; slot < world.costs.size(); ++slot) {
    const CellIndex cell = description.grid.geometry.index_of(description.grid.cell[slot]);
    bool known = true;
    for (int l = -kReach; l <= kReach; ++l) {
      for (int w = -kReach; w <= kReach; ++w) {
        const CellIndex near{cell.l + l, cell.w + w};
        known = known &&
                same_ground(description, description.grid.slot_at(near), grid, grid.slot_at(near));
      }
    }
    if (!known) continue;
    const auto k = static_cast<std::size_t>(grid.slot_at(cell));
    ASSERT_EQ(world.costs.status[slot], alone.status[k]);
    ASSERT_EQ(world.costs.gradient_x[slot], alone.gradient_x[k]);
    ASSERT_EQ(world.costs.gradient_y[slot], alone.gradient_y[k]);
    ASSERT_EQ(world.costs.step[slot], alone.step[k]);
    ASSERT_EQ(world.costs.roughness[slot], alone.roughness[k]);
    ++compared;
    mixed += description.field.above[slot] > 0 ? 1 : 0;
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(mixed, 10);
}

// Obstacles point by point: above the reference, or from the foot to the top of a cell.
TEST(FieldCosts, OracleObstaclesPointByPoint) {
  const World world(busy_ground(8, 0.2));
  const Description& description = world.description;
  const double clear = world.robot.height + world.robot.overhead_reserve;
  struct Cell {
    double highest = 0.0, top = -1e9, foot = 0.0, n = 0.0;
    bool hangs = false;
  };
  std::vector<Cell> cells(world.costs.size());
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const std::int32_t slot = world.workspace.point_slots[i];
    if (slot < 0) continue;
    Cell& cell = cells[static_cast<std::size_t>(slot)];
    const double z = double{world.points.z[i]};
    const double height = double{world.workspace.field.points.height[i]};
    // By heights: a side onto which the reference climbed is above the ground in labels alone.
    const Support support = world.workspace.field.points.support[i];
    if (support == Support::kGround) {
      cell.foot += z;
      cell.n += 1.0;
    } else if (support == Support::kAbove && height < clear) {
      cell.highest = std::max(cell.highest, height);
      cell.top = std::max(cell.top, z);
    } else {
      cell.hangs = true;
    }
  }
  int standing = 0, hanging = 0;
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    const Cell& cell = cells[slot];
    if (description.field.deck[slot] >= 0 || (cell.n == 0.0 && cell.hangs)) continue;
    std::array<double, 2> allowed{};  // along the axes
    const Position2 here = world.centre_of(slot);
    for (std::size_t other = 0; other < cells.size(); ++other) {
      const Position2 there = world.centre_of(other);
      const double dx = there.x - here.x, dy = there.y - here.y;
      if (std::abs(std::hypot(dx, dy) - 0.2) > 0.01) continue;  // the four at the sides
      double& along = allowed[std::abs(dx) > std::abs(dy) ? 0 : 1];
      const double rise = double{description.field.rim[other] - description.field.rim[slot]};
      along = std::max(along, std::abs(rise));
    }
    const bool low = cell.highest <= 0.5;
    const double rise =
        cell.n > 0.0 && low ? cell.top - cell.foot / cell.n - allowed[0] - allowed[1] : 0.0;
    EXPECT_NEAR(world.costs.obstacle[slot], std::max(cell.highest, rise), 1e-5);
    standing += cell.highest > 0.0 ? 1 : 0;
    hanging += cell.highest == 0.0 && description.field.above[slot] > 0 ? 1 : 0;
  }
  EXPECT_GT(standing, 10);
  EXPECT_GT(hanging, 3);
}

// A wall of 20 cm that the reference climbs to half its height: its cells hold points of its foot
// and of its top.
TEST(FieldCosts, LowThingsAreMeasuredFromTheirFoot) {
  Points points;
  worlds::add_flat(points, kPatch, 0.05, 0.0);
  RandomGenerator random(1);
  worlds::add_wall(points, 2.1, -6.0, 6.0, 0.2, 0.02, 0.0, random);
  World world(points);
  EXPECT_NEAR(world.at(2.1, 0.1).parts.obstacle * 0.08, 0.2, 0.03);
  std::vector<float> height = world.workspace.field.points.height;
  for (float& h : height) h -= h > 0.0F ? 0.1F : 0.0F;
  compute_cell_costs(world.description,
                     {world.points.view(), &world.workspace.point_slots, height.data()},
                     world.robot, world.cost_workspace, world.costs);
  // 3 cm for points at the foot of the wall.
  EXPECT_GT(world.at(2.1, 0.1).parts.obstacle * 0.08, 0.15);
  EXPECT_LT(world.at(2.1, 0.1).parts.obstacle * 0.08, 0.21);
}

// What cells say stands in where the points are not at hand.
TEST(FieldCosts, WithoutPointsTheSameCellsAreLethal) {
  for (const double height : {0.3, 0.5, 1.0}) {
    World world(ground_with_box(height));
    const int with = world.lethal_in(kPatch);
    compute_cell_costs(world.description, {}, world.robot, world.cost_workspace, world.costs);
    EXPECT_EQ(world.lethal_in(kPatch), with) << height;
  }
  World layer(ground_with(kThing, 1.0));
  compute_cell_costs(layer.description, {}, layer.robot, layer.cost_workspace, layer.costs);
  EXPECT_EQ(layer.lethal_in(kPatch), 0);
}

TEST(FieldCosts, PaperModeHasTheCostsOfTheGrid) {
  DescriptionParams params;
  params.grid = {12.0, 12.0, 0.2, 3.0};
  const World world(ground_with_box(0.5), {}, params);
  CostWorkspace workspace;
  CellCosts alone;
  compute_cell_costs(world.description.grid, world.robot, workspace, alone);
  EXPECT_FALSE(world.costs.has(CostPart::kObstacle));
  EXPECT_TRUE(world.costs.has(CostPart::kSlope));
  EXPECT_EQ(world.costs.gradient_x, alone.gradient_x);
  EXPECT_EQ(world.costs.gradient_y, alone.gradient_y);
  EXPECT_EQ(world.costs.step, alone.step);
  EXPECT_EQ(world.costs.roughness, alone.roughness);
  EXPECT_EQ(world.at(-5.95, 100.0).status, CostStatus::kOutside);
}

// Field mode, then paper mode, in the same memory.
TEST(FieldCosts, NothingIsLeftOfADescriptionBefore) {
  World world(ground_with_box(0.5));
  world.costs.unseen.assign(4, UnseenReason::kOccluded);
  compute_cell_costs(world.description.grid, world.robot, world.cost_workspace, world.costs);
  EXPECT_FALSE(world.costs.has(CostPart::kDoubt));
  EXPECT_TRUE(world.costs.unseen.empty());
}

TEST(FieldCosts, NoPoints) {
  const World world{Points{}};
  EXPECT_EQ(world.costs.size(), 0U);
  EXPECT_EQ(world.at(1.0, 1.0).status, CostStatus::kUnknown);
}

TEST(FieldCosts, DoubtIsTwoStandardErrors) {
  const World world(busy_ground(9));
  int counted = 0;
  for (std::size_t slot = 0; slot < world.costs.size(); ++slot) {
    const FieldCells& field = world.description.field;
    if (field.above[slot] + field.below[slot] > 0 || field.deck[slot] >= 0) continue;
    if (world.costs.hole[slot] >= 0 || world.costs.status[slot] != FeatureStatus::kOk) continue;
    const double expected = 2.0 * double{world.costs.roughness[slot]} / std::sqrt(field.on[slot]);
    EXPECT_NEAR(world.costs.doubt[slot], expected, 1e-6);
    ++counted;
  }
  EXPECT_GT(counted, 2000);
}

TEST(FieldCosts, NamesOfPartsAreUnique) {
  EXPECT_STREQ(name_of(CostPart::kSlope), "slope");
  EXPECT_STREQ(name_of(CostPart::kDoubt), "doubt");
  for (const auto& a : enum_names(CostPart{})) {
    for (const auto& b : enum_names(CostPart{})) {
      EXPECT_EQ(std::string(a.name) == b.name, a.value == b.value);
    }
  }
}

// A wall 4 m ahead casts a shadow; the lowest beam leaves a blind spot.
TEST(FieldCosts, UnseenGroundCostsWhatItsReasonSays) {
  constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, 1.0F};
  worlds::LidarModel model;
  model.beams = 64;
  model.lowest_deg = -25.0;
  model.highest_deg = 5.0;
  model.azimuth_step_deg = 0.25;
  const Points points = worlds::ring_scan(model, 1.0, [](double x, double y) {
    return x > 4.0 && x < 4.3 && std::abs(y) < 1.0 ? 0.45 : 0.0;
  });
  const ScanView scan{points.view(), {&kOrigin, nullptr}};
  DescriptionWorkspace workspace;
  Description description;
  describe(scan, worlds::field_params(), workspace, description);
  const RobotParams robot;
  CostWorkspace cost_workspace;
  CellCosts costs;
  compute_cell_costs(description, described_points(points.view(), workspace), robot, cost_workspace,
                     costs);
  EXPECT_EQ(cost_at(description.grid, costs, {6.1, 0.1}, robot).cost, 0.0) << "nobody has asked";
  UnseenWorkspace scratch;
  explain_unseen_cells(scan, workspace, description, scratch, costs.unseen);
  const auto at = [&](double x, double y) {
    const Cost cost = cost_at(description.grid, costs, {x, y}, robot, 0.5);
    EXPECT_EQ(cost.status, CostStatus::kUnknown);
    EXPECT_EQ(cost.cost, cost.parts.unknown);
    return cost.cost;
  };
  EXPECT_EQ(at(6.1, 0.1), robot.cost_occluded);
  EXPECT_EQ(at(-0.9, 0.1), robot.cost_out_of_view);
  EXPECT_GT(robot.cost_occluded, robot.cost_out_of_view);
  EXPECT_GT(robot.cost_no_return, robot.cost_out_of_view);
  EXPECT_EQ(cost_of_unseen(UnseenReason::kNoReturn, robot).cost, robot.cost_no_return);
  EXPECT_EQ(cost_of_unseen(UnseenReason::kSeen, robot).cost, 0.0);
}

// Area that a cell and the footprint share, by clipping the cell at the four sides in turn.
double shared_area(Position2 centre, double cell, Position2 position, const RobotParams& robot,
                   double heading) {
  struct Corner {
    double u, v;
  };
  std::vector<Corner> polygon;
  for (const auto& [sx, sy] :
       std::vector<std::pair<int, int>>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    const double dx = centre.x + 0.5 * cell * sx - position.x;
    const double dy = centre.y + 0.5 * cell * sy - position.y;
    polygon.push_back({std::cos(heading) * dx + std::sin(heading) * dy,
                       std::cos(heading) * dy - std::sin(heading) * dx});
  }
  for (int side = 0; side < 4; ++side) {
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    const double limit = 0.5 * (side < 2 ? robot.footprint_length : robot.footprint_width);
    const auto beyond = [&](const Corner& c) { return sign * (side < 2 ? c.u : c.v) - limit; };
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corner a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      const double da = beyond(a), db = beyond(b);
      if (da <= 0.0) kept.push_back(a);
      if (da * db < 0.0) {
        const double t = da / (da - db);
        kept.push_back({a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)});
      }
    }
    polygon = kept;
  }
  double area = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    area += 0.5 * (a.u * b.v - a.v * b.u);
  }
  return area;
}

int rank_of(CostStatus status) {
  switch (status) {
    case CostStatus::kOk:
      return 0;
    case CostStatus::kUnknown:
      return 1;
    case CostStatus::kOutside:
      return 2;
    case CostStatus::kLethal:
      return 3;
  }
  return -1;
}

TEST(FootprintCost, OracleEveryCellThatSharesAreaWithTheFootprint) {
  const World world(busy_ground(11));
  const GridGeometry& geometry = world.description.grid.geometry;
  RandomGenerator random(4);
  std::array<int, 4> seen{};
  for (int trial = 0; trial < 800; ++trial) {
    RobotParams robot = world.robot;
    robot.footprint_length = 0.1 + 1.5 * random.uniform();
    robot.footprint_width = 0.1 + random.uniform();
    const double reach = trial % 4 == 0 ? 14.99 : 6.5;
    const Position2 position{reach * (2.0 * random.uniform() - 1.0),
                             reach * (2.0 * random.uniform() - 1.0)};
    const double heading = 2.0 * kPi * random.uniform();
    Cost expected;
    expected.status = CostStatus::kOk;
    for (int l = -9; l < geometry.cells_l() + 9; ++l) {
      for (int w = -9; w < geometry.cells_w() + 9; ++w) {
        const Position2 centre = geometry.centre_of({l, w});
        if (std::abs(centre.x - position.x) > 2.0 || std::abs(centre.y - position.y) > 2.0)
          continue;
        if (!(shared_area(centre, 0.2, position, robot, heading) > 1e-12)) continue;
        const Cost cost = cost_at(world.description.grid, world.costs, centre, robot, heading);
        if (rank_of(cost.status) > rank_of(expected.status)) expected.status = cost.status;
        expected.cost = std::max(expected.cost, cost.cost);
        expected.parts.slope = std::max(expected.parts.slope, cost.parts.slope);
        expected.parts.obstacle = std::max(expected.parts.obstacle, cost.parts.obstacle);
      }
    }
    const Cost cost =
        footprint_cost_at(world.description.grid, world.costs, position, robot, heading);
    ASSERT_EQ(cost.status, expected.status) << trial;
    ASSERT_EQ(cost.cost, expected.cost) << trial;
    ASSERT_EQ(cost.parts.slope, expected.parts.slope) << trial;
    ASSERT_EQ(cost.parts.obstacle, expected.parts.obstacle) << trial;
    ++seen[static_cast<std::size_t>(rank_of(cost.status))];
  }
  for (const int count : seen) EXPECT_GT(count, 10);
}

TEST(FootprintCost, ALongRobotFitsAlongAWallOnly) {
  Points points = ground_with({3.0, 3.2, -6.0, 6.0}, 0.3);
  RobotParams robot;
  robot.footprint_length = 2.0;
  robot.footprint_width = 0.6;
  const World world(points, robot);
  const auto at = [&](double heading) {
    return footprint_cost_at(world.description.grid, world.costs, {2.3, 0.0}, robot, heading);
  };
  EXPECT_EQ(at(kPi / 2).status, CostStatus::kOk);
  EXPECT_EQ(at(0.0).status, CostStatus::kLethal);
  EXPECT_EQ(footprint_cost_at(world.description.grid, world.costs, {std::nan(""), 0.0}, robot, 0.0)
                .status,
            CostStatus::kOutside);
}

TEST(FieldCosts, NoAllocationOnceMemoryIsThere) {
  World world(busy_ground(12));
  const std::size_t before = bench::allocations();
  world.measure();
  EXPECT_EQ(bench::allocations(), before);
}

TEST(FieldCosts, SameInputSameBytes) {
  const World a(busy_ground(13));
  World b(busy_ground(14));
  World c(busy_ground(13));
  b.points = c.points;
  b.description = c.description;
  b.workspace = c.workspace;
  b.measure();  // in the memory of other points
  EXPECT_EQ(a.costs.step, b.costs.step);
  EXPECT_EQ(a.costs.gradient_x, b.costs.gradient_x);
  EXPECT_EQ(a.costs.obstacle, b.costs.obstacle);
  EXPECT_EQ(a.costs.likely, b.costs.likely);
  EXPECT_EQ(a.costs.doubt, b.costs.doubt);
  EXPECT_EQ(a.costs.hole, b.costs.hole);
}

}  // namespace
}  // namespace mrpt_terrain
