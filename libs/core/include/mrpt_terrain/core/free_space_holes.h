// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/ground_surface.h"
#include "mrpt_terrain/core/holes.h"

namespace mrpt_terrain {

/// What counts as a hole that beams have passed through. Metres.
struct FreeSpaceHoleParams {
  double least_depth = 0.2;  ///< of what is free below the ground
  double least_area = 0.2;   ///< square metres
};

/// Scratch memory of `find_free_space_holes`.
struct FreeSpaceHoleWorkspace {
  std::vector<float> depth;           ///< per cell that something is known of; 0: no candidate
  std::vector<std::uint8_t> taken;    ///< per cell: looked at
  std::vector<std::int32_t> members;  ///< cells of one hole
};

/// Looks for holes that beams of one scan or of many have passed through: cells in which space is
/// known to be free from the ground down to at least `least_depth` below it, connected in eight
/// directions. One layer more must be free, as rays along the ground free the layer that it lies
/// in.
///
/// `Description::holes` takes what is found, with kind `kFreeSpace`; depths are lower bounds, and
/// the confidence is the share of the hole's depth that exceeds a layer. Whoever calls this has a
/// map: `CTerrainMap::free_space(box, low, high)` makes the grid out of its octree.
/// \param free of the map
/// \param ground of the scan; where no ground was seen it is that of the coarser levels
/// \param T_map_scan pose of the scan's frame in the map, whose z is up
/// \param[out] holes frame of the scan; overwritten
/// \param[out] hole_cells a row per hole: its entries in `free.cell`, ascending; overwritten
void find_free_space_holes(const FreeSpaceGrid& free, const GroundSurface& ground,
                           const Eigen::Isometry3d& T_map_scan, const FreeSpaceHoleParams& params,
                           FreeSpaceHoleWorkspace& workspace, std::vector<HoleDescription>& holes,
                           IndexRows& hole_cells);

}  // namespace mrpt_terrain
