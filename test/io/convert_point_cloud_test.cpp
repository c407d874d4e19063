// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cstdlib>
#include <fstream>
#include <limits>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::obs::CObservationPointCloud;
using Format = CObservationPointCloud::ExternalStorageFormat;
using testing::fresh_folder;

CObservationPointCloud cloud_of(const std::vector<std::array<float, 3>>& points) {
  CObservationPointCloud observation;
  observation.sensorLabel = "lidar";
  observation.timestamp = mrpt::Clock::fromDouble(1000.0);
  observation.pointcloud = mrpt::maps::CSimplePointsMap::Create();
  observation.pointcloud->resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    observation.pointcloud->setPointFast(k, points[k][0], points[k][1], points[k][2]);
  }
  return observation;
}

CObservationPointCloud external(const std::string& file, Format format) {
  CObservationPointCloud observation;
  observation.sensorLabel = "lidar";
  observation.setAsExternalStorage(file, format);
  return observation;
}

std::string write_kitti(const std::vector<float>& values) {
  const std::string file = fresh_folder() + "/scan.bin";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(float)));
  return file;
}

TEST(ConvertPointCloud, LiteralCloudIsSortedIntoPointsAndCounts) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  auto observation = cloud_of({{1, 2, 3},
                               {0, 0, 0},
                               {nan, 1, 1},
                               {4, 5, -inf},
                               {0.1F, 0.1F, 0.1F},
                               {300, 0, 0},
                               {-4, 5, 6}});
  observation.sensorPose.setFromValues(0.0, 0.0, 1.5);
  SensorPoints points;
  const Conversion conversion = convert_observation(observation, {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kOk);
  EXPECT_TRUE(conversion.reason.empty());
  EXPECT_EQ(points.points.x, (std::vector<float>{1, -4}));
  EXPECT_EQ(points.points.y, (std::vector<float>{2, 5}));
  EXPECT_EQ(points.points.z, (std::vector<float>{3, 6})) << "the sensor's own frame";
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{0, 6}));
  EXPECT_EQ(points.source_size, 7U);
  EXPECT_EQ(points.counts.points, 2U);
  EXPECT_EQ(points.counts.no_return, 1U);
  EXPECT_EQ(points.counts.not_finite, 2U);
  EXPECT_EQ(points.counts.out_of_range, 2U);
  EXPECT_TRUE(points.time.empty());
  EXPECT_EQ(points.T_robot_sensor.z(), 1.5);
  EXPECT_NEAR(points.stamp, 1000.0, 1e-6);
}

TEST(ConvertPointCloud, RangeLimitsAreInclusive) {
  InputParams params;
  params.min_range = 1.0;
  params.max_range = 2.0;
  SensorPoints points;
  convert_observation(cloud_of({{1, 0, 0}, {0.999F, 0, 0}, {0, 2, 0}, {0, 0, 2.001F}}), params, {},
                      points);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{0, 2}));
}

TEST(ConvertPointCloud, ZeroReturnsStayOutEvenWithoutALowerLimit) {
  InputParams params;
  params.min_range = 0.0;
  SensorPoints points;
  convert_observation(cloud_of({{0, 0, 0}, {0.01F, 0, 0}}), params, {}, points);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(points.counts.no_return, 1U);
}

TEST(ConvertPointCloud, MissingAndEmptyCloudsHaveNoPoints) {
  SensorPoints points;
  CObservationPointCloud none;
  none.sensorLabel = "lidar";
  const Conversion missing = convert_observation(none, {}, {}, points);
  EXPECT_EQ(missing.status, ConversionStatus::kNoPoints);
  EXPECT_NE(missing.reason.find("CObservationPointCloud 'lidar'"), std::string::npos);
  EXPECT_EQ(convert_observation(cloud_of({}), {}, {}, points).status, ConversionStatus::kNoPoints);
  EXPECT_EQ(convert_observation(cloud_of({{0, 0, 0}}), {}, {}, points).status,
            ConversionStatus::kNoPoints);
}

TEST(ConvertPointCloud, ExternalKittiFileIsLoadedAndUnloaded) {
  const auto observation =
      external(write_kitti({1, 2, 3, 0.5F, 0, 0, 0, 0, 4, 5, 6, 0}), Format::KittiBinFile);
  SensorPoints points;
  const Conversion conversion = convert_observation(observation, {}, {}, points);
  ASSERT_EQ(conversion.status, ConversionStatus::kOk) << conversion.reason;
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(points.source_size, 3U);
  EXPECT_FALSE(observation.pointcloud) << "what was loaded here is unloaded";
}

TEST(ConvertPointCloud, CloudsThatSomebodyElseLoadedStayLoaded) {
  const auto observation = external(write_kitti({1, 2, 3, 0.5F}), Format::KittiBinFile);
  observation.load();
  SensorPoints points;
  ASSERT_EQ(convert_observation(observation, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_TRUE(observation.pointcloud);
}

TEST(ConvertPointCloud, ExternalFilesAreRelativeToTheFolderOfMrpt) {
  const std::string file = write_kitti({1, 2, 3, 0.5F});
  const std::string before = mrpt::io::getLazyLoadPathBase();
  mrpt::io::setLazyLoadPathBase(std::filesystem::path(file).parent_path().string());
  SensorPoints points;
  const auto conversion =
      convert_observation(external("scan.bin", Format::KittiBinFile), {}, {}, points);
  mrpt::io::setLazyLoadPathBase(before);
  EXPECT_EQ(conversion.status, ConversionStatus::kOk) << conversion.reason;
}

TEST(ConvertPointCloud, MissingExternalFileIsNamed) {
  const std::string file = fresh_folder() + "/none.bin";
  SensorPoints points;
  const auto conversion = convert_observation(external(file, Format::KittiBinFile), {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kLoadFailed);
  EXPECT_EQ(conversion.reason, "mrpt::obs::CObservationPointCloud 'lidar': external file '" + file +
                                   "' does not exist");
}

TEST(ConvertPointCloud, DamagedExternalFileIsNamed) {
  const std::string file = fresh_folder() + "/damaged.bin";
  std::ofstream(file) << "this is no serialised point cloud";
  SensorPoints points;
  const auto conversion =
      convert_observation(external(file, Format::MRPT_Serialization), {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kLoadFailed);
  EXPECT_NE(conversion.reason.find("'" + file + "' cannot be read: "), std::string::npos)
      << conversion.reason;
  EXPECT_EQ(conversion.reason.find('\n'), std::string::npos) << "one line";
}

TEST(ConvertPointCloud, ZeroReturnsOfARealScanKeepTheirSlots) {
  const char* configured = std::getenv("TERRAIN_DATA_DIR");
  const std::string data =
      configured != nullptr ? configured : MRPT_TERRAIN_SOURCE_DIR "/../shared/data";
  const std::string folder = data + "/rellis_104/velodyne";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  const auto file = std::filesystem::directory_iterator(folder)->path().string();
  InputParams params;
  params.min_range = 0.0;
  SensorPoints points;
  const auto conversion =
      convert_observation(external(file, Format::KittiBinFile), params, {}, points);
  ASSERT_EQ(conversion.status, ConversionStatus::kOk) << conversion.reason;
  EXPECT_EQ(points.source_size, 131072U);
  EXPECT_EQ(points.counts.no_return, 53364U);
  EXPECT_EQ(points.counts.points, 131072U - 53364U);
}

}  // namespace
}  // namespace mrpt_terrain::io
