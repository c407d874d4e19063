// SPDX-License-Identifier: BSD-3-Clause
#include "triangle_set.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mrpt_terrain::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray that counts for nothing; Embree reads some of the numbers of such rays nevertheless.
void blank(std::size_t k, RayPacket& packet) {
  for (auto* field : {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z, packet.ray.dir_x,
                      packet.ray.dir_y, packet.ray.dir_z, packet.ray.tnear, packet.ray.time}) {
    field[k] = 0.0F;
  }
  packet.ray.tfar[k] = -1.0F;
  packet.ray.mask[k] = packet.ray.id[k] = packet.ray.flags[k] = 0;
}

}  // namespace

TriangleSet::TriangleSet(const Mesh& mesh, Part part) {
  for (std::uint32_t t = 0; t < mesh.size(); ++t) {
    if (part == Part::kAll || mesh.kind[t] != SurfaceKind::kObject) triangle_.push_back(t);
  }
  measure(mesh, triangle_);
  std::vector<std::array<float, 3>> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) {
    const Eigen::Vector3f v = (vertex - centre_).cast<float>();
    vertices.push_back({v.x(), v.y(), v.z()});
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(triangle_.size());
  for (const std::uint32_t t : triangle_) triangles.push_back(mesh.triangles[t]);
  scene_ = std::make_unique<EmbreeScene>(vertices, triangles);
}

void TriangleSet::measure(const Mesh& mesh, const std::vector<std::uint32_t>& members) {
  for (const std::uint32_t t : members) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      min_corner_ = min_corner_.cwiseMin(mesh.vertices[v]);
      max_corner_ = max_corner_.cwiseMax(mesh.vertices[v]);
    }
  }
  if (!members.empty()) centre_ = 0.5 * (min_corner_ + max_corner_);
  planes_.resize(mesh.size(), Plane{0.0, 0.0, 0.0, 0.0});
  for (const std::uint32_t t : members) {
    const auto& corners = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices[corners[0]] - centre_;
    const Eigen::Vector3d b = mesh.vertices[corners[1]] - centre_;
    const Eigen::Vector3d c = mesh.vertices[corners[2]] - centre_;
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    planes_[t] = {normal.x(), normal.y(), normal.z(), normal.dot(a + b + c) / 3.0};
  }
}

void TriangleSet::load(const RayBlock& rays, std::size_t k, RayPacket& packet) const {
  packet.ray.org_x[k] = static_cast<float>(rays.ox[k] - centre_.x());
  packet.ray.org_y[k] = static_cast<float>(rays.oy[k] - centre_.y());
  packet.ray.org_z[k] = static_cast<float>(rays.oz[k] - centre_.z());
  packet.ray.dir_x[k] = static_cast<float>(rays.dx[k]);
  packet.ray.dir_y[k] = static_cast<float>(rays.dy[k]);
  packet.ray.dir_z[k] = static_cast<float>(rays.dz[k]);
  packet.ray.tnear[k] = 0.0F;
  // Beyond the limit by more than single precision loses; the limit itself is kept in double.
  packet.ray.tfar[k] = static_cast<float>(rays.max_range[k] * 1.00001 + 1e-4);
  packet.ray.time[k] = 0.0F;
  packet.ray.mask[k] = 0xFFFFFFFFU;
  packet.ray.id[k] = 0;
  packet.ray.flags[k] = 0;
}

double TriangleSet::range_of(const RayBlock& rays, std::size_t k, const SingleHit& hit) const {
  const Plane& plane = planes_[triangle_[hit.primitive]];
  const double approach = plane.nx * rays.dx[k] + plane.ny * rays.dy[k] + plane.nz * rays.dz[k];
  const double room = plane.offset - (plane.nx * (rays.ox[k] - centre_.x()) +
                                      plane.ny * (rays.oy[k] - centre_.y()) +
                                      plane.nz * (rays.oz[k] - centre_.z()));
  const auto single = static_cast<double>(hit.range);
  const double range = room / approach;
  // Almost along the plane the quotient says nothing.
  const bool agrees = std::abs(range - single) <= 0.01 * std::max(1.0, single);
  return std::max(agrees ? range : single, 0.0);
}

void TriangleSet::put(const RayBlock& rays, std::size_t k, const SingleHit& hit,
                      BlockHits& hits) const {
  const double range = range_of(rays, k, hit);
  if (range > rays.max_range[k]) return;
  const std::uint32_t triangle = triangle_[hit.primitive];
  const Plane& plane = planes_[triangle];
  const double approach = plane.nx * rays.dx[k] + plane.ny * rays.dy[k] + plane.nz * rays.dz[k];
  hits.range[k] = range;
  hits.triangle[k] = triangle;
  hits.cos_incidence[k] = std::min(std::abs(approach), 1.0);
}

void TriangleSet::load(const RayBlock& rays, ValidMask& valid, RayPacket& packet,
                       BlockHits& hits) const {
  for (std::size_t k = 0; k < kPacket; ++k) {
    const bool castable =
        k < rays.size && rays.max_range[k] > 0.0 &&
        is_castable({rays.ox[k], rays.oy[k], rays.oz[k]}, {rays.dx[k], rays.dy[k], rays.dz[k]});
    valid.lanes[k] = castable ? -1 : 0;
    packet.hit.geomID[k] = kNoTriangle;
    hits.range[k] = kInfinity;
    hits.triangle[k] = kNoTriangle;
    hits.cos_incidence[k] = 1.0;
    if (castable) {
      load(rays, k, packet);
    } else {
      blank(k, packet);
    }
  }
}

void TriangleSet::cast(const RayBlock& rays, BlockHits& hits) const {
  ValidMask valid;
  RayPacket packet;
  load(rays, valid, packet, hits);
  scene_->intersect(valid, packet);
  for (std::size_t k = 0; k < rays.size; ++k) {
    if (valid.lanes[k] != 0 && packet.hit.geomID[k] != kNoTriangle) {
      put(rays, k, {packet.hit.primID[k], packet.ray.tfar[k]}, hits);
    }
  }
}

void TriangleSet::cast_at_edges(const RayBlock& rays, BlockHits& hits) const {
  constexpr double kStepsPerMetre = 1e6;
  ValidMask valid;
  RayPacket packet;
  load(rays, valid, packet, hits);
  // Whole steps make an order of all triangles, so that it does not matter who comes first.
  std::array<double, kPacket> least_steps;
  std::array<SingleHit, kPacket> best;
  least_steps.fill(kInfinity);
  best.fill({kNoTriangle, 0.0F});
  scene_->for_all_hits(valid, packet, [&](std::size_t k, std::uint32_t primitive, float range) {
    const SingleHit hit{primitive, range};
    const double steps = std::round(range_of(rays, k, hit) * kStepsPerMetre);
    if (std::tie(steps, primitive) >= std::tie(least_steps[k], best[k].primitive)) return;
    least_steps[k] = steps;
    best[k] = hit;
  });
  for (std::size_t k = 0; k < rays.size; ++k) {
    if (best[k].primitive != kNoTriangle) put(rays, k, best[k], hits);
  }
}

Eigen::Vector3d TriangleSet::normal(std::uint32_t triangle) const {
  const Plane& plane = planes_[triangle];
  return {plane.nx, plane.ny, plane.nz};
}

}  // namespace mrpt_terrain::sim
