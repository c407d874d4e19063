// SPDX-License-Identifier: BSD-3-Clause
#include "medium_caster.h"

#include <algorithm>
#include <cmath>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr PathSpan kNowhere{1.0, 0.0};

PathSpan span_in_rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                           const Eigen::Vector3d& half_extent) {
  PathSpan span{0.0, kInfinity};
  for (int axis = 0; axis < 2; ++axis) {
    const double o = origin[axis], d = direction[axis], h = half_extent[axis];
    if (d == 0.0) {
      if (std::abs(o) > h) return kNowhere;
      continue;
    }
    const double far = std::copysign(h, d);
    span.begin = std::max(span.begin, (-far - o) / d);
    span.end = std::min(span.end, (far - o) / d);
  }
  return span;
}

PathSpan span_in_unit_sphere(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double a = direction.squaredNorm();
  const double b = origin.dot(direction);
  const double c = origin.squaredNorm() - 1.0;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0)) return kNowhere;
  const double root = std::sqrt(discriminant);
  return {std::max(0.0, (-b - root) / a), (-b + root) / a};
}

/// Metres until something returns light, in a medium without end.
double free_path(const Medium& medium, const ScatteredRays& rays, std::size_t ray) {
  // Finalizer of splitmix64: neighbouring rays get unrelated sequences.
  std::uint64_t mixed = rays.first_number + ray + 0x9E3779B97F4A7C15ULL;
  mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBULL;
  mixed ^= mixed >> 31U;
  RandomGenerator random(rays.seed ^ mixed, static_cast<std::uint64_t>(medium.solid));
  return -std::log(1.0 - random.uniform()) / medium.density;
}

void put_return(const Medium& medium, double range, std::size_t ray, Hits& hits) {
  hits.range[ray] = range;
  hits.solid[ray] = medium.solid;
  hits.kind[ray] = SurfaceKind::kObject;
  hits.cos_incidence[ray] = 1.0F;
}

/// Rays on their way through a layer. Where a ray crosses the top of the layer, the ray shifted
/// down by the layer's height meets the terrain; that is exact on slopes too.
class LayerPacket {
 public:
  LayerPacket(const Medium& medium, const TriangleSet& terrain)
      : medium_(medium), terrain_(terrain) {}

  [[nodiscard]] bool full() const { return block_.size == kPacket; }

  void add(const ScatteredRays& rays, std::size_t ray, const PathSpan& span) {
    const std::size_t k = block_.size++;
    ray_[k] = ray;
    at_[k] = span.begin;
    end_[k] = span.end;
    left_[k] = free_path(medium_, rays, ray);
    const Eigen::Vector3d direction = direction_of(rays.rays, ray);
    block_.dx[k] = direction.x();
    block_.dy[k] = direction.y();
    block_.dz[k] = direction.z();
  }

  /// Follows all rays to their end and empties the packet.
  void run(const Rays& rays, Hits& hits) {
    find_sides(rays);
    // A ray crosses the top twice per hill that it passes.
    constexpr int kMaxCrossings = 32;
    for (int crossing = 0; crossing < kMaxCrossings && any_on_the_way(); ++crossing) {
      BlockHits found;
      aim(rays);
      terrain_.cast(block_, found);
      for (std::size_t k = 0; k < block_.size; ++k) advance(found, k, hits);
    }
    block_.size = 0;
  }

 private:
  [[nodiscard]] bool any_on_the_way() const {
    for (std::size_t k = 0; k < block_.size; ++k) {
      if (at_[k] < end_[k]) return true;
    }
    return false;
  }

  /// Shifted rays from where they are now.
  void aim(const Rays& rays) {
    for (std::size_t k = 0; k < block_.size; ++k) {
      block_.ox[k] = rays.origin_x[ray_[k]] + at_[k] * block_.dx[k];
      block_.oy[k] = rays.origin_y[ray_[k]] + at_[k] * block_.dy[k];
      block_.oz[k] = rays.origin_z[ray_[k]] + at_[k] * block_.dz[k] - medium_.height;
      block_.max_range[k] = end_[k] - at_[k];
    }
  }

  /// Whether each ray begins inside of the layer: the shifted origin lies under the terrain.
  void find_sides(const Rays& rays) {
    aim(rays);
    RayBlock down = block_;
    const double top = terrain_.max_corner().z() + 1.0;
    for (std::size_t k = 0; k < block_.size; ++k) {
      down.oz[k] = top;
      down.dx[k] = down.dy[k] = 0.0;
      down.dz[k] = -1.0;
      down.max_range[k] = top - terrain_.min_corner().z() + 1.0;
    }
    BlockHits found;
    terrain_.cast(down, found);
    for (std::size_t k = 0; k < block_.size; ++k) {
      inside_[k] = found.triangle[k] != kNoTriangle && block_.oz[k] < top - found.range[k];
    }
  }

  /// To the next crossing, or to the return before it.
  void advance(const BlockHits& found, std::size_t k, Hits& hits) {
    if (!(at_[k] < end_[k])) return;
    const bool crossed = found.triangle[k] != kNoTriangle;
    const double step = crossed ? found.range[k] : end_[k] - at_[k];
    if (inside_[k] && left_[k] <= step) {
      put_return(medium_, at_[k] + left_[k], ray_[k], hits);
      end_[k] = at_[k];
      return;
    }
    if (inside_[k]) left_[k] -= step;
    // Off the surface just crossed.
    at_[k] += step + 1e-5;
    if (!crossed) return;
    const Eigen::Vector3d normal = terrain_.normal(found.triangle[k]);
    inside_[k] = normal.dot(Eigen::Vector3d(block_.dx[k], block_.dy[k], block_.dz[k])) < 0.0;
  }

  const Medium& medium_;
  const TriangleSet& terrain_;
  RayBlock block_;
  std::array<std::size_t, kPacket> ray_{};
  std::array<double, kPacket> at_{};    ///< place on the ray, metres from its origin
  std::array<double, kPacket> end_{};   ///< where the ray leaves the rectangle or meets something
  std::array<double, kPacket> left_{};  ///< of the free path, metres
  std::array<bool, kPacket> inside_{};
};

}  // namespace

PathSpan span_inside(const Medium& medium, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction) {
  const Eigen::Matrix3d back = medium.T_map_medium.linear().transpose();
  const Eigen::Vector3d o = back * (origin - medium.T_map_medium.translation());
  const Eigen::Vector3d d = back * direction;
  if (medium.form == Medium::Form::kLayer) return span_in_rectangle(o, d, medium.half_extent);
  return span_in_unit_sphere(o.cwiseQuotient(medium.half_extent),
                             d.cwiseQuotient(medium.half_extent));
}

void scatter_in(const Medium& medium, const TriangleSet& terrain, const ScatteredRays& rays,
                Hits& hits) {
  LayerPacket packet(medium, terrain);
  const double highest = terrain.max_corner().z() + medium.height;
  for (std::size_t ray = 0; ray < rays.rays.size(); ++ray) {
    const Eigen::Vector3d origin = origin_of(rays.rays, ray);
    const Eigen::Vector3d direction = direction_of(rays.rays, ray);
    PathSpan span = span_inside(medium, origin, direction);
    span.end = std::min({span.end, hits.range[ray], rays.max_range});
    if (!is_castable(origin, direction) || !(span.begin < span.end)) continue;
    if (medium.form == Medium::Form::kLayer) {
      const double lowest =
          origin.z() + std::min(span.begin * direction.z(), span.end * direction.z());
      if (lowest > highest) continue;
      packet.add(rays, ray, span);
      if (packet.full()) packet.run(rays.rays, hits);
      continue;
    }
    const double range = span.begin + free_path(medium, rays, ray);
    if (range < span.end) put_return(medium, range, ray, hits);
  }
  packet.run(rays.rays, hits);
}

}  // namespace mrpt_terrain::sim
