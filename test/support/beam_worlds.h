// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "lidar.h"
#include "mrpt_terrain/core/describe.h"

/// \file
/// Scans whose noise lies along the beams, described with `slope.method = beam`.
namespace mrpt_terrain::worlds {

inline constexpr std::array<float, 3> kLidarOrigin{0.0F, 0.0F, 0.81F};

/// Moves every point along its beam by normal noise.
inline void add_beam_noise(Points& points, double sigma, RandomGenerator& random) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 beam{points.x[i] - kLidarOrigin[0], points.y[i] - kLidarOrigin[1],
                    points.z[i] - kLidarOrigin[2]};
    const double shift = sigma * normal_deviate(random) / std::sqrt(dot(beam, beam));
    points.x[i] += static_cast<float>(shift * beam.x);
    points.y[i] += static_cast<float>(shift * beam.y);
    points.z[i] += static_cast<float>(shift * beam.z);
  }
}

/// Ramp of the paper's experiments: 1.2 m long, 1 m wide, low edge 1.25 m ahead.
inline constexpr Rect kPaperRamp{1.25, 2.45, -0.5, 0.5};

/// That ramp, with a box of the given side standing on it unless the side is 0.
[[nodiscard]] inline Scene ramp_scene(double angle, double box_side = 0.0) {
  Scene scene;
  scene.solids.push_back(ramp_solid(kPaperRamp, angle, 0));
  if (box_side > 0.0) {
    const Rect box{1.7, 1.7 + box_side, -box_side / 2, box_side / 2};
    scene.solids.push_back(
        box_solid(box, 0.0, std::tan(angle) * (1.7 - kPaperRamp.x0) + box_side, 1));
  }
  return scene;
}

[[nodiscard]] inline DescriptionParams beam_params() {
  DescriptionParams params;
  params.slope.method = SlopeMethod::kBeam;
  params.classes.all_features = true;
  return params;
}

[[nodiscard]] inline Description described(const Points& points,
                                           const DescriptionParams& params = beam_params()) {
  DescriptionWorkspace workspace;
  Description description;
  describe({points.view(), {&kLidarOrigin, nullptr}}, params, workspace, description);
  return description;
}

/// The cluster with the most points.
const ClusterDescription& largest(Description&&) = delete;  // the result would outlive its owner
[[nodiscard]] inline const ClusterDescription& largest(const Description& description) {
  const ClusterDescription* best = &description.things.front();
  for (const ClusterDescription& thing : description.things) {
    if (thing.points > best->points) best = &thing;
  }
  return *best;
}

}  // namespace mrpt_terrain::worlds
