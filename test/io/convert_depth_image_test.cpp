// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <cmath>

#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using testing::depth_image;
using testing::fresh_folder;

TEST(ConvertDepthImage, LiteralPixelLiesForwardLeftAndUp) {
  auto image = depth_image(40, 80);  // centre at column 40, row 20
  image.rangeImage(10, 15) = 2000;   // 25 pixels left of the centre, 10 above
  SensorPoints points;
  ASSERT_EQ(convert_observation(image, {}, {}, points).status, ConversionStatus::kOk);
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_NEAR(points.points.x[0], 2.0, 1e-5);
  EXPECT_NEAR(points.points.y[0], 2.0 * 25.0 / 100.0, 1e-5);
  EXPECT_NEAR(points.points.z[0], 2.0 * 10.0 / 100.0, 1e-5);
  EXPECT_EQ(points.source_index[0], 10U * 80U + 15U);
  EXPECT_EQ(points.source_size, 3200U);
  EXPECT_EQ(points.counts.no_return, 3199U);
}

TEST(ConvertDepthImage, RangesThatAreNotDepthsAreDistances) {
  auto image = depth_image(40, 80);
  image.range_is_depth = false;
  image.rangeImage(10, 15) = 2000;
  SensorPoints points;
  ASSERT_EQ(convert_observation(image, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_NEAR(std::hypot(points.points.x[0], points.points.y[0], points.points.z[0]), 2.0, 1e-5);
}

TEST(ConvertDepthImage, DecimationTakesEveryNthRowAndColumn) {
  auto image = depth_image(40, 80);
  image.rangeImage.fill(1500);
  InputParams params;
  params.depth_decimation = 3;
  SensorPoints points;
  ASSERT_EQ(convert_observation(image, params, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.points.size(), 14U * 27U);
  EXPECT_EQ(points.source_index[1], 3U);
  EXPECT_EQ(points.source_index[27], 3U * 80U);
}

TEST(ConvertDepthImage, OwnPointsGoBeforeTheRangeImage) {
  auto image = depth_image(4, 4);
  image.rangeImage.fill(1000);
  image.hasPoints3D = true;
  image.points3D_x = {1.0F, 0.0F, 3.0F};
  image.points3D_y = {0.0F, 0.0F, 1.0F};
  image.points3D_z = {0.0F, 0.0F, 1.0F};
  SensorPoints points;
  ASSERT_EQ(convert_observation(image, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.points.x, (std::vector<float>{1, 3}));
  EXPECT_EQ(points.source_size, 3U);
  EXPECT_EQ(points.counts.no_return, 1U);
  image.points3D_idxs_x = {1, 2, 2};
  image.points3D_idxs_y = {0, 1, 2};
  InputParams params;
  params.depth_decimation = 2;
  ASSERT_EQ(convert_observation(image, params, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{10}));
  EXPECT_EQ(points.source_size, 16U);
}

TEST(ConvertDepthImage, PixelsOutsideTheImageAreNotUsedAsSlots) {
  auto image = depth_image(4, 4);
  image.hasPoints3D = true;
  image.points3D_x = image.points3D_y = image.points3D_z = {1.0F, 2.0F};
  image.points3D_idxs_x = {1, 4};
  image.points3D_idxs_y = {0, 0};
  SensorPoints points;
  ASSERT_EQ(convert_observation(image, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.source_index, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(points.source_size, 2U);
}

TEST(ConvertDepthImage, ImagesWithoutRangesOrCalibrationAreRefused) {
  SensorPoints points;
  CObservation3DRangeScan nothing;
  EXPECT_EQ(convert_observation(nothing, {}, {}, points).status, ConversionStatus::kNoPoints);
  auto no_focal_length = depth_image(4, 4);
  no_focal_length.rangeImage.fill(1000);
  no_focal_length.cameraParams.setIntrinsicParamsFromValues(0.0, 0.0, 0.0, 0.0);
  const Conversion conversion = convert_observation(no_focal_length, {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kNoPoints);
  EXPECT_FALSE(conversion.reason.empty());
}

/// Stores the points or the ranges of an image outside, as rawlog tools do.
CObservation3DRangeScan stored_outside(bool points, const std::string& folder) {
  auto image = depth_image(4, 4);
  image.rangeImage.fill(1000);
  if (points) {
    image.hasPoints3D = true;
    image.resizePoints3DVectors(2);
    for (std::size_t k = 0; k < 2; ++k) {
      image.points3D_x[k] = image.points3D_y[k] = image.points3D_z[k] = 1.0F;
      image.points3D_idxs_x[k] = image.points3D_idxs_y[k] = static_cast<std::uint16_t>(k);
    }
    image.points3D_convertToExternalStorage("points.bin", folder);
  } else {
    image.rangeImage_convertToExternalStorage("ranges.bin", folder);
  }
  return image;
}

class ExternalImages : public ::testing::TestWithParam<bool> {};

TEST_P(ExternalImages, AreLoadedUnloadedAndNamedWhenMissing) {
  const std::string folder = fresh_folder() + "/";
  const auto image = stored_outside(GetParam(), folder);
  const std::string before = mrpt::img::CImage::getImagesPathBase();
  mrpt::img::CImage::setImagesPathBase(folder);
  SensorPoints points;
  const Conversion conversion = convert_observation(image, {}, {}, points);
  EXPECT_EQ(conversion.status, ConversionStatus::kOk) << conversion.reason;
  EXPECT_EQ(points.points.size(), GetParam() ? 2U : 16U);
  EXPECT_EQ(GetParam() ? image.points3D_x.size() : image.rangeImage.size(), 0U) << "unloaded";
  std::filesystem::remove_all(folder);
  const Conversion missing = convert_observation(image, {}, {}, points);
  EXPECT_EQ(missing.status, ConversionStatus::kLoadFailed);
  EXPECT_NE(missing.reason.find(GetParam() ? "points.bin" : "ranges.bin"), std::string::npos)
      << missing.reason;
  mrpt::img::CImage::setImagesPathBase(before);
}

INSTANTIATE_TEST_SUITE_P(ConvertDepthImage, ExternalImages, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Points" : "Ranges"; });

CObservation3DRangeScan::Ptr real_image() {
  return testing::first_observation<CObservation3DRangeScan>(
      testing::debian_dataset("tests_rgbd.rawlog"));
}

TEST(ConvertDepthImage, OracleUnprojectionOfARealImage) {
  const auto image = real_image();
  if (!image) GTEST_SKIP() << "tests_rgbd.rawlog is missing (Debian package mrpt-common)";
  image->hasPoints3D = false;
  SensorPoints points;
  ASSERT_EQ(convert_observation(*image, {}, {}, points).status, ConversionStatus::kOk);
  mrpt::maps::CSimplePointsMap expected;
  image->unprojectInto(expected);
  ASSERT_EQ(points.points.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_FLOAT_EQ(points.points.x[k], expected.getPointsBufferRef_x()[k]);
    ASSERT_FLOAT_EQ(points.points.y[k], expected.getPointsBufferRef_y()[k]);
    ASSERT_FLOAT_EQ(points.points.z[k], expected.getPointsBufferRef_z()[k]);
  }
}

TEST(ConvertDepthImage, RealStoredPointsKeepTheirPixels) {
  const auto image = real_image();
  if (!image) GTEST_SKIP() << "tests_rgbd.rawlog is missing (Debian package mrpt-common)";
  SensorPoints points;
  ASSERT_EQ(convert_observation(*image, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.points.size(), 273225U);
  EXPECT_EQ(points.source_size, 640U * 480U);
  EXPECT_EQ(points.source_index[0], image->points3D_idxs_y[0] * 640U + 23U);
  for (std::size_t k = 0; k < points.points.size(); k += 1000) {
    const std::size_t pixel = points.source_index[k];
    const double depth = image->rangeImage.data()[pixel] * 0.001;
    EXPECT_NEAR(points.points.x[k], depth, 1e-4);
  }
}

}  // namespace
}  // namespace mrpt_terrain::io
