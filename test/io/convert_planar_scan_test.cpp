// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cmath>
#include <limits>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using testing::kDegrees;

/// Three rays: right, ahead, left.
CObservation2DRangeScan three_rays(double pitch_deg) {
  CObservation2DRangeScan scan;
  scan.sensorLabel = "laser";
  scan.aperture = static_cast<float>(M_PI);
  scan.resizeScanAndAssign(3, 2.0F, true);
  scan.sensorPose.setFromValues(0.0, 0.0, 1.0, 0.0, pitch_deg * kDegrees, 0.0);
  return scan;
}

TEST(ConvertPlanarScan, LevelScansAreRefusedUpToFiveDegrees) {
  SensorPoints points;
  for (const double pitch : {0.0, 4.9, -4.9, 180.0}) {
    const Conversion conversion = convert_observation(three_rays(pitch), {}, {}, points);
    EXPECT_EQ(conversion.status, ConversionStatus::kPlanarScan) << pitch;
    EXPECT_NE(conversion.reason.find("CObservation2DRangeScan 'laser'"), std::string::npos);
    EXPECT_EQ(points.points.size(), 0U);
  }
  for (const double pitch : {5.1, -5.1, 90.0}) {
    EXPECT_EQ(convert_observation(three_rays(pitch), {}, {}, points).status, ConversionStatus::kOk);
  }
}

TEST(ConvertPlanarScan, LiteralRaysLieInTheSensorsPlane) {
  SensorPoints points;
  ASSERT_EQ(convert_observation(three_rays(45.0), {}, {}, points).status, ConversionStatus::kOk);
  ASSERT_EQ(points.points.size(), 3U);
  EXPECT_NEAR(points.points.y[0], -2.0, 1e-5);
  EXPECT_NEAR(points.points.x[1], 2.0, 1e-5);
  EXPECT_NEAR(points.points.y[2], 2.0, 1e-5);
  EXPECT_EQ(points.points.z, (std::vector<float>{0, 0, 0}));
}

TEST(ConvertPlanarScan, ClockwiseScansAreMirrored) {
  auto scan = three_rays(45.0);
  scan.rightToLeft = false;
  SensorPoints points;
  convert_observation(scan, {}, {}, points);
  EXPECT_NEAR(points.points.y[0], 2.0, 1e-5);
}

TEST(ConvertPlanarScan, NoddingScansLookDownMoreAndMore) {
  auto scan = three_rays(0.0);
  scan.deltaPitch = 60.0 * kDegrees;
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_NEAR(points.points.x[1], 2.0 * std::cos(30.0 * kDegrees), 1e-5);
  EXPECT_NEAR(points.points.z[1], -2.0 * std::sin(30.0 * kDegrees), 1e-5);
}

TEST(ConvertPlanarScan, InvalidRaysAreCounted) {
  auto scan = three_rays(45.0);
  scan.resizeScanAndAssign(6, 2.0F, true);
  scan.setScanRangeValidity(0, false);
  scan.setScanRange(1, scan.maxRange);
  scan.setScanRange(2, std::numeric_limits<float>::quiet_NaN());
  scan.setScanRange(3, 0.1F);
  scan.setScanRange(4, 0.0F);
  SensorPoints points;
  ASSERT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{5}));
  EXPECT_EQ(points.source_size, 6U);
  EXPECT_EQ(points.counts.no_return, 3U);
  EXPECT_EQ(points.counts.not_finite, 1U);
  EXPECT_EQ(points.counts.out_of_range, 1U);
}

TEST(ConvertPlanarScan, ScansWithoutRaysHaveNoPoints) {
  auto scan = three_rays(45.0);
  scan.resizeScan(0);
  SensorPoints points;
  EXPECT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kNoPoints);
}

}  // namespace
}  // namespace mrpt_terrain::io
