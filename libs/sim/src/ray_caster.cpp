// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/ray_caster.h"

#include <algorithm>
#include <limits>

#include "medium_caster.h"
#include "mover_caster.h"
#include "triangle_set.h"

namespace mrpt_terrain::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

RayBlock block_of(const Rays& rays, std::size_t first, double max_range) {
  RayBlock block;
  block.size = std::min(kPacket, rays.size() - first);
  for (std::size_t k = 0; k < block.size; ++k) {
    block.ox[k] = rays.origin_x[first + k];
    block.oy[k] = rays.origin_y[first + k];
    block.oz[k] = rays.origin_z[first + k];
    block.dx[k] = rays.direction_x[first + k];
    block.dy[k] = rays.direction_y[first + k];
    block.dz[k] = rays.direction_z[first + k];
    block.max_range[k] = max_range;
  }
  return block;
}

// Rays from the terrain start above it by more than single precision may lose.
constexpr double kAboveTerrain = 1e-3;

RayBlock block_above(const double* x, const double* y, const double* z, std::size_t n,
                     const Eigen::Vector3d& direction) {
  RayBlock block;
  block.size = n;
  for (std::size_t k = 0; k < n; ++k) {
    block.ox[k] = x[k];
    block.oy[k] = y[k];
    block.oz[k] = z[k] + kAboveTerrain;
    block.dx[k] = direction.x();
    block.dy[k] = direction.y();
    block.dz[k] = direction.z();
    block.max_range[k] = kInfinity;
  }
  return block;
}

}  // namespace

void Rays::resize(std::size_t n) {
  for (auto* field : {&origin_x, &origin_y, &origin_z, &direction_x, &direction_y, &direction_z}) {
    field->resize(n);
  }
}

void Hits::resize(std::size_t n) {
  range.resize(n);
  solid.resize(n);
  kind.resize(n);
  cos_incidence.resize(n);
}

struct RayCaster::Impl {
  explicit Impl(const World& w)
      : world(w),
        all(w.mesh, TriangleSet::Part::kAll),
        terrain(w.mesh, TriangleSet::Part::kTerrain) {
    for (const Mover& mover : w.movers) movers.emplace_back(mover);
  }

  /// The highest triangle of a set over each of up to kPacket places.
  void look_down(const TriangleSet& set, const double* x, const double* y, std::size_t n,
                 std::optional<TerrainPoint>* result) const;

  /// Whether a ray in that direction comes from behind the triangle; false for kNoTriangle.
  [[nodiscard]] bool leaves_solid(std::uint32_t triangle, const Eigen::Vector3d& direction) const {
    return triangle != kNoTriangle && all.normal(triangle).dot(direction) > 0.0;
  }

  const World& world;
  TriangleSet all;
  TriangleSet terrain;
  std::vector<MoverCaster> movers;
};

RayCaster::RayCaster(const World& world) : impl_(std::make_unique<Impl>(world)) {}
RayCaster::~RayCaster() = default;
const World& RayCaster::world() const { return impl_->world; }

void RayCaster::cast(const Rays& rays, double max_range, Hits& hits) const {
  hits.resize(rays.size());
  const Mesh& mesh = impl_->world.mesh;
  BlockHits found;
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const RayBlock block = block_of(rays, first, max_range);
    impl_->all.cast(block, found);
    for (std::size_t k = 0; k < block.size; ++k) {
      const std::uint32_t triangle = found.triangle[k];
      const bool hit = triangle != kNoTriangle;
      hits.range[first + k] = found.range[k];
      hits.solid[first + k] = hit ? mesh.solid[triangle] : kNoSolid;
      hits.kind[first + k] = hit ? mesh.kind[triangle] : SurfaceKind::kObject;
      hits.cos_incidence[first + k] = static_cast<float>(found.cos_incidence[k]);
    }
  }
  for (const MoverCaster& mover : impl_->movers) mover.cast(rays, max_range, hits);
}

void RayCaster::scatter(const Rays& rays, double max_range, std::uint64_t seed,
                        std::uint64_t first_number, Hits& hits) const {
  const ScatteredRays scattered{rays, max_range, seed, first_number};
  for (const Medium& medium : impl_->world.media) {
    scatter_in(medium, impl_->terrain, scattered, hits);
  }
}

void RayCaster::Impl::look_down(const TriangleSet& set, const double* x, const double* y,
                                std::size_t n, std::optional<TerrainPoint>* result) const {
  // Embree may miss the very edge: places there move inwards by what single precision cannot tell.
  const Eigen::Vector2d low = set.min_corner().head<2>(), high = set.max_corner().head<2>();
  const double margin = 1e-6 * (high - low).norm();
  const double top = set.max_corner().z() + 1.0;
  const double reach = top - set.min_corner().z() + 1.0;
  RayBlock block;
  block.size = n;
  for (std::size_t k = 0; k < n; ++k) {
    const bool inside = x[k] >= low.x() && x[k] <= high.x() && y[k] >= low.y() && y[k] <= high.y();
    block.ox[k] = inside ? std::clamp(x[k], low.x() + margin, high.x() - margin) : kInfinity;
    block.oy[k] = inside ? std::clamp(y[k], low.y() + margin, high.y() - margin) : kInfinity;
    block.oz[k] = top;
    block.dx[k] = block.dy[k] = 0.0;
    block.dz[k] = -1.0;
    block.max_range[k] = reach;
  }
  BlockHits found;
  set.cast_at_edges(block, found);
  for (std::size_t k = 0; k < n; ++k) {
    result[k].reset();
    if (found.triangle[k] == kNoTriangle) continue;
    Eigen::Vector3d normal = set.normal(found.triangle[k]);
    if (normal.z() < 0.0) normal = -normal;
    const double shift = normal.x() * (x[k] - block.ox[k]) + normal.y() * (y[k] - block.oy[k]);
    const double rise = normal.z() > 1e-3 ? -shift / normal.z() : 0.0;
    result[k] =
        TerrainPoint{top - found.range[k] + rise, normal, world.mesh.solid[found.triangle[k]],
                     world.mesh.kind[found.triangle[k]]};
  }
}

std::optional<TerrainPoint> RayCaster::terrain_at(double x, double y) const {
  std::optional<TerrainPoint> result;
  impl_->look_down(impl_->terrain, &x, &y, 1, &result);
  return result;
}

std::optional<TerrainPoint> RayCaster::top_at(double x, double y) const {
  std::optional<TerrainPoint> result;
  impl_->look_down(impl_->all, &x, &y, 1, &result);
  return result;
}

void RayCaster::terrain_under(const std::vector<double>& x, const std::vector<double>& y,
                              std::vector<std::optional<TerrainPoint>>& result) const {
  result.resize(x.size());
  for (std::size_t first = 0; first < x.size(); first += kPacket) {
    impl_->look_down(impl_->terrain, &x[first], &y[first], std::min(kPacket, x.size() - first),
                     &result[first]);
  }
}

void RayCaster::tops_under(const std::vector<double>& x, const std::vector<double>& y,
                           std::vector<std::optional<TerrainPoint>>& result) const {
  result.resize(x.size());
  for (std::size_t first = 0; first < x.size(); first += kPacket) {
    impl_->look_down(impl_->all, &x[first], &y[first], std::min(kPacket, x.size() - first),
                     &result[first]);
  }
}

void RayCaster::free_heights_over(const std::vector<double>& x, const std::vector<double>& y,
                                  const std::vector<double>& z, std::vector<double>& result) const {
  // Whatever way a ray leaves a solid, it meets an outer side from behind. Straight up alone would
  // not do: the top of a leg and the slab on it are one plane. No solid lies along this direction.
  static const Eigen::Vector3d kOblique(0.6, 0.64, 0.48);
  result.resize(x.size());
  BlockHits found;
  for (std::size_t first = 0; first < x.size(); first += kPacket) {
    const std::size_t n = std::min(kPacket, x.size() - first);
    RayBlock block = block_above(&x[first], &y[first], &z[first], n, Eigen::Vector3d::UnitZ());
    impl_->all.cast_at_edges(block, found);
    for (std::size_t k = 0; k < n; ++k) {
      const bool inside = impl_->leaves_solid(found.triangle[k], Eigen::Vector3d::UnitZ());
      result[first + k] = inside ? 0.0 : found.range[k] + kAboveTerrain;
    }
    block = block_above(&x[first], &y[first], &z[first], n, kOblique);
    impl_->all.cast_at_edges(block, found);
    for (std::size_t k = 0; k < n; ++k) {
      if (impl_->leaves_solid(found.triangle[k], kOblique)) result[first + k] = 0.0;
    }
  }
}

}  // namespace mrpt_terrain::sim
