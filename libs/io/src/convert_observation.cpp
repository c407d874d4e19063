// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/core/Clock.h>

#include <limits>

#include "conversion.h"

namespace mrpt_terrain::io {

void SensorPoints::clear() {
  points.clear();
  time.clear();
  source_index.clear();
  source_size = 0;
  T_robot_sensor = mrpt::poses::CPose3D();
  stamp = 0.0;
  counts = {};
}

std::string name_of(const mrpt::obs::CObservation& observation) {
  return std::string(observation.GetRuntimeClass()->className) + " '" + observation.sensorLabel +
         "'";
}

std::string summary_of(const std::exception& error) {
  std::string text = error.what();
  const std::string key = "Message:";
  if (const auto at = text.find(key); at != std::string::npos) {
    text.erase(0, text.find_first_not_of(' ', at + key.size()));
  }
  return text.substr(0, text.find('\n'));
}

PointSink::PointSink(SensorPoints& result, std::size_t slots, RangeLimits limits, bool timed)
    : result_(result),
      limits_(limits),
      min2_(static_cast<float>(limits.min * limits.min)),
      max2_(static_cast<float>(limits.max * limits.max)) {
  result.source_size = slots;
  result.points.resize(slots);
  result.source_index.resize(slots);
  result.time.resize(timed ? slots : 0);
  x_ = result.points.x.data();
  y_ = result.points.y.data();
  z_ = result.points.z.data();
  slot_ = result.source_index.data();
  time_ = timed ? result.time.data() : nullptr;
}

void PointSink::count_rejected(float x, float y, float z) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
    ++counts_.not_finite;
  } else if (x == 0.0F && y == 0.0F && z == 0.0F) {
    ++counts_.no_return;
  } else {
    ++counts_.out_of_range;
  }
}

void PointSink::finish() {
  result_.points.resize(counts_.points);
  result_.source_index.resize(counts_.points);
  if (time_ != nullptr) result_.time.resize(counts_.points);
  result_.counts = counts_;
}

bool is_level(const mrpt::poses::CPose3D& T_robot_sensor) {
  constexpr double kCosine5Degrees = 0.99619469809174555;
  return std::abs(T_robot_sensor.getRotationMatrix()(2, 2)) >= kCosine5Degrees;
}

Conversion planar_scan(const mrpt::obs::CObservation& observation) {
  return {ConversionStatus::kPlanarScan,
          name_of(observation) +
              " has one level scan plane, which says nothing about the ground: use a 3D sensor, or "
              "a 2D one that is tilted by more than 5 degrees"};
}

namespace {

Conversion dispatch(const mrpt::obs::CObservation& observation, const InputParams& params,
                    const sensors::SensorModels& models, SensorPoints& result) {
  using namespace mrpt::obs;  // NOLINT(google-build-using-namespace): five class names
  if (const auto* o = dynamic_cast<const CObservationVelodyneScan*>(&observation)) {
    return convert(*o, params, result);
  }
  if (const auto* o = dynamic_cast<const CObservationPointCloud*>(&observation)) {
    return convert(*o, params, result);
  }
  if (const auto* o = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
    return convert(*o, params, result);
  }
  if (const auto* o = dynamic_cast<const CObservationRotatingScan*>(&observation)) {
    return convert(*o, params, models, result);
  }
  if (const auto* o = dynamic_cast<const CObservation2DRangeScan*>(&observation)) {
    return convert(*o, params, result);
  }
  return {ConversionStatus::kNoGeometry, name_of(observation) + " holds no 3D points"};
}

Conversion no_points(const mrpt::obs::CObservation& observation, const ReturnCounts& counts) {
  return {ConversionStatus::kNoPoints,
          name_of(observation) + " holds no usable point: " + std::to_string(counts.no_return) +
              " without return, " + std::to_string(counts.not_finite) + " not finite, " +
              std::to_string(counts.out_of_range) + " out of range"};
}

}  // namespace

Conversion convert_observation(const mrpt::obs::CObservation& observation,
                               const InputParams& params, const sensors::SensorModels& models,
                               SensorPoints& result) {
  result.clear();
  observation.getSensorPose(result.T_robot_sensor);
  result.stamp = observation.timestamp == INVALID_TIMESTAMP
                     ? std::numeric_limits<double>::quiet_NaN()
                     : mrpt::Clock::toDouble(observation.timestamp);
  Conversion conversion = dispatch(observation, params, models, result);
  if (conversion.status == ConversionStatus::kOk && result.counts.points == 0) {
    conversion = no_points(observation, result.counts);
  }
  return conversion;
}

}  // namespace mrpt_terrain::io
