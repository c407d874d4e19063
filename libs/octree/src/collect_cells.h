// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/octree/insert_scan.h"
#include "ray_set.h"
#include "rays.h"
#include "scan_cells.h"
#include "walk_rays.h"

namespace mrpt_terrain::octree {

/// What `collect_cells` works with.
struct CollectionWorkspace {
  ScanCells cells;
  RaySet rays;
  EndBatch ends;
  RayBatch batch;
};

/// Fills `workspace.cells` with the cells that the rays of a scan cross and end in.
/// \param resolution edge of a cell, metres
template <Ties kTies>
InsertionResult collect_cells(const RayEnds& ends, const RayOrigins& origins,
                              const InsertionOptions& options, double resolution,
                              CollectionWorkspace& workspace);

}  // namespace mrpt_terrain::octree
