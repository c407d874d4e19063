// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/sim/ground_surface.h"
#include "mrpt_terrain/sim/mesh.h"
#include "mrpt_terrain/sim/scene.h"
#include "polygon.h"

namespace mrpt_terrain::sim {

/// A hole in the ground: what lies within its rim is lowered, by `depth` within the floor.
struct Hole {
  std::int32_t solid = 0;   ///< index into `World::solids`
  Polygon rim, floor;       ///< same number of corners; equal where the walls are upright
  double depth = 0.0;       ///< metres
  double wall_angle = 0.0;  ///< from horizontal, radians
  [[nodiscard]] bool upright_walls() const { return rim == floor; }
};

/// Whether the walls of a pothole or ditch have a floor between them; true of all other shapes.
[[nodiscard]] bool leaves_floor(const Shape& shape);

/// How far the ground is lowered at (x, y), metres.
[[nodiscard]] double lowered_by(const std::vector<Hole>& holes, double x, double y);

/// Adds the triangles of the ground to a mesh, holes cut out, and those of the holes' floors and
/// walls. The holes must not overlap.
void add_ground(const GroundSurface& ground, const std::vector<Hole>& holes, Mesh& mesh);

}  // namespace mrpt_terrain::sim
