// SPDX-License-Identifier: BSD-3-Clause
#include "deck_sides.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "allocation_counter.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr float kReach = 0.025F;

/// Points of sides, and what is found in them.
struct Sides {
  std::vector<DeckSidePoint> points;
  DeckSideBuckets buckets;
  std::vector<DeckSide> found;
  RandomGenerator random{3};
  std::int32_t next = 0;  ///< number of a point

  /// `count` points evenly from (x0, y0) to (x1, y1), up to `off` metres to both sides.
  void add(std::int32_t deck, double x0, double y0, double x1, double y1, int count,
           double off = 0.0) {
    const double length = std::hypot(x1 - x0, y1 - y0);
    for (int k = 0; k < count; ++k) {
      const double t = (k + 0.5) / count, e = off * (2.0 * random.uniform() - 1.0);
      points.push_back({deck, next++,
                        static_cast<float>(x0 + t * (x1 - x0) - e * (y1 - y0) / length),
                        static_cast<float>(y0 + t * (y1 - y0) + e * (x1 - x0) / length), 0.0F});
    }
  }
  void find() { find_deck_sides(kReach, points, buckets, found); }
  [[nodiscard]] bool on(std::int32_t deck, double x, double y) const {
    return is_on_side(found, deck, static_cast<float>(x), static_cast<float>(y), kReach);
  }
};

TEST(DeckSides, TheLineOfASideIsFound) {
  Sides sides;
  sides.add(0, -1.0, 0.7, 1.0, 1.3, 60, 0.02);
  sides.find();
  ASSERT_EQ(sides.found.size(), 1U);
  const DeckSide& side = sides.found[0];
  EXPECT_NEAR(std::atan2(side.along_y, side.along_x) * (side.along_x < 0.0F ? -1.0 : 1.0),
              std::atan2(0.6, 2.0), 0.01);
  EXPECT_NEAR(side.across(0.0F, 1.0F), 0.0F, 0.005F);
  EXPECT_TRUE(sides.on(0, 0.5, 1.15));
  EXPECT_FALSE(sides.on(0, 0.5, 1.20));
  EXPECT_FALSE(sides.on(0, 0.5, 1.10));
}

TEST(DeckSides, ASideGoesOnAsFarAsItsLineIsKnown) {
  Sides well, badly;
  well.add(0, 0.0, 0.0, 2.0, 0.0, 100, 0.01);
  badly.add(0, 0.0, 0.0, 0.5, 0.0, 8, 0.02);
  well.find();
  badly.find();
  ASSERT_EQ(well.found.size(), 1U);
  ASSERT_EQ(badly.found.size(), 1U);
  EXPECT_TRUE(well.on(0, 4.9, 0.0));
  EXPECT_FALSE(well.on(0, 5.1, 0.0));
  EXPECT_LT(badly.found[0].half_length, 0.25F + 0.4F);
}

TEST(DeckSides, OneBehindAGapIsAnother) {
  Sides sides;
  sides.add(0, 0.0, 0.0, 1.0, 0.0, 20);
  sides.add(0, 9.0, 0.0, 10.0, 0.0, 20);
  sides.find();
  ASSERT_EQ(sides.found.size(), 2U);
  EXPECT_TRUE(sides.on(0, 0.5, 0.0));
  EXPECT_TRUE(sides.on(0, 9.5, 0.0));
  EXPECT_FALSE(sides.on(0, 5.0, 0.0));
}

TEST(DeckSides, ACornerHasTwo) {
  Sides sides;
  sides.add(0, 0.0, 0.0, 1.5, 0.0, 40, 0.01);
  sides.add(0, 0.0, 0.0, 0.0, 1.5, 40, 0.01);
  sides.find();
  EXPECT_EQ(sides.found.size(), 2U);
  EXPECT_TRUE(sides.on(0, 1.0, 0.0));
  EXPECT_TRUE(sides.on(0, 0.0, 1.0));
  EXPECT_FALSE(sides.on(0, 0.3, 0.3));
}

TEST(DeckSides, EachDeckHasItsOwn) {
  Sides sides;
  sides.add(7, 0.0, 3.0, 1.0, 3.0, 20);
  sides.add(2, 0.0, 0.0, 1.0, 0.0, 20);
  sides.add(5, 0.0, 5.0, 0.1, 5.0, 20);  // too short
  sides.find();
  ASSERT_EQ(sides.found.size(), 2U);
  EXPECT_TRUE(sides.on(2, 0.5, 0.0));
  EXPECT_TRUE(sides.on(7, 0.5, 3.0));
  EXPECT_FALSE(sides.on(7, 0.5, 0.0));
  EXPECT_FALSE(sides.on(5, 0.05, 5.0));
}

TEST(DeckSides, ScatteredPointsAreNone) {
  Sides sides;
  for (int k = 0; k < 300; ++k) {
    const double x = sides.random.uniform(), y = sides.random.uniform();
    sides.points.push_back({0, k, static_cast<float>(x), static_cast<float>(y)});
  }
  sides.find();
  EXPECT_TRUE(sides.found.empty());
}

// Dense points say no more than some of them; neither do they take the place of other decks'
// points.
TEST(DeckSides, ManyPointsAreThinnedOut) {
  Sides sides;
  sides.add(0, 0.0, 0.0, 4.0, 0.0, 20000, 0.01);
  sides.add(0, 0.0, 0.0, 0.0, 2.0, 10000, 0.01);
  sides.add(1, 0.0, 5.0, 1.0, 5.0, 20, 0.01);
  sides.find();
  EXPECT_EQ(sides.found.size(), 3U);
  EXPECT_TRUE(sides.on(0, 3.9, 0.0));
  EXPECT_TRUE(sides.on(0, 0.0, 1.9));
  EXPECT_TRUE(sides.on(1, 0.5, 5.0));
}

// Random points and every n-th are taken of points in the order of the scan, whatever order they
// come in.
TEST(DeckSides, TheOrderOfThePointsDoesNotMatter) {
  Sides scan;
  for (const std::int32_t deck : {1, 0, 1}) scan.add(deck, -1.0, 0.7, 1.0, 1.3 + deck, 900, 0.03);
  Sides shuffled = scan;
  for (std::size_t k = shuffled.points.size() - 1; k > 0; --k)
    std::swap(shuffled.points[k],
              shuffled.points[shuffled.random.below(static_cast<std::uint32_t>(k + 1))]);
  scan.find();
  shuffled.find();
  ASSERT_GE(scan.found.size(), 2U);
  ASSERT_EQ(shuffled.found.size(), scan.found.size());
  for (std::size_t k = 0; k < scan.found.size(); ++k) {
    EXPECT_EQ(shuffled.found[k].deck, scan.found[k].deck);
    EXPECT_EQ(shuffled.found[k].x, scan.found[k].x);
    EXPECT_EQ(shuffled.found[k].along_y, scan.found[k].along_y);
    EXPECT_EQ(shuffled.found[k].half_length, scan.found[k].half_length);
  }
}

TEST(DeckSides, UsedMemoryIsEnough) {
  Sides sides;
  std::size_t allocated = 0;
  for (int run = 0; run < 2; ++run) {
    sides.points.clear();
    sides.add(3, 0.0, 0.0, 1.5, 0.0, 40, 0.01);
    sides.add(1, 0.0, 1.0, 0.0, 2.5, 40, 0.01);
    const std::size_t before = bench::allocations();
    sides.find();
    allocated = bench::allocations() - before;
    ASSERT_EQ(sides.found.size(), 2U) << run;
  }
  EXPECT_EQ(allocated, 0U);
}

TEST(DeckSides, FewPointsAreNone) {
  Sides sides;
  sides.add(0, 0.0, 0.0, 1.0, 0.0, 4);
  sides.find();
  EXPECT_TRUE(sides.found.empty());
  sides.points.clear();
  sides.find();
  EXPECT_TRUE(sides.found.empty());
}

/// Rings on the surfaces of decks, seen from 1 m above the origin, and what is found in them.
/// Ranges scatter by up to 2 cm.
struct Rings {
  std::vector<DeckSidePoint> points;
  DeckSideBuckets buckets;
  std::vector<DeckSide> found;
  RandomGenerator random{5};

  /// A ring whose beams fall by `fall` per metre, every 0.2 deg up to `aside` radians to both
  /// sides; `distance_of` gives the horizontal distance of what it meets at an azimuth.
  template <class DistanceOf>
  void add(std::int32_t deck, double fall, double aside, DistanceOf&& distance_of) {
    for (double azimuth = -aside; azimuth <= aside; azimuth += 0.0035) {
      const double distance = distance_of(azimuth) + 0.02 * (2.0 * random.uniform() - 1.0);
      points.push_back({deck, static_cast<std::int32_t>(points.size()),
                        static_cast<float>(distance * std::cos(azimuth)),
                        static_cast<float>(distance * std::sin(azimuth)),
                        static_cast<float>(1.0 - fall * distance)});
    }
  }
  void find() { find_side_rings(kReach, points, buckets, found); }
};

/// Distance of an upright face 6 m ahead.
double face_at(double azimuth) { return 6.0 / std::cos(azimuth); }

// At its nearest, the ring meets the face 0.145 m up; 2.2 m to both sides, 0.09 m.
TEST(SideRings, ARingAlongAnUprightFaceIsASide) {
  Rings rings;
  rings.add(0, 0.1425, 0.35, face_at);
  rings.find();
  ASSERT_EQ(rings.found.size(), 1U);
  EXPECT_NEAR(rings.found[0].half_length, 6.0 * std::tan(0.35), 0.05);
  EXPECT_TRUE(is_on_side(rings.found, 0, 6.0F, 2.0F, kReach));
  EXPECT_FALSE(is_on_side(rings.found, 0, 6.05F, 2.0F, kReach));
}

TEST(SideRings, ARingOnALevelTopIsNone) {
  Rings rings;
  rings.add(0, 0.1425, 0.35, [](double) { return 6.0; });
  rings.find();
  EXPECT_TRUE(rings.found.empty());
}

// Straight and falling to both ends as well, but there is one behind the other: a ridge.
TEST(SideRings, RingsBehindEachOtherAreNone) {
  Rings rings;
  for (const double behind : {0.0, 0.2, 0.4})
    rings.add(0, 0.855 / (6.0 + behind), 0.35,
              [behind](double azimuth) { return (6.0 + behind) / std::cos(azimuth); });
  rings.find();
  EXPECT_TRUE(rings.found.empty());
}

// Those that were found before stay, and all are sorted by deck.
TEST(SideRings, AreAddedToTheSidesThatAreKnown) {
  Rings rings;
  rings.found = {{0, 1.0F, 0.0F}, {2, 2.0F, 0.0F}};
  rings.add(1, 0.1425, 0.35, face_at);
  rings.find();
  ASSERT_EQ(rings.found.size(), 3U);
  for (std::int32_t deck = 0; deck < 3; ++deck)
    EXPECT_EQ(rings.found[static_cast<std::size_t>(deck)].deck, deck);
}

}  // namespace
}  // namespace mrpt_terrain
