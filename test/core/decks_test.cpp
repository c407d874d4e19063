// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/decks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

/// A surface over the ground z = 0, and where it is.
using Surface = std::function<double(double x, double y)>;

constexpr double kNoSurface = -1.0;
/// Where no beam comes down.
constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();
constexpr double kSensorX = -5.0, kSensorZ = 1.0;

/// Points every 5 cm, seen from (-5, 0, 1): the ground, or the surface where it is higher than
/// `ground_below`, shifted along their beams by normal noise.
struct World {
  Points points;
  FieldPoints field;
  PointSlots slots;
  ElevationGrid grid;
  GroundSegmentation ground;
  FieldCells cells;
  DeckWorkspace workspace;
  std::array<float, 3> sensor{static_cast<float>(kSensorX), 0.0F, static_cast<float>(kSensorZ)};

  explicit World(const Surface& surface, double noise = 0.0) {
    RandomGenerator random(7);
    for (int i = -120; i < 120; ++i) {
      for (int j = -120; j < 120; ++j) {
        const double x = 0.05 * i + 0.025, y = 0.05 * j + 0.025;
        const double height = surface(x, y);
        if (!std::isnan(height)) add(x, y, std::max(height, 0.0), noise * normal(random));
      }
    }
    measure();
  }

  /// An upright face of points every 2 cm, x = at, |y| < 2, from the ground to `height`.
  void add_side(double at, double height) {
    for (int i = -100; i < 100; ++i)
      for (double z = 0.01; z < height; z += 0.02) add(at, 0.02 * i, z, 0.0);
    measure();
  }

  static double normal(RandomGenerator& random) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    return sum;
  }

  void add(double x, double y, double z, double noise) {
    const double dx = x - kSensorX, dz = z - kSensorZ;
    const double shift = noise / std::sqrt(dx * dx + y * y + dz * dz);
    points.push_back(static_cast<float>(x + dx * shift), static_cast<float>(y + y * shift),
                     static_cast<float>(z + dz * shift));
  }

  void measure() {
    constexpr float kGroundBelow = 0.1F;
    GridParams params;
    params.length = params.width = 12.0;
    params.cell_size = 0.2;
    ElevationGridWorkspace scratch;
    build_elevation_grid(points.view(), params, scratch, grid, slots);
    const std::size_t n = grid.observed();
    ground.rule.assign(n, GroundRule::kGround);
    cells.ground.assign(n, 0.0F);
    cells.low.assign(n, 1e9F);
    cells.high.assign(n, 0.0F);
    field.height.assign(points.view().z, points.view().z + points.size());
    field.support.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool above = field.height[i] > kGroundBelow;
      field.support[i] = above ? Support::kAbove : Support::kGround;
      if (!above || slots[i] < 0) continue;
      const auto slot = static_cast<std::size_t>(slots[i]);
      ground.rule[slot] = GroundRule::kHigh;
      cells.low[slot] = std::min(cells.low[slot], field.height[i]);
      cells.high[slot] = std::max(cells.high[slot], field.height[i]);
    }
  }

  std::size_t find(const DeckParams& params = {}) {
    find_decks({points.view(), BeamOrigins{&sensor, nullptr}}, field, slots, grid, ground, params,
               workspace, cells);
    std::set<std::int32_t> numbers(cells.deck.begin(), cells.deck.end());
    numbers.erase(-1);
    return numbers.size();
  }

  std::vector<Support> labels(const DeckParams& params = {}) {
    std::vector<Support> support = field.support;
    label_deck_points(points.view(), field, slots, grid, cells, params, workspace, support);
    return support;
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

TEST(Decks, PlanesOfARampAreItsSurface) {
  World world(ramp(3.0, 2.0, 0.3));
  ASSERT_EQ(world.find(), 1U);
  int seen = 0;
  for (std::size_t slot = 0; slot < world.grid.observed(); ++slot) {
    if (world.cells.deck[slot] < 0) continue;
    const DeckPlane& plane = world.cells.deck_plane[slot];
    // At the edge the sloping surface and its upright end are in one cell.
    if (plane.x > 1.3F) continue;
    EXPECT_NEAR(plane.at(plane.x + 0.1F, plane.y), (plane.x + 1.6F) * std::tan(0.3), 0.006);
    ++seen;
  }
  EXPECT_GT(seen, 50);
}

TEST(Decks, ARidgeWithAPlatformIsOneDeck) {
  World world([](double x, double y) {
    if (!inside(x, y, 4.0, 2.0)) return kNoSurface;
    return std::min(0.4, (2.0 - std::abs(x)) * std::tan(0.3));
  });
  EXPECT_EQ(world.find(), 1U);
}

TEST(Decks, SlopesUpToTheLimitAreDecks) {
  DeckParams params;
  params.max_slope = 0.4;
  World below(ramp(3.0, 2.0, 0.38)), above(ramp(3.0, 2.0, 0.7));
  EXPECT_EQ(below.find(params), 1U);
  EXPECT_EQ(above.find(params), 0U);
}

TEST(Decks, WhatHardlyRisesIsNoRamp) {
  const auto slab = [](double slope) {
    return [=](double x, double y) {
      return inside(x, y, 4.6, 2.0) ? 0.2 + slope * (x + 2.3) : kNoSurface;
    };
  };
  World ramp(slab(0.06)), box(slab(0.03));
  EXPECT_EQ(ramp.find(), 1U);
  EXPECT_EQ(box.find(), 0U);
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

TEST(Decks, ABoxBesideACurbBehindGroundIsNoPartOfIt) {
  const auto curb_and_box = [](double ground_between) {
    return [=](double x, double y) {
      if (inside(x, y, 4.0, 0.8)) return 0.15;
      if (inside(x, y - 0.9, 0.6, 0.6)) return 0.17;
      return inside(x, y - 0.5, 0.6, 0.2) ? ground_between : kNoSurface;
    };
  };
  const auto box_is_deck = [](World& world) {
    EXPECT_EQ(world.find(), 1U);
    CellIndex cell;
    EXPECT_TRUE(world.grid.geometry.cell_at(0.1, 0.9, cell));
    return world.cells.deck[static_cast<std::size_t>(world.grid.slot_at(cell))] >= 0;
  };
  World seen(curb_and_box(0.0)), unseen(curb_and_box(kUnseen));
  EXPECT_FALSE(box_is_deck(seen));
  EXPECT_TRUE(box_is_deck(unseen));
}

// What sparse rings leave of stairs is even around every cell, but nowhere over a metre.
TEST(Decks, SlopesThatBendEverywhereAreNoRamps) {
  const auto bent = [](double curvature) {
    return [=](double x, double y) {
      return inside(x, y, 2.4, 2.0) ? 0.02 + 0.1 * (x + 1.2) + curvature / 2.0 * x * x : kNoSurface;
    };
  };
  World even(bent(0.05)), uneven(bent(0.6));
  // From above, range noise would scatter the points as much.
  even.sensor = uneven.sensor = {0.0F, 0.0F, 5.0F};
  EXPECT_EQ(even.find(), 1U);
  EXPECT_EQ(uneven.find(), 0U);
}

TEST(Decks, LargeIsATerrace) {
  World terrace(level(4.0, 4.0, 0.4)), table(level(4.0, 4.0, 0.8));
  EXPECT_EQ(terrace.find(), 1U);
  EXPECT_EQ(table.find(), 0U);
}

TEST(Decks, RangeNoiseIsNoUnevennessWhereBeamsGraze) {
  World ordinary(level(4.0, 1.0, 0.17), 0.02), grass(level(4.0, 1.0, 0.17), 0.1);
  EXPECT_EQ(ordinary.find(), 1U);
  EXPECT_EQ(grass.find(), 0U);
}

// One ring runs along the deck: on a surface its points are a line, in grass they lie in the cone
// of its beams, which would pass for an inclined surface.
TEST(Decks, OneRingTellsASurfaceFromGrass) {
  const auto deck_of = [](double noise) {
    return World(
        [](double x, double y) {
          if (!inside(x, y, 1.2, 4.0)) return kNoSurface;
          return std::abs(x) < 0.05 ? 0.17 : kUnseen;
        },
        noise);
  };
  World surface = deck_of(0.01), grass = deck_of(0.1);
  EXPECT_EQ(surface.find(), 1U);
  EXPECT_EQ(grass.find(), 0U);
}

TEST(Decks, WhatBeamsEnterHereAndThereIsNone) {
  World firm(level(4.0, 4.0, 0.4)), grass = firm, hollow = firm;
  const std::size_t n = firm.points.size();
  const auto sink = [](World& world, std::size_t i) {
    const PointsView& view = world.points.view();
    world.add(view.x[i], view.y[i], view.z[i] - 0.1, 0.0);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (firm.field.support[i] != Support::kAbove) continue;
    const PointsView& view = firm.points.view();
    if (i % 29 == 0) sink(grass, i);
    // As many deep points, but together: a manhole.
    if (std::abs(view.x[i]) < 0.4F && std::abs(view.y[i]) < 0.4F) sink(hollow, i);
  }
  grass.measure();
  hollow.measure();
  EXPECT_EQ(firm.find(), 1U);
  EXPECT_EQ(grass.find(), 0U);
  EXPECT_EQ(hollow.find(), 1U);
}

TEST(Decks, RubbleIsNone) {
  World world([](double x, double y) {
    const double bump = 0.03 * std::sin(31.0 * x) * std::sin(29.0 * y);
    return inside(x, y, 4.0, 1.0) ? 0.17 + bump : kNoSurface;
  });
  EXPECT_EQ(world.find(), 0U);
}

TEST(Decks, TallCellsAreNone) {
  World world(level(4.0, 1.0, 0.17));
  const std::size_t n = world.points.size();
  for (std::size_t i = 0; i < n; i += 3) {
    if (world.field.support[i] == Support::kAbove)
      world.add(world.points.view().x[i], world.points.view().y[i], 0.5, 0.0);
  }
  world.measure();
  EXPECT_EQ(world.find(), 0U);
}

TEST(Decks, TheSideOfACurbIsAboveAndItsTopIsGround) {
  World world(level(1.0, 6.0, 0.2), 0.005);
  const std::size_t tops = world.points.size();
  world.add_side(-0.5, 0.2);
  ASSERT_EQ(world.find(), 1U);
  const std::vector<Support> support = world.labels();
  int sides = 0, above = 0, top = 0, ground = 0;
  for (std::size_t i = 0; i < support.size(); ++i) {
    const PointsView view = world.points.view();
    if (i >= tops && view.z[i] > 0.1F) {
      ++sides;
      above += support[i] == Support::kAbove ? 1 : 0;
    }
    // Beyond 4 cm from the side, which no scan tells from it.
    if (i < tops && view.z[i] > 0.1F && view.x[i] > -0.46F) {
      ++top;
      ground += support[i] == Support::kGround ? 1 : 0;
    }
  }
  EXPECT_GT(above, 0.97 * sides);
  EXPECT_GT(ground, 0.99 * top);
  EXPECT_GT(sides, 500);
  EXPECT_GT(top, 1000);
}

// A ring may meet no more of a side than its upper edge, which is as high as the surface.
TEST(Decks, TheUpperEdgeOfASideIsAboveWhereverTheSideGoesOn) {
  World world(level(1.0, 6.0, 0.2));
  for (double y = -0.5; y < 0.5; y += 0.05) world.add(-0.5, y, 0.12, 0.0);
  const std::size_t edge = world.points.size();
  for (double y = -1.5; y < 1.5; y += 0.05) world.add(-0.5, y, 0.19, 0.0);
  world.measure();
  ASSERT_EQ(world.find(), 1U);
  const std::vector<Support> support = world.labels();
  EXPECT_EQ(std::count(support.begin() + static_cast<std::ptrdiff_t>(edge), support.end(),
                       Support::kAbove),
            static_cast<std::ptrdiff_t>(support.size() - edge));
  // The first row of the top is 2.5 cm behind.
  std::size_t top = 0, ground = 0;
  for (std::size_t i = 0; i < edge; ++i) {
    const PointsView view = world.points.view();
    if (view.z[i] < 0.15F || view.x[i] < -0.46F) continue;
    ++top;
    ground += support[i] == Support::kGround ? 1U : 0U;
  }
  EXPECT_EQ(ground, top);
  EXPECT_GT(top, 1000U);
}

// Below the threshold of labels by height, as rough ground may be.
TEST(Decks, ALowPointOnTheLineOfASideIsAbove) {
  World world(level(1.0, 6.0, 0.2));
  for (double y = -0.5; y < 0.5; y += 0.05) world.add(-0.5, y, 0.12, 0.0);
  const std::size_t on_line = world.points.size();
  world.add(-0.5, 0.31, 0.08, 0.0);
  world.add(-0.5, 0.31, 0.05, 0.0);
  world.measure();
  ASSERT_EQ(world.find(), 1U);
  const std::vector<Support> support = world.labels();
  EXPECT_EQ(support[on_line], Support::kAbove);
  EXPECT_EQ(support[on_line + 1], Support::kGround);
}

TEST(Decks, WhatStandsOnADeckIsNoGround) {
  World world(level(4.0, 4.0, 0.4));
  const std::size_t tops = world.points.size();
  for (double z = 0.45; z < 0.5; z += 0.01) world.add(0.31, 0.31, z, 0.0);
  world.measure();
  ASSERT_EQ(world.find(), 1U);
  const std::vector<Support> support = world.labels();
  for (std::size_t i = tops; i < support.size(); ++i) EXPECT_EQ(support[i], Support::kAbove);
}

TEST(Decks, NothingObservedIsNothing) {
  World world(level(4.0, 0.6, 0.15));
  world.points.clear();
  world.measure();
  EXPECT_EQ(world.find(), 0U);
}

}  // namespace
}  // namespace mrpt_terrain
