// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cstring>
#include <sstream>

#include "mrpt_terrain/io/import.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;
using mrpt::poses::CPose3D;
namespace fs = std::filesystem;

std::string bin(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// A data set of three scans of two points each, x = 10 * scan + slot.
fs::path small_set(const fs::path& folder) {
  fs::create_directories(folder / "velodyne");
  fs::create_directories(folder / "labels");
  for (int k = 0; k < 3; ++k) {
    const std::string name = "00000" + std::to_string(k);
    const auto x = static_cast<float>(10 * k);
    write_file(folder / "velodyne" / (name + ".bin"), bin({x, 1, 2, 0.5f, x + 1, 0, 0, 0}));
    write_labels((folder / "labels" / (name + ".label")).string(), {static_cast<unsigned>(k), 99});
  }
  return folder;
}

struct Scan {
  double stamp = 0.0;
  std::vector<float> x;
  CPose3D T_robot_sensor;
  std::optional<CPose3D> T_map_robot;
};

std::vector<Scan> read_back(const std::string& rawlog) {
  std::vector<Scan> scans;
  std::optional<CPose3D> pose;
  double pose_stamp = -1.0;
  const auto reader = open_observations(rawlog);
  for (ReadObservation read; reader->next(read);) {
    const double stamp = mrpt::Clock::toDouble(read.observation->timestamp);
    if (auto robot =
            std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(read.observation)) {
      pose = robot->pose.mean;
      pose_stamp = stamp;
    } else {
      auto cloud = std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(read.observation);
      const auto& x = cloud->pointcloud->getPointsBufferRef_x();
      scans.push_back({stamp, {x.begin(), x.end()}, cloud->sensorPose, pose});
      if (pose) {
        EXPECT_EQ(pose_stamp, stamp);
      }
      pose.reset();
    }
  }
  return scans;
}

TEST(ImportKitti, ImportsScansLabelsTimesAndTumPoses) {
  const auto folder = fresh_folder();
  const auto set = small_set(folder / "set");
  write_file(set / "times.txt", "0.0e+00\n1.5e-01\n3e-01\n");
  write_file(set / "poses.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 2 0 0 0 0 1 0\n");
  ImportOptions options;
  options.T_robot_sensor = CPose3D(0, 0, 1.73, 0, 0, 0);
  const ImportSummary summary =
      import_kitti(set.string(), options, (folder / "out.rawlog").string());
  EXPECT_EQ(summary.scans, 3u);
  EXPECT_EQ(summary.points, 6u);
  EXPECT_EQ(summary.poses, 3u);
  EXPECT_EQ(summary.labelled_scans, 3u);
  const auto scans = read_back(summary.rawlog);
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_NEAR(scans[1].stamp, 0.15, 1e-7);
  EXPECT_EQ(scans[2].x, (std::vector<float>{20, 21}));
  EXPECT_EQ(scans[2].T_robot_sensor.z(), 1.73);
  ASSERT_TRUE(scans[2].T_map_robot);
  EXPECT_LT(difference(*scans[2].T_map_robot, CPose3D(2, 0, -1.73, 3.141592653589793, 0, 0)), 1e-9);
  EXPECT_EQ(read_labels((folder / "out_labels" / "000002.label").string()),
            (std::vector<std::uint32_t>{2, 99}));
  const Trajectory tum = load_tum(summary.poses_file);
  ASSERT_EQ(tum.size(), 3u);
  EXPECT_NEAR(tum.stamps()[1], 0.15, 1e-7);
}

TEST(ImportKitti, CameraPosesBecomePosesOfTheSensor) {
  const auto folder = fresh_folder();
  const auto set = small_set(folder / "set");
  fs::remove_all(set / "labels");
  // The camera looks along the sensor's x: its z is our x, its x our -y, its y our -z; it sits 0.3
  // m ahead of the sensor.
  write_file(set / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n");
  // It goes 5 m ahead and turns 90 degrees to the left (about its -y).
  write_file(set / "poses.txt",
             "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 5\n0 0 -1 0 0 1 0 0 1 0 0 5\n");
  const ImportSummary summary = import_kitti(set.string(), {}, (folder / "out.rawlog").string());
  EXPECT_EQ(summary.labels_folder, "");
  const auto scans = read_back(summary.rawlog);
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_LT(difference(*scans[0].T_map_robot, CPose3D()), 1e-9);
  EXPECT_LT(difference(*scans[1].T_map_robot, CPose3D(5, 0, 0, 0, 0, 0)), 1e-9);
  EXPECT_LT(difference(*scans[2].T_map_robot, CPose3D(5.3, -0.3, 0, 1.5707963267948966, 0, 0)),
            1e-9);
  EXPECT_NEAR(scans[2].stamp, 0.2, 1e-7);
}

TEST(ImportKitti, TakesTheRowThatTheFileNameSaysFromLongerLists) {
  const auto folder = fresh_folder();
  const auto set = small_set(folder / "set");
  fs::remove(set / "velodyne" / "000001.bin");
  write_file(set / "times.txt", "1\n2\n3\n");
  const ImportSummary summary = import_kitti(set.string(), {}, (folder / "out.rawlog").string());
  const auto scans = read_back(summary.rawlog);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1].stamp, 3.0);
  write_file(set / "times.txt", "1\n");
  const std::string message = message_of<ReadError>(
      [&] { (void)import_kitti(set.string(), {}, (folder / "b.rawlog").string()); });
  EXPECT_TRUE(contains(message, "times.txt: holds 1 rows for 2 scans, and none for")) << message;
}

TEST(ImportKitti, TakesAFolderOfScansToo) {
  const auto folder = fresh_folder();
  const auto set = small_set(folder / "set");
  const ImportSummary summary =
      import_kitti((set / "velodyne").string(), {}, (folder / "out.rawlog").string());
  EXPECT_EQ(summary.scans, 3u);
  EXPECT_EQ(summary.poses + summary.labelled_scans, 0u);
}

TEST(ImportKitti, ErrorsNameFileAndPlace) {
  const auto folder = fresh_folder();
  const auto set = small_set(folder / "set");
  const std::string out = (folder / "out.rawlog").string();
  const auto error = [&](const fs::path& file, const std::string& content) {
    const bool existed = fs::exists(file);
    const std::string before = existed ? read_file(file) : "";
    write_file(file, content);
    std::string message = message_of<ReadError>([&] { (void)import_kitti(set.string(), {}, out); });
    if (existed) {
      write_file(file, before);
    } else {
      fs::remove(file);
    }
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(out + ".part"));
    EXPECT_FALSE(fs::exists(folder / "out_labels"));
    EXPECT_EQ(message.substr(0, file.string().size()), file.string());
    return message.substr(std::min(message.size(), file.string().size()));
  };
  EXPECT_TRUE(contains(error(set / "velodyne" / "000001.bin", "12345678901234567890"),
                       ": byte 16: cut off: 20 bytes"));
  EXPECT_EQ(error(set / "velodyne" / "000001.bin", ""), ": is empty");
  EXPECT_EQ(error(set / "labels" / "000001.label", "1234"),
            ": holds 1 labels for a scan of 2 points");
  EXPECT_TRUE(contains(error(set / "times.txt", "1\n2\nx\n"), ":3: is not one number"));
  write_file(set / "calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(error(set / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 2\n"),
            ":2: is not a 3x4 matrix of 12 numbers");
  write_file(set / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_TRUE(contains(error(set / "calib.txt", "P0: 1\n"), ": has no line 'Tr:'"));
  EXPECT_TRUE(contains(
      message_of<ReadError>([&] { (void)import_kitti((folder / "none").string(), {}, out); }),
      "none: is no folder"));
  fs::create_directories(folder / "empty");
  EXPECT_TRUE(contains(
      message_of<ReadError>([&] { (void)import_kitti((folder / "empty").string(), {}, out); }),
      "is no KITTI folder"));
}

TEST(ImportKitti, OracleTheRealPosesAndPoints) {
  const auto set = data_folder() / "kitti_00";
  if (!fs::exists(set)) GTEST_SKIP() << "the data set kitti_00 is not there";
  const auto folder = fresh_folder();
  ImportOptions options;
  options.T_robot_sensor = CPose3D(0.8, 0, 1.73, 0, 0, 0);
  options.max_scans = 2;
  const ImportSummary summary =
      import_kitti(set.string(), options, (folder / "out.rawlog").string());
  EXPECT_EQ(summary.scans, 2u);
  const auto scans = read_back(summary.rawlog);
  ASSERT_EQ(scans.size(), 2u);
  std::istringstream lines(read_file(set / "poses.tum"));
  std::string line;
  for (const Scan& scan : scans) {
    while (std::getline(lines, line) && line[0] == '#') {
    }
    double stamp = 0, x = 0, y = 0, z = 0;
    std::istringstream(line) >> stamp >> x >> y >> z;
    EXPECT_NEAR(scan.stamp, stamp, 1e-6);
    ASSERT_TRUE(scan.T_map_robot);
    const CPose3D T_map_sensor = *scan.T_map_robot + scan.T_robot_sensor;
    EXPECT_NEAR(T_map_sensor.x(), x, 1e-9);
    EXPECT_NEAR(T_map_sensor.y(), y, 1e-9);
    EXPECT_NEAR(T_map_sensor.z(), z, 1e-9);
  }
  const std::string bytes = read_file(set / "velodyne" / "000001.bin");
  ASSERT_EQ(scans[1].x.size(), bytes.size() / 16);
  for (std::size_t k = 0; k < scans[1].x.size(); ++k) {
    ASSERT_EQ(std::memcmp(&scans[1].x[k], bytes.data() + 16 * k, 4), 0) << k;
  }
}

TEST(ImportKitti, RellisKeepsItsZeroReturnsAndLabels) {
  const auto set = data_folder() / "rellis_104";
  if (!fs::exists(set)) GTEST_SKIP() << "the data set rellis_104 is not there";
  const auto folder = fresh_folder();
  const ImportSummary summary = import_kitti(set.string(), {}, (folder / "out.rawlog").string());
  EXPECT_EQ(summary.points, 131072u);
  EXPECT_EQ(read_file(folder / "out_labels" / "000000.label"),
            read_file(set / "labels" / "000104.label"));
}

}  // namespace
}  // namespace mrpt_terrain::io
