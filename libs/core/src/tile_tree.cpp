// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/tile_tree.h"

#include <algorithm>
#include <iterator>

namespace mrpt_terrain {
namespace {

// A tile is put in order when more than one in so many of its bins lies out of order.
constexpr std::uint32_t kMostDisorder = 4;
// Enough for nearly all tiles: 16 bins a cell.
constexpr std::size_t kUsualBlocks = 16 * kTileCells / kBinsPerBlock;
constexpr std::size_t kMostBlocks = kMostBins / kBinsPerBlock;

// Number of the child on the way to a tile; `i` and `j` count from the tree's corner.
std::size_t child_on_way(std::int32_t i, std::int32_t j, int level) {
  const int shift = kTreeShift * level;
  constexpr std::int32_t kMask = kTreeSide - 1;
  return static_cast<std::size_t>(((i >> shift) & kMask) * kTreeSide + ((j >> shift) & kMask));
}

bool is_empty(const TreeNode& node) {
  return std::none_of(node.child.begin(), node.child.end(),
                      [](const Ref<SharedNode>& child) { return static_cast<bool>(child); });
}

// Makes a node ready to be used again; whoever held it has let it go.
void reset(TreeNode& node) { node.child.fill({}); }
void reset(Tile&) {}

template <class Node>
void collect_from(Recycler<Node>& recycler) {
  // In the order of letting go, parents came before children: resetting one frees the others.
  auto& waiting = recycler.waiting;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < waiting.size(); ++k) {
    if (waiting[k].is_only_one()) {
      reset(*waiting[k]);
      recycler.ready.push_back(std::move(waiting[k]));
    } else {
      if (kept != k) waiting[kept] = std::move(waiting[k]);
      ++kept;
    }
  }
  waiting.resize(kept);
}

template <class Node>
Ref<Node> take_from(Recycler<Node>& recycler) {
  if (recycler.ready.empty()) return Ref<Node>(new Node);
  Ref<Node> node = std::move(recycler.ready.back());
  recycler.ready.pop_back();
  return node;
}

// Lets a child go, to be used again when nobody holds it.
template <class Node>
void retire(Ref<SharedNode>& child, Recycler<Node>& recycler) {
  recycler.waiting.push_back(Ref<Node>(static_cast<Node*>(child.get())));
  child = {};
}

// Lists the bins of a tile's last block that begin at `first` as unused, in their order.
void list_unused(Tile& tile, std::size_t first) {
  for (std::size_t k = tile.blocks.size() * kBinsPerBlock; k > first; --k) {
    const auto bin = static_cast<BinIndex>(k - 1);
    tile.bin(bin).next = tile.first_unused;
    tile.first_unused = bin;
  }
}

// Fetches a block while the one before is copied.
void prefetch(const BinBlock& block) {
#if defined(__GNUC__)
  for (const HeightBin& bin : block) __builtin_prefetch(&bin);
#else
  (void)block;
#endif
}

}  // namespace

const Tile* TileTree::find(TileIndex index) const {
  const std::int32_t i = index.i + kBias;
  const std::int32_t j = index.j + kBias;
  const SharedNode* node = root_.get();
  for (int level = kTreeLevels - 1; level >= 0 && node != nullptr; --level) {
    node = static_cast<const TreeNode*>(node)->child[child_on_way(i, j, level)].get();
  }
  return static_cast<const Tile*>(node);
}

Ref<Tile> TileStore::new_tile() {
  Ref<Tile> tile = take_from(tiles_);
  tile->blocks.reserve(kUsualBlocks);
  tile->cells.fill(TileCell{});
  tile->first_unused = kNoBin;
  tile->bins = 0;
  tile->disorder = 0;
  return tile;
}

// Bins of a cell follow each other in the copy, and cells follow each other too: readers then walk
// through memory in order. It costs little more than copying the blocks as they are.
Ref<Tile> TileStore::copy_of(const Tile& tile) {
  Ref<Tile> copy = new_tile();
  copy->cells = tile.cells;
  BinIndex used = 0;
  for (TileCell& cell : copy->cells) {
    BinIndex k = cell.first;
    if (k != kNoBin) cell.first = used;
    while (k != kNoBin) {
      if (used % kBinsPerBlock == 0) {
        copy->blocks.push_back(new_block());
        if (copy->blocks.size() < tile.blocks.size()) prefetch(*tile.blocks[copy->blocks.size()]);
      }
      HeightBin& bin = copy->bin(used++);
      bin = tile.bin(k);
      k = bin.next;
      bin.next = k == kNoBin ? kNoBin : used;
    }
  }
  copy->bins = used;
  list_unused(*copy, used);
  return copy;
}

std::unique_ptr<BinBlock> TileStore::new_block() {
  if (blocks_.empty()) return std::make_unique<BinBlock>();
  std::unique_ptr<BinBlock> block = std::move(blocks_.back());
  blocks_.pop_back();
  return block;
}

// A node that only the writer's tree holds, in place of one that may be shared or missing.
TreeNode& TileStore::own(Ref<SharedNode>& node) {
  if (!node) {
    node = Ref<SharedNode>(take_from(nodes_).get());
  } else if (!node.is_only_one()) {
    const Ref<TreeNode> copy = take_from(nodes_);
    copy->child = static_cast<const TreeNode&>(*node).child;
    retire(node, nodes_);
    node = Ref<SharedNode>(copy.get());
  }
  return static_cast<TreeNode&>(*node);
}

Tile& TileStore::writable(TileTree& tree, TileIndex index) {
  const std::int32_t i = index.i + TileTree::kBias;
  const std::int32_t j = index.j + TileTree::kBias;
  TreeNode* node = &own(tree.root_);
  for (int level = kTreeLevels - 1; level > 0; --level) {
    node = &own(node->child[child_on_way(i, j, level)]);
  }
  Ref<SharedNode>& leaf = node->child[child_on_way(i, j, 0)];
  if (!leaf) {
    leaf = Ref<SharedNode>(new_tile().get());
    return static_cast<Tile&>(*leaf);
  }
  const auto& tile = static_cast<const Tile&>(*leaf);
  if (!leaf.is_only_one() || tile.disorder > tile.bins / kMostDisorder + kBinsPerBlock) {
    const Ref<Tile> copy = copy_of(tile);
    retire(leaf, tiles_);
    leaf = Ref<SharedNode>(copy.get());
  }
  return static_cast<Tile&>(*leaf);
}

void TileStore::drop(TileTree& tree, TileIndex index) {
  if (tree.find(index) == nullptr) return;
  const std::int32_t i = index.i + TileTree::kBias;
  const std::int32_t j = index.j + TileTree::kBias;
  std::array<Ref<SharedNode>*, kTreeLevels> way{};
  way[0] = &tree.root_;
  for (std::size_t k = 0; k + 1 < kTreeLevels; ++k) {
    const int level = kTreeLevels - 1 - static_cast<int>(k);
    way[k + 1] = &own(*way[k]).child[child_on_way(i, j, level)];
  }
  retire(own(*way.back()).child[child_on_way(i, j, 0)], tiles_);
  for (std::size_t k = kTreeLevels; k > 0; --k) {
    if (!is_empty(static_cast<const TreeNode&>(**way[k - 1]))) return;
    retire(*way[k - 1], nodes_);
  }
}

void TileStore::collect() {
  collect_from(nodes_);
  const std::size_t before = tiles_.ready.size();
  collect_from(tiles_);
  for (std::size_t k = before; k < tiles_.ready.size(); ++k) {
    auto& blocks = tiles_.ready[k]->blocks;
    std::move(blocks.begin(), blocks.end(), std::back_inserter(blocks_));
    blocks.clear();
  }
}

BinIndex TileStore::new_bin(Tile& tile) {
  if (tile.first_unused == kNoBin) {
    if (tile.blocks.size() == kMostBlocks) return kNoBin;
    const std::size_t first = tile.blocks.size() * kBinsPerBlock;
    tile.blocks.push_back(new_block());
    list_unused(tile, first);
  }
  const BinIndex bin = tile.first_unused;
  tile.first_unused = tile.bin(bin).next;
  tile.bin(bin) = HeightBin{};
  ++tile.bins;
  ++tile.disorder;
  return bin;
}

void TileStore::free_bin(Tile& tile, BinIndex bin) {
  tile.bin(bin).next = tile.first_unused;
  tile.first_unused = bin;
  --tile.bins;
}

std::size_t TileStore::spare_bytes() const {
  std::size_t bytes = blocks_.size() * sizeof(BinBlock);
  bytes += (nodes_.ready.size() + nodes_.waiting.size()) * sizeof(TreeNode);
  for (const auto* list : {&tiles_.ready, &tiles_.waiting}) {
    for (const Ref<Tile>& tile : *list) {
      bytes += sizeof(Tile) + tile->blocks.size() * sizeof(BinBlock);
    }
  }
  return bytes;
}

}  // namespace mrpt_terrain
