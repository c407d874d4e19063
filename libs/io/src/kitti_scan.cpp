// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/kitti_scan.h"

#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <filesystem>

#include "cloud_map.h"
#include "file_bytes.h"
#include "mrpt_terrain/io/import.h"

namespace mrpt_terrain::io {
namespace {

namespace fs = std::filesystem;

class KittiScanReader : public ObservationReader {
 public:
  explicit KittiScanReader(const std::string& file)
      : scan_(std::make_shared<mrpt::obs::CObservationPointCloud>()) {
    scan_->timestamp = INVALID_TIMESTAMP;
    scan_->sensorLabel = ImportOptions().sensor_label;
    scan_->pointcloud = to_map(read_kitti_scan(file));
  }

  bool next(ReadObservation& result) override {
    if (!scan_) return false;
    summary_.entries = 1;
    ++summary_.observations[scan_->GetRuntimeClass()->className];
    result.observation = std::move(scan_);
    result.entry = 0;
    result.T_map_robot.reset();
    return true;
  }
  [[nodiscard]] const ReadSummary& summary() const override { return summary_; }
  [[nodiscard]] double progress() const override { return scan_ ? 0.0 : 1.0; }

 private:
  mrpt::obs::CObservationPointCloud::Ptr scan_;
  ReadSummary summary_;
};

}  // namespace

std::vector<std::string> find_kitti_scans(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw ReadError(folder + ": is no folder");
  fs::path scans = fs::path(folder) / "velodyne";
  if (!fs::is_directory(scans, error)) scans = folder;
  std::vector<std::string> files;
  fs::directory_iterator entry(scans, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() == ".bin") files.push_back(entry->path().string());
  }
  if (error) throw ReadError(scans.string() + ": cannot be read: " + error.message());
  if (files.empty()) {
    throw ReadError(folder +
                    ": is no KITTI folder: there are no .bin files in it or its velodyne/");
  }
  std::sort(files.begin(), files.end());
  return files;
}

FileCloud read_kitti_scan(const std::string& file) {
  // The first x of a scan may begin as a gzip file does.
  const std::vector<std::uint8_t> bytes = read_bytes(file, Compression::kNone);
  constexpr std::size_t kPoint = 16;
  if (bytes.size() % kPoint != 0) {
    fail_at_byte(file, bytes.size() - bytes.size() % kPoint,
                 "cut off: " + std::to_string(bytes.size()) +
                     " bytes are no whole number of points (x, y, z, intensity as float32)");
  }
  FileCloud cloud;
  const std::size_t count = bytes.size() / kPoint;
  cloud.points.resize(count);
  cloud.intensity.resize(count);
  const ScalarType type{ScalarType::Kind::kFloat, 4};
  const auto value = [&](std::size_t k, std::size_t column) {
    return static_cast<float>(load_scalar(bytes.data() + kPoint * k + 4 * column, type));
  };
  for (std::size_t k = 0; k < count; ++k) {
    cloud.points.x[k] = value(k, 0);
    cloud.points.y[k] = value(k, 1);
    cloud.points.z[k] = value(k, 2);
    cloud.intensity[k] = value(k, 3);
  }
  return cloud;
}

std::unique_ptr<ObservationReader> open_kitti_scan(const std::string& file) {
  return std::make_unique<KittiScanReader>(file);
}

}  // namespace mrpt_terrain::io
