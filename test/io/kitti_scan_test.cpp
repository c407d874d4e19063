// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/kitti_scan.h"

#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cstring>
#include <limits>

#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;
namespace fs = std::filesystem;

std::string bin(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

TEST(KittiScan, ReadsEverySlotInItsPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const FileCloud cloud = read_kitti_scan(
      write_file(fresh_folder() / "a.bin", bin({1, 2, 3, 0.5F, 0, 0, 0, 0, nan, 5, 6, 1})));
  ASSERT_EQ(cloud.points.size(), 3U);
  EXPECT_EQ(cloud.points.y, (std::vector<float>{2, 0, 5}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.5F, 0, 1}));
  EXPECT_TRUE(std::isnan(cloud.points.x[2]));
}

// One scan in 65536 begins with the two bytes by which gzip files are known.
TEST(KittiScan, AScanThatBeginsLikeAGzipFile) {
  std::string bytes = bin({8, 2, 3, 0});
  bytes[0] = '\x1F';
  bytes[1] = '\x8B';
  const FileCloud cloud = read_kitti_scan(write_file(fresh_folder() / "a.bin", bytes));
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(std::memcmp(cloud.points.x.data(), bytes.data(), 4), 0);
  EXPECT_EQ(cloud.points.y[0], 2.0F);
}

TEST(KittiScan, ErrorsNameTheFile) {
  const auto folder = fresh_folder();
  const auto error_of = [](const std::string& file) {
    return message_of<ReadError>([&] { (void)open_kitti_scan(file); });
  };
  const std::string cut = write_file(folder / "cut.bin", std::string(33, 'x'));
  EXPECT_EQ(error_of(cut), cut +
                               ": byte 32: cut off: 33 bytes are no whole number of points (x, y, "
                               "z, intensity as float32)");
  const std::string empty = write_file(folder / "empty.bin", "");
  EXPECT_EQ(error_of(empty), empty + ": is empty");
  EXPECT_EQ(error_of((folder / "none.bin").string()),
            (folder / "none.bin").string() + ": no such file");
}

TEST(KittiScan, AsAnInputOfOneObservation) {
  const auto reader =
      open_kitti_scan(write_file(fresh_folder() / "a.bin", bin({1, 2, 3, 0.5F, 0, 0, 0, 0})));
  ReadObservation read;
  ASSERT_TRUE(reader->next(read));
  const auto cloud = std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(read.observation);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->pointcloud->size(), 2U);
  EXPECT_EQ(cloud->timestamp, INVALID_TIMESTAMP);
  EXPECT_EQ(cloud->sensorLabel, "lidar");
  EXPECT_FALSE(read.T_map_robot);
  EXPECT_FALSE(reader->next(read));
  EXPECT_EQ(reader->summary().entries, 1U);
}

TEST(KittiScan, FindsTheScansOfAFolderInTheOrderOfTheirNames) {
  const auto folder = fresh_folder();
  fs::create_directories(folder / "set" / "velodyne");
  for (const std::string name : {"000010.bin", "000002.bin", "notes.txt"}) {
    write_file(folder / "set" / "velodyne" / name, "x");
  }
  const auto scans = folder / "set" / "velodyne";
  const std::vector<std::string> expected = {(scans / "000002.bin").string(),
                                             (scans / "000010.bin").string()};
  EXPECT_EQ(find_kitti_scans((folder / "set").string()), expected);
  EXPECT_EQ(find_kitti_scans(scans.string()), expected);
}

}  // namespace
}  // namespace mrpt_terrain::io
