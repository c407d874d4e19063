// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/sim/scene.h"
#include "mrpt_terrain/sim/world.h"
#include "polygon.h"
#include "terrain.h"

namespace mrpt_terrain::sim {

/// Rectangle that a shape covers on the ground.
[[nodiscard]] Polygon footprint_of(const Solid& solid);

/// Adds what stands on the ground to the world: triangles, a mover or a medium, and its measures in
/// `world.solids[index]`. Tops that can be driven on become part of the terrain.
void add_body(const Solid& solid, std::int32_t index, Terrain& terrain, World& world);

}  // namespace mrpt_terrain::sim
