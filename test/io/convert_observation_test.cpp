// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <vector>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using testing::turning_packet;
using testing::velodyne_scan;
using testing::VelodynePacket;

TEST(ConvertObservation, ClassesWithoutGeometryAreNamed) {
  SensorPoints points;
  mrpt::obs::CObservationIMU imu;
  imu.sensorLabel = "imu0";
  const Conversion conversion = convert_observation(imu, {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kNoGeometry);
  EXPECT_EQ(conversion.reason, "mrpt::obs::CObservationIMU 'imu0' holds no 3D points");
  EXPECT_EQ(convert_observation(mrpt::obs::CObservationOdometry(), {}, {}, points).status,
            ConversionStatus::kNoGeometry);
}

TEST(ConvertObservation, NothingOfTheLastScanIsLeft) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets = {turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000).build()};
  scan.sensorPose.setFromValues(1.0, 2.0, 3.0);
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kOk);
  ASSERT_FALSE(points.time.empty());

  mrpt::obs::CObservationPointCloud cloud;
  cloud.pointcloud = mrpt::maps::CSimplePointsMap::Create();
  cloud.pointcloud->insertPoint(1.0F, 1.0F, 1.0F);
  ASSERT_EQ(convert_observation(cloud, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.points.size(), 1U);
  EXPECT_TRUE(points.time.empty());
  EXPECT_EQ(points.source_size, 1U);
  EXPECT_EQ(points.counts.no_return, 0U);
  EXPECT_EQ(points.T_robot_sensor.x(), 0.0);

  convert_observation(mrpt::obs::CObservationIMU(), {}, {}, points);
  EXPECT_EQ(points.points.size(), 0U);
  EXPECT_EQ(points.source_size, 0U);
  EXPECT_EQ(points.counts.points, 0U);
}

TEST(ConvertObservation, MemoryIsReusedFromScanToScan) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets.assign(5, turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000).build());
  SensorPoints points;
  convert_observation(scan, {}, {}, points);
  const auto* x = points.points.x.data();
  const auto* time = points.time.data();
  const auto* index = points.source_index.data();
  scan.scan_packets.pop_back();
  convert_observation(scan, {}, {}, points);
  scan.scan_packets.push_back(scan.scan_packets[0]);
  convert_observation(scan, {}, {}, points);
  EXPECT_EQ(points.points.x.data(), x);
  EXPECT_EQ(points.time.data(), time);
  EXPECT_EQ(points.source_index.data(), index);
}

TEST(ConvertObservation, MissingTimeStampIsNotANumber) {
  auto scan = velodyne_scan("VLP16");
  SensorPoints points;
  convert_observation(scan, {}, {}, points);
  EXPECT_NEAR(points.stamp, 1000.0, 1e-6);
  scan.timestamp = INVALID_TIMESTAMP;
  convert_observation(scan, {}, {}, points);
  EXPECT_TRUE(std::isnan(points.stamp));
}

TEST(ConvertObservation, SwappedRangeLimitsLeaveNothingAndSaySo) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets = {turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000).build()};
  InputParams params;
  params.min_range = 50.0;
  params.max_range = 5.0;
  SensorPoints points;
  EXPECT_EQ(convert_observation(scan, params, {}, points).status, ConversionStatus::kNoPoints);
  EXPECT_EQ(points.counts.out_of_range, points.source_size);
}

}  // namespace
}  // namespace mrpt_terrain::io
