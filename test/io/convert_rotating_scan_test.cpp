// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;
using testing::kDegrees;
using testing::rotating_scan;

sensors::SensorModels two_rows() {
  sensors::SensorModels models;
  models.add({"TWO", {}, {10.0 * kDegrees, -20.0 * kDegrees}, 100.0, 10.0, 0, 0.0});
  return models;
}

sensors::SensorModels shipped_models() {
  return sensors::SensorModels::from_folder(MRPT_TERRAIN_SOURCE_DIR "/params/sensors");
}

TEST(ConvertRotatingScan, LiteralFullTurnCounterClockwise) {
  auto scan = rotating_scan("two", 2, 4);  // columns at -180, -90, 0, 90 degrees
  scan.sweepDuration = 0.1;
  scan.rangeImage(0, 3) = 500;
  scan.rangeImage(1, 2) = 200;
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, two_rows(), points).status, ConversionStatus::kOk);
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_EQ(points.source_size, 8U);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{6, 3}));
  EXPECT_EQ(points.counts.no_return, 6U);
  EXPECT_NEAR(points.points.x[0], 2.0 * std::cos(20.0 * kDegrees), 1e-6);
  EXPECT_NEAR(points.points.y[0], 0.0, 1e-6);
  EXPECT_NEAR(points.points.z[0], -2.0 * std::sin(20.0 * kDegrees), 1e-6);
  EXPECT_NEAR(points.points.y[1], 5.0 * std::cos(10.0 * kDegrees), 1e-6);
  EXPECT_NEAR(points.points.z[1], 5.0 * std::sin(10.0 * kDegrees), 1e-6);
  EXPECT_NEAR(points.time[0], 0.05, 1e-9);
  EXPECT_FLOAT_EQ(points.time[1], 0.075F);
}

TEST(ConvertRotatingScan, PartOfATurnEndsWithItsLastColumnAndMayRunClockwise) {
  auto scan = rotating_scan("two", 2, 3);
  scan.startAzimuth = 90.0 * kDegrees;
  scan.azimuthSpan = -180.0 * kDegrees;
  scan.rangeImage(0, 0) = scan.rangeImage(0, 2) = 100;
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, two_rows(), points).status, ConversionStatus::kOk);
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_NEAR(points.points.y[0], std::cos(10.0 * kDegrees), 1e-6);
  EXPECT_NEAR(points.points.y[1], -std::cos(10.0 * kDegrees), 1e-6);
  EXPECT_TRUE(points.time.empty()) << "the sweep's duration is not known";
}

TEST(ConvertRotatingScan, LasersThatFireInTurnLookFartherOn) {
  sensors::SensorModels models;
  models.add({"TWO", {}, {0.0, 0.0}, 100.0, 10.0, 0, 0.001});
  auto scan = rotating_scan("TWO", 2, 4);
  scan.sweepDuration = 0.1;  // 3.6 degrees per millisecond
  scan.rangeImage(0, 2) = scan.rangeImage(1, 2) = 100;
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, models, points).status, ConversionStatus::kOk);
  EXPECT_NEAR(std::atan2(points.points.y[0], points.points.x[0]), 0.0, 1e-6);
  EXPECT_NEAR(std::atan2(points.points.y[1], points.points.x[1]), 3.6 * kDegrees, 1e-6);
}

TEST(ConvertRotatingScan, RowsThatLookAsideAreTurned) {
  sensors::SensorModel model{"TWO", {}, {0.0, 0.0}, 100.0, 10.0, 0, 0.0};
  model.azimuth_offset = {2.0 * kDegrees, -3.0 * kDegrees};
  sensors::SensorModels models;
  models.add(model);
  auto scan = rotating_scan("TWO", 2, 4);
  scan.rangeImage(0, 2) = scan.rangeImage(1, 2) = 100;
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, models, points).status, ConversionStatus::kOk);
  EXPECT_NEAR(std::atan2(points.points.y[0], points.points.x[0]), 2.0 * kDegrees, 1e-6);
  EXPECT_NEAR(std::atan2(points.points.y[1], points.points.x[1]), -3.0 * kDegrees, 1e-6);
}

TEST(ConvertRotatingScan, UnknownModelsAreRefusedWithTheirNameAndRows) {
  SensorPoints points;
  for (const auto& [model, rows] : {std::pair{"OTHER", 2}, std::pair{"TWO", 3}}) {
    const auto scan = rotating_scan(model, static_cast<std::uint16_t>(rows), 4);
    const Conversion conversion = convert_observation(scan, {}, two_rows(), points);
    EXPECT_EQ(conversion.status, ConversionStatus::kUnknownModel);
    const std::string expected =
        "model '" + std::string(model) + "' with " + std::to_string(rows) + " rows";
    EXPECT_NE(conversion.reason.find(expected), std::string::npos) << conversion.reason;
    EXPECT_NE(conversion.reason.find("TWO (2 rows)"), std::string::npos) << conversion.reason;
  }
}

TEST(ConvertRotatingScan, EmptyImagesHaveNoPoints) {
  SensorPoints points;
  EXPECT_EQ(convert_observation(rotating_scan("TWO", 0, 0), {}, two_rows(), points).status,
            ConversionStatus::kNoPoints);
  const Conversion zeros = convert_observation(rotating_scan("TWO", 2, 4), {}, two_rows(), points);
  EXPECT_EQ(zeros.status, ConversionStatus::kNoPoints);
  EXPECT_NE(zeros.reason.find("8 without return"), std::string::npos) << zeros.reason;
}

TEST(ConvertRotatingScan, OneLevelRowIsPlanarAndOneTiltedRowIsNot) {
  auto scan = rotating_scan("2D_SCAN_front", 1, 3);
  scan.startAzimuth = -90.0 * kDegrees;
  scan.azimuthSpan = 180.0 * kDegrees;
  scan.rangeImage.fill(100);
  SensorPoints points;
  const Conversion level = convert_observation(scan, {}, {}, points);
  EXPECT_EQ(level.status, ConversionStatus::kPlanarScan);
  EXPECT_NE(level.reason.find("CObservationRotatingScan 'lidar'"), std::string::npos);
  scan.sensorPose.setFromValues(0.0, 0.0, 1.0, 0.0, 30.0 * kDegrees, 0.0);
  ASSERT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kOk);
  ASSERT_EQ(points.points.size(), 3U);
  EXPECT_NEAR(points.points.y[0], -1.0, 1e-6);
  EXPECT_NEAR(points.points.x[1], 1.0, 1e-6);
  EXPECT_NEAR(points.points.y[2], 1.0, 1e-6);
}

TEST(ConvertRotatingScan, RealPlanarScanIsRefusedWithAReason) {
  const auto file = testing::debian_dataset("rot_scan_2d.rawlog");
  const auto scan = testing::first_observation<CObservationRotatingScan>(file);
  if (!scan) GTEST_SKIP() << file << " is missing (Debian package mrpt-common)";
  SensorPoints points;
  EXPECT_EQ(convert_observation(*scan, {}, shipped_models(), points).status,
            ConversionStatus::kPlanarScan);
}

/// How two sets of points differ that should be the same.
struct Differences {
  std::size_t matched = 0;
  double azimuth = 0.0;           ///< greatest, radians
  double range_and_height = 0.0;  ///< greatest, metres
  double median_distance = 0.0;
};

/// Compares the points of packets with those of the range image that MRPT made of them, matched by
/// packet, firing and laser.
Differences compare(const SensorPoints& packets, const SensorPoints& image, std::size_t lasers,
                    std::size_t width) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> by_firing;
  for (std::size_t k = 0; k < packets.points.size(); ++k) {
    const std::size_t slot = packets.source_index[k];
    by_firing[{slot / lasers, slot % lasers}] = k;
  }
  Differences result;
  std::vector<double> distances;
  for (std::size_t k = 0; k < image.points.size(); ++k) {
    const std::size_t slot = image.source_index[k];
    const auto found = by_firing.find({slot % width, slot / width});
    if (found == by_firing.end()) continue;
    const std::size_t j = found->second;
    EXPECT_NEAR(packets.time[j], image.time[k], 2e-5);
    const Points &a = packets.points, &b = image.points;
    const double turn = std::atan2(a.y[j], a.x[j]) - std::atan2(b.y[k], b.x[k]);
    result.azimuth = std::max(result.azimuth, std::abs(std::remainder(turn, 2.0 * M_PI)));
    result.range_and_height =
        std::max<double>({result.range_and_height, std::abs(a.z[j] - b.z[k]),
                          std::abs(std::hypot(a.x[j], a.y[j]) - std::hypot(b.x[k], b.y[k]))});
    distances.push_back(std::hypot(a.x[j] - b.x[k], a.y[j] - b.y[k], a.z[j] - b.z[k]));
  }
  std::sort(distances.begin(), distances.end());
  result.matched = distances.size();
  if (!distances.empty()) result.median_distance = distances[distances.size() / 2];
  return result;
}

TEST(ConvertRotatingScan, OracleTheSameSweepAsPacketsAndAsImage) {
  const auto packets_file = testing::debian_dataset("test_velodyne_VLP16.rawlog");
  const auto image_file = testing::debian_dataset("rot_scan_velodyne.rawlog");
  const auto packets = testing::first_observation<CObservationVelodyneScan>(packets_file);
  const auto image = testing::first_observation<CObservationRotatingScan>(image_file);
  if (!packets || !image) {
    GTEST_SKIP() << packets_file << " or " << image_file << " is missing (mrpt-common)";
  }
  SensorPoints of_packets, of_image;
  const sensors::SensorModels models = shipped_models();
  ASSERT_EQ(convert_observation(*packets, {}, models, of_packets).status, ConversionStatus::kOk);
  ASSERT_EQ(convert_observation(*image, {}, models, of_image).status, ConversionStatus::kOk);
  EXPECT_EQ(of_packets.stamp, of_image.stamp);
  EXPECT_EQ(of_image.points.size(), 11305U);
  const Differences found = compare(of_packets, of_image, 16, 28800);
  EXPECT_EQ(found.matched, of_image.points.size());
  EXPECT_LE(found.range_and_height, 1e-4);
  // The image holds the mean speed of the turn only. This head turned its first half 0.1 % faster
  // than its second, as the azimuths of the packets say: 0.18 degrees in the middle.
  EXPECT_LE(found.azimuth, 0.18 * kDegrees);
  EXPECT_LE(found.median_distance, 0.02);
}

TEST(ConvertRotatingScan, OracleImagesOfAnHdl32) {
  auto packets = testing::velodyne_scan("HDL32");
  for (std::uint32_t p = 0; p < 20; ++p) {
    packets.scan_packets.push_back(
        testing::turning_packet(553 * p, testing::VelodynePacket::kHdl32, 12 * 16 * p, 16, 5000)
            .build());
  }
  CObservationRotatingScan image;
  image.fromVelodyne(packets);
  SensorPoints of_packets, of_image;
  ASSERT_EQ(convert_observation(packets, {}, {}, of_packets).status, ConversionStatus::kOk);
  ASSERT_EQ(convert_observation(image, {}, shipped_models(), of_image).status,
            ConversionStatus::kOk);
  const Differences found =
      compare(of_packets, of_image, 32, static_cast<std::size_t>(image.columnCount));
  EXPECT_EQ(found.matched, 20U * 12U * 16U);  // MRPT 2.5.8 keeps the first 16 rings only
  EXPECT_LE(found.range_and_height, 1e-4);
  EXPECT_LE(found.azimuth, 0.01 * kDegrees);
}

}  // namespace
}  // namespace mrpt_terrain::io
