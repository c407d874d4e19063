// SPDX-License-Identifier: BSD-3-Clause
#include "judged_scan.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/io/scan.h"

namespace mrpt_terrain {
namespace {

/// Takes a number from the bytes that objects are serialised as. Large arrays go through four
/// lanes, so that multiplications need not wait for each other.
class HashingArchive : public mrpt::serialization::CArchive {
 public:
  [[nodiscard]] std::uint64_t value() const {
    std::uint64_t sum = bytes_;
    for (const std::uint64_t lane : lanes_) sum = mixed(sum, lane);
    return sum ^ (sum >> 29U);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add_array(values.data(), values.size());
  }
  template <class Value>
  void add_array(const Value* values, std::size_t n) {
    const std::uint64_t size = n;
    write(&size, sizeof(size));
    write(values, n * sizeof(Value));
  }
  std::string getArchiveDescription() const override { return "a fingerprint"; }

 private:
  static std::uint64_t mixed(std::uint64_t lane, std::uint64_t word) {
    lane = (lane ^ word) * 0x9E3779B97F4A7C15ULL;
    return lane ^ (lane >> 32U);
  }
  std::size_t read(void*, std::size_t) override { throw std::logic_error("write only"); }
  std::size_t write(const void* from, std::size_t n) override {
    const auto* bytes = static_cast<const unsigned char*>(from);
    std::size_t begin = 0;
    std::array<std::uint64_t, 4> words{};
    for (; begin + sizeof(words) <= n; begin += sizeof(words)) {
      std::memcpy(words.data(), bytes + begin, sizeof(words));
      for (std::size_t k = 0; k < 4; ++k) lanes_[k] = mixed(lanes_[k], words[k]);
    }
    words = {};
    if (begin < n) std::memcpy(words.data(), bytes + begin, n - begin);
    for (std::size_t k = 0; k < 4; ++k) lanes_[k] = mixed(lanes_[k], words[k] + (n << 3U) + k);
    bytes_ += n;
    return n;
  }

  std::array<std::uint64_t, 4> lanes_{1, 2, 3, 4};
  std::uint64_t bytes_ = 0;
};

bool is_stored_elsewhere(const mrpt::obs::CObservation& observation) {
  if (const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation)) {
    return cloud->isExternallyStored();
  }
  if (const auto* image = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    return image->points3D_isExternallyStored() || image->rangeImage_isExternallyStored();
  }
  return false;
}

/// What the points of a depth image depend on. Its colours would be compressed to be serialised.
void add_depth_image(const mrpt::obs::CObservation3DRangeScan& image, HashingArchive& hash) {
  hash << image.sensorPose << image.timestamp << image.sensorLabel << image.cameraParams
       << image.hasPoints3D << image.hasRangeImage << image.range_is_depth << image.rangeUnits;
  for (const auto* axis : {&image.points3D_x, &image.points3D_y, &image.points3D_z}) {
    hash.add(*axis);
  }
  hash.add(image.points3D_idxs_x);
  hash.add(image.points3D_idxs_y);
  hash << static_cast<std::uint64_t>(image.rangeImage.cols());
  hash.add_array(image.rangeImage.data(), static_cast<std::size_t>(image.rangeImage.size()));
}

std::shared_ptr<const JudgedScan> convert(const mrpt::obs::CObservation& observation,
                                          const MapParams& params,
                                          const sensors::SensorModels& models,
                                          std::optional<std::uint64_t> fingerprint) {
  auto result = std::make_shared<JudgedScan>();
  result->fingerprint = fingerprint;
  io::SensorPoints sensor_points;
  const io::Conversion conversion =
      io::convert_observation(observation, params.input, models, sensor_points);
  result->usable = conversion.status == io::ConversionStatus::kOk;
  if (!result->usable) return result;
  io::Scan scan;
  io::to_robot_frame(sensor_points, nullptr, params.input, scan);
  result->points = thinned(scan.points, static_cast<std::size_t>(params.likelihood.decimation));
  return result;
}

}  // namespace

std::shared_ptr<const JudgedScan> JudgedScans::of(const mrpt::obs::CObservation& observation,
                                                  const MapParams& params,
                                                  const sensors::SensorModels& models) const {
  const std::optional<std::uint64_t> fingerprint = fingerprint_of(observation);
  if (!fingerprint) return convert(observation, params, models, fingerprint);
  {
    const std::lock_guard lock(mutex_);
    if (last_ && last_->fingerprint == fingerprint) return last_;
  }
  auto converted = convert(observation, params, models, fingerprint);
  const std::lock_guard lock(mutex_);
  last_ = converted;
  return converted;
}

Points thinned(const Points& points, std::size_t step) {
  if (step <= 1) return points;
  Points result;
  RandomGenerator random(1);
  for (std::size_t begin = 0; begin < points.size(); begin += step) {
    const std::size_t n = std::min(step, points.size() - begin);
    const std::size_t k = begin + random.below(static_cast<std::uint32_t>(n));
    result.push_back(points.x[k], points.y[k], points.z[k]);
  }
  return result;
}

std::optional<std::uint64_t> fingerprint_of(const mrpt::obs::CObservation& observation) {
  if (is_stored_elsewhere(observation)) return std::nullopt;
  try {
    HashingArchive hash;
    const auto* image = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
    if (image != nullptr) {
      add_depth_image(*image, hash);
    } else {
      hash << observation;
    }
    return hash.value();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace mrpt_terrain
