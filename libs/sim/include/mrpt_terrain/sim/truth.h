// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/sim/ray_caster.h"
#include "mrpt_terrain/sim/sweep.h"

namespace mrpt_terrain::sim {

/// Truth of the returns of one sweep, in their order (doc/simulation.md has the rules).
struct PointTruth {
  std::vector<std::int32_t> solid;          ///< id of the solid as in the scene; 0: ground
  std::vector<Support> support;             ///< kUnknown: between ground and object, not counted
  std::vector<TerrainClass> terrain_class;  ///< of the solid; kNone: ground without a thing
  std::vector<float> true_range;            ///< metres
  std::vector<float> height;                ///< above the drivable ground, metres
};
[[nodiscard]] PointTruth truth_of(const RayCaster& caster, const Sweep& sweep);

/// Truth of every cell of a grid, whether anything was seen there or not. Arrays are indexed by
/// cell l * cells_w + w. NaN: outside the scene.
struct CellTruth {
  GridGeometry geometry;
  std::vector<float> min, mean, max;   ///< heights of the uppermost surface in the cell, metres
  std::vector<float> ground_height;    ///< of the drivable surface at the centre, metres
  std::vector<float> slope;            ///< of the drivable surface, radians
  std::vector<float> slope_direction;  ///< where it rises, from x towards y, radians
  std::vector<Support> support;
  std::vector<TerrainClass> terrain_class;
};
/// \param T_map_grid pose of the grid; only x, y and yaw move the cells, heights are relative to
/// its z
[[nodiscard]] CellTruth truth_of_cells(const RayCaster& caster, const Eigen::Isometry3d& T_map_grid,
                                       const GridGeometry& geometry);

}  // namespace mrpt_terrain::sim
