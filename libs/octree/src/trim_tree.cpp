// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/trim_tree.h"

#include <cassert>

#include "tree_access.h"

namespace mrpt_terrain::octree {
namespace {

// Cube of 2^level cells along an edge.
struct Cube {
  std::array<std::uint32_t, 3> low;
  int level;

  [[nodiscard]] Cube part(std::size_t k) const {
    const std::uint32_t half = 1U << (level - 1);
    Cube cube{low, level - 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((k >> axis & 1) != 0) cube.low[axis] += half;
    }
    return cube;
  }
};

enum class Place { kInside, kAcross, kOutside };

Place place_of(const Cube& cube, const CellWindow& window) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t low = cube.low[axis];
    const std::uint32_t high = low + (1U << cube.level) - 1;
    if (high < window.low[axis] || low > window.high[axis]) return Place::kOutside;
    inside = inside && low >= window.low[axis] && high <= window.high[axis];
  }
  return inside ? Place::kInside : Place::kAcross;
}

enum class Outcome { kUnchanged, kChanged, kEmpty };

class Trimmer {
 public:
  Trimmer(const CellWindow& window, octomap::OcTree& tree) : window_(window), tree_(tree) {}

  // Trims what is below a node across the border. An empty node is left without children.
  Outcome trim(OcTreeNode& node, const Cube& cube) {
    ++result_.visited;
    if (!has_children(node)) tree_.expandNode(&node);
    bool changed = false;
    for (std::size_t k = 0; k < 8; ++k) {
      OcTreeNode* const child = child_of(node, k);
      if (child == nullptr) continue;
      const Cube part = cube.part(k);
      const Place place = place_of(part, window_);
      if (place == Place::kInside) continue;
      const Outcome outcome = place == Place::kAcross ? trim(*child, part) : Outcome::kEmpty;
      if (outcome == Outcome::kEmpty) remove_child(node, k);
      changed = changed || outcome != Outcome::kUnchanged;
    }
    if (!has_children(node)) return Outcome::kEmpty;
    if (changed) prune_or_raise(tree_, node);
    return changed ? Outcome::kChanged : Outcome::kUnchanged;
  }

  [[nodiscard]] const TrimResult& result() const { return result_; }

 private:
  void remove_child(OcTreeNode& node, std::size_t index) {
    OcTreeNode& child = *child_of(node, index);
    for (std::size_t k = 0; k < 8; ++k) {
      if (child_of(child, k) != nullptr) remove_child(child, k);
    }
    delete[] children_of(child);
    children_of(child) = nullptr;
    tree_.deleteNodeChild(&node, static_cast<unsigned>(index));
    ++result_.removed;
  }

  const CellWindow& window_;
  octomap::OcTree& tree_;
  TrimResult result_;
};

}  // namespace

TrimResult trim_tree(const CellWindow& window, octomap::OcTree& tree) {
  for (std::size_t axis = 0; axis < 3; ++axis) assert(window.low[axis] <= window.high[axis]);
  constexpr Cube kAll{{0, 0, 0}, 16};
  if (tree.getRoot() == nullptr || place_of(kAll, window) == Place::kInside) return {};
  Trimmer trimmer(window, tree);
  const Outcome outcome = trimmer.trim(*tree.getRoot(), kAll);
  TrimResult result = trimmer.result();
  if (outcome == Outcome::kEmpty) {
    tree.clear();
    ++result.removed;
  }
  return result;
}

}  // namespace mrpt_terrain::octree
