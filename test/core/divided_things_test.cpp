// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "cell_scene.h"
#include "field_worlds.h"
#include "lidar.h"
#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {
namespace {

using worlds::LidarScan;
using worlds::Rect;

/// Two posts of 0.2 m, seen by 32 beams, numbered 0 and 1, on level ground.
struct TwoPosts {
  worlds::Scene scene;
  /// \param x, y of the first post's corner; the second stands `dx`, `dy` farther
  TwoPosts(double x, double y, double dx, double dy) {
    for (const int post : {0, 1}) {
      const Rect foot{x + post * dx, x + post * dx + 0.2, y + post * dy, y + post * dy + 0.2};
      scene.solids.push_back(worlds::box_solid(foot, 0.0, 1.2, post));
    }
  }
  [[nodiscard]] LidarScan seen() const {
    const worlds::LidarModel model = worlds::thirty_two_beams(0.01);
    RandomGenerator random(7);
    return worlds::scan(scene, model, random);
  }
};

/// Number of the thing that most points of each of two objects are of.
std::array<std::int32_t, 2> things_of(const LidarScan& scan, bool origin_known = true) {
  const std::array<float, 3> sensor{0.0F, 0.0F, 0.81F};
  BeamOrigins origins;
  if (origin_known) origins.origins = &sensor;
  DescriptionWorkspace workspace;
  Description description;
  describe({scan.points.view(), origins}, worlds::field_params(), workspace, description);
  std::array<std::map<std::int32_t, int>, 2> counts;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.object[i] < 0 || scan.object[i] > 1) continue;
    ++counts[static_cast<std::size_t>(scan.object[i])][description.labels.cluster[i]];
  }
  std::array<std::int32_t, 2> result{kNoCluster, kNoCluster};
  for (const std::size_t object : {0U, 1U}) {
    int most = 0;
    for (const auto& [thing, points] : counts[object]) {
      if (points <= most) continue;
      most = points;
      result[object] = thing;
    }
  }
  return result;
}
bool are_two(const std::array<std::int32_t, 2>& things) {
  return things[0] != kNoCluster && things[1] != kNoCluster && things[0] != things[1];
}
bool are_one(const std::array<std::int32_t, 2>& things) {
  return things[0] != kNoCluster && things[0] == things[1];
}

// Their cells touch, with a gap of 0.2 m between the posts: 2.3 deg, and ground behind it.
TEST(DividedThings, ABeamThatPassesBetweenTwoPostsDividesThem) {
  const LidarScan scan = TwoPosts(5.0, -0.3, 0.0, 0.4).seen();
  EXPECT_TRUE(are_two(things_of(scan)));
  EXPECT_TRUE(are_one(things_of(scan, false))) << "nobody knows where beams begin";
}

// A gap of 0.1 m is as wide as several columns 3 m away, and as two of a coarse sensor at 8 m.
TEST(DividedThings, NarrowGapsFarAwayAreNone) {
  EXPECT_TRUE(are_two(things_of(TwoPosts(3.0, -0.3, 0.0, 0.3).seen())));
  EXPECT_TRUE(are_one(things_of(TwoPosts(8.0, -0.3, 0.0, 0.3).seen())));
}

// The same posts as above, but with nothing seen behind them: no beam is known to have passed.
TEST(DividedThings, AGapThatNoBeamHasPassedDividesNothing) {
  const LidarScan scan = TwoPosts(5.0, -0.3, 0.0, 0.4).seen();
  LidarScan front;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.object[i] < 0 && scan.points.x[i] > 5.0F) continue;
    front.points.push_back(scan.points.x[i], scan.points.y[i], scan.points.z[i]);
    front.object.push_back(scan.object[i]);
  }
  EXPECT_TRUE(are_one(things_of(front)));
}

// The second post stands behind the first: seen from the sensor there is no gap.
TEST(DividedThings, WhatStandsBehindIsNotDividedByBeams) {
  EXPECT_TRUE(are_one(things_of(TwoPosts(5.0, -0.2, 0.3, 0.05).seen())));
}

/// A lawn of 4 m x 4 m, by default 0.2 m high everywhere; else a third of it is higher.
worlds::CellScene lawn(float higher = 0.2F) {
  worlds::CellScene scene;
  scene.thing({4.0, 8.0, -2.0, 2.0}, 0.05F, 0.2F);
  scene.thing({4.0, 8.0, 0.8, 2.0}, 0.05F, higher);
  return scene;
}
const Rect kMiddle{5.8, 6.4, -0.2, 0.4};
const std::vector<Position2> kLawnAndMiddle{{4.5, -1.5}, {6.1, 0.1}};

TEST(DividedThings, ABoxStandsOutOfTheLawnAroundIt) {
  for (const float higher : {0.2F, 0.3F}) {
    worlds::CellScene box = lawn(higher);
    box.thing(kMiddle, 0.05F, 0.6F);
    EXPECT_TRUE(worlds::all_apart(box.things_at(kLawnAndMiddle))) << higher;
  }
  worlds::CellScene flat = lawn(0.3F);
  flat.thing(kMiddle, 0.5F, 0.6F);
  EXPECT_TRUE(worlds::all_one(flat.things_at(kLawnAndMiddle))) << "nothing upright is seen";
}

TEST(DividedThings, ALowBoxStandsOutOfALawnThatIsEven) {
  worlds::CellScene box = lawn(), top = lawn();
  box.thing(kMiddle, 0.05F, 0.35F);
  EXPECT_TRUE(worlds::all_apart(box.things_at(kLawnAndMiddle)));
  top.thing(kMiddle, 0.3F, 0.35F);
  EXPECT_TRUE(worlds::all_apart(top.things_at(kLawnAndMiddle))) << "its top alone is seen";
  worlds::CellScene uneven = lawn(0.3F), grass = lawn();
  uneven.thing(kMiddle, 0.05F, 0.35F);
  EXPECT_TRUE(worlds::all_one(uneven.things_at(kLawnAndMiddle))) << "the grass is as uneven";
  grass.thing(kMiddle, 0.05F, 0.28F);
  EXPECT_TRUE(worlds::all_one(grass.things_at(kLawnAndMiddle))) << "grass varies by as much";
}

// A mound rises by 0.08 m per cell.
TEST(DividedThings, AMoundInALawnStaysOne) {
  worlds::CellScene mound = lawn();
  for (int k = 1; k < 5; ++k) {
    const double half = 1.1 - 0.2 * k;
    const float top = 0.2F + 0.08F * static_cast<float>(k);
    mound.thing({6.1 - half, 6.1 + half, 0.1 - half, 0.1 + half}, 0.05F, top);
  }
  EXPECT_TRUE(worlds::all_one(mound.things_at(kLawnAndMiddle)));
}

// It rises by 0.1 m per cell from 0.1 to 0.8 m, and its sides are seen.
TEST(DividedThings, WhatRisesGraduallyStaysOne) {
  worlds::CellScene ramp;
  for (int k = 0; k < 8; ++k) {
    const double x = 4.0 + 0.2 * k;
    ramp.thing({x, x + 0.2, -1.0, 1.0}, 0.05F, 0.1F * static_cast<float>(k + 1));
  }
  EXPECT_TRUE(worlds::all_one(ramp.things_at({{4.1, 0.1}, {5.5, 0.1}})));
}

// Six steps of 0.21 m.
TEST(DividedThings, StairsStayOne) {
  worlds::CellScene stairs;
  for (int k = 0; k < 6; ++k) {
    const double x = 4.0 + 0.2 * k;
    const float top = 0.21F * static_cast<float>(k + 1);
    stairs.thing({x, x + 0.2, -1.0, 1.0}, std::max(0.05F, top - 0.25F), top);
  }
  EXPECT_TRUE(worlds::all_one(stairs.things_at({{4.1, 0.1}, {5.1, 0.1}})));
}

/// Kerbs 0.12 m high with the ground around.
worlds::CellScene kerbs(const std::vector<worlds::Rect>& all, bool sharp = true) {
  worlds::CellScene scene;
  scene.ground({3.0, 9.9, -3.0, 9.9});
  for (const worlds::Rect& kerb : all) {
    scene.thing(kerb, 0.08F, 0.12F);
    if (sharp) scene.sharp(kerb);
  }
  return scene;
}

TEST(DividedThings, KerbsThatMeetAreTwo) {
  const std::vector<worlds::Rect> meeting{{4.0, 8.0, -0.2, 0.2}, {5.8, 6.2, 0.2, 3.0}};
  const std::vector<Position2> places{{4.3, 0.1}, {6.1, 2.5}};
  EXPECT_TRUE(worlds::all_apart(kerbs(meeting).things_at(places)));
  EXPECT_TRUE(worlds::all_one(kerbs(meeting, false).things_at(places))) << "no edge is sharp";
}

// Two pieces that are too short for strips touch the first kerb, with a quarter of all cells.
TEST(DividedThings, KerbsMayHaveShortPieces) {
  const std::vector<worlds::Rect> all{
      {4.0, 8.0, -0.2, 0.2}, {5.8, 6.2, 0.2, 3.0}, {4.2, 4.6, -1.4, -0.2}, {7.4, 7.8, -1.4, -0.2}};
  EXPECT_TRUE(worlds::all_apart(kerbs(all).things_at({{4.3, 0.1}, {6.1, 2.5}})));
}

// Its cells are more than a strip is wide.
TEST(DividedThings, AWideKerbIsOneStrip) {
  const auto things = [](double width) {
    return kerbs({{4.0, 8.0, -width, 0.0}, {5.8, 6.2, 0.0, 3.0}})
        .things_at({{4.3, -0.1}, {4.3, 0.1 - width}, {6.1, 2.5}});
  };
  const std::vector<std::int32_t> kerb = things(0.8);
  EXPECT_EQ(kerb[0], kerb[1]);
  EXPECT_NE(kerb[0], kerb[2]);
  EXPECT_TRUE(worlds::all_one(things(1.6))) << "an area";
}

// They touch where they begin.
TEST(DividedThings, KerbsAtASmallAngleAreTwo) {
  const std::vector<worlds::Rect> meeting{{4.0, 9.0, 0.0, 0.2},
                                          {4.0, 5.0, 0.2, 0.4},
                                          {5.0, 6.0, 0.4, 0.6},
                                          {6.0, 7.0, 0.6, 0.8},
                                          {7.0, 9.0, 0.8, 1.2}};
  EXPECT_TRUE(worlds::all_apart(kerbs(meeting).things_at({{8.5, 0.1}, {8.5, 1.1}})));
}

// So far away, cells with two others between are linked.
TEST(DividedThings, KerbsSideBySideAreApartIfTheGroundIsSeenBetween) {
  const std::vector<worlds::Rect> three{
      {6.0, 9.8, 8.0, 8.2}, {6.0, 9.8, 8.6, 8.8}, {6.0, 9.8, 9.2, 9.4}};
  const std::vector<Position2> places{{9.5, 8.1}, {9.5, 8.7}, {9.5, 9.3}};
  EXPECT_TRUE(worlds::all_apart(kerbs(three).things_at(places)));
  EXPECT_TRUE(worlds::all_one(kerbs(three, false).things_at(places)));
}

TEST(DividedThings, AnAreaHasNoStrips) {
  const std::vector<worlds::Rect> area{{4.0, 8.0, -1.0, 1.0}, {4.0, 6.0, 1.0, 2.0}};
  EXPECT_TRUE(worlds::all_one(kerbs(area).things_at({{4.3, 0.1}, {4.3, 1.5}})));
}

}  // namespace
}  // namespace mrpt_terrain
