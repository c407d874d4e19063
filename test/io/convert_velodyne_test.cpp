// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/system/datetime.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using testing::kDegrees;
using testing::turning_packet;
using testing::velodyne_scan;
using testing::VelodynePacket;

constexpr std::size_t kSlotsPerPacket = 384;

SensorPoints converted(const CObservationVelodyneScan& scan, const InputParams& params = {}) {
  SensorPoints result;
  const Conversion conversion = convert_observation(scan, params, {}, result);
  EXPECT_EQ(conversion.status, ConversionStatus::kOk) << conversion.reason;
  return result;
}

std::size_t total(const ReturnCounts& counts) {
  return counts.points + counts.no_return + counts.not_finite + counts.out_of_range;
}

TEST(ConvertVelodyne, LiteralReturnOfTheSecondFiringOfAVlp16) {
  auto scan = velodyne_scan("VLP16");
  VelodynePacket packet(5'000'000, VelodynePacket::kStrongest, VelodynePacket::kVlp16);
  for (std::uint32_t block = 0; block < 12; ++block) packet.azimuth(block, 9000 + 40 * block);
  packet.distance(1, 16 + 1, 5000);  // block 1, second firing, laser 1: +1 degree, 10 m
  scan.scan_packets = {packet.build()};

  const SensorPoints points = converted(scan);
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_EQ(points.source_size, kSlotsPerPacket);
  EXPECT_EQ(points.source_index[0], 32U + 17U);
  EXPECT_EQ(points.counts.no_return, kSlotsPerPacket - 1);
  // 90.4 degrees clockwise at the start of the block, 0.4 degrees per 110.592 us.
  const double azimuth = (90.4 + 0.4 * (55.296 + 2.304) / 110.592) * kDegrees;
  EXPECT_NEAR(points.points.x[0], 10.0 * std::cos(kDegrees) * std::cos(azimuth), 1e-5);
  EXPECT_NEAR(points.points.y[0], -10.0 * std::cos(kDegrees) * std::sin(azimuth), 1e-5);
  EXPECT_NEAR(points.points.z[0], 10.0 * std::sin(kDegrees), 1e-5);
  EXPECT_NEAR(points.time[0], 110.592e-6 + 55.296e-6, 1e-9);
  EXPECT_NEAR(points.stamp, 1000.0, 1e-6);
}

TEST(ConvertVelodyne, AllRingsOfAnHdl32AreRead) {
  auto scan = velodyne_scan("HDL32");
  scan.scan_packets = {turning_packet(0, VelodynePacket::kHdl32, 0, 16, 5000).build()};
  const SensorPoints points = converted(scan);
  ASSERT_EQ(points.points.size(), kSlotsPerPacket);
  const auto& lasers = scan.calibration.laser_corrections;
  for (std::size_t k = 0; k < 32; ++k) {
    EXPECT_NEAR(points.points.z[k], 10.0 * lasers[k].sinVertCorrection, 1e-5) << k;
  }
  EXPECT_NEAR(points.time.back(), 11 * 46.08e-6, 1e-9);
}

TEST(ConvertVelodyne, Hdl64ReadsBothBanksAndItsAzimuthCorrections) {
  auto scan = velodyne_scan("HDL32");
  scan.calibration.laser_corrections.resize(64);
  scan.calibration.laser_corrections[40].azimuthCorrection = 5.0;
  VelodynePacket packet(0, VelodynePacket::kStrongest, 0);
  packet.header(1, 0xddff).azimuth(0, 3000).azimuth(1, 3000);
  packet.distance(0, 8, 1000).distance(1, 8, 1000);  // lasers 8 and 40
  scan.scan_packets = {packet.build()};
  const SensorPoints points = converted(scan);
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_NEAR(std::atan2(-points.points.y[0], points.points.x[0]), 30.0 * kDegrees, 1e-6);
  EXPECT_NEAR(std::atan2(-points.points.y[1], points.points.x[1]), 25.0 * kDegrees, 1e-6);
}

TEST(ConvertVelodyne, SecondEchoesOfDualModeCountOnce) {
  auto scan = velodyne_scan("VLP16");
  VelodynePacket packet(0, VelodynePacket::kDual, VelodynePacket::kVlp16);
  for (std::uint32_t block = 0; block < 12; ++block) packet.azimuth(block, 40 * (block / 2));
  packet.distance(2, 3, 5000).distance(3, 3, 5000);  // one echo, told twice
  packet.distance(4, 3, 5000).distance(5, 3, 4000);  // two echoes
  scan.scan_packets = {packet.build()};
  const SensorPoints points = converted(scan);
  ASSERT_EQ(points.points.size(), 3U);
  EXPECT_EQ(total(points.counts), kSlotsPerPacket);
  EXPECT_NEAR(points.time[0], 110.592e-6, 1e-9);  // blocks 2 and 3 are the second pair
  EXPECT_EQ(points.time[1], points.time[2]);
}

TEST(ConvertVelodyne, DamagedBlocksAreLeftOut) {
  auto scan = velodyne_scan("VLP16");
  auto packet = turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000);
  packet.header(3, 0x1234).header(4, 0xddff);
  scan.scan_packets = {packet.build()};
  const SensorPoints points = converted(scan);
  EXPECT_EQ(points.counts.points, kSlotsPerPacket - 64);
  EXPECT_EQ(points.counts.no_return, 64U);
}

TEST(ConvertVelodyne, TimesRunOnOverTheSensorsHour) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets = {turning_packet(3'599'999'500, VelodynePacket::kVlp16, 0, 40, 5000).build(),
                       turning_packet(827, VelodynePacket::kVlp16, 480, 40, 5000).build()};
  const SensorPoints points = converted(scan);
  ASSERT_EQ(points.time.size(), 2 * kSlotsPerPacket);
  EXPECT_NEAR(points.time[kSlotsPerPacket], 1327e-6, 1e-9);
}

TEST(ConvertVelodyne, RangesOutsideTheLimitsAreCounted) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets = {turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000).build()};
  InputParams params;
  params.max_range = 9.9;
  SensorPoints points;
  const Conversion conversion = convert_observation(scan, params, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kNoPoints);
  EXPECT_EQ(points.counts.out_of_range, kSlotsPerPacket);
  EXPECT_NE(conversion.reason.find("384 out of range"), std::string::npos) << conversion.reason;
  scan.minRange = 10.1;  // the sensor's own limit
  EXPECT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kNoPoints);
}

TEST(ConvertVelodyne, UnknownCalibrationIsRefused) {
  auto scan = velodyne_scan("VLP16");
  scan.scan_packets = {turning_packet(0, VelodynePacket::kVlp16, 0, 40, 5000).build()};
  for (const std::size_t lasers : {0, 8, 128}) {
    scan.calibration.laser_corrections.resize(lasers);
    SensorPoints points;
    const Conversion conversion = convert_observation(scan, {}, {}, points);
    EXPECT_EQ(conversion.status, ConversionStatus::kUnknownModel);
    EXPECT_NE(conversion.reason.find("'velodyne'"), std::string::npos) << conversion.reason;
  }
}

TEST(ConvertVelodyne, GeneratedCloudIsUsedWhereThereAreNoPackets) {
  auto scan = velodyne_scan("VLP16");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scan.point_cloud.x = {1.0F, 0.0F, nan, 500.0F, 2.0F};
  scan.point_cloud.y = {2.0F, 0.0F, 1.0F, 0.0F, 0.0F};
  scan.point_cloud.z = {3.0F, 0.0F, 1.0F, 0.0F, 0.0F};
  SensorPoints points = converted(scan);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{0, 4}));
  EXPECT_EQ(points.source_size, 5U);
  EXPECT_EQ(points.counts.no_return, 1U);
  EXPECT_EQ(points.counts.not_finite, 1U);
  EXPECT_EQ(points.counts.out_of_range, 1U);
  EXPECT_TRUE(points.time.empty());
  for (int k = 0; k < 5; ++k) {
    scan.point_cloud.timestamp.push_back(mrpt::system::timestampAdd(scan.timestamp, 0.01 * k));
  }
  points = converted(scan);
  ASSERT_EQ(points.time.size(), 2U);
  EXPECT_NEAR(points.time[1], 0.04, 1e-6);
}

TEST(ConvertVelodyne, EmptyScanHasNoPoints) {
  SensorPoints points;
  const auto conversion = convert_observation(velodyne_scan("VLP16"), {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kNoPoints);
}

/// Slots of the returns that MRPT 2.5.8 decodes: the first 16 of each block.
std::vector<std::size_t> first_halves(const SensorPoints& points) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < points.points.size(); ++k) {
    if (points.source_index[k] % 32 < 16) result.push_back(k);
  }
  return result;
}

TEST(ConvertVelodyne, OracleMrptDecodesTheSamePointsWhereItDecodesThem) {
  const auto file = testing::debian_dataset("test_velodyne_VLP16.rawlog");
  const auto scan = testing::first_observation<CObservationVelodyneScan>(file);
  if (!scan) GTEST_SKIP() << file << " is missing (Debian package mrpt-common)";
  const SensorPoints points = converted(*scan);
  EXPECT_EQ(points.source_size, 75 * kSlotsPerPacket);
  EXPECT_EQ(total(points.counts), points.source_size);
  EXPECT_NEAR(points.T_robot_sensor.z(), 0.09, 1e-8);

  CObservationVelodyneScan::TGeneratePointCloudParameters all;
  all.minDistance = 0.0F;
  scan->generatePointCloud(all);
  const auto& cloud = scan->point_cloud;
  const auto shared = first_halves(points);
  ASSERT_EQ(shared.size(), cloud.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const std::size_t own = shared[k];
    const double distance =
        std::hypot(points.points.x[own] - cloud.x[k], points.points.y[own] - cloud.y[k],
                   points.points.z[own] - cloud.z[k]);
    // MRPT rounds azimuths to 0.01 degrees and looks them up in a table of 36000 entries that
    // stretches 35999 steps over the full turn: off by up to 0.005 + 0.01 degrees.
    const double range = std::hypot(cloud.x[k], cloud.y[k]);
    worst = std::max(worst, distance / (range * 0.0151 * kDegrees + 1e-4));
  }
  EXPECT_LE(worst, 1.0);
}

TEST(ConvertVelodyne, SecondFiringsLieBetweenTheirNeighboursInARealSweep) {
  const auto file = testing::debian_dataset("test_velodyne_VLP16.rawlog");
  const auto scan = testing::first_observation<CObservationVelodyneScan>(file);
  if (!scan) GTEST_SKIP() << file << " is missing (Debian package mrpt-common)";
  const SensorPoints points = converted(*scan);
  const std::set<float> times(points.time.begin(), points.time.end());
  EXPECT_EQ(times.size(), 1800U);  // 75 packets of 24 firings
  // Azimuth of consecutive firings of laser 0 grows by 0.2 degrees, also from half to half.
  std::vector<double> azimuth(1800, std::nan(""));
  for (std::size_t k = 0; k < points.points.size(); ++k) {
    if (points.source_index[k] % 16 != 0) continue;
    azimuth[points.source_index[k] / 16] = std::atan2(-points.points.y[k], points.points.x[k]);
  }
  std::size_t steps = 0;
  for (std::size_t k = 1; k < azimuth.size(); ++k) {
    if (std::isnan(azimuth[k]) || std::isnan(azimuth[k - 1])) continue;
    EXPECT_NEAR(std::remainder(azimuth[k] - azimuth[k - 1], 2.0 * M_PI), 0.2 * kDegrees,
                0.03 * kDegrees);
    ++steps;
  }
  EXPECT_GT(steps, 900U);
}

}  // namespace
}  // namespace mrpt_terrain::io
