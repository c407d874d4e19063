// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <map>

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

}  // namespace
}  // namespace mrpt_terrain
