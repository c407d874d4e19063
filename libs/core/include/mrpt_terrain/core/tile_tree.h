// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mrpt_terrain/core/fused_tile.h"
#include "mrpt_terrain/core/shared_node.h"

namespace mrpt_terrain {

/// Node of the tree of tiles: 8 x 8 children, nodes or, on the last level, tiles.
inline constexpr int kTreeShift = 3;
inline constexpr int kTreeSide = 1 << kTreeShift;
inline constexpr int kTreeLevels = 7;
struct TreeNode : SharedNode {
  std::array<Ref<SharedNode>, kTreeSide * kTreeSide> child;
};

/// A set of tiles that can be copied in no time: the copy shares all nodes and tiles, and a writer
/// makes its own copies of those that it changes, and of the nodes above them.
class TileTree {
 public:
  /// The tile at an index, or null. Valid as long as this tree or a copy of it is unchanged.
  [[nodiscard]] const Tile* find(TileIndex index) const;

  /// Calls `visit(TileIndex, const Tile&)` for all tiles, in an order that depends on their indices
  /// alone.
  template <class Visit>
  void for_each(Visit&& visit) const {
    if (root_)
      visit_below(static_cast<const TreeNode&>(*root_), kTreeLevels - 1, TileIndex{}, visit);
  }

 private:
  friend class TileStore;

  template <class Visit>
  static void visit_below(const TreeNode& node, int level, TileIndex prefix, Visit& visit) {
    for (int k = 0; k < kTreeSide * kTreeSide; ++k) {
      const SharedNode* child = node.child[static_cast<std::size_t>(k)].get();
      if (child == nullptr) continue;
      const TileIndex below{prefix.i * kTreeSide + k / kTreeSide,
                            prefix.j * kTreeSide + k % kTreeSide};
      if (level > 0) {
        visit_below(static_cast<const TreeNode&>(*child), level - 1, below, visit);
      } else {
        visit(TileIndex{below.i - kBias, below.j - kBias}, static_cast<const Tile&>(*child));
      }
    }
  }

  // Indices count from here in the tree, so that they are not negative.
  static constexpr std::int32_t kBias = 1 << (kTreeShift * kTreeLevels - 1);

  Ref<SharedNode> root_;
};

/// What has been let go, kept to be used again: nodes that a snapshot may still hold wait until it
/// is gone.
template <class Node>
struct Recycler {
  std::vector<Ref<Node>> waiting;
  std::vector<Ref<Node>> ready;
};

/// The one writer of a tree, with the memory of tiles and nodes that are no longer needed.
class TileStore {
 public:
  /// The tile at an index, made if there is none, as the writer's own: copied if a snapshot shares
  /// it. Valid until the next copy of `tree`, or until it is dropped.
  Tile& writable(TileTree& tree, TileIndex index);
  /// Removes a tile if there is one.
  void drop(TileTree& tree, TileIndex index);
  /// Looks which of the nodes let go nobody holds any more.
  void collect();

  /// A bin for a cell of a tile, not yet linked; kNoBin if the tile is full.
  BinIndex new_bin(Tile& tile);
  /// Gives back a bin that is no longer linked.
  static void free_bin(Tile& tile, BinIndex bin);

  /// Memory held by what is ready to be used again, bytes.
  [[nodiscard]] std::size_t spare_bytes() const;

 private:
  Ref<Tile> new_tile();
  Ref<Tile> copy_of(const Tile& tile);
  TreeNode& own(Ref<SharedNode>& node);
  std::unique_ptr<BinBlock> new_block();

  Recycler<TreeNode> nodes_;
  Recycler<Tile> tiles_;
  std::vector<std::unique_ptr<BinBlock>> blocks_;
};

}  // namespace mrpt_terrain
