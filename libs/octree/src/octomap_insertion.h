// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include "mrpt_terrain/octree/insert_scan.h"

namespace mrpt_terrain::octree {

/// Inserts a scan with OctoMap's own functions, origin by origin into the same two sets of cells.
/// Rays that `insert_scan` leaves out are left out, too.
/// \param[in,out] before may be null; the free cells of the tree before the scan
InsertionResult insert_with_octomap(const RayEnds& ends, const RayOrigins& origins,
                                    const InsertionOptions& options, octomap::OcTree& tree,
                                    FreeCells* before);

}  // namespace mrpt_terrain::octree
