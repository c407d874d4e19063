// SPDX-License-Identifier: BSD-3-Clause
#include "update_tree.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "tree_access.h"

namespace mrpt_terrain::octree {
namespace {

// Marked cells of a cube of 2^kLevel cells, of a cell at level 0 up to a tile at level 6. Each has
// the same questions: is there any, are there free or occupied ones, are all the same, and which
// are those of child k.
struct CellMarks {
  static constexpr int kLevel = 0;
  bool occupied;
  [[nodiscard]] bool any_free() const { return !occupied; }
  [[nodiscard]] bool any_occupied() const { return occupied; }
  [[nodiscard]] bool all_free() const { return !occupied; }
  [[nodiscard]] bool all_occupied() const { return occupied; }
};

struct PairMarks {
  static constexpr int kLevel = 1;
  std::uint8_t free, occupied;  // disjoint
  [[nodiscard]] bool any() const { return (free | occupied) != 0; }
  [[nodiscard]] bool any_free() const { return free != 0; }
  [[nodiscard]] bool any_occupied() const { return occupied != 0; }
  [[nodiscard]] bool all_free() const { return free == 0xff; }
  [[nodiscard]] bool all_occupied() const { return occupied == 0xff; }
  [[nodiscard]] bool has_part(std::size_t k) const { return ((free | occupied) >> k & 1) != 0; }
  [[nodiscard]] CellMarks part(std::size_t k) const { return {(occupied >> k & 1) != 0}; }
};

struct WordMarks {
  static constexpr int kLevel = 2;
  std::uint64_t free, occupied;  // disjoint
  [[nodiscard]] bool any_free() const { return free != 0; }
  [[nodiscard]] bool any_occupied() const { return occupied != 0; }
  [[nodiscard]] bool all_free() const { return ~free == 0; }
  [[nodiscard]] bool all_occupied() const { return ~occupied == 0; }
  [[nodiscard]] bool has_part(std::size_t k) const { return part(k).any(); }
  [[nodiscard]] PairMarks part(std::size_t k) const {
    return {static_cast<std::uint8_t>(free >> 8 * k), static_cast<std::uint8_t>(occupied >> 8 * k)};
  }
};

struct BlockMarks {
  static constexpr int kLevel = 3;
  const std::uint64_t* crossed;  // not disjoint from the others
  const std::uint64_t* occupied;
  [[nodiscard]] bool has_part(std::size_t k) const { return (crossed[k] | occupied[k]) != 0; }
  [[nodiscard]] WordMarks part(std::size_t k) const {
    return {crossed[k] & ~occupied[k], occupied[k]};
  }
  [[nodiscard]] bool any_free() const {
    std::uint64_t any = 0;
    for (std::size_t k = 0; k < 8; ++k) any |= part(k).free;
    return any != 0;
  }
  [[nodiscard]] bool any_occupied() const {
    std::uint64_t any = 0;
    for (std::size_t k = 0; k < 8; ++k) any |= occupied[k];
    return any != 0;
  }
  [[nodiscard]] bool all_free() const {
    std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t k = 0; k < 8; ++k) all &= part(k).free;
    return ~all == 0;
  }
  [[nodiscard]] bool all_occupied() const {
    std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t k = 0; k < 8; ++k) all &= occupied[k];
    return ~all == 0;
  }
};

// Larger cubes do not say that all of their cells are the same, and take free ones for granted.
struct TileMarks {
  const ScanCells* cells;
  const CellTile* tile;
  [[nodiscard]] bool any_free() const { return true; }
  [[nodiscard]] bool all_free() const { return false; }
  [[nodiscard]] bool all_occupied() const { return false; }
};

// Two blocks along each axis: eight bits of a word of the tile.
struct EightBlocks : TileMarks {
  static constexpr int kLevel = 4;
  std::size_t first;  // its first block
  [[nodiscard]] bool any_occupied() const {
    return (tile->occupied[first >> 6] >> (first & 63) & 0xff) != 0;
  }
  [[nodiscard]] bool has_part(std::size_t k) const { return tile->block[first + k] != 0; }
  [[nodiscard]] BlockMarks part(std::size_t k) const {
    const std::uint32_t block = tile->block[first + k];
    return {cells->free(block).words, cells->occupied(block).words};
  }
};

// Four blocks along each axis: a word of the tile.
struct WordOfBlocks : TileMarks {
  static constexpr int kLevel = 5;
  std::size_t word;
  [[nodiscard]] bool any_occupied() const { return tile->occupied[word] != 0; }
  [[nodiscard]] bool has_part(std::size_t k) const {
    return (tile->present[word] >> 8 * k & 0xff) != 0;
  }
  [[nodiscard]] EightBlocks part(std::size_t k) const { return {*this, 64 * word + 8 * k}; }
};

template <int kLevelAbove>
struct AboveTile;

struct WholeTile : TileMarks {
  static constexpr int kLevel = 6;
  [[nodiscard]] bool any_occupied() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : tile->occupied) any |= word;
    return any != 0;
  }
  [[nodiscard]] bool has_part(std::size_t k) const { return tile->present[k] != 0; }
  [[nodiscard]] WordOfBlocks part(std::size_t k) const { return {*this, k}; }
};

// A cube of which only those cells are looked at that lie in one tile.
template <int kLevelAbove>
struct AboveTile : WholeTile {
  static constexpr int kLevel = kLevelAbove;
  [[nodiscard]] bool has_part(std::size_t k) const {
    return (tile->code >> 3 * (kLevelAbove - 7) & 7) == k;
  }
  [[nodiscard]] auto part(std::size_t) const {
    if constexpr (kLevelAbove == 7) {
      return WholeTile{*this};
    } else {
      return AboveTile<kLevelAbove - 1>{*this};
    }
  }
};

constexpr int kTreeDepth = 16;

// One passage through the tree. Functions on nodes say whether OctoMap would have updated a cell
// below the node: it leaves cells alone that are at the limit of their value already.
template <bool kReport>
class Passage {
 public:
  Passage(octomap::OcTree& tree, std::vector<FreedCube>* freed, FreeCells* free)
      : tree_(tree),
        hit_(tree.getProbHitLog()),
        miss_(tree.getProbMissLog()),
        least_(tree.getClampingThresMinLog()),
        greatest_(tree.getClampingThresMaxLog()),
        threshold_(tree.getOccupancyThresLog()),
        freed_(freed),
        free_(free) {}

  void update_all(const ScanCells& cells) {
    for (const CellTile& tile : cells.tiles()) {
      if (!tile.is_empty()) update(cells, tile);
    }
  }

 private:
  void update(const ScanCells& cells, const CellTile& tile) {
    OcTreeNode*& root = root_of(tree_);
    const bool is_new = root == nullptr;
    if (is_new) {
      root = new OcTreeNode();
      ++size_of(tree_);
    }
    extent_is_stale(tree_) = true;
    update_node(*root, is_new, AboveTile<kTreeDepth>{{{&cells, &tile}}}, tile.code);
  }

  // OctoMap's early abort.
  [[nodiscard]] bool is_at_limit(float value, float change) const {
    return (change >= 0.0F && value >= greatest_) || (change <= 0.0F && value <= least_);
  }

  // All cells of the node's cube get the same update; the node has no children.
  template <class Marks>
  bool update_leaf(OcTreeNode& node, bool is_new, const Marks& marks, CellCode code) {
    const float change = marks.all_free() ? miss_ : hit_;
    const float before = node.getLogOdds();
    if (!is_new && is_at_limit(before, change)) return false;
    float value = before + change;
    if (value < least_) {
      value = least_;
    } else if (value > greatest_) {
      value = greatest_;
    }
    node.setLogOdds(value);
    if constexpr (kReport) {
      const bool was_free = !is_new && before < threshold_;
      const bool is_free = value < threshold_;
      if (was_free != is_free) report(code, Marks::kLevel, is_new, is_free);
    }
    return true;
  }

  void report(CellCode code, int level, bool is_new, bool is_free) {
    const CellKey low = key_of(code << 3 * level);
    if (free_ != nullptr) free_->set(low, level, is_free);
    if (freed_ == nullptr || is_new || !is_free) return;
    freed_->push_back({low, static_cast<std::uint16_t>(1 << level)});
  }

  // Whether no marked cell changes, if all cells of the cube have the value of the node.
  template <class Marks>
  [[nodiscard]] bool stays(const OcTreeNode& node, const Marks& marks) const {
    const float value = node.getLogOdds();
    return (!marks.any_free() || is_at_limit(value, miss_)) &&
           (!marks.any_occupied() || is_at_limit(value, hit_));
  }

  // `code` of the node's cube, without the bits below its level.
  template <class Marks>
  bool update_node(OcTreeNode& node, bool is_new, const Marks& marks, CellCode code) {
    if constexpr (Marks::kLevel == 0) {
      return update_leaf(node, is_new, marks, code);
    } else {
      if (has_children(node)) return update_children(node, is_new, marks, code);
      if (marks.all_free() || marks.all_occupied()) return update_leaf(node, is_new, marks, code);
      if (is_new) return update_children(node, is_new, marks, code);
      if (stays(node, marks)) return false;
      tree_.expandNode(&node);
      const bool touched = update_children(node, is_new, marks, code);
      if (!touched) tree_.pruneNode(&node);
      return touched;
    }
  }

  // The cells of a node one level above them: the innermost loop.
  bool update_children(OcTreeNode& node, bool is_new, const PairMarks& marks, CellCode code) {
    ensure_array(node);
    prefetch_children(node);
    bool touched = is_new;
    bool equal = true;
    float greatest = -std::numeric_limits<float>::max();
    const OcTreeNode* first = nullptr;
    for (std::size_t k = 0; k < 8; ++k) {
      OcTreeNode* child = child_of(node, k);
      const bool is_new_child = child == nullptr;
      if (marks.has_part(k)) {
        if (is_new_child) child = add_child(tree_, node, k);
        touched |= update_leaf(*child, is_new_child, marks.part(k), code << 3 | k);
      } else if (is_new_child) {
        equal = false;
        continue;
      }
      const float value = child->getLogOdds();
      if (value > greatest) greatest = value;
      if (first == nullptr) first = child;
      equal = equal && value == first->getLogOdds();
    }
    if (!touched) return false;
    if (equal) {
      remove_leaves(tree_, node, first->getLogOdds());
    } else {
      node.setLogOdds(greatest);
    }
    return true;
  }

  template <class Marks>
  bool update_children(OcTreeNode& node, bool is_new, const Marks& marks, CellCode code) {
    ensure_array(node);
    prefetch_children(node);
    bool touched = is_new;
    for (std::size_t k = 0; k < 8; ++k) {
      if (k < 7) prefetch_array_of(child_of(node, k + 1));
      if (!marks.has_part(k)) continue;
      OcTreeNode* child = child_of(node, k);
      const bool is_new_child = child == nullptr;
      if (is_new_child) child = add_child(tree_, node, k);
      const CellCode child_code = child_code_of<Marks::kLevel>(code, k);
      touched |= update_node(*child, is_new_child, marks.part(k), child_code);
    }
    if (touched) prune_or_raise(tree_, node);
    return touched;
  }

  static void prefetch_array_of(OcTreeNode* node) {
    if (node != nullptr) prefetch(children_of(*node));
  }

  // Above the tile there is one way only, and the code is the tile's.
  template <int kLevel>
  [[nodiscard]] static CellCode child_code_of(CellCode code, std::size_t k) {
    return kLevel > 6 ? code : code << 3 | k;
  }

  octomap::OcTree& tree_;
  float hit_, miss_, least_, greatest_, threshold_;  // log-odds
  std::vector<FreedCube>* freed_;
  FreeCells* free_;
};

}  // namespace

void update_tree(const ScanCells& cells, octomap::OcTree& tree, std::vector<FreedCube>* freed,
                 FreeCells* free) {
  if (freed == nullptr && free == nullptr) {
    Passage<false> passage(tree, nullptr, nullptr);
    passage.update_all(cells);
  } else {
    Passage<true> passage(tree, freed, free);
    passage.update_all(cells);
  }
}

}  // namespace mrpt_terrain::octree
