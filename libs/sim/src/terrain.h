// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "holes.h"
#include "mesh_builder.h"
#include "mrpt_terrain/sim/ground_surface.h"

namespace mrpt_terrain::sim {

/// A drivable top that stands on the ground: a profile drawn out along y.
struct Platform {
  Eigen::Isometry3d T_platform_map;
  Profile profile;
  double width = 0.0;
};

/// Heights that things stand on while the world is being built: the ground with its holes, and the
/// drivable tops that were put on it so far.
class Terrain {
 public:
  Terrain(const GroundSurface& ground, const std::vector<Hole>& holes)
      : ground_(ground), holes_(holes) {}
  void add(Platform platform) { platforms_.push_back(std::move(platform)); }

  [[nodiscard]] const GroundSurface& ground() const { return ground_; }
  [[nodiscard]] double height(double x, double y) const;
  /// Lowest height within a rectangle (sampled, so a little below what the samples say).
  [[nodiscard]] double lowest(const Polygon& rectangle) const;

 private:
  const GroundSurface& ground_;
  const std::vector<Hole>& holes_;
  std::vector<Platform> platforms_;
};

}  // namespace mrpt_terrain::sim
