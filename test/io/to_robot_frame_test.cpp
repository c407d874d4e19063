// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;
using testing::kDegrees;

constexpr double kStamp = 1'500'000'000.0;
constexpr double kSweep = 0.1;

CPose3D pose(double x, double y, double z, double yaw = 0.0, double pitch = 0.0,
             double roll = 0.0) {
  return CPose3D::FromXYZYawPitchRoll(x, y, z, yaw, pitch, roll);
}

/// A robot that drives straight while it turns evenly about its vertical: between poses as dense as
/// one likes, linear and spherical interpolation are exact.
struct Motion {
  TPoint3D velocity;
  double yaw_rate;

  [[nodiscard]] CPose3D at(double t) const {
    return pose(3.0 + velocity.x * t, -2.0 + velocity.y * t, velocity.z * t, 0.4 + yaw_rate * t);
  }
  [[nodiscard]] Trajectory trajectory() const {
    Trajectory result;
    for (int k = -2; k <= 4; ++k) result.add(kStamp + 0.05 * k, at(0.05 * k));
    return result;
  }
};

struct PlaneInMap {
  TPoint3D normal;
  double distance;  ///< normal * p = distance
};

/// What a sensor measures of a plane in the map while it turns once and the robot moves: the exact
/// intersections, in the sensor's frame at the time of each ray.
SensorPoints sweep_over(const PlaneInMap& plane, const Motion& motion,
                        const CPose3D& T_robot_sensor) {
  SensorPoints result;
  result.stamp = kStamp;
  result.T_robot_sensor = T_robot_sensor;
  constexpr int kColumns = 360;
  for (int c = 0; c < kColumns; ++c) {
    const float t = static_cast<float>(kSweep * c / kColumns);
    const CPose3D T_map_sensor = motion.at(static_cast<double>(t)) + T_robot_sensor;
    for (const double elevation : {-0.3, -0.1, 0.05}) {
      const double azimuth = -2.0 * M_PI * c / kColumns;
      const TPoint3D ray(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const TPoint3D in_map = T_map_sensor.rotateVector(ray);
      const TPoint3D& n = plane.normal;
      const double range = (plane.distance - n.x * T_map_sensor.x() - n.y * T_map_sensor.y() -
                            n.z * T_map_sensor.z()) /
                           (n.x * in_map.x + n.y * in_map.y + n.z * in_map.z);
      if (!(range > 0.3 && range < 50.0)) continue;
      result.points.push_back(static_cast<float>(ray.x * range), static_cast<float>(ray.y * range),
                              static_cast<float>(ray.z * range));
      result.time.push_back(t);
      result.source_index.push_back(static_cast<std::uint32_t>(result.source_index.size()));
    }
  }
  result.source_size = result.points.size();
  result.counts.points = result.points.size();
  return result;
}

/// Greatest distance of the scan's points, put into the map, from a plane.
double worst_distance(const Scan& scan, const CPose3D& T_map_robot, const PlaneInMap& plane) {
  double worst = 0.0;
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const TPoint3D p =
        T_map_robot.composePoint(TPoint3D(scan.points.x[k], scan.points.y[k], scan.points.z[k]));
    const TPoint3D& n = plane.normal;
    worst = std::max(worst, std::abs(n.x * p.x + n.y * p.y + n.z * p.z - plane.distance));
  }
  return worst;
}

const CPose3D kSensor = pose(0.4, -0.1, 1.2, 0.3, 0.05, -0.08);
const PlaneInMap kWall{{1.0, 0.0, 0.0}, 12.0};
const PlaneInMap kFloor{{0.0, 0.0, 1.0}, 0.0};
const Motion kStraight{{8.0, 3.0, 0.5}, 0.0};
const Motion kTurning{{0.0, 0.0, 0.0}, 1.5};
const Motion kBoth{{-4.0, 8.0, 0.2}, -2.0};

TEST(ToRobotFrame, AnalyticWallsAndFloorsAreFlatAfterDeskewing) {
  for (const Motion& motion : {kStraight, kTurning, kBoth}) {
    const Trajectory trajectory = motion.trajectory();
    for (const PlaneInMap& plane : {kWall, kFloor}) {
      const SensorPoints sensor = sweep_over(plane, motion, kSensor);
      ASSERT_GT(sensor.points.size(), 100U);
      Scan scan;
      to_robot_frame(sensor, &trajectory, {}, scan);
      EXPECT_TRUE(scan.deskewed);
      ASSERT_TRUE(scan.T_map_robot);
      // Coordinates up to 50 m in single precision: 4e-6 m each, twice rounded.
      EXPECT_LE(worst_distance(scan, motion.at(0.0), plane), 3e-5);
    }
  }
}

TEST(ToRobotFrame, WithoutDeskewingTheWallBendsByTheMotion) {
  const SensorPoints sensor = sweep_over(kWall, kStraight, kSensor);
  const Trajectory trajectory = kStraight.trajectory();
  InputParams params;
  params.deskew = false;
  Scan scan;
  to_robot_frame(sensor, &trajectory, params, scan);
  EXPECT_FALSE(scan.deskewed);
  EXPECT_TRUE(scan.T_map_robot);
  const double latest = *std::max_element(sensor.time.begin(), sensor.time.end());
  EXPECT_NEAR(worst_distance(scan, kStraight.at(0.0), kWall), latest * 8.0, 1e-4);
}

TEST(ToRobotFrame, OracleFormulaPointByPoint) {
  Trajectory trajectory;  // uneven stamps, tilted attitudes
  trajectory.add(kStamp - 0.02, pose(1.0, 2.0, 0.0, 0.1, 0.02, 0.0));
  trajectory.add(kStamp + 0.03, pose(1.3, 2.1, 0.1, 0.3, -0.05, 0.1));
  trajectory.add(kStamp + 0.07, pose(1.9, 2.0, 0.1, 0.2, 0.10, -0.1));
  trajectory.add(kStamp + 0.08, pose(2.0, 1.9, 0.2, 0.2, 0.10, -0.1));
  const SensorPoints sensor = sweep_over(kFloor, kBoth, kSensor);
  Scan scan;
  trajectory.tolerance = 0.1;  // the sweep ends after the last pose
  to_robot_frame(sensor, &trajectory, {}, scan);
  ASSERT_TRUE(scan.deskewed);
  for (std::size_t k = 0; k < sensor.points.size(); ++k) {
    const CPose3D T_robot_sensor =
        -*trajectory.at(kStamp) + *trajectory.at(kStamp + sensor.time[k]) + kSensor;
    const TPoint3D expected = T_robot_sensor.composePoint(
        TPoint3D(sensor.points.x[k], sensor.points.y[k], sensor.points.z[k]));
    // The stamp's own resolution, 0.24 us, moves points by as much as they move in that time.
    ASSERT_NEAR(scan.points.x[k], expected.x, 5e-5) << k;
    ASSERT_NEAR(scan.points.y[k], expected.y, 5e-5) << k;
    ASSERT_NEAR(scan.points.z[k], expected.z, 5e-5) << k;
    const auto& origin = scan.ray_origins[scan.origin_of[k]];
    ASSERT_NEAR(origin[0], T_robot_sensor.x(), 1e-5) << k;
    ASSERT_NEAR(origin[1], T_robot_sensor.y(), 1e-5) << k;
    ASSERT_NEAR(origin[2], T_robot_sensor.z(), 1e-5) << k;
  }
}

TEST(ToRobotFrame, InvariantTheMapsFrameDoesNotMatter) {
  const SensorPoints sensor = sweep_over(kFloor, kBoth, kSensor);
  const Trajectory trajectory = kBoth.trajectory();
  const CPose3D T_other_map = pose(-20.0, 7.0, 3.0, 2.0, 0.3, -1.0);
  Trajectory moved;
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    moved.add(trajectory.stamps()[k], T_other_map + trajectory.pose(k));
  }
  Scan a, b;
  to_robot_frame(sensor, &trajectory, {}, a);
  to_robot_frame(sensor, &moved, {}, b);
  ASSERT_TRUE(b.deskewed);
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    ASSERT_NEAR(a.points.x[k], b.points.x[k], 1e-5);
    ASSERT_NEAR(a.points.y[k], b.points.y[k], 1e-5);
    ASSERT_NEAR(a.points.z[k], b.points.z[k], 1e-5);
  }
}

TEST(ToRobotFrame, InvariantTheOrderOfThePointsDoesNotMatter) {
  const SensorPoints sensor = sweep_over(kFloor, kBoth, kSensor);
  SensorPoints reversed = sensor;
  for (auto* values :
       {&reversed.points.x, &reversed.points.y, &reversed.points.z, &reversed.time}) {
    std::reverse(values->begin(), values->end());
  }
  const Trajectory trajectory = kBoth.trajectory();
  Scan a, b;
  to_robot_frame(sensor, &trajectory, {}, a);
  to_robot_frame(reversed, &trajectory, {}, b);
  EXPECT_EQ(a.ray_origins.size(), b.ray_origins.size());
  std::reverse(b.points.x.begin(), b.points.x.end());
  EXPECT_EQ(a.points.x, b.points.x);
}

TEST(ToRobotFrame, LiteralSensorPoseWithoutTrajectory) {
  SensorPoints sensor;
  sensor.points.push_back(1.0F, 2.0F, 3.0F);
  sensor.time = {0.0F};
  sensor.source_index = {7};
  sensor.source_size = 9;
  sensor.stamp = 12.5;
  sensor.counts = {1, 2, 3, 3};
  sensor.T_robot_sensor = pose(10.0, 20.0, 30.0, 90.0 * kDegrees);
  Scan scan;
  to_robot_frame(sensor, nullptr, {}, scan);
  ASSERT_EQ(scan.points.size(), 1U);
  EXPECT_NEAR(scan.points.x[0], 8.0F, 1e-5);
  EXPECT_NEAR(scan.points.y[0], 21.0F, 1e-5);
  EXPECT_NEAR(scan.points.z[0], 33.0F, 1e-5);
  EXPECT_EQ(scan.ray_origins, (std::vector<std::array<float, 3>>{{10.0F, 20.0F, 30.0F}}));
  EXPECT_TRUE(scan.origin_of.empty());
  EXPECT_EQ(scan.source_index, sensor.source_index);
  EXPECT_EQ(scan.source_size, 9U);
  EXPECT_EQ(scan.stamp, 12.5);
  EXPECT_EQ(scan.counts.no_return, 2U);
  EXPECT_FALSE(scan.T_map_robot);
  EXPECT_FALSE(scan.deskewed);
}

TEST(ToRobotFrame, PointsOfOneFiringShareTheirOrigin) {
  const SensorPoints sensor = sweep_over(kFloor, kBoth, kSensor);
  const Trajectory trajectory = kBoth.trajectory();
  Scan scan;
  to_robot_frame(sensor, &trajectory, {}, scan);
  const std::set<float> times(sensor.time.begin(), sensor.time.end());
  EXPECT_EQ(scan.ray_origins.size(), times.size());
  ASSERT_EQ(scan.origin_of.size(), scan.points.size());
  for (std::size_t k = 1; k < sensor.time.size(); ++k) {
    EXPECT_EQ(sensor.time[k] == sensor.time[k - 1], scan.origin_of[k] == scan.origin_of[k - 1]);
  }
}

struct Uncovered {
  const char* name;
  std::vector<double> stamps;  ///< relative to the scan's
};

TEST(ToRobotFrame, IsNotDeskewedWhereTheTrajectoryDoesNotCoverTheSweep) {
  const Uncovered cases[] = {{"no poses", {}},
                             {"ends too early", {-0.1, 0.04}},
                             {"begins too late", {0.06, 0.2}},
                             {"has a gap at the stamp", {-0.9, 0.5}},
                             {"has a gap in the sweep", {-1.5, 0.0, 1.2}}};
  const SensorPoints sensor = sweep_over(kFloor, kBoth, kSensor);
  Scan rigid;
  to_robot_frame(sensor, nullptr, {}, rigid);
  for (const auto& uncovered : cases) {
    Trajectory trajectory;
    for (const double t : uncovered.stamps) trajectory.add(kStamp + t, kBoth.at(t));
    Scan scan;
    to_robot_frame(sensor, &trajectory, {}, scan);
    EXPECT_FALSE(scan.deskewed) << uncovered.name;
    EXPECT_EQ(scan.points.x, rigid.points.x) << uncovered.name;
    EXPECT_EQ(scan.ray_origins.size(), 1U) << uncovered.name;
    EXPECT_TRUE(scan.origin_of.empty()) << uncovered.name;
  }
}

TEST(ToRobotFrame, ASinglePoseAtTheStampIsARobotAtRest) {
  SensorPoints sensor;
  sensor.points.push_back(1.0F, 2.0F, 3.0F);
  sensor.time = {0.01F};
  sensor.source_index = {0};
  sensor.stamp = kStamp;
  Trajectory trajectory;
  trajectory.add(kStamp, pose(5.0, 5.0, 0.0, 1.0));
  Scan scan;
  to_robot_frame(sensor, &trajectory, {}, scan);
  EXPECT_TRUE(scan.deskewed);
  EXPECT_NEAR(scan.points.x[0], 1.0F, 1e-6);
  EXPECT_NEAR(scan.points.y[0], 2.0F, 1e-6);
}

TEST(ToRobotFrame, NegativeTimesLieBeforeTheStamp) {
  SensorPoints sensor;
  sensor.points.push_back(1.0F, 0.0F, 0.0F);
  sensor.time = {-0.05F};
  sensor.source_index = {0};
  sensor.stamp = kStamp;
  const Motion forward{{10.0, 0.0, 0.0}, 0.0};
  const Trajectory trajectory = forward.trajectory();
  Scan scan;
  to_robot_frame(sensor, &trajectory, {}, scan);
  ASSERT_TRUE(scan.deskewed);
  // Half a metre behind, along the map's x; the robot looks 0.4 rad to the left of that.
  EXPECT_NEAR(scan.points.x[0], 1.0 - 0.5 * std::cos(0.4), 1e-5);
  EXPECT_NEAR(scan.points.y[0], 0.5 * std::sin(0.4), 1e-5);
}

TEST(ToRobotFrame, EmptyScansAreFine) {
  const Trajectory trajectory = kBoth.trajectory();
  SensorPoints sensor;
  sensor.stamp = kStamp;
  Scan scan;
  to_robot_frame(sensor, &trajectory, {}, scan);
  EXPECT_EQ(scan.points.size(), 0U);
  EXPECT_FALSE(scan.deskewed);
  EXPECT_TRUE(scan.T_map_robot);
}

}  // namespace
}  // namespace mrpt_terrain::io
