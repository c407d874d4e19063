// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;

GroundPlane plane_of(const Points& points, const GroundPlaneParams& params = {}) {
  GroundPlaneWorkspace workspace;
  return find_ground_plane(points.view(), params, workspace);
}

/// 20 m x 20 m of exact plane z = height + slope x.
Points tilted_ground(double height, double angle) {
  Points points;
  worlds::add_surface(points, {-10.0, 10.0, -10.0, 10.0}, 0.2,
                      [&](double x, double) { return height + x * std::tan(angle); });
  return points;
}

// Analytic: floats of at most 10 m are wrong by 5e-7 m, over 5.8 m of spread.
TEST(GroundPlane, ExactPlanesAreFound) {
  for (const double degrees : {-15.0, -3.0, 0.0, 5.0, 15.0}) {
    const GroundPlane plane = plane_of(tilted_ground(-1.7, radians(degrees)));
    ASSERT_TRUE(plane.found) << degrees;
    EXPECT_NEAR(plane.height, -1.7, 1e-6) << degrees;
    EXPECT_NEAR(plane.tilt, std::abs(radians(degrees)), 2e-6) << degrees;
    EXPECT_NEAR(plane.normal.x(), -std::sin(radians(degrees)), 1e-6) << degrees;
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-12);
    EXPECT_EQ(plane.share, 1.0);
  }
}

// Analytic: noise s over n = 10,000 points; all of them lie within the tolerance of 7 s and enter
// the fit, so that height and tilt have standard deviations of s / 100 and s / (100 * 5.8 m).
TEST(GroundPlane, LowestPointsDoNotPullTheFitDown) {
  RandomGenerator random(121);
  Points points = tilted_ground(-1.0, 0.0);
  for (float& z : points.z) z += static_cast<float>(0.02 * worlds::normal_deviate(random));
  const GroundPlane plane = plane_of(points);
  ASSERT_TRUE(plane.found);
  EXPECT_NEAR(plane.height, -1.0, 5 * 0.02 / 100);
  EXPECT_NEAR(plane.tilt, 0.0, 5 * 0.02 / 580);
}

// A roof over everything, dense, while 60 % of the ground is hidden from the sensor: more cells see
// the roof only, but those that see the ground are below it.
TEST(GroundPlane, WhatHasSomethingBelowIsNotTheGround) {
  Points points;
  worlds::add_flat(points, {2.0, 10.0, -10.0, 10.0}, 0.2, -1.0);
  worlds::add_flat(points, {-10.0, 10.0, -10.0, 10.0}, 0.1, 1.5);
  const GroundPlane plane = plane_of(points);
  ASSERT_TRUE(plane.found);
  EXPECT_NEAR(plane.height, -1.0, 1e-6);
  EXPECT_NEAR(plane.share, 0.4, 0.03);
}

// Most candidates lie on an embankment of 35 deg, which is steeper than ground may be.
TEST(GroundPlane, SteepPlanesAreNoCandidates) {
  Points points;
  worlds::add_surface(points, {-10.0, 10.0, -10.0, 10.0}, 0.2, [](double x, double) {
    return x < -2.0 ? 0.0 : (x + 2.0) * std::tan(radians(35.0));
  });
  const GroundPlane plane = plane_of(points);
  ASSERT_TRUE(plane.found);
  EXPECT_LT(plane.tilt, radians(5.0));
}

// 15 % of the candidates are flat ground, the others scattered above it.
TEST(GroundPlane, TooSmallAShareIsNotFound) {
  RandomGenerator random(123);
  Points points;
  worlds::add_surface(points, {-10.0, 10.0, -10.0, 10.0}, 0.5, [&](double x, double) {
    return x < -7.0 ? 0.0 : 1.0 + 9.0 * random.uniform();
  });
  EXPECT_FALSE(plane_of(points).found);
  GroundPlaneParams params;
  params.min_share = 0.1;
  EXPECT_TRUE(plane_of(points, params).found);
}

TEST(GroundPlane, SteeperThanMaxTiltIsNotFound) {
  GroundPlaneParams params;
  params.max_tilt = radians(10.0);
  EXPECT_TRUE(plane_of(tilted_ground(0.0, radians(9.0)), params).found);
  // Planes through corners of a steep one may be gentle, but hold too few candidates.
  params.min_share = 0.5;
  EXPECT_FALSE(plane_of(tilted_ground(0.0, radians(30.0)), params).found);
}

// A strip that is narrower than its noise is high has its least scatter sideways; that is no
// ground.
TEST(GroundPlane, NeverSteeperThanMaxTiltEvenAfterTheFit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomGenerator random(seed);
    Points points;
    for (int i = 0; i < 4000; ++i) {
      const double x = 40.0 * random.uniform() - 20.0;
      const double y = 0.25 + 0.02 * random.uniform();
      worlds::add_point(points, x, y, 0.2 * random.uniform() - 0.1);
    }
    const GroundPlane plane = plane_of(points);
    EXPECT_TRUE(!plane.found || plane.tilt <= GroundPlaneParams{}.max_tilt) << "seed " << seed;
    EXPECT_TRUE(std::isfinite(plane.height) && plane.normal.allFinite()) << "seed " << seed;
  }
}

TEST(GroundPlane, PointsBeyondTheRangeDoNotCount) {
  Points points = tilted_ground(0.0, 0.0);
  worlds::add_flat(points, {31.0, 60.0, -30.0, 30.0}, 0.25, -5.0);
  worlds::add_flat(points, {-60.0, -31.0, -30.0, 30.0}, 0.25, 0.1);  // within the tolerance
  const GroundPlane plane = plane_of(points);
  ASSERT_TRUE(plane.found);
  EXPECT_NEAR(plane.height, 0.0, 1e-6);
}

TEST(GroundPlane, OrderOfThePointsAndWorkspacesDoNotMatter) {
  const Points points = tilted_ground(-0.8, radians(4.0));
  GroundPlaneWorkspace workspace;
  (void)find_ground_plane(tilted_ground(3.0, 0.1).view(), {}, workspace);
  const GroundPlane a = plane_of(points);
  const GroundPlane b = find_ground_plane(points.view(), {}, workspace);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.normal, b.normal);
  const GroundPlane c = plane_of(worlds::shuffled(points, 122));
  // Sums over 10,000 points of 10 m in another order.
  EXPECT_NEAR(a.height, c.height, 1e-10);
}

TEST(GroundPlane, DegenerateInputFindsNothing) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Points line;
  Points spot;
  Points nowhere;
  Points few;
  for (int i = 0; i < 1000; ++i) {
    line.push_back(0.02F * static_cast<float>(i), 0.1F, 0.0F);
    spot.push_back(1.0F, 1.0F, 1.0F);
    nowhere.push_back(0.02F * static_cast<float>(i), kNan, i % 2 == 0 ? 0.0F : kNan);
  }
  for (int i = 0; i < 19; ++i)
    few.push_back(static_cast<float>(i), static_cast<float>(i * i % 7), 0);
  for (const Points& points : {Points{}, line, spot, nowhere, few}) {
    const GroundPlane plane = plane_of(points);
    EXPECT_FALSE(plane.found);
    EXPECT_TRUE(std::isfinite(plane.height) && plane.normal.allFinite());
  }
}

}  // namespace
}  // namespace mrpt_terrain
