// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/sensors/sensor_model.h"

namespace mrpt_terrain {

/// What poses of one observation are judged by.
struct JudgedScan {
  std::optional<std::uint64_t> fingerprint;  ///< of the observation; none: not to be used again
  bool usable = false;                       ///< whether the observation has points
  Points points;                             ///< those that count, robot frame
};

/// The last observation that was judged. Filters ask for hundreds of poses of one observation,
/// which is converted once; whether it is the same one is told by its content, not its address. Any
/// number of threads may ask.
class JudgedScans {
 public:
  /// May throw what MRPT throws about observations that are stored elsewhere.
  [[nodiscard]] std::shared_ptr<const JudgedScan> of(const mrpt::obs::CObservation& observation,
                                                     const MapParams& params,
                                                     const sensors::SensorModels& models) const;

 private:
  mutable std::mutex mutex_;  ///< held for the time of copying a pointer
  mutable std::shared_ptr<const JudgedScan> last_;
};

/// One of every `step` points in a row, each time another one of them: sensors store ring after
/// ring, and every n-th point might be one ring's.
[[nodiscard]] Points thinned(const Points& points, std::size_t step);

/// A number for all that an observation's points depend on. None for those that are stored
/// elsewhere or cannot be serialised.
[[nodiscard]] std::optional<std::uint64_t> fingerprint_of(
    const mrpt::obs::CObservation& observation);

}  // namespace mrpt_terrain
