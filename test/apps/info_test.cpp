// SPDX-License-Identifier: BSD-3-Clause
// `terrain-rawlog info`.
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "scans.h"

namespace mrpt_terrain::test {
namespace {

ProgramResult info(const std::filesystem::path& folder, const std::string& bytes) {
  return terrain_rawlog(folder, {"info", write_file(folder / "drive.rawlog", bytes)});
}

TEST(Info, NamesSensorsRatesPointsAndSensorPoses) {
  const auto folder = fresh_folder();
  std::string bytes;
  for (int k = 0; k < 3; ++k) {
    Cloud cloud = drive_scan(k);
    cloud.sensorPose = mrpt::poses::CPose3D(1, 2, 0.5, M_PI / 2, 0, 0);
    bytes += stored(cloud);
  }
  mrpt::obs::CObservationRobotPose pose;
  pose.sensorLabel = "gt";
  for (int k = 0; k < 2; ++k) {
    pose.timestamp = mrpt::Clock::fromDouble(1000.0 + k);
    bytes += stored(pose);
  }
  const ProgramResult result = info(folder, bytes);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const std::string line :
       {"5 entries\n", "3 x mrpt::obs::CObservationPointCloud \"lidar\", 10.00 Hz over 0.2 s\n",
        "points of 14 641 returns, times per point: no\n",
        "sensor pose: 1.000 2.000 0.500 90.00 0.00 0.00 (x y z m, yaw pitch roll deg)\n",
        "robot poses: 2 from CObservationRobotPose, t = 1000.000 s to t = 1001.000 s\n"}) {
    EXPECT_TRUE(contains(result.out, line)) << line << "\n" << result.out;
  }
}

TEST(Info, SaysWhatCannotBeDescribedAndWhy) {
  const auto folder = fresh_folder();
  mrpt::obs::CObservation2DRangeScan level;
  level.sensorLabel = "sick";
  level.resizeScanAndAssign(10, 1.0F, true);
  std::string unknown = stored(mrpt::obs::CObservationIMU());
  const std::string name = "CObservationIMU";
  unknown.replace(unknown.find(name), name.size(), "CObservationXYZ");
  const ProgramResult result =
      info(folder, stored(level) + stored(mrpt::obs::CObservationIMU()) + unknown);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const std::string line :
       {"1 x mrpt::obs::CObservation2DRangeScan \"sick\"\n      not described: ",
        "has one level scan plane", "1 x mrpt::obs::CObservationIMU\n      not described: ",
        "1 x mrpt::obs::CObservationXYZ: class unknown to MRPT, passed over\n",
        "robot poses: none\n"}) {
    EXPECT_TRUE(contains(result.out, line)) << line << "\n" << result.out;
  }
}

TEST(Info, DamagedFileIsDescribedUpToTheDamage) {
  const auto folder = fresh_folder();
  const std::size_t third = drive_bytes(2).size();
  const ProgramResult result = info(folder, drive_bytes(3).substr(0, third + 500));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.out, "2 x mrpt::obs::CObservationPointCloud \"lidar\""))
      << result.out;
  EXPECT_TRUE(contains(result.err, "error: " + (folder / "drive.rawlog").string() + ": entry 2 "))
      << result.err;
  EXPECT_TRUE(contains(result.err, "at byte " + std::to_string(third))) << result.err;
}

TEST(Info, GoesOnAfterAMissingFile) {
  const auto folder = fresh_folder();
  const std::string missing = (folder / "none.rawlog").string();
  const std::string file = write_file(folder / "drive.rawlog", drive_bytes(1));
  const ProgramResult result = terrain_rawlog(folder, {"info", missing, file});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + missing + ": no such file\n");
  EXPECT_TRUE(contains(result.out, file + "\n1 entries\n") ||
              contains(result.out, file + "\n1 entry\n"))
      << result.out;
}

TEST(Info, WritesNothing) {
  const auto folder = fresh_folder();
  ASSERT_EQ(info(folder, drive_bytes(1)).exit_code, 0);
  EXPECT_EQ(files_ending_in(folder, ""),
            (std::vector<std::string>{"drive.rawlog", "stderr.txt", "stdout.txt"}));
}

}  // namespace
}  // namespace mrpt_terrain::test
