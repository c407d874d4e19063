// SPDX-License-Identifier: BSD-3-Clause
#include "conversion.h"

namespace mrpt_terrain::io {

Conversion convert(const mrpt::obs::CObservation2DRangeScan& observation, const InputParams& params,
                   SensorPoints& result) {
  const bool nodding = observation.deltaPitch != 0.0;
  if (!nodding && is_level(observation.sensorPose)) return planar_scan(observation);
  const std::size_t rays = observation.getScanSize();
  if (rays == 0) return {ConversionStatus::kNoPoints, name_of(observation) + " has no rays"};
  PointSink sink(result, rays, limits_of(params), false);
  for (std::size_t k = 0; k < rays; ++k) {
    const float range = observation.getScanRange(k);
    if (!std::isfinite(range)) {
      static_cast<void>(sink.accepts_range(static_cast<double>(range)));
    } else if (!observation.getScanRangeValidity(k) || range <= 0.0F ||
               range >= observation.maxRange) {
      sink.add_no_return();
    } else if (sink.accepts_range(static_cast<double>(range))) {
      const double azimuth = observation.getScanAngle(k);
      const double pitch = observation.deltaPitch * static_cast<double>(k) /
                           std::max(1.0, static_cast<double>(rays) - 1.0);
      const double forward = range * std::cos(azimuth);
      sink.put(static_cast<float>(forward * std::cos(pitch)),
               static_cast<float>(range * std::sin(azimuth)),
               static_cast<float>(-forward * std::sin(pitch)), k, 0.0F);
    }
  }
  sink.finish();
  return {ConversionStatus::kOk, {}};
}

}  // namespace mrpt_terrain::io
