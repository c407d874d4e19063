// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mrpt_terrain/sim/world.h"

namespace mrpt_terrain::sim {

/// Rays, structure of arrays; directions are unit vectors. Map frame, metres, seconds.
struct Rays {
  std::vector<double> origin_x, origin_y, origin_z;
  std::vector<double> direction_x, direction_y, direction_z;
  std::vector<double> time;  ///< of each ray, where movers are; empty: all at 0
  [[nodiscard]] std::size_t size() const { return origin_x.size(); }
  void resize(std::size_t n);
};

/// What rays met first; same length as the rays.
struct Hits {
  std::vector<double> range;         ///< metres; infinite: nothing within reach
  std::vector<std::int32_t> solid;   ///< index into World::solids, or kNoSolid
  std::vector<SurfaceKind> kind;     ///< of the triangle; kObject for media and movers
  std::vector<float> cos_incidence;  ///< |normal . direction| of the surface; 1 for media
  void resize(std::size_t n);
};

/// Where a vertical line meets the terrain.
struct TerrainPoint {
  double height = 0.0;                                ///< metres
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, upwards
  std::int32_t solid = kGroundSolid;
};

/// Casts rays into a world by Embree; ranges are taken again in double precision from the triangle
/// that Embree found, so that they do not depend on the vector unit of the machine. Immutable and
/// safe to share between threads. The world has to stay alive.
class RayCaster {
 public:
  explicit RayCaster(const World& world);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// First hits of all rays up to `max_range`, media left out. Rays with a number that is not
  /// finite or a direction of zero meet nothing.
  void cast(const Rays& rays, double max_range, Hits& hits) const;

  /// Lets rays return from within media: where the random free path of a ray in a medium ends
  /// before its hit, the hit moves there. Layers follow the terrain under them.
  /// \param seed of the free paths; ray k has the random numbers of `first_number` + k
  void scatter(const Rays& rays, double max_range, std::uint64_t seed, std::uint64_t first_number,
               Hits& hits) const;

  /// The terrain at (x, y): the highest surface that a wheel can rest on, or the flank of a pothole
  /// or ditch where there is no such surface. Nothing outside the ground's extent.
  [[nodiscard]] std::optional<TerrainPoint> terrain_at(double x, double y) const;

  /// The highest surface of all that stands still at (x, y), objects included.
  [[nodiscard]] std::optional<TerrainPoint> top_at(double x, double y) const;

  /// `terrain_at` and `top_at` of many places, several times faster than one by one.
  /// \param result one per place; its memory is used again
  void terrain_under(const std::vector<double>& x, const std::vector<double>& y,
                     std::vector<std::optional<TerrainPoint>>& result) const;
  void tops_under(const std::vector<double>& x, const std::vector<double>& y,
                  std::vector<std::optional<TerrainPoint>>& result) const;

  [[nodiscard]] const World& world() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mrpt_terrain::sim
