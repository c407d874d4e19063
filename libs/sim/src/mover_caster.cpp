// SPDX-License-Identifier: BSD-3-Clause
#include "mover_caster.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::sim {
namespace {

double time_of(const Rays& rays, std::size_t ray) {
  return rays.time.empty() ? 0.0 : rays.time[ray];
}

}  // namespace

MoverCaster::MoverCaster(const Mover& mover)
    : mover_(mover), triangles_(mover.mesh, TriangleSet::Part::kAll) {}

MoverCaster::Sphere MoverCaster::bounds(const Rays& rays) const {
  double first = 0.0, last = 0.0;
  if (!rays.time.empty()) {
    const auto [low, high] = std::minmax_element(rays.time.begin(), rays.time.end());
    first = *low;
    last = *high;
  }
  // About a point of the mover's upright axis, because it turns about that at the ends.
  const Eigen::Vector3d low = triangles_.min_corner(), high = triangles_.max_corner();
  const Eigen::Vector3d middle(0.0, 0.0, 0.5 * (low.z() + high.z()));
  const Eigen::Vector3d reach = (low - middle).cwiseAbs().cwiseMax((high - middle).cwiseAbs());
  return {mover_.pose_at(0.5 * (first + last)) * middle,
          reach.norm() + 0.5 * mover_.speed * (last - first) + 1e-6};
}

void MoverCaster::cast_block(const Rays& rays, const std::array<std::size_t, kPacket>& members,
                             RayBlock& block, Hits& hits) const {
  for (std::size_t k = 0; k < block.size; ++k) {
    const Eigen::Isometry3d T_mover_map = mover_.pose_at(time_of(rays, members[k])).inverse();
    const Eigen::Vector3d origin = T_mover_map * origin_of(rays, members[k]);
    const Eigen::Vector3d direction = T_mover_map.linear() * direction_of(rays, members[k]);
    block.ox[k] = origin.x();
    block.oy[k] = origin.y();
    block.oz[k] = origin.z();
    block.dx[k] = direction.x();
    block.dy[k] = direction.y();
    block.dz[k] = direction.z();
  }
  BlockHits found;
  triangles_.cast(block, found);
  for (std::size_t k = 0; k < block.size; ++k) {
    const std::size_t ray = members[k];
    if (found.triangle[k] == kNoTriangle || found.range[k] >= hits.range[ray]) continue;
    hits.range[ray] = found.range[k];
    hits.solid[ray] = mover_.solid;
    hits.kind[ray] = SurfaceKind::kObject;
    hits.cos_incidence[ray] = static_cast<float>(found.cos_incidence[k]);
  }
  block.size = 0;
}

void MoverCaster::cast(const Rays& rays, double max_range, Hits& hits) const {
  if (mover_.mesh.size() == 0) return;
  const Sphere sphere = bounds(rays);
  RayBlock block;
  std::array<std::size_t, kPacket> members{};
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    const Eigen::Vector3d to_centre = sphere.centre - origin_of(rays, ray);
    const double along = to_centre.dot(direction_of(rays, ray));
    const double limit = std::min(max_range, hits.range[ray]);
    const double aside = to_centre.squaredNorm() - along * along;
    const bool near = aside <= sphere.radius * sphere.radius && along >= -sphere.radius &&
                      along <= limit + sphere.radius;
    if (!near) continue;
    members[block.size] = ray;
    block.max_range[block.size++] = limit;
    if (block.size == kPacket) cast_block(rays, members, block, hits);
  }
  if (block.size > 0) cast_block(rays, members, block, hits);
}

}  // namespace mrpt_terrain::sim
