// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/trim_tree.h"

#include <gtest/gtest.h>

#include "octree_scans.h"

namespace mrpt_terrain::octree {
namespace {

using octomap::OcTree;

constexpr std::uint16_t kMiddle = 32768;

[[nodiscard]] bool contains(const CellWindow& window, const octomap::OcTreeKey& key) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (key[axis] < window.low[axis] || key[axis] > window.high[axis]) return false;
  }
  return true;
}

/// A tree that only ever had the cells inside.
OcTree trimmed_by_brute_force(const OcTree& tree, const CellWindow& window) {
  OcTree result(tree);
  result.clear();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const auto low = leaf.getIndexKey();
    const int size = 1 << (16 - static_cast<int>(leaf.getDepth()));
    for (int k = 0; k < size * size * size; ++k) {
      const octomap::OcTreeKey key(static_cast<std::uint16_t>(low[0] + k % size),
                                   static_cast<std::uint16_t>(low[1] + k / size % size),
                                   static_cast<std::uint16_t>(low[2] + k / size / size));
      // Without clamping, as the limits of the other tree may differ.
      if (contains(window, key)) {
        result.setNodeValue(key, 0.0F, true)->setLogOdds(leaf->getLogOdds());
      }
    }
  }
  result.updateInnerOccupancy();
  result.prune();
  return result;
}

CellWindow random_window(RandomGenerator& random) {
  CellWindow window;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    window.low[axis] =
        static_cast<std::uint16_t>(kMiddle - 10 + static_cast<int>(random.below(14)));
    window.high[axis] = static_cast<std::uint16_t>(window.low[axis] + random.below(12));
  }
  return window;
}

TEST(TrimTree, OracleInsideTheWindowTheTreeIsThatOfOctomap) {
  InsertionWorkspace workspace;
  const std::uint32_t rounds = test::kSanitized ? 30 : 200;
  for (std::uint32_t seed = 0; seed < rounds; ++seed) {
    RandomGenerator random(seed, 4);
    OcTree own = test::random_tree(random);
    OcTree reference(own);
    const CellWindow window = random_window(random);
    for (int k = 0; k < 4; ++k) {
      const auto scan = test::random_scan(random, own.getResolution(), 1);
      insert_scan(scan.ends(), scan.starts(), {}, workspace, own);
      test::insert_by_octomap(scan, {}, reference);
      const std::size_t before = own.size();
      const TrimResult result = trim_tree(window, own);
      const OcTree expected = trimmed_by_brute_force(reference, window);
      ASSERT_TRUE(test::same_tree(own, expected)) << "seed " << seed << ", scan " << k;
      EXPECT_TRUE(own.size() >= before || result.removed > 0);
    }
  }
}

TEST(TrimTree, DegenerateTrees) {
  OcTree tree(0.1);
  const CellWindow window{{kMiddle, kMiddle, kMiddle}, {kMiddle, kMiddle, kMiddle}};
  EXPECT_EQ(trim_tree(window, tree).removed, 0U);
  tree.updateNode(octomap::OcTreeKey(1, 2, 3), true);
  EXPECT_EQ(trim_tree(window, tree).removed, 17U);
  EXPECT_EQ(tree.getRoot(), nullptr);
  EXPECT_EQ(tree.size(), 0U);
  tree.updateNode(octomap::OcTreeKey(kMiddle, kMiddle, kMiddle), true);
  EXPECT_EQ(trim_tree(window, tree).removed, 0U);
  EXPECT_EQ(tree.size(), 17U);
  EXPECT_EQ(trim_tree({{0, 0, 0}, {65535, 65535, 65535}}, tree).visited, 0U);
}

/// Marks a plane of cells, 64 times `length` of them, from the middle on.
void add_floor(OcTree& tree, int length) {
  for (int x = 0; x < length; ++x) {
    for (int y = 0; y < 64; ++y) {
      tree.updateNode(octomap::OcTreeKey(static_cast<std::uint16_t>(kMiddle + x),
                                         static_cast<std::uint16_t>(kMiddle + y), kMiddle),
                      x % 2 == 0);
    }
  }
}

TEST(TrimTree, InvariantTheCostDoesNotGrowWithTheTree) {
  const CellWindow window{{kMiddle + 8, 0, 0}, {65535, 65535, 65535}};
  OcTree small(0.1), large(0.1);
  add_floor(small, 128);
  add_floor(large, 2048);
  const TrimResult of_small = trim_tree(window, small);
  const TrimResult of_large = trim_tree(window, large);
  EXPECT_GT(of_small.removed, 8U * 64U);
  EXPECT_EQ(of_small.removed, of_large.removed);
  EXPECT_EQ(of_small.visited, of_large.visited);
  EXPECT_GT(large.size(), 10 * small.size());
  EXPECT_EQ(trim_tree(window, large).removed, 0U);
}

}  // namespace
}  // namespace mrpt_terrain::octree
