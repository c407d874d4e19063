// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/decks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

/// A surface over the ground z = 0, and where it is.
using Surface = std::function<double(double x, double y)>;

constexpr double kNoSurface = -1.0;

/// Observed cells of 0.2 m, all of them, each with one layer of points: the surface, which is as
/// thick as it rises within the cell, or the ground.
struct World {
  ElevationGrid grid;
  GroundSegmentation ground;
  FieldCells cells;
  DeckWorkspace workspace;

  explicit World(const Surface& surface, double noise = 0.0) {
    GridParams params;
    params.length = params.width = 12.0;
    params.cell_size = 0.2;
    Points points;
    const GridGeometry geometry(12.0, 12.0, 0.2);
    for (int l = 0; l < geometry.cells_l(); ++l) {
      for (int w = 0; w < geometry.cells_w(); ++w) {
        const Position2 at = geometry.centre_of({l, w});
        points.push_back(static_cast<float>(at.x), static_cast<float>(at.y), 0.0F);
      }
    }
    ElevationGridWorkspace scratch;
    PointSlots slots;
    build_elevation_grid(points.view(), params, scratch, grid, slots);
    const std::size_t n = grid.observed();
    ground.rule.assign(n, GroundRule::kGround);
    cells.ground.assign(n, 0.0F);
    cells.low.assign(n, 0.0F);
    cells.high.assign(n, 0.0F);
    RandomGenerator random(7);
    for (std::size_t slot = 0; slot < n; ++slot) {
      const Position2 at = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
      const double height = surface(at.x, at.y);
      if (height < 0.12) continue;  // ground by its height
      const double shift = noise * (2.0 * random.uniform() - 1.0);
      ground.rule[slot] = GroundRule::kHigh;
      cells.low[slot] = static_cast<float>(height + shift - 0.02);
      cells.high[slot] = static_cast<float>(height + shift + 0.02);
    }
  }

  std::size_t find(const DeckParams& params = {}) {
    find_decks(grid, ground, params, workspace, cells);
    std::set<std::int32_t> numbers(cells.deck.begin(), cells.deck.end());
    numbers.erase(-1);
    return numbers.size();
  }
};

bool inside(double x, double y, double length, double width) {
  return std::abs(x) < length / 2 && std::abs(y) < width / 2;
}
Surface level(double length, double width, double height) {
  return [=](double x, double y) { return inside(x, y, length, width) ? height : kNoSurface; };
}
/// Rises along x from the ground at -length / 2.
Surface ramp(double length, double width, double slope) {
  return [=](double x, double y) {
    return inside(x, y, length, width) ? (x + length / 2) * std::tan(slope) : kNoSurface;
  };
}

TEST(Decks, ARampIsOneDeckOfAllItsCells) {
  World world(ramp(3.0, 2.0, 0.3));
  EXPECT_EQ(world.find(), 1U);
  for (std::size_t slot = 0; slot < world.grid.observed(); ++slot) {
    const bool high = world.ground.rule[slot] == GroundRule::kHigh;
    EXPECT_EQ(world.cells.deck[slot] >= 0, high);
  }
}

TEST(Decks, SlopesUpToTheLimitAreDecks) {
  DeckParams params;
  params.max_slope = 0.4;
  World below(ramp(3.0, 2.0, 0.38)), above(ramp(3.0, 2.0, 0.55));
  EXPECT_EQ(below.find(params), 1U);
  EXPECT_EQ(above.find(params), 0U);
}

TEST(Decks, ARampThatBeginsInTheAirIsNone) {
  World world([](double x, double y) {
    return inside(x, y, 3.0, 2.0) ? 0.6 + 0.2 * (x + 1.5) : kNoSurface;
  });
  EXPECT_EQ(world.find(), 0U);
}

TEST(Decks, LowAndLongIsACurbShortIsAThing) {
  World curb(level(4.0, 0.6, 0.15)), box(level(1.2, 1.2, 0.15)), high(level(4.0, 0.6, 0.4));
  EXPECT_EQ(curb.find(), 1U);
  EXPECT_EQ(box.find(), 0U);
  EXPECT_EQ(high.find(), 0U);
}

TEST(Decks, LargeIsATerrace) {
  World terrace(level(4.0, 4.0, 0.4)), table(level(4.0, 4.0, 0.8));
  EXPECT_EQ(terrace.find(), 1U);
  EXPECT_EQ(table.find(), 0U);
}

TEST(Decks, WhatIsUnevenIsNone) {
  World smooth(level(4.0, 1.0, 0.17), 0.005), rough(level(4.0, 1.0, 0.17), 0.04);
  EXPECT_EQ(smooth.find(), 1U);
  EXPECT_EQ(rough.find(), 0U);
}

TEST(Decks, ThickCellsAreNone) {
  World world(level(4.0, 1.0, 0.17));
  for (float& high : world.cells.high) high += high > 0.0F ? 0.2F : 0.0F;
  EXPECT_EQ(world.find(), 0U);
}

TEST(Decks, SidesOfACurbAreBelowItsTop) {
  World world(level(4.0, 0.6, 0.15));
  ASSERT_EQ(world.find(), 1U);
  const DeckParams params;
  for (std::size_t slot = 0; slot < world.grid.observed(); ++slot) {
    if (world.cells.deck[slot] < 0) continue;
    EXPECT_FLOAT_EQ(world.cells.deck_low[slot], 0.17F - static_cast<float>(params.side));
  }
}

TEST(Decks, NothingObservedIsNothing) {
  World world(level(4.0, 0.6, 0.15));
  world.grid = ElevationGrid{};
  world.ground = GroundSegmentation{};
  world.cells = FieldCells{};
  EXPECT_EQ(world.find(), 0U);
}

}  // namespace
}  // namespace mrpt_terrain
