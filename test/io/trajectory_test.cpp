// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::poses::CPose3D;
using testing::fresh_folder;
using testing::kDegrees;

CPose3D pose(double x, double y, double z, double yaw = 0.0, double pitch = 0.0,
             double roll = 0.0) {
  return CPose3D::FromXYZYawPitchRoll(x, y, z, yaw, pitch, roll);
}

void expect_near(const CPose3D& a, const CPose3D& b, double tolerance) {
  EXPECT_NEAR(a.distanceTo(b), 0.0, tolerance);
  const auto difference =
      (a.getRotationMatrix().asEigen() - b.getRotationMatrix().asEigen()).eval();
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), tolerance);
}

Trajectory two_poses() {
  Trajectory trajectory;
  trajectory.add(10.0, pose(0.0, 2.0, 0.0, 170.0 * kDegrees));
  trajectory.add(10.8, pose(8.0, 2.0, -4.0, -170.0 * kDegrees));
  return trajectory;
}

TEST(Trajectory, LiteralInterpolationGoesTheShortWayRound) {
  const auto middle = two_poses().at(10.2);
  ASSERT_TRUE(middle);
  expect_near(*middle, pose(2.0, 2.0, -1.0, 175.0 * kDegrees), 1e-12);
}

TEST(Trajectory, AnalyticTurnAboutATiltedAxisHasConstantRate) {
  const CPose3D start = pose(1.0, 2.0, 3.0, 0.3, -0.2, 0.5);
  const CPose3D turn_axis = pose(0.0, 0.0, 0.0, 0.7, 0.4, 0.0);
  const auto turned = [&](double angle) {
    return start + (turn_axis + pose(0.0, 0.0, 0.0, angle) + (-turn_axis));
  };
  Trajectory trajectory;
  trajectory.add(0.0, start);
  trajectory.add(1.0, turned(2.0));
  for (const double share : {0.1, 0.5, 0.9}) {
    ASSERT_TRUE(trajectory.at(share));
    expect_near(*trajectory.at(share), turned(2.0 * share), 1e-9);
  }
}

TEST(Trajectory, GivesTheEndPoseWithinTheToleranceAndNothingBeyond) {
  const Trajectory trajectory = two_poses();
  ASSERT_TRUE(trajectory.at(9.96));
  expect_near(*trajectory.at(9.96), trajectory.pose(0), 1e-12);
  ASSERT_TRUE(trajectory.at(10.84));
  expect_near(*trajectory.at(10.84), trajectory.pose(1), 1e-12);
  EXPECT_FALSE(trajectory.at(9.94));
  EXPECT_FALSE(trajectory.at(10.86));
  EXPECT_FALSE(trajectory.at(std::nan("")));
  EXPECT_FALSE(Trajectory().at(10.0));
}

TEST(Trajectory, GivesNothingInsideALongGapButBothOfItsEnds) {
  Trajectory trajectory;
  trajectory.add(0.0, pose(0.0, 0.0, 0.0));
  trajectory.add(1.5, pose(1.0, 0.0, 0.0));
  EXPECT_TRUE(trajectory.at(0.0));
  EXPECT_FALSE(trajectory.at(0.7));
  EXPECT_TRUE(trajectory.at(1.5));
  trajectory.max_gap = 2.0;
  EXPECT_TRUE(trajectory.at(0.7));
}

TEST(Trajectory, SortsStampsAndReplacesEqualOnes) {
  Trajectory trajectory;
  trajectory.add(2.0, pose(2.0, 0.0, 0.0));
  trajectory.add(1.0, pose(1.0, 0.0, 0.0));
  trajectory.add(3.0, pose(3.0, 0.0, 0.0));
  trajectory.add(1.0, pose(7.0, 0.0, 0.0));
  EXPECT_EQ(trajectory.stamps(), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(trajectory.pose(0).x(), 7.0);
  EXPECT_EQ(trajectory.pose(1).x(), 2.0);
}

std::string write_tum(const std::string& content) {
  const std::string file = fresh_folder() + "/poses.tum";
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

TEST(LoadTum, ReadsCommentsBlankLinesTabsAndCarriageReturns) {
  const auto file = write_tum(
      "# stamp tx ty tz qx qy qz qw\r\n\r\n"
      "20.5 4 5 6 0 0 0 1  # the later one first\r\n"
      "\t10.25\t1 2 3 0 0 0.70710678 0.70710678");
  const Trajectory trajectory = load_tum(file);
  ASSERT_EQ(trajectory.stamps(), (std::vector<double>{10.25, 20.5}));
  expect_near(trajectory.pose(0), pose(1.0, 2.0, 3.0, 90.0 * kDegrees), 1e-9);
  expect_near(trajectory.pose(1), pose(4.0, 5.0, 6.0), 1e-12);
}

TEST(LoadTum, NormalisesQuaternionsThatAreNearlyUnit) {
  const Trajectory trajectory = load_tum(write_tum("0 0 0 0 0 0 0 1.0009\n"));
  EXPECT_NEAR(trajectory.pose(0).getRotationMatrix()(0, 0), 1.0, 1e-15);
}

TEST(LoadTum, TurnsPosesOfTheSensorIntoPosesOfTheRobot) {
  const CPose3D T_robot_sensor = pose(0.5, 0.0, 1.0, 0.1, 0.2, 0.3);
  const CPose3D T_map_robot = pose(7.0, 8.0, 0.0, 1.0);
  Trajectory of_sensor;
  of_sensor.add(1.0, T_map_robot + T_robot_sensor);
  const std::string file = fresh_folder() + "/sensor.tum";
  save_tum(of_sensor, file);
  expect_near(load_tum(file, T_robot_sensor).pose(0), T_map_robot, 1e-8);
}

struct BadFile {
  const char* content;
  const char* message;
};

TEST(LoadTum, NamesFileLineAndReason) {
  const BadFile files[] = {
      {"", ":1: holds no pose"},
      {"# only a comment\n", ":1: holds no pose"},
      {"1 2 3 4 0 0 0 1\n2 2 3 4 0 0 1\n",
       ":2: expected 8 numbers (stamp tx ty tz qx qy qz qw), found 7"},
      {"1 2 3 4 0 0 0 1 9\n", ":1: expected 8 numbers (stamp tx ty tz qx qy qz qw), found 9"},
      {"\n\n1 2 3,5 4 0 0 0 1\n", ":3: ty = '3,5' is not a number"},
      {"1 2 3 4x 0 0 0 1\n", ":1: tz = '4x' is not a number"},
      {"1 2 nan 4 0 0 0 1\n", ":1: ty = 'nan' is not finite"},
      {"inf 2 3 4 0 0 0 1\n", ":1: stamp = 'inf' is not finite"},
      {"1 2 3 4 0 0 0 1.002\n", ":1: the quaternion has norm 1.002000, must be 1 within 0.001"},
      {"1 2 3 4 0 0 0 0\n", ":1: the quaternion has norm 0.000000, must be 1 within 0.001"},
  };
  for (const auto& bad : files) {
    const std::string file = write_tum(bad.content);
    try {
      static_cast<void>(load_tum(file));
      ADD_FAILURE() << "accepted: " << bad.content;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), file + bad.message);
    }
  }
}

TEST(LoadTum, RefusesAMissingFile) {
  const std::string file = fresh_folder() + "/none.tum";
  try {
    static_cast<void>(load_tum(file));
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file + ": cannot be opened");
  }
}

TEST(SaveTum, RoundTripKeepsNineDecimals) {
  Trajectory trajectory;
  trajectory.add(1519637061.085268021, pose(-123.456789123, 0.000000001, 2.0, 3.1, -1.2, 0.4));
  trajectory.add(1519637061.185268021, pose(5.0, 6.0, 7.0, -3.0, 0.1, -2.0));
  const std::string file = fresh_folder() + "/poses.tum";
  save_tum(trajectory, file);
  const Trajectory read = load_tum(file);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(read.stamps()[k], trajectory.stamps()[k], 5e-7);  // doubles of that size
    expect_near(read.pose(k), trajectory.pose(k), 3e-9);
  }
}

TEST(SaveTum, RefusesAFolderThatDoesNotExist) {
  const std::string file = fresh_folder() + "/none/poses.tum";
  EXPECT_THROW(save_tum(two_poses(), file), std::runtime_error);
}

}  // namespace
}  // namespace mrpt_terrain::io
