// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/io/lazy_load_path.h>

#include <filesystem>

#include "conversion.h"

namespace mrpt_terrain::io {
namespace {

using PointCloud = mrpt::obs::CObservationPointCloud;

/// Loads the points if they are stored outside; the destructor unloads what was loaded here.
class LoadedCloud {
 public:
  explicit LoadedCloud(const PointCloud& observation) : observation_(observation) {
    if (!observation.isExternallyStored() || observation.pointcloud) return;
    const auto file = mrpt::io::lazy_load_absolute_path(observation.getExternalStorageFile());
    const std::string what = name_of(observation) + ": external file '" + file + "' ";
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      failure_ = what + "does not exist";
      return;
    }
    try {
      observation.load();
      loaded_ = true;
    } catch (const std::exception& error) {
      failure_ = what + "cannot be read: " + summary_of(error);
    }
  }
  ~LoadedCloud() {
    // Unloading writes the file if it has vanished meanwhile, which may fail.
    try {
      if (loaded_) observation_.unload();
    } catch (const std::exception&) {
      loaded_ = false;
    }
  }
  LoadedCloud(const LoadedCloud&) = delete;
  LoadedCloud& operator=(const LoadedCloud&) = delete;

  /// Why it could not be loaded; empty if it could.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  const PointCloud& observation_;
  bool loaded_ = false;
  std::string failure_;
};

}  // namespace

Conversion convert(const PointCloud& observation, const InputParams& params, SensorPoints& result) {
  const LoadedCloud loaded(observation);
  if (!loaded.failure().empty()) return {ConversionStatus::kLoadFailed, loaded.failure()};
  if (!observation.pointcloud) {
    return {ConversionStatus::kNoPoints, name_of(observation) + " holds no point cloud"};
  }
  const auto& x = observation.pointcloud->getPointsBufferRef_x();
  const auto& y = observation.pointcloud->getPointsBufferRef_y();
  const auto& z = observation.pointcloud->getPointsBufferRef_z();
  PointSink sink(result, x.size(), limits_of(params), false);
  for (std::size_t k = 0; k < x.size(); ++k) sink.add_point(x[k], y[k], z[k], k);
  sink.finish();
  return {ConversionStatus::kOk, {}};
}

}  // namespace mrpt_terrain::io
