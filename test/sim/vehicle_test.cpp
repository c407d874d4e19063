// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/vehicle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "meshes.h"
#include "test_files.h"

namespace mrpt_terrain::sim {
namespace {

constexpr double kDegrees = M_PI / 180.0;

/// Ground 20 m x 20 m with one slope: tan of the rise along x and along y.
World tilted_world(double rise_x, double rise_y) {
  World world;
  world.solids.resize(1);
  worlds::add_patch(world.mesh, {-10, -10, -10 * (rise_x + rise_y)}, {20, 0, 20 * rise_x},
                    {0, 20, 20 * rise_y}, kGroundSolid, SurfaceKind::kDrivable);
  world.min_corner.setConstant(-10);
  world.max_corner.setConstant(10);
  return world;
}

/// Level ground that is `height` higher where x > 0.
World step_world(double height) {
  World world;
  world.solids.resize(1);
  worlds::add_patch(world.mesh, {-10, -10, 0}, {10, 0, 0}, {0, 20, 0}, kGroundSolid,
                    SurfaceKind::kDrivable);
  worlds::add_patch(world.mesh, {0, -10, height}, {10, 0, 0}, {0, 20, 0}, kGroundSolid,
                    SurfaceKind::kDrivable);
  world.min_corner.setConstant(-10);
  world.max_corner.setConstant(10);
  return world;
}

DrivePath path_of(std::vector<Eigen::Vector2d> waypoints, double speed = 0.5) {
  DrivePath path;
  path.waypoints = std::move(waypoints);
  path.speed = speed;
  return path;
}

Motion drive_in(const World& world, const DrivePath& path) {
  return drive(RayCaster(world), VehicleParams{}, path, "scene.yaml");
}

double yaw_of(const Eigen::Isometry3d& pose) {
  return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

/// Largest yaw rate and speed between samples `dt` apart.
struct Rates {
  double yaw = 0.0, speed = 0.0;
};
Rates rates_of(const Motion& motion, double dt) {
  Rates rates;
  for (double t = motion.start(); t + dt <= motion.end(); t += dt) {
    const Eigen::Isometry3d a = motion.at(t), b = motion.at(t + dt);
    const double turn = std::remainder(yaw_of(b) - yaw_of(a), 2.0 * M_PI);
    rates.yaw = std::max(rates.yaw, std::abs(turn) / dt);
    rates.speed = std::max(rates.speed, (b.translation() - a.translation()).norm() / dt);
  }
  return rates;
}

TEST(Vehicle, OnALevelPlaneMovesAtConstantSpeedAlongTheHeading) {
  const Motion motion = drive_in(tilted_world(0, 0), path_of({{1, 1}, {1, 5}}));
  EXPECT_EQ(motion.start(), 0.0);
  EXPECT_NEAR(motion.end(), 8.0, 1e-9);
  const Eigen::Isometry3d pose = motion.at(3.0);
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, 2.5, 0), 1e-9));
  const Eigen::Matrix3d north = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).matrix();
  EXPECT_TRUE(pose.linear().isApprox(north, 1e-9));
}

// A plane's normal is in closed form; the wheels' feet lie on it wherever they are.
TEST(Vehicle, OnARampItsAxesAreThoseOfTheRamp) {
  const double rise = std::tan(15 * kDegrees);
  const Motion motion = drive_in(tilted_world(rise, 0), path_of({{-2, 0}, {2, 0}}));
  const Eigen::Isometry3d pose = motion.at(2.0);
  EXPECT_NEAR(pose.translation().z(), -1.0 * rise, 1e-6);
  // Nose up turns x towards z: a negative turn about y.
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(-15 * kDegrees, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_TRUE(pose.linear().isApprox(expected, 1e-6)) << pose.linear();
}

TEST(Vehicle, OnASideSlopeItRolls) {
  const Motion motion =
      drive_in(tilted_world(0, std::tan(10 * kDegrees)), path_of({{-2, 1}, {2, 1}}));
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(10 * kDegrees, Eigen::Vector3d::UnitX()).matrix();
  EXPECT_TRUE(motion.at(1.0).linear().isApprox(expected, 1e-6));
}

TEST(Vehicle, OnAnySlopeItsZAxisIsTheNormalAndItsXAxisKeepsTheHeading) {
  const Motion motion = drive_in(tilted_world(0.2, -0.3), path_of({{-3, -3}, {3, 1}}));
  const Eigen::Matrix3d axes = motion.at(4.0).linear();
  EXPECT_TRUE(axes.col(2).isApprox(Eigen::Vector3d(-0.2, 0.3, 1).normalized(), 1e-6));
  EXPECT_NEAR(std::atan2(axes(1, 0), axes(0, 0)), std::atan2(4, 6), 1e-9);
  EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
}

// With all front feet h above the rear ones the plane rises by h over the wheelbase.
TEST(Vehicle, FrontWheelsOnAStepRaiseTheNose) {
  const VehicleParams vehicle;
  const Motion motion = drive_in(step_world(0.1), path_of({{-1, 0}, {1, 0}}));
  const Eigen::Isometry3d pose = motion.at(2.0);  // at x = 0
  EXPECT_NEAR(pose.translation().z(), 0.05, 1e-6);
  EXPECT_NEAR(std::atan2(pose.linear()(2, 0), pose.linear()(0, 0)),
              std::atan(0.1 / vehicle.wheelbase), 1e-6);
}

// The front feet rise by h within the contact length: pitch by atan(h / wheelbase) and the middle
// by h / 2. One sample of 1 cm passes one of 21 places under the wheel: 5 % above the mean rate.
TEST(Vehicle, AStepIsClimbedWithinTheContactLength) {
  constexpr double kStep = 0.15, kSpeed = 0.5, kDt = 1e-3;
  const Motion motion = drive_in(step_world(kStep), path_of({{-1, 0}, {1, 0}}, kSpeed));
  const double bound = 1.1 * 0.5 * kStep / kContactLength * kSpeed;
  double highest = 0.0;
  for (double t = 0.0; t < motion.end() - kDt; t += kDt) {
    const double rise = motion.at(t + kDt).translation().z() - motion.at(t).translation().z();
    highest = std::max(highest, rise / kDt);
  }
  EXPECT_LE(highest, bound);
  EXPECT_GE(highest, 0.8 * bound);
}

TEST(Vehicle, CornersAreArcsOfHalfAMetre) {
  const Motion motion = drive_in(tilted_world(0, 0), path_of({{0, 0}, {4, 0}, {4, 4}}));
  // Straight to (3.5, 0), quarter of a circle about (3.5, 0.5), straight from (4, 0.5); at 1 rad/s
  // and 0.5 m/s the arc takes pi / 2.
  EXPECT_NEAR(motion.end(), 7.0 + M_PI / 2 + 7.0, 1e-6);
  const Eigen::Isometry3d middle = motion.at(7.0 + M_PI / 4);
  const double reach = 0.5 * std::sqrt(0.5);
  EXPECT_NEAR(middle.translation().x(), 3.5 + reach, 1e-5);
  EXPECT_NEAR(middle.translation().y(), 0.5 - reach, 1e-5);
  EXPECT_NEAR(yaw_of(middle), M_PI / 4, 1e-6);
  EXPECT_LE(rates_of(motion, 0.01).yaw, 1.0 + 1e-6);
}

TEST(Vehicle, ArcsAtShortLegsTakeHalfOfTheLegAndSlowDown) {
  const Motion motion =
      drive_in(tilted_world(0, 0), path_of({{0, 0}, {0.2, 0}, {0.2, 4}, {-1, 4}}, 2.0));
  const Rates rates = rates_of(motion, 0.001);
  EXPECT_LE(rates.yaw, 1.0 + 1e-6);
  EXPECT_NEAR(rates.speed, 2.0, 1e-3);
  EXPECT_TRUE(motion.at(motion.end()).translation().isApprox(Eigen::Vector3d(-1, 4, 0), 1e-9));
}

TEST(Vehicle, TurnsBackOnTheSpot) {
  const Motion motion = drive_in(tilted_world(0, 0), path_of({{0, 0}, {2, 0}, {0, 0}}));
  EXPECT_NEAR(motion.end(), 4.0 + M_PI + 4.0, 1e-6);
  const Eigen::Isometry3d turning = motion.at(4.0 + M_PI / 2);
  EXPECT_TRUE(turning.translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-9));
  EXPECT_NEAR(std::abs(yaw_of(turning)), M_PI / 2, 1e-3);
  EXPECT_NEAR(std::abs(yaw_of(motion.at(motion.end()))), M_PI, 1e-9);
  EXPECT_LE(rates_of(motion, 0.01).yaw, 1.0 + 1e-6);
}

TEST(Vehicle, DoubledWaypointsCountOnce) {
  const World world = tilted_world(0.1, 0);
  const Motion once = drive_in(world, path_of({{0, 0}, {2, 0}, {2, 2}}));
  const Motion twice =
      drive_in(world, path_of({{0, 0}, {0, 0}, {2, 0}, {2, 0}, {2, 0}, {2, 2}, {2, 2}}));
  EXPECT_EQ(once.end(), twice.end());
  for (double t = 0.0; t < once.end(); t += 0.1) {
    EXPECT_TRUE(once.at(t).matrix() == twice.at(t).matrix()) << t;
  }
}

TEST(Vehicle, WithOnePlaceToBeStandsStill) {
  const World world = tilted_world(std::tan(5 * kDegrees), 0);
  DrivePath path = path_of({{1, 2}, {1, 2}});
  path.yaw = M_PI / 2;
  const Motion motion = drive_in(world, path);
  ASSERT_TRUE(motion.stands_still());
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(-5 * kDegrees, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()))
                                       .matrix();
  // The heading stays level because the slope lies across it.
  EXPECT_TRUE(motion.at(0.0).linear().isApprox(expected, 1e-6));
  path.waypoints.clear();
  EXPECT_TRUE(drive_in(world, path).stands_still());
}

TEST(Vehicle, PathThatLeavesTheTerrainIsRefusedWithPlaceAndRule) {
  const World world = tilted_world(0, 0);
  const std::string message = test::message_of<SceneError>([&] {
    (void)drive_in(world, path_of({{0, 0}, {9.9, 0}}));
  });
  EXPECT_TRUE(test::contains(message, ": leaves the terrain at (10")) << message;
  EXPECT_TRUE(test::contains(message,
                             ": every wheel must stand on the ground, which reaches from "
                             "(-10, -10) to (10, 10) m"))
      << message;
}

TEST(Vehicle, NumbersThatAreNoPathAreRefused) {
  const World world = tilted_world(0, 0);
  const auto refusal = [&](const DrivePath& path) {
    return test::message_of<SceneError>([&] { (void)drive_in(world, path); });
  };
  EXPECT_EQ(refusal(path_of({{0, 0}, {1, std::numeric_limits<double>::quiet_NaN()}})),
            "scene.yaml: path: waypoints[1] = (1, nan): must be finite numbers, metres");
  EXPECT_EQ(refusal(path_of({{0, 0}, {1, 0}}, 0.0)),
            "scene.yaml: path: speed = 0: must be above 0 m/s");
}

// Chosen angles; the expected axes are written out.
TEST(Vehicle, SensorIsMountedNoseDownForPositivePitch) {
  VehicleParams vehicle;
  vehicle.sensor_x = 0.3;
  vehicle.sensor_z = 0.9;
  vehicle.sensor_pitch = 30 * kDegrees;
  const Eigen::Isometry3d pose = vehicle.T_robot_sensor();
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0.3, 0, 0.9)));
  EXPECT_TRUE(pose.linear().col(0).isApprox(Eigen::Vector3d(std::sqrt(0.75), 0, -0.5), 1e-12));
  vehicle.sensor_pitch = 0.0;
  vehicle.sensor_roll = 30 * kDegrees;
  EXPECT_TRUE(vehicle.T_robot_sensor().linear().col(1).isApprox(
      Eigen::Vector3d(0, std::sqrt(0.75), 0.5), 1e-12));
}

}  // namespace
}  // namespace mrpt_terrain::sim
