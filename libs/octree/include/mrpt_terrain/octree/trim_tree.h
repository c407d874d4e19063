// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <cstddef>
#include <cstdint>

/// \file
/// Removal of everything outside a window, for maps that roll with a robot.
namespace mrpt_terrain::octree {

/// A box of cells by their OctoMap keys, both ends included. Windows whose borders are multiples of
/// 8 or 16 cells are cheaper, because fewer cubes of equal cells are cut into pieces.
struct CellWindow {
  std::array<std::uint16_t, 3> low{};
  std::array<std::uint16_t, 3> high{};  ///< at least `low`
};

struct TrimResult {
  std::size_t removed = 0;  ///< nodes deleted
  std::size_t visited = 0;  ///< nodes that stayed and were looked at: those across the border
};

/// Removes all cells outside the window and keeps the values inside: the tree is then the one that
/// OctoMap would hold if only the cells inside had ever been updated. Subtrees inside are not
/// looked at, so the cost follows what is removed and what lies across the border, not the size of
/// the tree. Requires a tree whose inner nodes are up to date.
TrimResult trim_tree(const CellWindow& window, octomap::OcTree& tree);

}  // namespace mrpt_terrain::octree
