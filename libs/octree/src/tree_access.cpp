// SPDX-License-Identifier: BSD-3-Clause
#include "tree_access.h"

#include <limits>

namespace mrpt_terrain::octree {

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
    tree.pruneNode(&node);
  } else {
    node.setLogOdds(greatest);
  }
}

}  // namespace mrpt_terrain::octree
