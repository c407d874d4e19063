// SPDX-License-Identifier: BSD-3-Clause
#include "tree_access.h"

#include <limits>

namespace mrpt_terrain::octree {

void remove_leaves(octomap::OcTree& tree, OcTreeNode& node, float value) {
  for (std::size_t k = 0; k < 8; ++k) delete child_of(node, k);
  delete[] children_of(node);
  children_of(node) = nullptr;
  node.setLogOdds(value);
  size_of(tree) -= 8;
  extent_is_stale(tree) = true;
}

void prune_or_raise(octomap::OcTree& tree, OcTreeNode& node) {
  float greatest = -std::numeric_limits<float>::max();
  bool equal = true;
  const OcTreeNode* first = child_of(node, 0);
  for (std::size_t k = 0; k < 8; ++k) {
    OcTreeNode* const child = child_of(node, k);
    if (child == nullptr) {
      equal = false;
      continue;
    }
    const float value = child->getLogOdds();
    if (value > greatest) greatest = value;
    equal = equal && first != nullptr && value == first->getLogOdds() && !has_children(*child);
  }
  if (equal) {
    remove_leaves(tree, node, first->getLogOdds());
  } else {
    node.setLogOdds(greatest);
  }
}

}  // namespace mrpt_terrain::octree
