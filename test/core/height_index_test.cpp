// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/height_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "grids.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using grids::all_slots;
using grids::grid_of;
using grids::range_of;

HeightIndex index_of(const std::vector<grids::Heights>& cells) {
  const ElevationGrid grid = grid_of({cells});
  GroundSegmentation ground;
  ground.h_mean = grid.h_mean;
  const std::vector<std::int32_t> slots = all_slots(grid);
  return height_index(grid, ground, range_of(slots));
}

// Literal: H_d = 0.75 - 0.25, H_m = 0.5, so the two are equal; then each decides once.
TEST(HeightIndex, AboveTheGroundByHand) {
  const HeightIndex even = index_of({{0.25F, 0.5F, 0.375F}, {0.5F, 0.75F, 0.625F}});
  EXPECT_EQ(even.h_d, 0.5);
  EXPECT_EQ(even.h_m, 0.5);
  EXPECT_EQ(even.h_f, 0.5);
  // A table seen from above: little difference, great height.
  EXPECT_EQ(index_of({{0.75F, 0.875F, 0.8125F}}).h_f, 0.8125);
  // A box with its sides.
  EXPECT_EQ(index_of({{0.0F, 0.5F, 0.25F}}).h_f, 0.5);
}

TEST(HeightIndex, BelowTheGroundByHand) {
  const HeightIndex walls = index_of({{-0.5F, 0.0F, -0.25F}});
  EXPECT_EQ(walls.h_d, 0.5);
  EXPECT_EQ(walls.h_m, -0.25);
  EXPECT_EQ(walls.h_f, -0.5);
  // Only the floor is seen.
  EXPECT_EQ(index_of({{-0.5F, -0.375F, -0.4375F}}).h_f, -0.4375);
}

// Row "H_m = 0": counts as >= 0.
TEST(PaperReading, MeanHeightOfZeroCountsAsPositive) {
  const HeightIndex index = index_of({{-0.25F, 0.5F, -0.125F}, {0.0F, 0.25F, 0.125F}});
  EXPECT_EQ(index.h_m, 0.0);
  EXPECT_EQ(index.h_f, 0.75);
}

TEST(HeightIndex, MeanIsOverCellsNotPoints) {
  ElevationGrid grid = grid_of({{{0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}}});
  for (int k = 0; k < 99; ++k) grid.sums[0].add(0.0, 0.0, 0.0);
  GroundSegmentation ground;
  ground.h_mean = grid.h_mean;
  const std::vector<std::int32_t> slots = all_slots(grid);
  EXPECT_EQ(height_index(grid, ground, range_of(slots)).h_m, 0.5);
}

// Row "eq. (2) order": H_m uses the raised mean, H_d the heights as they were measured.
TEST(PaperReading, HeightIndexUsesTheRaisedMeans) {
  const ElevationGrid grid = grid_of({{{0.0F, 0.03125F, 0.015625F}}});
  GroundSegmentation ground;
  ground.h_mean = {0.0625F};
  const std::vector<std::int32_t> slots = all_slots(grid);
  const HeightIndex index = height_index(grid, ground, range_of(slots));
  EXPECT_EQ(index.h_d, 0.03125);
  EXPECT_EQ(index.h_m, 0.0625);
  EXPECT_EQ(index.h_f, 0.0625);
}

TEST(HeightIndex, OnlyTheGivenCellsCount) {
  const ElevationGrid grid =
      grid_of({{{-9.0F, 9.0F, 0.0F}, {0.25F, 0.5F, 0.375F}, {-9.0F, 9.0F, 0.0F}}});
  GroundSegmentation ground;
  ground.h_mean = grid.h_mean;
  const std::vector<std::int32_t> slots = {1};
  EXPECT_EQ(height_index(grid, ground, range_of(slots)).h_f, 0.375);
}

// Oracle: sorted heights. Invariant: negating all heights negates H_f, except where H_m = 0.
TEST(HeightIndex, EqualsSortedHeightsAndIsOddInTheHeights) {
  RandomGenerator random(41);
  for (int k = 0; k < 200; ++k) {
    std::vector<grids::Heights> cells(1 + random.below(30));
    std::vector<float> extremes;
    double mean = 0.0;
    const double offset = random.uniform() - 0.5;
    for (auto& cell : cells) {
      const auto centre = static_cast<float>(offset + 0.4 * (random.uniform() - 0.5));
      const auto half = static_cast<float>(0.1 * random.uniform());
      cell = {centre - half, centre + half, centre};
      extremes.insert(extremes.end(), {cell.min, cell.max});
      mean += double{centre} / static_cast<double>(cells.size());
    }
    std::sort(extremes.begin(), extremes.end());
    const HeightIndex index = index_of(cells);
    const double difference = double{extremes.back()} - double{extremes.front()};
    EXPECT_EQ(index.h_d, difference);
    // 30 additions of numbers below 1.
    EXPECT_NEAR(index.h_m, mean, 1e-14);
    EXPECT_NEAR(index.h_f, mean >= 0 ? std::max(difference, mean) : std::min(-difference, mean),
                1e-14);
    for (auto& cell : cells) cell = {-cell.max, -cell.min, -cell.mean};
    EXPECT_EQ(index_of(cells).h_f, -index.h_f) << "seed 41, cluster " << k;
  }
}

}  // namespace
}  // namespace mrpt_terrain
