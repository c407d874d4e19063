// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <vector>

#include "mrpt_terrain/octree/free_cells.h"
#include "mrpt_terrain/octree/insert_scan.h"
#include "scan_cells.h"

namespace mrpt_terrain::octree {

/// What `GuardedCells` says, before a scan is entered into a tree: takes those cells out of the
/// free ones that rays only graze, and forgets in the tree what such rays did before.
/// \param[in,out] free may be null; the free cells of the tree
/// \return number of cells that are not freed therefore
std::size_t guard_cells(const std::vector<GuardedCells>& guarded, ScanCells& cells,
                        octomap::OcTree& tree, FreeCells* free);

/// The same for OctoMap's disjoint sets of cells.
struct KeySets {
  octomap::KeySet free, occupied;
};
std::size_t guard_cells(const std::vector<GuardedCells>& guarded, KeySets& cells,
                        octomap::OcTree& tree, FreeCells* free);

}  // namespace mrpt_terrain::octree
