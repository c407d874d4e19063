// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>

/// \file
/// What OctoMap keeps to its own classes, reached through classes derived from them: the root of an
/// empty tree cannot be made, nor a subtree be deleted without leaking, by its public functions.
namespace mrpt_terrain::octree {

using octomap::OcTreeNode;

struct NodeMembers : octomap::OcTreeNode {
  using octomap::OcTreeNode::children;
};

/// The eight children of a node, of which some may be null; null if it has no array of them.
[[nodiscard]] inline octomap::AbstractOcTreeNode**& children_of(OcTreeNode& node) {
  return node.*(&NodeMembers::children);
}

[[nodiscard]] inline OcTreeNode* child_of(OcTreeNode& node, std::size_t index) {
  octomap::AbstractOcTreeNode** const children = children_of(node);
  return children == nullptr ? nullptr : static_cast<OcTreeNode*>(children[index]);
}

[[nodiscard]] inline bool has_children(OcTreeNode& node) {
  octomap::AbstractOcTreeNode** const children = children_of(node);
  if (children == nullptr) return false;
  for (std::size_t k = 0; k < 8; ++k) {
    if (children[k] != nullptr) return true;
  }
  return false;
}

struct TreeMembers : octomap::OcTree {
  using octomap::OcTree::root;
  using octomap::OcTree::size_changed;
  using octomap::OcTree::tree_size;
};

[[nodiscard]] inline OcTreeNode*& root_of(octomap::OcTree& tree) {
  return tree.*(&TreeMembers::root);
}
/// Number of nodes. Whoever changes it sets `extent_is_stale`, too.
[[nodiscard]] inline std::size_t& size_of(octomap::OcTree& tree) {
  return tree.*(&TreeMembers::tree_size);
}

[[nodiscard]] inline bool& extent_is_stale(octomap::OcTree& tree) {
  return tree.*(&TreeMembers::size_changed);
}

/// Makes a child of a node that has an array of children, and none at this place.
inline OcTreeNode* add_child(octomap::OcTree& tree, OcTreeNode& node, std::size_t index) {
  auto* const child = new OcTreeNode();
  children_of(node)[index] = child;
  ++size_of(tree);
  return child;
}

/// Gives a node an array without children, if it has none.
inline void ensure_array(OcTreeNode& node) {
  if (children_of(node) == nullptr) children_of(node) = new octomap::AbstractOcTreeNode*[8]();
}

/// Fetches what is about to be looked at: nodes lie all over the memory.
inline void prefetch(const void* place) {
#if defined(__GNUC__)
  __builtin_prefetch(place);
#else
  (void)place;
#endif
}
/// The same for the children of a node that has an array of them.
inline void prefetch_children(OcTreeNode& node) {
  for (std::size_t k = 0; k < 8; ++k) prefetch(children_of(node)[k]);
}

/// Replaces eight children that have no children themselves by one value.
void remove_leaves(octomap::OcTree& tree, OcTreeNode& node, float value);

/// Makes children of a node equal if that is possible, or gives it the greatest value of its
/// children: what OctoMap does with every node above an updated cell. The node has children.
void prune_or_raise(octomap::OcTree& tree, OcTreeNode& node);

}  // namespace mrpt_terrain::octree
