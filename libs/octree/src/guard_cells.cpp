// SPDX-License-Identifier: BSD-3-Clause
#include "guard_cells.h"

#include <cstdint>

namespace mrpt_terrain::octree {
namespace {

octomap::OcTreeKey octomap_key(const CellKey& key) { return {key[0], key[1], key[2]}; }

bool is_free(const CellKey& key, const ScanCells& cells) { return cells.is_free(code_of(key)); }
bool is_occupied(const CellKey& key, const ScanCells& cells) {
  return cells.is_occupied(code_of(key));
}
void unmark_free(const CellKey& key, ScanCells& cells) { cells.unmark_free(code_of(key)); }

bool is_free(const CellKey& key, const KeySets& cells) {
  return cells.free.count(octomap_key(key)) != 0;
}
bool is_occupied(const CellKey& key, const KeySets& cells) {
  return cells.occupied.count(octomap_key(key)) != 0;
}
void unmark_free(const CellKey& key, KeySets& cells) { cells.free.erase(octomap_key(key)); }

bool is_known(const CellKey& key, const FreeCells* free) {
  return free != nullptr && (free->column(key[0], key[1], key[2]) & 1) != 0;
}

template <class Cells>
class Guard {
 public:
  Guard(Cells& cells, octomap::OcTree& tree, FreeCells* free)
      : cells_(cells), tree_(tree), free_(free) {}

  std::size_t apply(const GuardedCells& guarded) {
    std::size_t kept = 0;
    for (int z = guarded.low; z <= guarded.high; ++z) {
      const CellKey key{guarded.x, guarded.y, static_cast<std::uint16_t>(z)};
      if (is_occupied(key, cells_)) {
        if (!is_gone(guarded)) forget_misses(key);
      } else if (is_free(key, cells_) && !is_gone(guarded)) {
        unmark_free(key, cells_);
        ++kept;
      }
    }
    return kept;
  }

 private:
  // Whether the surface is not there any more: what lies below it is free.
  [[nodiscard]] bool is_gone(const GuardedCells& guarded) const {
    for (int z = guarded.low - 1; z >= guarded.below; --z) {
      const CellKey key{guarded.x, guarded.y, static_cast<std::uint16_t>(z)};
      if (!is_known(key, free_) && !is_free(key, cells_)) return false;
    }
    return true;
  }

  void forget_misses(const CellKey& key) {
    if (free_ != nullptr && !is_known(key, free_)) return;
    const octomap::OcTreeNode* node = tree_.search(octomap_key(key));
    if (node == nullptr || !(node->getLogOdds() < 0.0F)) return;
    tree_.setNodeValue(octomap_key(key), 0.0F);
    // The value may have been clamped, and 0 may count as free.
    node = tree_.search(octomap_key(key));
    if (free_ != nullptr) free_->set(key, 0, !tree_.isNodeOccupied(node));
  }

  Cells& cells_;
  octomap::OcTree& tree_;
  FreeCells* free_;
};

template <class Cells>
std::size_t guard_all(const std::vector<GuardedCells>& guarded, Guard<Cells> guard) {
  std::size_t kept = 0;
  for (const GuardedCells& column : guarded) kept += guard.apply(column);
  return kept;
}

}  // namespace

std::size_t guard_cells(const std::vector<GuardedCells>& guarded, ScanCells& cells,
                        octomap::OcTree& tree, FreeCells* free) {
  return guard_all(guarded, Guard<ScanCells>(cells, tree, free));
}

std::size_t guard_cells(const std::vector<GuardedCells>& guarded, KeySets& cells,
                        octomap::OcTree& tree, FreeCells* free) {
  return guard_all(guarded, Guard<KeySets>(cells, tree, free));
}

}  // namespace mrpt_terrain::octree
