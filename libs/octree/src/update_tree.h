// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <vector>

#include "mrpt_terrain/octree/insert_scan.h"
#include "scan_cells.h"

namespace mrpt_terrain::octree {

/// Gives every marked cell its update, occupied before free, in one passage through the tree.
/// \param[out] freed may be null; cells that went from occupied to free are appended
/// \param[in,out] free may be null; the free cells of the tree
void update_tree(const ScanCells& cells, octomap::OcTree& tree, std::vector<FreedCube>* freed,
                 FreeCells* free);

}  // namespace mrpt_terrain::octree
