// SPDX-License-Identifier: BSD-3-Clause
#include "face_consensus.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plane_inliers.h"

namespace mrpt_terrain {

float seed_distance(const Eigen::Vector3f& normal, const Eigen::Vector3f& beam,
                    const BeamSlopeParams& params) {
  const float across = std::abs(normal.dot(beam)) + static_cast<float>(kAcrossBeam);
  return std::min(static_cast<float>(params.seed_distance), kAlongBeam * across);
}

std::optional<BeamPlane> consensus_plane(const FaceSlopeWorkspace& workspace,
                                         const Eigen::Vector3f& beam, const BeamSlopeParams& params,
                                         double steepest, RandomGenerator& random) {
  const PointsView cloud{workspace.x.data(), workspace.y.data(), workspace.z.data(),
                         workspace.x.size()};
  const auto least_upright = static_cast<float>(std::cos(steepest));
  float best_cost = std::numeric_limits<float>::max();
  std::optional<BeamPlane> best;
  for (int k = 0; k < params.hypotheses; ++k) {
    const std::optional<Plane> plane = random_plane(cloud, random);
    if (!plane || std::abs(plane->c) < least_upright) continue;
    const float limit = seed_distance({plane->a, plane->b, plane->c}, beam, params);
    const float per_square = 1.0F / (limit * limit);
    float cost = 0.0F;
    for (std::size_t i = 0; i < cloud.size && cost < best_cost; ++i) {
      const float e =
          plane->a * cloud.x[i] + plane->b * cloud.y[i] + plane->c * cloud.z[i] + plane->d;
      cost += std::min(e * e * per_square, 1.0F);
    }
    if (!(cost < best_cost)) continue;
    best_cost = cost;
    best = beam_plane_of(*plane);
  }
  return best;
}

}  // namespace mrpt_terrain
