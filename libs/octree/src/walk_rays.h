// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rays.h"
#include "scan_cells.h"

namespace mrpt_terrain::octree {

/// Which axis goes first where a ray crosses an edge or a corner.
enum class Ties {
  kAsOctomap,  ///< z before y before x
  kFlipped,    ///< x before y before z; for tests that must notice
};

/// Marks the cells that the rays cross as free, without the cells that they end in, and empties
/// the batch, which has to be prepared. A ray ends with its last cell, or where the next border is
/// beyond its length: rounding can lead it past its last cell. (after Amanatides and Woo, A Fast
/// Voxel Traversal Algorithm for Ray Tracing, 1987)
template <Ties kTies>
void walk_rays(RayBatch& rays, ScanCells& cells);

}  // namespace mrpt_terrain::octree
