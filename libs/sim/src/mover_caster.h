// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/sim/ray_caster.h"
#include "triangle_set.h"

namespace mrpt_terrain::sim {

/// A thing that moves, ready for rays.
class MoverCaster {
 public:
  explicit MoverCaster(const Mover& mover);

  /// Puts the mover's own hits where they are nearer than what `hits` has.
  void cast(const Rays& rays, double max_range, Hits& hits) const;

 private:
  /// Around the mover wherever it is during a span of time.
  struct Sphere {
    Eigen::Vector3d centre;
    double radius;
  };
  [[nodiscard]] Sphere bounds(const Rays& rays) const;
  void cast_block(const Rays& rays, const std::array<std::size_t, kPacket>& members,
                  RayBlock& block, Hits& hits) const;

  const Mover& mover_;
  TriangleSet triangles_;
};

}  // namespace mrpt_terrain::sim
