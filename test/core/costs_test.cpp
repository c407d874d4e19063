// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/costs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "allocation_counter.h"
#include "grids.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using grids::flat_cells;
using grids::grid_of;
using grids::Heights;
using grids::kNone;
using worlds::add_point;
using worlds::kPi;
using worlds::radians;
using worlds::Rect;

/// A grid with its costs, in fresh memory.
struct Costed {
  ElevationGrid grid;
  CellCosts costs;
  RobotParams robot;

  [[nodiscard]] std::size_t slot(int l, int w) const {
    const Slot found = grid.slot_at({l, w});
    EXPECT_NE(found, kUnobserved) << l << ", " << w;
    return found == kUnobserved ? 0 : static_cast<std::size_t>(found);
  }
  [[nodiscard]] double step(int l, int w) const { return costs.step[slot(l, w)]; }
  [[nodiscard]] Cost at(std::size_t k) const { return cost_of(costs, static_cast<Slot>(k), robot); }
  [[nodiscard]] double angle(std::size_t k) const {
    return std::atan(std::hypot(double{costs.gradient_x[k]}, double{costs.gradient_y[k]}));
  }
};

Costed costed(ElevationGrid grid, const RobotParams& robot = {}) {
  Costed result{std::move(grid), {}, robot};
  CostWorkspace workspace;
  compute_cell_costs(result.grid, robot, workspace, result.costs);
  return result;
}

Costed costed(const Points& points, double cell_size, const RobotParams& robot = {},
              double side = 5.0) {
  ElevationGrid grid;
  ElevationGridWorkspace workspace;
  PointSlots slots;
  build_elevation_grid(points.view(), {side, side, cell_size, 10.0}, workspace, grid, slots);
  return costed(std::move(grid), robot);
}

using HeightAt = std::function<double(double x, double y)>;

/// Points on a lattice that is turned against the cells, so that they lie anywhere in them.
Points surface(const HeightAt& height, double spacing, double half, double sigma = 0.0,
               std::uint64_t seed = 1) {
  RandomGenerator random(seed);
  Points points;
  const int n = static_cast<int>(std::ceil(1.5 * half / spacing));
  for (int i = -n; i <= n; ++i) {
    for (int k = -n; k <= n; ++k) {
      const double u = (i + 0.31) * spacing;
      const double v = (k + 0.17) * spacing;
      const double x = u * std::cos(0.3) - v * std::sin(0.3);
      const double y = u * std::sin(0.3) + v * std::cos(0.3);
      if (std::abs(x) >= half || std::abs(y) >= half) continue;
      add_point(points, x, y, height(x, y) + sigma * worlds::normal_deviate(random));
    }
  }
  return points;
}

/// Where along the direction `yaw` a position is, metres.
double along(double yaw, double x, double y) { return x * std::cos(yaw) + y * std::sin(yaw); }

/// Cells that are at least `margin` cells away from the edges of the grid.
bool is_inner(const ElevationGrid& grid, std::size_t k, int margin) {
  const CellIndex cell = grid.geometry.index_of(grid.cell[k]);
  return cell.l >= margin && cell.w >= margin && cell.l < grid.geometry.cells_l() - margin &&
         cell.w < grid.geometry.cells_w() - margin;
}

/// Every number is one.
void expect_sane(const Costed& c) {
  ASSERT_EQ(c.costs.size(), c.grid.observed());
  ASSERT_EQ(c.costs.step.size(), c.grid.observed());
  for (std::size_t k = 0; k < c.costs.size(); ++k) {
    ASSERT_TRUE(std::isfinite(c.costs.gradient_x[k]) && std::isfinite(c.costs.gradient_y[k]));
    ASSERT_TRUE(std::isfinite(c.costs.step[k]) && c.costs.step[k] >= 0.0F);
    ASSERT_TRUE(std::isfinite(c.costs.roughness[k]) && c.costs.roughness[k] >= 0.0F);
    const Cost cost = c.at(k);
    ASSERT_GE(cost.cost, 0.0);
    ASSERT_LE(cost.cost, 1.0);
    ASSERT_EQ(cost.status == CostStatus::kLethal, cost.cost == 1.0);
  }
}

// Literal, cells of 1 m: reach 1.

TEST(Costs, PlaneOfFiveByFiveCellsByHand) {
  grids::MeanTable table(5, std::vector<float>(5));
  for (int l = 0; l < 5; ++l) {
    for (int w = 0; w < 5; ++w) {
      table[static_cast<std::size_t>(l)][static_cast<std::size_t>(w)] =
          0.25F * static_cast<float>(l) - 0.125F * static_cast<float>(w);
    }
  }
  const Costed c = costed(flat_cells(table));
  for (std::size_t k = 0; k < 25; ++k) {
    ASSERT_EQ(c.costs.status[k], FeatureStatus::kOk);
    EXPECT_NEAR(c.costs.gradient_x[k], 0.25, 1e-6);
    EXPECT_NEAR(c.costs.gradient_y[k], -0.125, 1e-6);
    EXPECT_NEAR(c.costs.step[k], 0.0, 1e-6);
    EXPECT_NEAR(c.costs.roughness[k], 0.0, 1e-6);
  }
}

// A curb between the rows l = 2 and l = 3: both rows at it have its height as their step, and all
// rows are level, because there are windows of three rows on either side.
TEST(Costs, CurbOfSevenByFiveCellsByHand) {
  grids::MeanTable table(3, std::vector<float>(5, 0.0F));
  table.resize(7, std::vector<float>(5, 0.5F));
  const Costed c = costed(flat_cells(table));
  for (int l = 0; l < 7; ++l) {
    for (int w = 0; w < 5; ++w) {
      const std::size_t k = c.slot(l, w);
      EXPECT_NEAR(c.costs.gradient_x[k], 0.0, 1e-6) << l << ", " << w;
      EXPECT_NEAR(c.costs.gradient_y[k], 0.0, 1e-6) << l << ", " << w;
      EXPECT_NEAR(c.costs.roughness[k], 0.0, 1e-6) << l << ", " << w;
      EXPECT_NEAR(c.costs.step[k], l == 2 || l == 3 ? 0.5 : 0.0, 1e-6) << l << ", " << w;
    }
  }
}

// A pit of one cell, deep by 0.3 m. Every surface two cells away is level; a window that contains
// the pit sinks by at most 0.3 m x (1/9 + 1/6) when carried a cell beyond its centre.
TEST(Costs, PitOfOneCellByHand) {
  grids::MeanTable table(9, std::vector<float>(9, 0.0F));
  table[4][4] = -0.3F;
  const Costed c = costed(flat_cells(table));
  EXPECT_NEAR(c.step(4, 4), 0.3, 1e-6);
  EXPECT_LT(c.step(2, 2), 0.09);
  EXPECT_NEAR(c.step(1, 4), 0.0, 1e-6);
  EXPECT_EQ(c.at(c.slot(4, 4)).status, CostStatus::kLethal);
}

// One row of windows: 0, 0, d of three times three cells. The only surface is the middle one.
TEST(Costs, RoughnessOfThreeByThreeCellsByHand) {
  // Heights a (1, -1, 1) in rows: mean a / 3, level plane, variance 8/9 a^2.
  const float a = 0.03F;
  const Costed c = costed(flat_cells({{a, a, a}, {-a, -a, -a}, {a, a, a}}));
  const std::size_t k = c.slot(1, 1);
  EXPECT_NEAR(c.costs.gradient_x[k], 0.0, 1e-6);
  EXPECT_NEAR(c.costs.roughness[k], std::sqrt(8.0 / 9.0) * a, 1e-7);
}

// The corner's own window has four cells and a variance of a^2; that of all nine cells has 14/9
// a^2, less per cell. The windows of six cells have 1.18 a^2, more per cell than nine.
TEST(Costs, SurfaceHasTheLeastVariancePerCellByHand) {
  const float a = 0.01F;
  const Costed c = costed(flat_cells({{a, -a, 2 * a}, {-a, a, -a}, {2 * a, -a, a}}));
  EXPECT_NEAR(c.costs.roughness[c.slot(0, 0)], std::sqrt(14.0 / 9.0) * a, 1e-6);
}

// The cell's own extent counts beyond what its gradient explains: 1 m cells on a level plane.
TEST(Costs, ExtentWithinACellByHand) {
  grids::HeightTable table(5, std::vector<Heights>(5, Heights{0.0F, 0.0F, 0.0F}));
  table[2][2].max = 0.2F;
  const Costed c = costed(grid_of(table));
  EXPECT_NEAR(c.step(2, 2), 0.2, 1e-6);
  EXPECT_NEAR(c.step(1, 2), 0.0, 1e-6);
}

TEST(Costs, PartsAreValuesOverLimits) {
  CellCosts costs;
  costs.gradient_x = {0.1F};
  costs.gradient_y = {0.2F};
  costs.step = {0.02F};
  costs.roughness = {0.01F};
  costs.status = {FeatureStatus::kOk};
  RobotParams robot;
  robot.max_climb = 0.5;
  robot.max_tilt = 0.25;
  robot.max_step = 0.1;
  robot.max_roughness = 0.04;
  const Cost forward = cost_of(costs, 0, robot, 0.0);
  EXPECT_NEAR(forward.parts.slope, std::atan(0.2) / 0.25, 1e-7);
  EXPECT_NEAR(forward.parts.step, 0.2, 1e-6);
  EXPECT_NEAR(forward.parts.roughness, 0.25, 1e-6);
  EXPECT_EQ(forward.cost, forward.parts.slope);
  EXPECT_EQ(forward.status, CostStatus::kOk);
  const Cost left = cost_of(costs, 0, robot, kPi / 2);
  EXPECT_NEAR(left.parts.slope, std::atan(0.1) / 0.25, 1e-7);
  const Cost worst = cost_of(costs, 0, robot);
  EXPECT_NEAR(worst.parts.slope, std::atan(std::sqrt(0.05)) / 0.25, 1e-7);
  robot.max_roughness = 0.01;
  EXPECT_EQ(cost_of(costs, 0, robot, 0.0).status, CostStatus::kLethal);
  EXPECT_EQ(cost_of(costs, 0, robot, 0.0).cost, 1.0);
}

TEST(Costs, UnknownUnlessTheStepAloneIsLethal) {
  CellCosts costs;
  costs.gradient_x = costs.gradient_y = costs.roughness = {0.0F, 0.0F};
  costs.step = {0.02F, 0.5F};
  costs.status = {FeatureStatus::kTooFewPoints, FeatureStatus::kDegenerate};
  const RobotParams robot;
  EXPECT_EQ(cost_of(costs, 0, robot).status, CostStatus::kUnknown);
  EXPECT_EQ(cost_of(costs, 0, robot, 1.0).status, CostStatus::kUnknown);
  EXPECT_EQ(cost_of(costs, 1, robot).status, CostStatus::kLethal);
  EXPECT_EQ(cost_of(costs, 1, robot, 1.0).status, CostStatus::kLethal);
}

TEST(Costs, PositionsOutsideAndWithoutPointsHaveAStatus) {
  const Costed c = costed(flat_cells({{0, 0, 0}, {0, kNone, 0}, {0, 0, 0}}));
  const auto status = [&](double x, double y) {
    EXPECT_EQ(cost_at(c.grid, c.costs, {x, y}, c.robot).status,
              cost_at(c.grid, c.costs, {x, y}, c.robot, 1.0).status);
    return cost_at(c.grid, c.costs, {x, y}, c.robot).status;
  };
  EXPECT_EQ(status(1.0, 1.0), CostStatus::kOk);
  EXPECT_EQ(status(0.0, 0.0), CostStatus::kUnknown);
  EXPECT_EQ(status(1.6, 0.0), CostStatus::kOutside);
  EXPECT_EQ(status(0.0, -1.6), CostStatus::kOutside);
  EXPECT_EQ(status(std::nan(""), 0.0), CostStatus::kOutside);
  EXPECT_EQ(cost_of(c.costs, kUnobserved, c.robot).status, CostStatus::kUnknown);
  EXPECT_EQ(cost_of(c.costs, kUnobserved, c.robot, 0.5).status, CostStatus::kUnknown);
  EXPECT_EQ(std::string(name_of(CostStatus::kOutside)), "outside");
}

TEST(Costs, WindowsAreAsWideAsTheRobotWithinThreeToSevenCells) {
  RobotParams robot;
  robot.footprint_width = 0.4;
  EXPECT_EQ(window_reach(robot, 0.05), 3);
  EXPECT_EQ(window_reach(robot, 0.11), 2);
  EXPECT_EQ(window_reach(robot, 0.2), 1);
  EXPECT_EQ(window_reach(robot, 1.0), 1);
  robot.footprint_width = 2.0;
  EXPECT_EQ(window_reach(robot, 0.2), 3);
  EXPECT_EQ(window_reach(robot, 0.45), 2);
}

// Analytic worlds.

TEST(Costs, RampsOfAnyYawHaveTheirAngleAndNoStep) {
  for (const double cell : {0.05, 0.2}) {
    for (const double degrees : {5.0, 10.0, 20.0, 30.0}) {
      for (const double yaw : {0.0, 0.4, 1.1, 2.5, 4.0}) {
        const double gradient = std::tan(radians(degrees));
        const Costed c =
            costed(surface([&](double x, double y) { return gradient * along(yaw, x, y); },
                           0.4 * cell, 12.0 * cell),
                   cell);
        expect_sane(c);
        for (std::size_t k = 0; k < c.costs.size(); ++k) {
          ASSERT_EQ(c.costs.status[k], FeatureStatus::kOk);
          // Heights are floats below 3 m, rounded to 1.2e-7 m; a window is at least 0.15 m wide.
          ASSERT_NEAR(c.costs.gradient_x[k], gradient * std::cos(yaw), 1e-4);
          ASSERT_NEAR(c.costs.gradient_y[k], gradient * std::sin(yaw), 1e-4);
          ASSERT_NEAR(c.costs.roughness[k], 0.0, 1e-5);
          // Steeper than max_climb, the cell's own extent is not all explained.
          const double unexplained =
              std::max(0.0, gradient - std::tan(c.robot.max_climb)) * 1.42 * cell;
          ASSERT_LT(c.costs.step[k], 1e-5 + unexplained);
          ASSERT_EQ(c.at(k).status, degrees < 15.0 ? CostStatus::kOk : CostStatus::kLethal);
        }
      }
    }
  }
}

// Driving across 20 deg with a limit of 15 deg is lethal, driving up with a limit of 25 is not.
TEST(Costs, HeadingDecidesOnARamp) {
  RobotParams robot;
  robot.max_climb = radians(25.0);
  robot.max_tilt = radians(15.0);
  const double yaw = 0.7;
  const double gradient = std::tan(radians(20.0));
  const Costed c =
      costed(surface([&](double x, double y) { return gradient * along(yaw, x, y); }, 0.02, 0.5),
             0.05, robot);
  for (std::size_t k = 0; k < c.costs.size(); ++k) {
    const auto slot = static_cast<Slot>(k);
    const auto toward = [&](double heading) { return cost_of(c.costs, slot, robot, heading); };
    EXPECT_EQ(toward(yaw).status, CostStatus::kOk);
    EXPECT_NEAR(toward(yaw).cost, 20.0 / 25.0, 1e-3);
    EXPECT_NEAR(toward(yaw + kPi).cost, 20.0 / 25.0, 1e-3);
    EXPECT_EQ(toward(yaw + kPi / 2).status, CostStatus::kLethal);
    EXPECT_NEAR(toward(yaw - kPi / 2).parts.slope, 20.0 / 15.0, 1e-3);
    EXPECT_EQ(cost_of(c.costs, slot, robot).status, CostStatus::kLethal);
  }
}

// No heading costs more than the worst, and one comes close to it.
TEST(Costs, OracleWorstHeadingIsTheMaximumOverHeadings) {
  RandomGenerator random(3);
  CellCosts costs;
  costs.step = costs.roughness = {0.0F};
  costs.status = {FeatureStatus::kOk};
  for (int trial = 0; trial < 50; ++trial) {
    costs.gradient_x = {static_cast<float>(2.0 * random.uniform() - 1.0)};
    costs.gradient_y = {static_cast<float>(2.0 * random.uniform() - 1.0)};
    RobotParams robot;
    robot.max_climb = radians(10.0 + 40.0 * random.uniform());
    robot.max_tilt = radians(10.0 + 40.0 * random.uniform());
    const double worst = cost_of(costs, 0, robot).parts.slope;
    double greatest = 0.0;
    for (int k = 0; k < 720; ++k) {
      greatest = std::max(greatest, cost_of(costs, 0, robot, k * kPi / 360.0).parts.slope);
    }
    EXPECT_LE(greatest, worst * (1.0 + 1e-12));
    EXPECT_GT(greatest, worst * (1.0 - 1e-4));
  }
}

/// A curb of height h across the direction `yaw`, at `shift` from the middle.
HeightAt curb(double h, double yaw, double shift) {
  return [=](double x, double y) { return along(yaw, x, y) < shift ? 0.0 : h; };
}

struct CurbCase {
  double cell, yaw, shift;
};
std::vector<CurbCase> curb_cases() {
  std::vector<CurbCase> cases;
  for (const double cell : {0.05, 0.1, 0.2}) {
    for (const double yaw : {0.0, 0.35, kPi / 4, 1.3, kPi / 2, 2.2, kPi}) {
      for (const double part : {0.0, 0.25, 0.5, 0.9}) cases.push_back({cell, yaw, part * cell});
    }
  }
  return cases;
}

// The step limit decides, not the slope of planes across the curb.
TEST(Costs, CurbBelowMaxStepIsNotLethalAndHasItsHeight) {
  RobotParams robot;
  robot.max_step = 0.12;
  for (const CurbCase& t : curb_cases()) {
    const Costed c = costed(surface(curb(0.1, t.yaw, t.shift), 0.3 * t.cell, 16.0 * t.cell), t.cell,
                            robot, 32.0 * t.cell);
    expect_sane(c);
    float highest = 0.0F;
    double steepest = 0.0;
    for (std::size_t k = 0; k < c.costs.size(); ++k) {
      // Where the curb ends at the edge of the grid, no window may lie on one side of it.
      if (!is_inner(c.grid, k, 7)) continue;
      const Cost cost = c.at(k);
      const CellIndex cell = c.grid.geometry.index_of(c.grid.cell[k]);
      const Position2 p = c.grid.geometry.centre_of(cell);
      ASSERT_EQ(cost.status, CostStatus::kOk)
          << "cell " << t.cell << " yaw " << t.yaw << " shift " << t.shift << " at "
          << along(t.yaw, p.x, p.y) - t.shift << " parts " << cost.parts.slope << " "
          << cost.parts.step << " " << cost.parts.roughness;
      highest = std::max(highest, c.costs.step[k]);
      steepest = std::max(steepest, c.angle(k));
    }
    EXPECT_LT(steepest, radians(0.5))
        << "cell " << t.cell << " yaw " << t.yaw << " shift " << t.shift;
    EXPECT_NEAR(highest, 0.1, 0.01) << "cell " << t.cell << " yaw " << t.yaw;
  }
}

TEST(Costs, CurbAboveMaxStepIsLethalAllAlong) {
  RobotParams robot;
  robot.max_step = 0.12;
  for (const CurbCase& t : curb_cases()) {
    const double half = 16.0 * t.cell;
    const Costed c = costed(surface(curb(0.15, t.yaw, t.shift), 0.3 * t.cell, half), t.cell, robot);
    // Walking along the curb, every position on it is lethal.
    for (double v = -0.7 * half; v < 0.7 * half; v += 0.5 * t.cell) {
      const double x = t.shift * std::cos(t.yaw) - v * std::sin(t.yaw);
      const double y = t.shift * std::sin(t.yaw) + v * std::cos(t.yaw);
      EXPECT_EQ(cost_at(c.grid, c.costs, {x, y}, robot).status, CostStatus::kLethal)
          << "cell " << t.cell << " yaw " << t.yaw << " shift " << t.shift << " at " << v;
    }
    // Away from it nothing of it is left.
    for (std::size_t k = 0; k < c.costs.size(); ++k) {
      const Position2 p = c.grid.geometry.centre_of(c.grid.geometry.index_of(c.grid.cell[k]));
      if (std::abs(along(t.yaw, p.x, p.y) - t.shift) < 3.5 * t.cell) continue;
      EXPECT_LT(c.at(k).cost, 0.1);
    }
  }
}

TEST(Costs, PotholeIsAStepAllAround) {
  const auto pothole = [](double x, double y) { return std::hypot(x, y) < 0.3 ? -0.15 : 0.0; };
  for (const double cell : {0.05, 0.1}) {
    const Costed c = costed(surface(pothole, 0.3 * cell, 1.0), cell);
    for (double angle = 0.0; angle < 2.0 * kPi; angle += 0.1) {
      bool lethal = false;
      for (double r = 0.3 - cell; r <= 0.3 + cell; r += 0.25 * cell) {
        const Position2 position{r * std::cos(angle), r * std::sin(angle)};
        const Cost cost = cost_at(c.grid, c.costs, position, c.robot);
        lethal = lethal || cost.status == CostStatus::kLethal;
      }
      EXPECT_TRUE(lethal) << "cell " << cell << " angle " << angle;
    }
    EXPECT_EQ(cost_at(c.grid, c.costs, {0.8, 0.0}, c.robot).status, CostStatus::kOk);
    EXPECT_LT(cost_at(c.grid, c.costs, {0.8, 0.0}, c.robot).cost, 0.01);
  }
}

// Seen from one side: ground up to the wall, nothing behind it.
TEST(Costs, WallIsLethalAndTheGroundAwayFromItIsNot) {
  for (const double cell : {0.05, 0.2}) {
    RandomGenerator random(5);
    Points points;
    worlds::add_flat(points, {-2.0, 1.01, -1.0, 1.0}, 0.3 * cell, 0.0);
    worlds::add_wall(points, 1.01, -1.0, 1.0, 1.0, 0.3 * cell, 0.002, random);
    const Costed c = costed(points, cell);
    expect_sane(c);
    for (double y = -0.9; y < 0.9; y += cell) {
      EXPECT_EQ(cost_at(c.grid, c.costs, {1.01, y}, c.robot).status, CostStatus::kLethal);
      const Cost near = cost_at(c.grid, c.costs, {1.0 - 3.0 * cell, y}, c.robot);
      EXPECT_EQ(near.status, CostStatus::kOk) << "cell " << cell << " y " << y;
      EXPECT_LT(near.cost, 0.5);
    }
  }
}

// A thin rod: five points up to 0.5 m among the many of the ground.
TEST(Costs, RodIsLethal) {
  Points points = surface([](double, double) { return 0.0; }, 0.01, 0.5, 0.005);
  for (int k = 1; k <= 5; ++k) add_point(points, 0.12, 0.13, 0.1 * k);
  const Costed c = costed(points, 0.05);
  EXPECT_EQ(cost_at(c.grid, c.costs, {0.12, 0.13}, c.robot).status, CostStatus::kLethal);
  EXPECT_EQ(cost_at(c.grid, c.costs, {-0.2, 0.13}, c.robot).status, CostStatus::kOk);
}

// White noise of 5 cm in every point: roughness is that, less what the smoothest of nine windows
// and the planes' three parameters take away (windows of about 25 x 10 points).
TEST(Costs, RoughGroundHasItsRoughness) {
  RobotParams robot;
  robot.max_roughness = 0.1;
  robot.max_step = 1.0;
  const Costed c =
      costed(surface([](double, double) { return 0.0; }, 0.015, 1.0, 0.05, 7), 0.05, robot);
  for (std::size_t k = 0; k < c.costs.size(); ++k) {
    if (is_inner(c.grid, k, 2)) {
      EXPECT_NEAR(c.costs.roughness[k], 0.046, 0.009);
    }
  }
  robot.max_roughness = 0.03;
  const auto lethal = [&](std::size_t k) {
    return cost_of(c.costs, static_cast<Slot>(k), robot).status == CostStatus::kLethal;
  };
  for (std::size_t k = 0; k < c.costs.size(); ++k) EXPECT_TRUE(lethal(k));
}

// Noise of ranges must not make level ground lethal, whatever the number of points of a cell.
TEST(Costs, LevelGroundWithNoiseIsNotLethal) {
  for (const double cell : {0.05, 0.2}) {
    for (const double spacing : {0.1, 0.25, 0.5, 0.6}) {
      for (const double sigma : {0.01, 0.02}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          const double half = std::min(2.4, (spacing < 0.2 ? 20.0 : 45.0) * cell);
          const Costed c = costed(
              surface([](double, double) { return 0.0; }, spacing * cell, half, sigma, seed), cell);
          std::size_t lethal = 0;
          double greatest = 0.0;
          CostParts parts;
          for (std::size_t k = 0; k < c.costs.size(); ++k) {
            const Cost cost = c.at(k);
            lethal += cost.status == CostStatus::kLethal ? 1U : 0U;
            if (cost.cost >= greatest) parts = cost.parts;
            greatest = std::max(greatest, cost.cost);
          }
          EXPECT_EQ(lethal, 0U) << "cell " << cell << " spacing " << spacing << " sigma " << sigma
                                << " seed " << seed << " of " << c.costs.size() << " slope "
                                << parts.slope << " step " << parts.step << " roughness "
                                << parts.roughness;
        }
      }
    }
  }
}

// With noise of 2 cm and ten points in a cell, nine of ten positions on a curb of 0.2 m are lethal
// for a robot that climbs 0.12 m, and of one of 0.06 m not one in a hundred cells around it.
TEST(Costs, CurbsAreToldThroughNoise) {
  RobotParams robot;
  robot.max_step = 0.12;
  for (const double cell : {0.05, 0.2}) {
    for (const double yaw : {0.0, 0.35, kPi / 4}) {
      const double half = 16.0 * cell;
      const auto scan = [&](double h) {
        return costed(surface(curb(h, yaw, 0.0), 0.3 * cell, half, 0.02, 9), cell, robot,
                      2.0 * half);
      };
      const Costed high = scan(0.2);
      int lethal = 0;
      int all = 0;
      for (double v = -0.7 * half; v < 0.7 * half; v += 0.5 * cell, ++all) {
        const Position2 p{-v * std::sin(yaw), v * std::cos(yaw)};
        const Cost cost = cost_at(high.grid, high.costs, p, robot);
        lethal += cost.status == CostStatus::kLethal ? 1 : 0;
      }
      EXPECT_GE(lethal, 0.9 * all) << "cell " << cell << " yaw " << yaw;
      const Costed low = scan(0.06);
      int blocked = 0;
      for (std::size_t k = 0; k < low.costs.size(); ++k) {
        blocked += low.at(k).status == CostStatus::kLethal ? 1 : 0;
      }
      EXPECT_LE(blocked, 0.01 * static_cast<double>(low.costs.size()))
          << "cell " << cell << " yaw " << yaw;
    }
  }
}

/// Hills, a curb, a wall and noise: something of everything.
Points mixed_world(std::uint64_t seed) {
  return surface(
      [](double x, double y) {
        const double hills = 0.15 * std::sin(2.1 * x) * std::cos(1.7 * y);
        const double step = y > 0.31 ? 0.1 : 0.0;
        return hills + step + (x > 0.9 && y < -0.5 ? 0.6 : 0.0);
      },
      0.03, 1.2, 0.01, seed);
}

// Turning by a quarter turns gradients; where two windows are equally good, another may be taken
// because rounding differs, which is why a few cells in ten thousand may differ.
TEST(Costs, InvariantQuarterTurnTurnsTheGradients) {
  const Points points = mixed_world(21);
  for (const double size : {0.05, 0.1}) {
    const Costed a = costed(points, size);
    const Costed b = costed(worlds::turned_left(points), size);
    ASSERT_EQ(a.costs.size(), b.costs.size());
    const int cells = a.grid.geometry.cells_l();
    std::size_t different = 0;
    for (std::size_t k = 0; k < a.costs.size(); ++k) {
      const CellIndex cell = a.grid.geometry.index_of(a.grid.cell[k]);
      const std::size_t t = b.slot(cells - 1 - cell.w, cell.l);
      const bool same = std::abs(b.costs.gradient_x[t] + a.costs.gradient_y[k]) < 1e-3F &&
                        std::abs(b.costs.gradient_y[t] - a.costs.gradient_x[k]) < 1e-3F &&
                        std::abs(b.costs.step[t] - a.costs.step[k]) < 1e-4F &&
                        std::abs(b.costs.roughness[t] - a.costs.roughness[k]) < 1e-4F &&
                        b.costs.status[t] == a.costs.status[k];
      different += same ? 0U : 1U;
    }
    EXPECT_LE(different, a.costs.size() / 1000);
  }
}

TEST(Costs, InvariantShiftByWholeCellsShiftsTheCosts) {
  const Points points = mixed_world(22);
  const Costed a = costed(points, 0.0625);
  const Costed b = costed(worlds::shifted(points, 0.25F, -0.5F), 0.0625);
  // Coordinates are rounded to floats after the shift, so points near borders may change cells.
  std::size_t different = 0;
  for (std::size_t k = 0; k < a.costs.size(); ++k) {
    const CellIndex cell = a.grid.geometry.index_of(a.grid.cell[k]);
    const Slot t = b.grid.slot_at({cell.l + 4, cell.w - 8});
    const bool same =
        t != kUnobserved &&
        std::abs(b.costs.step[static_cast<std::size_t>(t)] - a.costs.step[k]) < 1e-3F &&
        std::abs(b.at(static_cast<std::size_t>(t)).cost - a.at(k).cost) < 1e-2;
    different += same ? 0U : 1U;
  }
  EXPECT_LE(different, a.costs.size() / 100);
}

TEST(Costs, InvariantHeightOfTheFrameDoesNotMatter) {
  const Points points = mixed_world(23);
  Points raised = points;
  for (float& z : raised.z) z += 2.0F;
  const Costed a = costed(points, 0.1);
  const Costed b = costed(raised, 0.1);
  ASSERT_EQ(a.costs.size(), b.costs.size());
  for (std::size_t k = 0; k < a.costs.size(); ++k) {
    EXPECT_NEAR(a.costs.step[k], b.costs.step[k], 1e-3);
    EXPECT_NEAR(a.at(k).cost, b.at(k).cost, 1e-2);
  }
}

TEST(Costs, SameInputGivesTheSameBytesAndOldMemoryLeavesNoTrace) {
  const Costed fresh = costed(mixed_world(24), 0.05);
  const Costed other = costed(mixed_world(25), 0.2);
  CostWorkspace workspace;
  CellCosts costs;
  compute_cell_costs(other.grid, other.robot, workspace, costs);
  compute_cell_costs(fresh.grid, fresh.robot, workspace, costs);
  EXPECT_EQ(costs.gradient_x, fresh.costs.gradient_x);
  EXPECT_EQ(costs.gradient_y, fresh.costs.gradient_y);
  EXPECT_EQ(costs.step, fresh.costs.step);
  EXPECT_EQ(costs.roughness, fresh.costs.roughness);
  EXPECT_EQ(costs.status, fresh.costs.status);
}

// Cells are worked on side by side; where in the row a cell comes must not matter.
TEST(Costs, InvariantCellsFarAwayDoNotChangeABit) {
  const Costed alone = costed(mixed_world(27), 0.1, {}, 8.0);
  for (int more = 1; more <= 9; ++more) {
    Points points = mixed_world(27);
    for (int k = 0; k < more; ++k) add_point(points, -3.95, -3.95 + 0.3 * k, 0.1 * k);
    const Costed c = costed(points, 0.1, {}, 8.0);
    ASSERT_EQ(c.grid.observed(), alone.grid.observed() + static_cast<std::size_t>(more));
    for (std::size_t k = 0; k < alone.grid.observed(); ++k) {
      const auto n = static_cast<std::size_t>(
          c.grid.slot_at(alone.grid.geometry.index_of(alone.grid.cell[k])));
      ASSERT_EQ(c.costs.gradient_x[n], alone.costs.gradient_x[k]) << more << ", slot " << k;
      ASSERT_EQ(c.costs.gradient_y[n], alone.costs.gradient_y[k]) << more << ", slot " << k;
      ASSERT_EQ(c.costs.step[n], alone.costs.step[k]) << more << ", slot " << k;
      ASSERT_EQ(c.costs.roughness[n], alone.costs.roughness[k]) << more << ", slot " << k;
      ASSERT_EQ(c.costs.status[n], alone.costs.status[k]) << more << ", slot " << k;
    }
  }
}

TEST(Costs, SteadyStateDoesNotAllocate) {
  const Costed c = costed(mixed_world(26), 0.05);
  CostWorkspace workspace;
  CellCosts costs;
  compute_cell_costs(c.grid, c.robot, workspace, costs);
  const std::size_t before = bench::allocations();
  compute_cell_costs(c.grid, c.robot, workspace, costs);
  const Cost cost = cost_at(c.grid, costs, {0.1, 0.1}, c.robot, 0.3);
  EXPECT_EQ(bench::allocations(), before);
  EXPECT_NE(cost.status, CostStatus::kOutside);
}

// Degenerate input: what is observed, and the status of all of it.
TEST(Costs, TableOfDegenerateGrids) {
  struct Case {
    const char* name;
    grids::MeanTable table;
    FeatureStatus status;
    CostStatus cost;
  };
  const std::vector<Case> cases = {
      {"no cell", {{kNone, kNone}, {kNone, kNone}}, FeatureStatus::kOk, CostStatus::kOk},
      {"one cell", {{0.0F}}, FeatureStatus::kTooFewPoints, CostStatus::kUnknown},
      {"two cells", {{0.0F, 0.01F}}, FeatureStatus::kTooFewPoints, CostStatus::kUnknown},
      {"two cells, a cliff", {{0.0F, 2.0F}}, FeatureStatus::kTooFewPoints, CostStatus::kLethal},
      {"three cells on a line", {{0, 0, 0}}, FeatureStatus::kDegenerate, CostStatus::kUnknown},
      {"a row", {{0, 0, 0, 0, 0}}, FeatureStatus::kTooFewPoints, CostStatus::kUnknown},
      {"four cells", {{0, 0}, {0, 0}}, FeatureStatus::kOk, CostStatus::kOk},
      {"corners",
       {{0, kNone, 0}, {kNone, 0, kNone}, {0, kNone, 0}},
       FeatureStatus::kOk,
       CostStatus::kOk},
  };
  for (const Case& t : cases) {
    const Costed c = costed(flat_cells(t.table));
    expect_sane(c);
    for (std::size_t k = 0; k < c.costs.size(); ++k) {
      // The ends of a row see two cells only, its middle three on a line.
      if (std::string(t.name) != "a row" && std::string(t.name) != "three cells on a line") {
        EXPECT_EQ(c.costs.status[k], t.status) << t.name << " slot " << k;
      } else {
        EXPECT_NE(c.costs.status[k], FeatureStatus::kOk) << t.name << " slot " << k;
      }
      EXPECT_EQ(c.at(k).status, t.cost) << t.name << " slot " << k;
    }
  }
}

// A cliff that no plane can be found for: heights differ by more than 20 deg explain over 1 m.
TEST(Costs, WithoutPlanesHeightsBeyondTheClimbableAreSteps) {
  const Costed c = costed(flat_cells({{0.0F, 0.5F}}));
  const double explained = std::tan(c.robot.max_climb) * 1.0;
  EXPECT_NEAR(c.step(0, 0), 0.5 - explained, 1e-6);
  EXPECT_NEAR(c.step(0, 1), 0.5 - explained, 1e-6);
  const Costed gentle = costed(flat_cells({{0.0F, 0.3F}}));
  EXPECT_EQ(gentle.step(0, 0), 0.0);
}

// Heights and extents at random, some cells empty: every number is one.
TEST(Costs, RandomGridsGiveSaneNumbers) {
  RandomGenerator random(31);
  for (int trial = 0; trial < 300; ++trial) {
    grids::HeightTable table(9, std::vector<Heights>(8));
    const double density = random.uniform();
    for (auto& row : table) {
      for (Heights& h : row) {
        const auto low = static_cast<float>(4.0 * random.uniform() - 2.0);
        const auto extent = static_cast<float>(random.uniform());
        h = {low, low + extent, random.uniform() < density ? low + 0.5F * extent : kNone};
      }
    }
    expect_sane(costed(grid_of(table)));
  }
}

// All points of a cell upright above each other, and all of the scan in one upright plane.
TEST(Costs, UprightPlanesHaveASteepGradientAndAreLethal) {
  Points points;
  worlds::add_surface(points, {-0.5, 0.5, 0.0, 1.0}, 0.02, [](double, double) { return 0.0; });
  for (std::size_t i = 0; i < points.size(); ++i) std::swap(points.y[i], points.z[i]);
  const Costed c = costed(points, 0.05);
  expect_sane(c);
  for (std::size_t k = 0; k < c.costs.size(); ++k) {
    EXPECT_EQ(c.at(k).status, CostStatus::kLethal);
    EXPECT_LE(std::tan(c.angle(k)), kSteepestGradient * 1.001);
  }
}

}  // namespace
}  // namespace mrpt_terrain
