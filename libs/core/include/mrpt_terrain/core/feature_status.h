// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Whether a feature could be computed. Its numbers mean something only when it is `kOk`.
enum class FeatureStatus : std::uint8_t {
  kOk = 0,
  kNotNeeded,     ///< the class was known without it (the paper computes features in sequence)
  kTooFewPoints,  ///< fewer than three points
  kDegenerate,    ///< the points are on one spot or one line: no plane
  kNoConsensus,   ///< RANSAC found no plane that holds more than its own three points
  kNoOrigin,      ///< the origins of the beams are not known
  kNotPlanar,     ///< no plane explains enough of the points; the numbers are not trustworthy
  kUncertain,     ///< the points leave the angle open; the numbers are not trustworthy
};
constexpr EnumNames<FeatureStatus, 8> enum_names(FeatureStatus) {
  return {{{FeatureStatus::kOk, "ok"},
           {FeatureStatus::kNotNeeded, "not_needed"},
           {FeatureStatus::kTooFewPoints, "too_few_points"},
           {FeatureStatus::kDegenerate, "degenerate"},
           {FeatureStatus::kNoConsensus, "no_consensus"},
           {FeatureStatus::kNoOrigin, "no_origin"},
           {FeatureStatus::kNotPlanar, "not_planar"},
           {FeatureStatus::kUncertain, "uncertain"}}};
}

}  // namespace mrpt_terrain
