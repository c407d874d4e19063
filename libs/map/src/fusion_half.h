// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/apply_free_space.h"
#include "mrpt_terrain/core/describe_fused.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "octree_half.h"

namespace mrpt_terrain {

/// The fused grid of a terrain map, with the memory that its writer uses again.
struct FusionHalf {
  explicit FusionHalf(const FusionParams& given) : params(given), grid(given) {}

  FusionParams params;
  FusedGrid grid;
  FusionWorkspace fusing;
  FusedDescriptionWorkspace describing;
  std::vector<ColumnRequest> columns;
  std::vector<ColumnRequest> sorted_columns;
  std::vector<std::size_t> sort_begin;
  FreeSpaceGrid free;
  std::vector<GuardedGround> guarded;
};

/// Fuses a scan and inserts it into `octree`, if there is one: the heights that its rays have freed
/// leave the grid, what the window has left leaves the OctoMap, and the grid says, if that is
/// wanted, which voxels hold ground.
/// \param time of the scan, seconds
void fuse(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot, double time,
          FusionHalf& fusion, OctreeHalf* octree);

/// Makes an empty grid hold what a snapshot holds, without sharing anything with it.
void copy_tiles(const FusedSnapshot& from, FusedGrid& grid);

}  // namespace mrpt_terrain
