// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/fused_grid.h"

namespace mrpt_terrain {

/// What free space did to the grid.
struct FreeSpaceCounts {
  std::size_t bins_removed = 0;
  std::size_t points_removed = 0;
  std::size_t bins_guarded = 0;  ///< lie in free layers and were kept
};

/// Forgets heights where later rays have found empty space, and remembers the free space above the
/// ground of each cell.
///
/// A bin is looked at if its layer is free in `free` and it was not hit since `free.time`. From the
/// bottom of the cell up, with the *ground* the lowest bin that stays:
/// 1. Without ground below, it goes only if the free span begins `guard_height` or more below its
///    lowest point (rays that graze a surface pass above it, never below), or if two thirds of the
///    known cells within `ground_reach` (at least four) have something `guard_height` or more below
///    it.
/// 2. If it reaches higher than `guard_height` above the lowest point of the ground, it goes, if
///    the free span begins in a layer below it, or within `guard_height` above the ground. (A ray
///    that grazes the roof of a car frees the layer of the roof, but none inside the car.)
/// 3. Otherwise, close above the ground like a curb, it goes once `guard_scans` scans have hit the
///    cell, freed the layer, and not hit it.
/// \param free same lattice as the grid; cells outside the grid are ignored
FreeSpaceCounts apply_free_space(const FreeSpaceGrid& free, const FusionParams& params,
                                 FusedGrid& grid);

/// Ground that rays may cross without anything being gone: they graze it.
struct GuardedGround {
  MapCell cell;
  LayerSpan layers;  ///< those that hold the ground's surface
  /// If all layers from this one up to the ground's are free, the surface is gone: `guard_height`
  /// below its lowest point, as in rule 1 above.
  std::int32_t below = 0;
};

/// Lists the ground of the known cells of a rectangle, without what stands out of the ground
/// around it (second half of rule 1): what an octree beside the grid has to be guarded against.
/// \param[out] found tile by tile; keeps its memory
void find_guarded_ground(const FusedSnapshot& map, const MapCellRect& where,
                         const FusionParams& params, std::vector<GuardedGround>& found);

}  // namespace mrpt_terrain
