// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr double kDegree = 0.017453292519943295;

struct Tilt {
  double height, slope_x, slope_y;  // z = height + slope_x x + slope_y y
};

// Ground of the given plane with `noise` (uniform, half width), a point every 0.25 m.
Points ground(const Tilt& plane, double noise) {
  RandomGenerator random(3);
  Points points;
  for (double x = -15; x < 15; x += 0.25) {
    for (double y = -15; y < 15; y += 0.25) {
      const double z =
          plane.height + plane.slope_x * x + plane.slope_y * y + noise * (2 * random.uniform() - 1);
      points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
  return points;
}

void add_patch(Points& points, double x0, double y0, double size, double z) {
  for (double x = x0; x < x0 + size; x += 0.25) {
    for (double y = y0; y < y0 + size; y += 0.25) {
      points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
}

TEST(GroundPlane, AnalyticWorldHeightAndTilt) {
  GroundPlaneWorkspace workspace;
  for (const Tilt& world : {Tilt{-1.73, 0, 0}, Tilt{-2.2, std::tan(5 * kDegree), 0},
                            Tilt{0.4, 0, -std::tan(10 * kDegree)}}) {
    const GroundPlane plane = find_ground_plane(ground(world, 0.02).view(), {}, workspace);
    ASSERT_TRUE(plane.found);
    // 14,400 points of 1.2 cm: the mean is known to 0.1 mm, the slope to 0.1 mm over 8.7 m.
    EXPECT_NEAR(plane.height, world.height, 1e-3);
    EXPECT_NEAR(plane.tilt, std::atan(std::hypot(world.slope_x, world.slope_y)), 1e-4);
    EXPECT_NEAR(-plane.normal.x() / plane.normal.z(), world.slope_x, 1e-4);
    EXPECT_NEAR(-plane.normal.y() / plane.normal.z(), world.slope_y, 1e-4);
  }
}

TEST(GroundPlane, ALargerRoofAboveIsNotTheGround) {
  // Ground is seen in less than half of the map; over the rest there is a flat roof.
  const Points open = ground({-1.5, 0, 0}, 0.01);
  Points roofed;
  for (std::size_t i = 0; i < open.size(); ++i) {
    roofed.push_back(open.x[i], open.y[i], open.x[i] < -1 ? open.z[i] : 1.0F);
  }
  GroundPlaneWorkspace workspace;
  const GroundPlane plane = find_ground_plane(roofed.view(), {}, workspace);
  ASSERT_TRUE(plane.found);
  EXPECT_NEAR(plane.height, -1.5, 0.01);
}

TEST(GroundPlane, ThingsOnTheGroundDoNotLiftIt) {
  Points points = ground({-1.2, 0, 0}, 0.01);
  for (int k = 0; k < 8; ++k) add_patch(points, -14 + 3.5 * k, 3, 2.5, -0.6);
  GroundPlaneWorkspace workspace;
  const GroundPlane plane = find_ground_plane(points.view(), {}, workspace);
  ASSERT_TRUE(plane.found);
  EXPECT_NEAR(plane.height, -1.2, 2e-3);
}

TEST(GroundPlane, NothingFoundInAWallNoPointsOrNaN) {
  GroundPlaneWorkspace workspace;
  EXPECT_FALSE(find_ground_plane({}, {}, workspace).found);
  Points wall;
  for (double y = -5; y < 5; y += 0.05) {
    for (double z = -1; z < 1; z += 0.05) {
      wall.push_back(2.0F, static_cast<float>(y), static_cast<float>(z));
    }
  }
  EXPECT_FALSE(find_ground_plane(wall.view(), {}, workspace).found);
  Points nan = ground({0, 0, 0}, 0);
  for (float& z : nan.z) z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(find_ground_plane(nan.view(), {}, workspace).found);
}

TEST(GroundPlane, SteeperThanMaxTiltIsNoGround) {
  GroundPlaneWorkspace workspace;
  const Points points = ground({0, std::tan(30 * kDegree), 0}, 0.01);
  EXPECT_FALSE(find_ground_plane(points.view(), {}, workspace).found);
  GroundPlaneParams loose;
  loose.max_tilt = 35 * kDegree;
  EXPECT_TRUE(find_ground_plane(points.view(), loose, workspace).found);
}

TEST(GroundPlane, SamePointsAndSeedGiveTheSamePlane) {
  GroundPlaneWorkspace workspace, other;
  const Points points = ground({-1, 0.05, 0.02}, 0.05);
  const GroundPlane a = find_ground_plane(points.view(), {}, workspace);
  const GroundPlane b = find_ground_plane(points.view(), {}, other);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.height, b.height);
}

}  // namespace
}  // namespace mrpt_terrain
