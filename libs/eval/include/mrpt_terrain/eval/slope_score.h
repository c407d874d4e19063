// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/cluster_score.h"
#include "mrpt_terrain/eval/scan_truth.h"
#include "mrpt_terrain/eval/support_score.h"

namespace mrpt_terrain::eval {

/// One described slope beside its truth, radians.
struct SlopeSample {
  double truth = 0.0;            ///< of the angle
  double angle_error = 0.0;      ///< described minus true
  double direction_error = 0.0;  ///< the same, within (-pi, pi]
  double angle_sigma = 0.0;      ///< stated; 0: not stated
  double direction_sigma = 0.0;
  double distance = 0.0;  ///< metres
};

struct SlopeScore {
  std::vector<SlopeSample> samples;
  std::size_t ramps = 0;     ///< things of class slope that were found as a cluster
  std::size_t no_angle = 0;  ///< of these: the description has no angle
  std::size_t several = 0;   ///< of these: the cluster covers several faces
  void add(const SlopeScore& other);
};

/// Share of a cluster's points on a slope that must lie on one face of it.
inline constexpr double kOneFace = 0.9;
/// Faces less inclined than this are platforms: the slope has no direction there, radians.
inline constexpr double kLeastInclination = 0.0174532925199432958;

/// Compares the slopes of matched things of class slope with the face on which at least `kOneFace`
/// of the points lie that thing and cluster share.
void add_slopes(const ClusterMatching& matching, const ScanTruth& truth, const PointLabels& labels,
                const std::vector<ClusterDescription>& clusters, SlopeScore& score);

/// Statistics of one kind of error; angles in radians, NaN where there are no samples.
struct ErrorSummary {
  std::size_t samples = 0;
  double bias = 0.0, rmse = 0.0;
  double p95 = 0.0;       ///< 95 % of the errors are at most this, in absolute value
  double greatest = 0.0;  ///< in absolute value
  Share in_two_sigma;     ///< of the errors with a stated sigma
};
[[nodiscard]] ErrorSummary summarise(const std::vector<double>& errors,
                                     const std::vector<double>& sigmas);
[[nodiscard]] ErrorSummary angle_summary(const SlopeScore& score);
[[nodiscard]] ErrorSummary direction_summary(const SlopeScore& score);

}  // namespace mrpt_terrain::eval
