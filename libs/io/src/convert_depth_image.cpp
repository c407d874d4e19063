// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "conversion.h"

namespace mrpt_terrain::io {
namespace {

using DepthImage = mrpt::obs::CObservation3DRangeScan;

bool lacks_points(const DepthImage& observation) {
  return observation.hasPoints3D && observation.points3D_isExternallyStored() &&
         observation.points3D_x.empty();
}

bool lacks_ranges(const DepthImage& observation) {
  return observation.hasRangeImage && observation.rangeImage_isExternallyStored() &&
         observation.rangeImage.rows() == 0;
}

/// Loads what is stored outside; the destructor unloads it if it was loaded here.
class LoadedImage {
 public:
  explicit LoadedImage(const DepthImage& observation) : observation_(observation) {
    if (lacks_points(observation)) {
      load(observation.points3D_getExternalStorageFileAbsolutePath());
    } else if (lacks_ranges(observation) && !observation.hasPoints3D) {
      load(observation.rangeImage_getExternalStorageFileAbsolutePath(""));
    }
  }
  ~LoadedImage() {
    try {
      if (loaded_) observation_.unload();
    } catch (const std::exception&) {
      loaded_ = false;
    }
  }
  LoadedImage(const LoadedImage&) = delete;
  LoadedImage& operator=(const LoadedImage&) = delete;

  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  void load(const std::string& file) {
    const std::string what = name_of(observation_) + ": external file '" + file + "' ";
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      failure_ = what + "does not exist";
      return;
    }
    try {
      loaded_ = true;  // load() may stop half way
      observation_.load();
    } catch (const std::exception& error) {
      failure_ = what + "cannot be read: " + summary_of(error);
    }
  }

  const DepthImage& observation_;
  bool loaded_ = false;
  std::string failure_;
};

bool all_below(const std::vector<std::uint16_t>& indices, std::size_t n, std::size_t limit) {
  return indices.size() == n && std::all_of(indices.begin(), indices.end(),
                                            [limit](std::uint16_t index) { return index < limit; });
}

/// Copies the points that the observation holds; their pixels, where known, are the slots.
void copy_points(const DepthImage& observation, const InputParams& params, SensorPoints& result) {
  const auto& x = observation.points3D_x;
  const auto& y = observation.points3D_y;
  const auto& z = observation.points3D_z;
  const std::size_t n = std::min({x.size(), y.size(), z.size()});
  const auto& column = observation.points3D_idxs_x;
  const auto& row = observation.points3D_idxs_y;
  const std::size_t columns = observation.cameraParams.ncols;
  const std::size_t pixels = columns * observation.cameraParams.nrows;
  // Without pixels of the points, decimation has no rows and columns to work on.
  const bool organised = n <= pixels && all_below(column, n, columns) &&
                         all_below(row, n, observation.cameraParams.nrows);
  const auto step = static_cast<unsigned>(std::max(1, params.depth_decimation));
  PointSink sink(result, organised ? pixels : n, limits_of(params), false);
  for (std::size_t k = 0; k < n; ++k) {
    if (!organised) {
      sink.add_point(x[k], y[k], z[k], k);
    } else if (column[k] % step == 0 && row[k] % step == 0) {
      sink.add_point(x[k], y[k], z[k], row[k] * columns + column[k]);
    }
  }
  sink.finish();
}

/// Unprojects the range image with MRPT's table of pixel directions, which it keeps per camera.
/// Its `unprojectInto` is no choice: it changes the observation that it reads.
Conversion unproject(const DepthImage& observation, const InputParams& params,
                     SensorPoints& result) {
  const auto rows = static_cast<std::size_t>(observation.rangeImage.rows());
  const auto columns = static_cast<std::size_t>(observation.rangeImage.cols());
  const auto& directions = observation.get_unproj_lut();
  if (directions.Kxs.size() != rows * columns) {
    return {ConversionStatus::kNoPoints,
            name_of(observation) + ": the camera's calibration is not for an image of " +
                std::to_string(columns) + " x " + std::to_string(rows) + " pixels"};
  }
  const auto step = static_cast<std::size_t>(std::max(1, params.depth_decimation));
  const std::uint16_t* ranges = observation.rangeImage.data();
  PointSink sink(result, rows * columns, limits_of(params), false);
  for (std::size_t row = 0; row < rows; row += step) {
    for (std::size_t column = 0; column < columns; column += step) {
      const std::size_t pixel = row * columns + column;
      const float range = static_cast<float>(ranges[pixel]) * observation.rangeUnits;
      sink.add_point(directions.Kxs[pixel] * range, directions.Kys[pixel] * range,
                     directions.Kzs[pixel] * range, pixel);
    }
  }
  sink.finish();
  return {ConversionStatus::kOk, {}};
}

}  // namespace

Conversion convert(const DepthImage& observation, const InputParams& params, SensorPoints& result) {
  const LoadedImage loaded(observation);
  if (!loaded.failure().empty()) return {ConversionStatus::kLoadFailed, loaded.failure()};
  if (observation.hasPoints3D && !observation.points3D_x.empty()) {
    copy_points(observation, params, result);
    return {ConversionStatus::kOk, {}};
  }
  if (!observation.hasRangeImage || observation.rangeImage.rows() == 0) {
    return {ConversionStatus::kNoPoints,
            name_of(observation) + " holds neither 3D points nor a range image"};
  }
  try {
    return unproject(observation, params, result);
  } catch (const std::exception& error) {
    return {ConversionStatus::kNoPoints,
            name_of(observation) + ": the range image cannot be unprojected: " + summary_of(error)};
  }
}

}  // namespace mrpt_terrain::io
