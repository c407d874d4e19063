// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/import_writer.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>

#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

FileCloud small_cloud() {
  FileCloud cloud;
  cloud.points.push_back(1, 2, 3);
  cloud.points.push_back(0, 0, 0);
  cloud.points.push_back(NAN, 5, 6);
  cloud.intensity = {0.25f, 0, 1};
  cloud.labels = {40, 0, 7};
  return cloud;
}

TEST(ImportWriter, KeepsEverySlotInItsPlace) {
  const auto folder = fresh_folder();
  ImportOptions options;
  options.T_robot_sensor = mrpt::poses::CPose3D(0.5, 0, 1.73, 0, 0.1, 0);
  options.sensor_label = "hdl";
  ImportWriter writer((folder / "out.rawlog").string(), options);
  const mrpt::poses::CPose3D pose(1, 2, 3, 0.4, 0, 0);
  writer.add(small_cloud(), 12.5, pose);
  const ImportSummary summary = writer.commit();
  EXPECT_EQ(summary.scans, 1u);
  EXPECT_EQ(summary.points, 3u);
  EXPECT_EQ(summary.poses, 1u);
  EXPECT_EQ(summary.labelled_scans, 1u);
  EXPECT_EQ(summary.poses_file, (folder / "out.tum").string());
  EXPECT_EQ(summary.labels_folder, (folder / "out_labels").string());

  const auto reader = open_observations(summary.rawlog);
  ReadObservation read;
  ASSERT_TRUE(reader->next(read));
  const auto robot = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(read.observation);
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot->pose.mean.distanceTo(pose), 0.0);
  ASSERT_TRUE(reader->next(read));
  const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(read.observation);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->sensorLabel, "hdl");
  EXPECT_EQ(mrpt::Clock::toDouble(scan->timestamp), 12.5);
  EXPECT_NEAR(scan->sensorPose.pitch(), 0.1, 1e-12);
  const auto map = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(scan->pointcloud);
  ASSERT_TRUE(map);
  ASSERT_EQ(map->size(), 3u);
  EXPECT_EQ(map->getPointsBufferRef_y()[0], 2.0f);
  EXPECT_EQ(map->getPointsBufferRef_x()[1], 0.0f);
  EXPECT_TRUE(std::isnan(map->getPointsBufferRef_x()[2]));
  EXPECT_EQ(map->getPointIntensity(0), 0.25f);
  EXPECT_FALSE(reader->next(read));
  EXPECT_EQ(read_labels((folder / "out_labels" / "000000.label").string()),
            (std::vector<std::uint32_t>{40, 0, 7}));
  EXPECT_EQ(load_tum(summary.poses_file).size(), 1u);
}

TEST(ImportWriter, LeavesNothingWithoutCommit) {
  const auto folder = fresh_folder();
  {
    ImportWriter writer((folder / "out.rawlog").string(), {});
    writer.add(small_cloud(), 0, mrpt::poses::CPose3D());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(ImportWriter, ReplacesTheLabelsOfAnEarlierImport) {
  const auto folder = fresh_folder();
  for (const int scans : {3, 1}) {
    ImportWriter writer((folder / "out.rawlog").string(), {});
    for (int k = 0; k < scans; ++k) writer.add(small_cloud(), k, std::nullopt);
    const ImportSummary summary = writer.commit();
    EXPECT_EQ(summary.poses_file, "");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out_labels")) {
      files += entry.path().extension() == ".label" ? 1 : 0;
    }
    EXPECT_EQ(files, static_cast<std::size_t>(scans));
    EXPECT_FALSE(std::filesystem::exists(folder / "out_labels.part"));
  }
}

}  // namespace
}  // namespace mrpt_terrain::io
