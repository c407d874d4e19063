// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "embree_api.h"
#include "mrpt_terrain/sim/mesh.h"
#include "mrpt_terrain/sim/ray_caster.h"

namespace mrpt_terrain::sim {

/// Up to kPacket rays in the frame of a mesh; directions are unit vectors.
struct RayBlock {
  std::size_t size = 0;
  std::array<double, kPacket> ox, oy, oz, dx, dy, dz;
  std::array<double, kPacket> max_range;
};

/// What the rays of a block met.
struct BlockHits {
  std::array<double, kPacket> range;            ///< infinite: nothing
  std::array<std::uint32_t, kPacket> triangle;  ///< of the mesh, or kNoTriangle
  std::array<double, kPacket> cos_incidence;
};

/// Whether a ray can meet anything: finite numbers and a direction that is not zero.
[[nodiscard]] inline bool is_castable(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) {
  const double square = direction.squaredNorm();
  // Embree's own limit is 1e18; nobody is that far away.
  return square > 0.0 && square < 1e15 && origin.squaredNorm() < 1e30;
}

[[nodiscard]] inline Eigen::Vector3d origin_of(const Rays& rays, std::size_t ray) {
  return {rays.origin_x[ray], rays.origin_y[ray], rays.origin_z[ray]};
}
[[nodiscard]] inline Eigen::Vector3d direction_of(const Rays& rays, std::size_t ray) {
  return {rays.direction_x[ray], rays.direction_y[ray], rays.direction_z[ray]};
}

/// Some triangles of a mesh. Embree looks for the triangle in single precision about a centre;
/// where the ray meets it is computed in double.
class TriangleSet {
 public:
  enum class Part : std::uint8_t { kAll, kTerrain };
  TriangleSet(const Mesh& mesh, Part part);

  /// First hits of the rays; those whose numbers are not finite or whose direction is zero meet
  /// nothing. On an edge any of its triangles is found.
  void cast(const RayBlock& rays, BlockHits& hits) const;

  /// The same, slower, and on edges without chance: of triangles at the same range to the
  /// micrometre the one that comes first in the mesh. For regular places in worlds of round
  /// numbers, many of which lie on edges.
  void cast_at_edges(const RayBlock& rays, BlockHits& hits) const;

  /// Unit normal of a triangle of the mesh that belongs to this set.
  [[nodiscard]] Eigen::Vector3d normal(std::uint32_t triangle) const;
  /// Extent of the vertices in use, metres; inverted if there are none.
  [[nodiscard]] const Eigen::Vector3d& min_corner() const { return min_corner_; }
  [[nodiscard]] const Eigen::Vector3d& max_corner() const { return max_corner_; }

 private:
  /// Unit normal and distance from the centre.
  struct Plane {
    double nx, ny, nz, offset;
  };
  /// What Embree found out about one ray.
  struct SingleHit {
    std::uint32_t primitive;
    float range;
  };
  /// Puts the castable rays into a packet and clears the hits.
  void load(const RayBlock& rays, ValidMask& valid, RayPacket& packet, BlockHits& hits) const;
  void load(const RayBlock& rays, std::size_t k, RayPacket& packet) const;
  /// Range in double precision of what ray k met.
  [[nodiscard]] double range_of(const RayBlock& rays, std::size_t k, const SingleHit& hit) const;
  void put(const RayBlock& rays, std::size_t k, const SingleHit& hit, BlockHits& hits) const;
  void measure(const Mesh& mesh, const std::vector<std::uint32_t>& members);

  Eigen::Vector3d min_corner_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max_corner_ = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::vector<Plane> planes_;            ///< one per triangle of the mesh
  std::vector<std::uint32_t> triangle_;  ///< of the mesh, per primitive of the scene
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace mrpt_terrain::sim
