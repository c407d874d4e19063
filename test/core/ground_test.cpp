// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "grids.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using grids::flat_cells;
using grids::grid_of;
using grids::HeightTable;
using grids::kNone;
using grids::MeanTable;

GroundSegmentation segmented(const ElevationGrid& grid, const GroundParams& params = {}) {
  GroundSegmentation result;
  GroundWorkspace workspace;
  segment_ground(grid, params, workspace, result);
  return result;
}

/// The rule that applies to a single cell of these heights.
GroundRule rule_of(grids::Heights heights) { return segmented(grid_of({{heights}})).rule[0]; }

GroundRule rule_at(const ElevationGrid& grid, const GroundSegmentation& ground, int l, int w) {
  return ground.rule[static_cast<std::size_t>(grid.slot_at({l, w}))];
}

/// 3 x 3 cells of one height with another one in the middle.
MeanTable bump(float around, float middle) {
  return {{around, around, around}, {around, middle, around}, {around, around, around}};
}

TEST(Ground, EquationOneByHand) {
  EXPECT_EQ(rule_of({0.0F, 0.04F, 0.02F}), GroundRule::kGround);
  EXPECT_EQ(rule_of({0.0F, 0.06F, 0.02F}), GroundRule::kDifference);
  EXPECT_EQ(rule_of({0.06F, 0.07F, 0.065F}), GroundRule::kHigh);
  EXPECT_EQ(rule_of({-0.07F, -0.06F, -0.065F}), GroundRule::kLow);
}

TEST(Ground, EquationOneIncludesItsThresholds) {
  EXPECT_EQ(rule_of({0.0F, 0.05F, 0.02F}), GroundRule::kDifference);
  EXPECT_EQ(rule_of({0.0F, std::nextafter(0.05F, 0.0F), 0.02F}), GroundRule::kGround);
  EXPECT_EQ(rule_of({0.05F, 0.06F, 0.055F}), GroundRule::kHigh);
  EXPECT_EQ(rule_of({std::nextafter(0.05F, 0.0F), 0.06F, 0.055F}), GroundRule::kGround);
  EXPECT_EQ(rule_of({-0.05F, -0.04F, -0.045F}), GroundRule::kLow);
  EXPECT_EQ(rule_of({std::nextafter(-0.05F, 0.0F), -0.04F, -0.045F}), GroundRule::kGround);
}

TEST(Ground, FirstRuleThatAppliesIsTold) {
  EXPECT_EQ(rule_of({0.5F, 0.7F, 0.6F}), GroundRule::kDifference);
  EXPECT_EQ(rule_of({-0.7F, -0.5F, -0.6F}), GroundRule::kDifference);
}

TEST(Ground, MinimumDecidesNotMean) {
  EXPECT_EQ(rule_of({0.04F, 0.08F, 0.07F}), GroundRule::kGround);
  EXPECT_EQ(rule_of({-0.06F, -0.02F, -0.03F}), GroundRule::kLow);
}

// Row "empty cells": neither C_G nor C_N, so there is no rule for them at all.
TEST(PaperReading, EmptyCellsAreNeitherGroundNorNonGround) {
  const ElevationGrid grid = flat_cells({{0.0F, kNone}, {kNone, 1.0F}});
  EXPECT_EQ(segmented(grid).rule.size(), 2U);
}

// The same row: eq. (2) needs eight observed neighbours.
TEST(PaperReading, AnEmptyCellBlocksTheEightNeighbourTest) {
  for (int l = 0; l < 3; ++l) {
    for (int w = 0; w < 3; ++w) {
      if (l == 1 && w == 1) continue;
      MeanTable table = bump(-0.03F, 0.04F);
      EXPECT_EQ(segmented(flat_cells(table)).rule[4], GroundRule::kKernel);
      table[static_cast<std::size_t>(l)][static_cast<std::size_t>(w)] = kNone;
      const ElevationGrid grid = flat_cells(table);
      EXPECT_EQ(rule_at(grid, segmented(grid), 1, 1), GroundRule::kGround) << l << " " << w;
    }
  }
}

TEST(Ground, ANonGroundNeighbourBlocksEquationTwo) {
  MeanTable table = bump(-0.03F, 0.04F);
  table[0][2] = 0.5F;
  EXPECT_EQ(segmented(flat_cells(table)).rule[4], GroundRule::kGround);
}

TEST(Ground, CellsOnTheBorderHaveFewerThanEightNeighbours) {
  // The middle of the long side, of the short side and a corner stand out.
  const ElevationGrid grid = flat_cells({{0.04F, -0.04F, 0.04F, -0.04F},
                                         {-0.04F, -0.04F, -0.04F, -0.04F},
                                         {0.04F, -0.04F, -0.04F, 0.04F}});
  for (const GroundRule rule : segmented(grid).rule) EXPECT_EQ(rule, GroundRule::kGround);
}

// Row "kernel w": centre +1, neighbours -1/8, in metres.
TEST(PaperReading, KernelIsCentreMinusMeanOfNeighbours) {
  // Thresholds and heights that binary holds exactly.
  GroundParams params;
  params.t_diff = 0.0625;
  EXPECT_EQ(segmented(flat_cells(bump(-0.03125F, 0.03125F)), params).rule[4], GroundRule::kKernel);
  const float less = std::nextafter(0.03125F, 0.0F);
  EXPECT_EQ(segmented(flat_cells(bump(-0.03125F, less)), params).rule[4], GroundRule::kGround);
  // One neighbour weighs an eighth: the others have to make up for it.
  MeanTable uneven = bump(-0.03125F, 0.03125F);
  uneven[2][0] = 0.03125F;
  EXPECT_EQ(segmented(flat_cells(uneven), params).rule[4], GroundRule::kGround);
  uneven[0][1] = -0.046875F;
  uneven[1][0] = -0.046875F;
  uneven[1][2] = -0.046875F;
  uneven[2][2] = -0.046875F;
  EXPECT_EQ(segmented(flat_cells(uneven), params).rule[4], GroundRule::kKernel);
}

// The same row: the 8 / -1 form is an option and responds eight times as much.
TEST(PaperReading, KernelOfEightAndMinusOneIsAnOption) {
  GroundParams params;
  params.t_diff = 0.0625;
  params.kernel = GroundKernel::kSumDifference;
  EXPECT_EQ(segmented(flat_cells(bump(0.0F, 0.0078125F)), params).rule[4], GroundRule::kKernel);
  const float less = std::nextafter(0.0078125F, 0.0F);
  EXPECT_EQ(segmented(flat_cells(bump(0.0F, less)), params).rule[4], GroundRule::kGround);
}

// The same row: both forms vanish on any plane. Heights are floats below 0.06: each is wrong by at
// most 2e-9 m, nine of them with weights of up to 8 by less than 4e-8 m.
TEST(PaperReading, KernelSumsToZeroOnAnyPlane) {
  RandomGenerator random(21);
  for (int k = 0; k < 100; ++k) {
    const double a = 0.02 * (random.uniform() - 0.5);
    const double b = 0.02 * (random.uniform() - 0.5);
    MeanTable table(3, std::vector<float>(3));
    for (int l = 0; l < 3; ++l) {
      for (int w = 0; w < 3; ++w) {
        table[static_cast<std::size_t>(l)][static_cast<std::size_t>(w)] =
            static_cast<float>(a * l + b * w + 0.01);
      }
    }
    GroundParams params;
    params.kernel = GroundKernel::kSumDifference;
    // Heights differ by less than t_diff, so that only eq. (2) can take the middle out.
    params.t_diff = 4e-8;
    HeightTable heights;
    for (const auto& row : table) {
      heights.emplace_back();
      for (const float h : row) heights.back().push_back({h, h, h});
    }
    EXPECT_EQ(segmented(grid_of(heights), params).rule[4], GroundRule::kGround) << "plane " << k;
  }
}

TEST(Ground, DentsDoNotRespond) {
  EXPECT_EQ(segmented(flat_cells(bump(0.04F, -0.04F))).rule[4], GroundRule::kGround);
}

// Row "eq. (2) order": both of two touching bumps see the other as ground, whichever comes first.
TEST(PaperReading, EquationTwoSeesTheUnchangedGround) {
  const ElevationGrid grid = flat_cells({{-0.04F, -0.04F, -0.04F, -0.04F},
                                         {-0.04F, 0.04F, 0.04F, -0.04F},
                                         {-0.04F, -0.04F, -0.04F, -0.04F}});
  // Each: 0.04 - (7 (-0.04) + 0.04) / 8 = 0.07.
  const GroundSegmentation ground = segmented(grid);
  EXPECT_EQ(rule_at(grid, ground, 1, 1), GroundRule::kKernel);
  EXPECT_EQ(rule_at(grid, ground, 1, 2), GroundRule::kKernel);
}

// The same row: the raised mean of one bump must not lower the response of the other.
TEST(PaperReading, EquationTwoSeesTheUnchangedMeans) {
  GroundParams params;
  params.t_high = 10.0;  // a bump that is raised to 10 m would drown its neighbour
  const ElevationGrid grid = flat_cells({{-0.04F, -0.04F, -0.04F, -0.04F},
                                         {-0.04F, 0.04F, 0.04F, -0.04F},
                                         {-0.04F, -0.04F, -0.04F, -0.04F}});
  const GroundSegmentation ground = segmented(grid, params);
  EXPECT_EQ(rule_at(grid, ground, 1, 1), GroundRule::kKernel);
  EXPECT_EQ(rule_at(grid, ground, 1, 2), GroundRule::kKernel);
}

// The same row: the mean becomes max(mean, T_high); h_max and h_min stay.
TEST(PaperReading, EquationTwoRaisesTheMeanToTHigh) {
  const ElevationGrid grid = flat_cells(bump(-0.03F, 0.04F));
  const GroundSegmentation ground = segmented(grid);
  EXPECT_EQ(ground.h_mean[4], 0.05F);
  EXPECT_EQ(ground.h_mean[0], -0.03F);
  EXPECT_EQ(grid.h_mean[4], 0.04F);
  EXPECT_EQ(grid.h_max[4], 0.04F);
  EXPECT_EQ(grid.h_min[4], 0.04F);
}

TEST(PaperReading, EquationTwoNeverLowersAMean) {
  HeightTable table(3, std::vector<grids::Heights>(3, {0.0F, 0.0F, 0.0F}));
  table[1][1] = {0.04F, 0.08F, 0.07F};
  const GroundSegmentation ground = segmented(grid_of(table));
  EXPECT_EQ(ground.rule[4], GroundRule::kKernel);
  EXPECT_EQ(ground.h_mean[4], 0.07F);
}

/// Oracle: the two equations cell by cell with a look-up per neighbour.
GroundSegmentation segmented_naively(const ElevationGrid& grid, const GroundParams& params) {
  GroundSegmentation first;
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const float diff = grid.h_max[slot] - grid.h_min[slot];
    const bool out = diff >= static_cast<float>(params.t_diff) ||
                     grid.h_min[slot] >= static_cast<float>(params.t_high) ||
                     grid.h_min[slot] <= static_cast<float>(params.t_low);
    first.rule.push_back(out ? GroundRule::kDifference : GroundRule::kGround);
  }
  GroundSegmentation result = first;
  result.h_mean = grid.h_mean;
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const CellIndex centre = grid.geometry.index_of(grid.cell[slot]);
    int ground_neighbours = 0;
    double response = grid.h_mean[slot];
    for (int s = -1; s <= 1; ++s) {
      for (int t = -1; t <= 1; ++t) {
        if (s == 0 && t == 0) continue;
        const Slot neighbour = grid.slot_at({centre.l + s, centre.w + t});
        if (neighbour == kUnobserved || !first.is_ground(static_cast<std::size_t>(neighbour))) {
          continue;
        }
        ++ground_neighbours;
        response -= double{grid.h_mean[static_cast<std::size_t>(neighbour)]} / 8.0;
      }
    }
    if (!first.is_ground(slot) || ground_neighbours < 8 || response < params.t_diff) continue;
    result.rule[slot] = GroundRule::kKernel;
    result.h_mean[slot] = std::max(grid.h_mean[slot], static_cast<float>(params.t_high));
  }
  return result;
}

TEST(Ground, EqualsTheNaiveSegmentation) {
  RandomGenerator random(22);
  int kernel_cells = 0;
  GroundWorkspace workspace;
  GroundSegmentation fast;
  for (int k = 0; k < 100; ++k) {
    const std::size_t rows = 1 + random.below(12);
    const std::size_t columns = 1 + random.below(12);
    HeightTable table(rows, std::vector<grids::Heights>(columns));
    for (auto& row : table) {
      for (auto& cell : row) {
        const auto mean = static_cast<float>(0.096 * (random.uniform() - 0.5));
        const auto half = static_cast<float>(random.uniform() < 0.05 ? 0.04 : 0.001);
        cell = {mean - half, mean + half, random.uniform() < 0.03 ? kNone : mean};
      }
    }
    table[0][0].mean = 0.0F;
    const ElevationGrid grid = grid_of(table);
    const GroundSegmentation naive = segmented_naively(grid, {});
    segment_ground(grid, {}, workspace, fast);
    ASSERT_EQ(fast.rule.size(), naive.rule.size());
    EXPECT_EQ(fast.h_mean, naive.h_mean) << "seed 22, grid " << k;
    for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
      EXPECT_EQ(fast.is_ground(slot), naive.is_ground(slot)) << "seed 22, grid " << k;
      EXPECT_EQ(fast.rule[slot] == GroundRule::kKernel, naive.rule[slot] == GroundRule::kKernel);
      kernel_cells += fast.rule[slot] == GroundRule::kKernel ? 1 : 0;
    }
  }
  EXPECT_GT(kernel_cells, 20) << "the random grids must exercise eq. (2)";
}

TEST(Ground, TurningTheGridTurnsTheResult) {
  RandomGenerator random(23);
  MeanTable table(7, std::vector<float>(9));
  MeanTable turned(9, std::vector<float>(7));
  for (std::size_t l = 0; l < 7; ++l) {
    for (std::size_t w = 0; w < 9; ++w) {
      // Multiples of 2^-10, so that sums do not depend on their order.
      table[l][w] = static_cast<float>(static_cast<int>(random.below(90)) - 45) / 1024.0F;
      turned[8 - w][l] = table[l][w];
    }
  }
  const ElevationGrid a = flat_cells(table);
  const ElevationGrid b = flat_cells(turned);
  const GroundSegmentation ground_a = segmented(a);
  const GroundSegmentation ground_b = segmented(b);
  for (int l = 0; l < 7; ++l) {
    for (int w = 0; w < 9; ++w) {
      EXPECT_EQ(rule_at(a, ground_a, l, w), rule_at(b, ground_b, 8 - w, l));
    }
  }
}

TEST(Ground, EmptyGridGivesEmptyResult) {
  const ElevationGrid grid = flat_cells({{kNone, kNone}});
  EXPECT_TRUE(segmented(grid).rule.empty());
}

}  // namespace
}  // namespace mrpt_terrain
