// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "mrpt_terrain/io/scan.h"

/// \file
/// What the converters of the observation classes share; not installed.
namespace mrpt_terrain::io {

/// Ranges that count, metres from the sensor, both ends included.
struct RangeLimits {
  double min, max;
};

[[nodiscard]] inline RangeLimits limits_of(const InputParams& params) {
  return {params.min_range, params.max_range};
}

/// The stricter of the user's limits and the sensor's own.
[[nodiscard]] inline RangeLimits limits_of(const InputParams& params, double sensor_min,
                                           double sensor_max) {
  return {std::max(params.min_range, sensor_min), std::min(params.max_range, sensor_max)};
}

/// Class name and sensor label of an observation, for messages.
[[nodiscard]] std::string name_of(const mrpt::obs::CObservation& observation);

/// First sentence of an exception out of MRPT, without its stack trace.
[[nodiscard]] std::string summary_of(const std::exception& error);

/// Sorts the slots of an observation into points and counts; keeps the order of the slots.
class PointSink {
 public:
  /// \param slots at most so many calls of `add_*` follow
  /// \param timed whether the points have times
  PointSink(SensorPoints& result, std::size_t slots, RangeLimits limits, bool timed);

  void add_no_return() { ++counts_.no_return; }

  /// A point whose range is still to be found; (0, 0, 0) marks a ray without return.
  void add_point(float x, float y, float z, std::size_t slot, float time = 0.0F) {
    const float range2 = x * x + y * y + z * z;
    if (range2 >= min2_ && range2 <= max2_ && range2 > 0.0F) {
      put(x, y, z, slot, time);
    } else {
      count_rejected(x, y, z);
    }
  }

  [[nodiscard]] bool accepts_range(double range) {
    if (range >= limits_.min && range <= limits_.max) return true;
    std::isfinite(range) ? ++counts_.out_of_range : ++counts_.not_finite;
    return false;
  }

  /// A point whose range `accepts_range` has accepted.
  void put(float x, float y, float z, std::size_t slot, float time) {
    x_[counts_.points] = x;
    y_[counts_.points] = y;
    z_[counts_.points] = z;
    slot_[counts_.points] = static_cast<std::uint32_t>(slot);
    if (time_ != nullptr) time_[counts_.points] = time;
    ++counts_.points;
  }

  /// Cuts the result to the points that arrived. Call once, at the end.
  void finish();

 private:
  void count_rejected(float x, float y, float z);

  SensorPoints& result_;
  RangeLimits limits_;
  float min2_, max2_;
  float *x_, *y_, *z_, *time_;
  std::uint32_t* slot_;
  ReturnCounts counts_;
};

// One converter per class; `result` comes cleared, with pose and stamp filled in.
Conversion convert(const mrpt::obs::CObservationVelodyneScan& observation,
                   const InputParams& params, SensorPoints& result);
Conversion convert(const mrpt::obs::CObservationPointCloud& observation, const InputParams& params,
                   SensorPoints& result);
Conversion convert(const mrpt::obs::CObservation3DRangeScan& observation, const InputParams& params,
                   SensorPoints& result);
Conversion convert(const mrpt::obs::CObservationRotatingScan& observation,
                   const InputParams& params, const sensors::SensorModels& models,
                   SensorPoints& result);
Conversion convert(const mrpt::obs::CObservation2DRangeScan& observation, const InputParams& params,
                   SensorPoints& result);

/// Whether a scan plane of a sensor so mounted is level to 5 degrees.
[[nodiscard]] bool is_level(const mrpt::poses::CPose3D& T_robot_sensor);
/// The answer for level scan planes.
[[nodiscard]] Conversion planar_scan(const mrpt::obs::CObservation& observation);

}  // namespace mrpt_terrain::io
