// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

mrpt::obs::CObservationOdometry odometry(double stamp, const CPose2D& pose) {
  mrpt::obs::CObservationOdometry result;
  result.timestamp = mrpt::Clock::fromDouble(stamp);
  result.odometry = pose;
  return result;
}

std::string action_2d(double stamp, const CPose2D& increment) {
  mrpt::obs::CActionRobotMovement2D action;
  action.computeFromOdometry(increment, {});
  action.timestamp = stamp < 0 ? INVALID_TIMESTAMP : mrpt::Clock::fromDouble(stamp);
  mrpt::obs::CActionCollection actions;
  actions.insert(action);
  return stored(actions);
}

std::string frame(double stamp) {
  mrpt::obs::CSensoryFrame result;
  auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation>(
      mrpt::rtti::findRegisteredClass("mrpt::obs::CObservation2DRangeScan")->createObject());
  scan->timestamp = mrpt::Clock::fromDouble(stamp);
  result.insert(scan);
  return stored(result);
}

Trajectory read_bytes_of(const std::string& bytes, PoseSource expected) {
  PoseSource source = PoseSource::kNone;
  Trajectory result = read_trajectory(write_file(fresh_folder() / "a.rawlog", bytes), source);
  EXPECT_EQ(source, expected);
  return result;
}

void expect_pose(const Trajectory& trajectory, std::size_t k, double stamp, const CPose3D& pose) {
  ASSERT_LT(k, trajectory.size());
  EXPECT_NEAR(trajectory.stamps()[k], stamp, 1e-6);
  EXPECT_LT(difference(trajectory.pose(k), pose), 1e-9);
}

TEST(ReadTrajectory, RobotPosesGoBeforeOdometry) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = mrpt::Clock::fromDouble(100.25);
  pose.pose.mean = CPose3D(1, 2, 3, 0.1, 0.2, 0.3);
  const auto trajectory =
      read_bytes_of(stored(odometry(100, {5, 5, 0})) + stored(pose), PoseSource::kRobotPose);
  ASSERT_EQ(trajectory.size(), 1u);
  expect_pose(trajectory, 0, 100.25, pose.pose.mean);
}

TEST(ReadTrajectory, OdometryGoesBeforeActions) {
  const auto trajectory = read_bytes_of(action_2d(1, {9, 9, 0}) + stored(odometry(1, {5, 6, 0.5})) +
                                            stored(odometry(2, {7, 8, -0.5})),
                                        PoseSource::kOdometry);
  ASSERT_EQ(trajectory.size(), 2u);
  expect_pose(trajectory, 0, 1, CPose3D(5, 6, 0, 0.5, 0, 0));
  expect_pose(trajectory, 1, 2, CPose3D(7, 8, 0, -0.5, 0, 0));
}

TEST(ReadTrajectory, ActionsAreChainedAndTakeStampsFromFramesWhereTheyHaveNone) {
  const double quarter = 1.5707963267948966;
  const auto trajectory = read_bytes_of(
      action_2d(1, {1, 0, quarter}) + frame(1.5) + action_2d(-1, {2, 0, 0}) + frame(3),
      PoseSource::kActions);
  ASSERT_EQ(trajectory.size(), 2u);
  expect_pose(trajectory, 0, 1, CPose3D(1, 0, 0, quarter, 0, 0));
  expect_pose(trajectory, 1, 3, CPose3D(1, 2, 0, quarter, 0, 0));
}

TEST(ReadTrajectory, ActionsMayBeIn3d) {
  std::string bytes;
  for (int k = 1; k <= 2; ++k) {
    mrpt::obs::CActionRobotMovement3D action;
    action.poseChange.mean = CPose3D(0, 0, 0.5, 0, 0, 0);
    action.timestamp = mrpt::Clock::fromDouble(k);
    mrpt::obs::CActionCollection actions;
    actions.insert(action);
    bytes += stored(actions);
  }
  const auto trajectory = read_bytes_of(bytes, PoseSource::kActions);
  ASSERT_EQ(trajectory.size(), 2u);
  expect_pose(trajectory, 1, 2, CPose3D(0, 0, 1, 0, 0, 0));
}

TEST(ReadTrajectory, KeyframesOfASimpleMap) {
  mrpt::maps::CSimpleMap map;
  for (int k = 0; k < 2; ++k) {
    mrpt::obs::CSensoryFrame keyframe;
    keyframe.insert(mrpt::obs::CObservationOdometry::Create(odometry(10 + k, {})));
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.mean = CPose3D(k, 0, 1, 0, 0.1, 0);
    map.insert(pose, keyframe);
  }
  const auto trajectory = read_bytes_of(gzip(stored(map)), PoseSource::kKeyframes);
  ASSERT_EQ(trajectory.size(), 2u);
  expect_pose(trajectory, 1, 11, CPose3D(1, 0, 1, 0, 0.1, 0));
}

TEST(ReadTrajectory, AFileWithoutPosesGivesNone) {
  EXPECT_TRUE(read_bytes_of(frame(1), PoseSource::kNone).empty());
}

TEST(ReadTrajectory, ACutFileIsAnError) {
  const std::string bytes = stored(odometry(1, {})) + stored(odometry(2, {}));
  const std::string file =
      write_file(fresh_folder() / "a.rawlog", bytes.substr(0, bytes.size() - 1));
  PoseSource source = PoseSource::kNone;
  EXPECT_THROW((void)read_trajectory(file, source), ReadError);
  std::string damage;
  const Trajectory before = read_trajectory(file, source, &damage);
  EXPECT_EQ(before.size(), 1U) << "the poses before the damage";
  EXPECT_EQ(source, PoseSource::kOdometry);
  EXPECT_TRUE(contains(damage, "a.rawlog")) << damage;
}

TEST(ReadTrajectory, OracleTheDemoOfMrptMovesAsItsActionsSay) {
  const auto file = mrpt_datasets() / "localization_demo.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "MRPT's data sets are not installed";
  PoseSource source = PoseSource::kNone;
  const Trajectory trajectory = read_trajectory(file.string(), source);
  EXPECT_EQ(source, PoseSource::kActions);
  EXPECT_GT(trajectory.size(), 10u);
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    EXPECT_LT(trajectory.pose(k).distanceTo(trajectory.pose(k - 1)), 2.0) << k;
  }
}

}  // namespace
}  // namespace mrpt_terrain::io
