// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/cost_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mrpt_terrain::eval {
namespace {

/// Level ground of 5 x 5 cells of 0.2 m.
sim::CellTruth level_truth() {
  sim::CellTruth truth;
  truth.geometry = GridGeometry(1.0, 1.0, 0.2);
  truth.min.assign(25, 0.0F);
  truth.mean = truth.max = truth.ground_height = truth.slope = truth.slope_direction = truth.min;
  truth.support.assign(25, Support::kGround);
  truth.terrain_class.assign(25, TerrainClass::kNone);
  return truth;
}

std::vector<TrueCell> kinds_of(const sim::CellTruth& truth, const RobotParams& robot = {},
                               const std::vector<TrueThing>& things = {}) {
  return true_cells(truth, things, Eigen::Isometry3d::Identity(), robot);
}

// The robot takes 8 cm, 15 deg.
TEST(CostScore, KindsOfCellsByHand) {
  sim::CellTruth truth = level_truth();
  truth.max[0] = 0.3F;
  truth.support[0] = Support::kAbove;
  truth.max[4] = 0.06F;  // between half and all of the limit
  truth.slope[20] = static_cast<float>(20.0 * M_PI / 180.0);
  truth.max[24] = std::nanf("");
  for (const std::size_t k : {10U, 11U}) truth.ground_height[k] = truth.max[k] = 0.2F;
  const auto kinds = kinds_of(truth);
  EXPECT_EQ(kinds[0], TrueCell::kObstacle);
  EXPECT_EQ(kinds[4], TrueCell::kNotCounted);
  EXPECT_EQ(kinds[20], TrueCell::kSteep);
  EXPECT_EQ(kinds[24], TrueCell::kNotCounted);
  for (const std::size_t k : {5U, 6U, 10U, 11U, 12U, 16U})
    EXPECT_EQ(kinds[k], TrueCell::kEdge) << k;
  EXPECT_EQ(kinds[8], TrueCell::kTraversable);
}

TEST(CostScore, HolesByTheWheelThatFallsIn) {
  TrueThing hole;
  hole.depth = 0.15;
  hole.footprint = {{0.0, 0.0}, 0.0, 0.5, 0.3, false};
  RobotParams robot;
  EXPECT_EQ(kinds_of(level_truth(), robot, {hole})[12], TrueCell::kHole);
  EXPECT_EQ(kinds_of(level_truth(), robot, {hole})[0], TrueCell::kTraversable);
  robot.wheel_radius = 1.0;  // 3.2 cm over 0.5 m
  EXPECT_EQ(kinds_of(level_truth(), robot, {hole})[12], TrueCell::kTraversable);
}

// A grid of 7 x 7 cells around the middle of 5 x 5, all observed but one.
TEST(CostScore, CountsByHand) {
  ElevationGrid grid;
  grid.geometry = GridGeometry(1.4, 1.4, 0.2);
  grid.slot_of.assign(static_cast<std::size_t>(grid.geometry.array_size()), kUnobserved);
  CellCosts costs;
  for (int l = 0; l < 7; ++l) {
    for (int w = 0; w < 7; ++w) {
      if (l == 5 && w == 5) continue;  // the last cell of the middle
      grid.slot_of[static_cast<std::size_t>(value_of(grid.geometry.id_of({l, w})))] =
          static_cast<Slot>(grid.cell.size());
      grid.cell.push_back(grid.geometry.id_of({l, w}));
      const bool lethal = (l == 1 && w == 1) || (l == 1 && w == 4);
      costs.step.push_back(lethal ? 1.0F : 0.0F);
      costs.gradient_x.push_back(0.0F);
      costs.gradient_y.push_back(0.0F);
      costs.roughness.push_back(0.0F);
      costs.status.push_back(FeatureStatus::kOk);
    }
  }
  const GridGeometry middle = middle_of(grid.geometry, 0.55);
  ASSERT_EQ(middle.cells_l(), 5 - 1) << "0.55 m are two whole cells to each side";
  const GridGeometry five(1.0, 1.0, 0.2);
  std::vector<TrueCell> kinds(25, TrueCell::kTraversable);
  kinds[0] = kinds[1] = TrueCell::kObstacle;  // the first lethal cell, and one beside
  kinds[20] = TrueCell::kHole;                // nothing lethal near
  CostScore score;
  add_costs(grid, costs, five, kinds, {}, score);
  const auto obstacle = static_cast<std::size_t>(TrueCell::kObstacle);
  const auto hole = static_cast<std::size_t>(TrueCell::kHole);
  EXPECT_EQ(score.open[obstacle].total, 2U);
  EXPECT_EQ(score.open[obstacle].hits, 1U);
  EXPECT_EQ(score.all_open[obstacle].hits, 0U);
  EXPECT_EQ(score.open[hole].hits, 1U);
  EXPECT_EQ(score.all_open[hole].hits, 1U);
  EXPECT_EQ(score.unknown[hole].hits, 0U);
  EXPECT_EQ(score.blocked.total, 21U);
  EXPECT_EQ(score.blocked.hits, 1U);       // the second lethal cell, at (0, 3) of the middle
  EXPECT_EQ(score.blocked_free.hits, 1U);  // whose neighbours are all traversable
  CostScore twice = score;
  twice.add(score);
  EXPECT_EQ(twice.blocked.total, 42U);
  EXPECT_EQ(twice.all_open[hole].hits, 2U);
}

}  // namespace
}  // namespace mrpt_terrain::eval
