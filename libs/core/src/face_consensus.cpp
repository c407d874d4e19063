// SPDX-License-Identifier: BSD-3-Clause
#include "face_consensus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "lanes.h"
#include "plane_inliers.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

/// Planes that are tried side by side.
struct Hypotheses {
  std::array<Plane, kCellLanes> plane;
  std::size_t size = 0;
  std::array<float, kCellLanes> a{}, b{}, c{}, d{}, per_square{};

  void add(const Plane& next, float limit) {
    plane[size] = next;
    a[size] = next.a;
    b[size] = next.b;
    c[size] = next.c;
    d[size] = next.d;
    per_square[size++] = 1.0F / (limit * limit);
  }
};

MRPT_TERRAIN_LANES bool any_less(const FloatLanes& costs, float than) {
  std::array<float, kCellLanes> cost;
  std::memcpy(cost.data(), &costs, sizeof(costs));
  bool any = false;
  for (const float value : cost) any |= value < than;
  return any;
}

// Truncated squared distances of the points from each plane, summed up; those that are no less than
// `enough` may lack the last points.
MRPT_TERRAIN_WIDE_REGISTERS
void measure_costs(const PointsView cloud, const Hypotheses& planes, float enough, float* costs) {
  constexpr std::size_t kBetweenLooks = 16;
  FloatLanes a, b, c, d, per_square, cost{};
  load_from(planes.a.data(), a);
  load_from(planes.b.data(), b);
  load_from(planes.c.data(), c);
  load_from(planes.d.data(), d);
  load_from(planes.per_square.data(), per_square);
  const FloatLanes one = FloatLanes{} + 1.0F;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const FloatLanes e = a * cloud.x[i] + b * cloud.y[i] + c * cloud.z[i] + d;
    const FloatLanes square = e * e * per_square;
    cost += one < square ? one : square;
    if (i % kBetweenLooks == kBetweenLooks - 1 && !any_less(cost, enough)) break;
  }
  std::memcpy(costs, &cost, sizeof(cost));
}

}  // namespace

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
  for (int k = 0; k < params.hypotheses;) {
    Hypotheses planes;
    for (; k < params.hypotheses && planes.size < kCellLanes; ++k) {
      const std::optional<Plane> plane = random_plane(cloud, random);
      if (!plane || std::abs(plane->c) < least_upright) continue;
      planes.add(*plane, seed_distance({plane->a, plane->b, plane->c}, beam, params));
    }
    std::array<float, kCellLanes> cost;
    measure_costs(cloud, planes, best_cost, cost.data());
    for (std::size_t p = 0; p < planes.size; ++p) {
      if (!(cost[p] < best_cost)) continue;
      best_cost = cost[p];
      best = beam_plane_of(planes.plane[p]);
    }
  }
  return best;
}

}  // namespace mrpt_terrain
