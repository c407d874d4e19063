// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/free_cells.h"

#include <gtest/gtest.h>

#include "octree_scans.h"

namespace mrpt_terrain::octree {
namespace {

using octomap::OcTree;

constexpr std::uint16_t kMiddle = 32768;
constexpr int kReach = 70;  // cells about the middle in which random scans have theirs, and beyond

std::uint16_t key_at(int offset) { return static_cast<std::uint16_t>(kMiddle + offset); }

/// 64 cells above each other, looked up one by one.
std::uint64_t column_of(const OcTree& tree, std::uint16_t x, std::uint16_t y, std::uint16_t z) {
  std::uint64_t bits = 0;
  for (int k = 0; k < 64 && z + k <= 0xFFFF; ++k) {
    const auto* node = tree.search(octomap::OcTreeKey(x, y, static_cast<std::uint16_t>(z + k)));
    const bool is_free = node != nullptr && !tree.isNodeOccupied(node);
    bits |= std::uint64_t{is_free ? 1U : 0U} << k;
  }
  return bits;
}

/// Number of random columns that are not those of the tree.
int wrong_columns(const FreeCells& cells, const OcTree& tree, RandomGenerator& random) {
  const auto pick = [&] { return key_at(static_cast<int>(random.below(2 * kReach)) - kReach); };
  int wrong = 0;
  for (int k = 0; k < 300; ++k) {
    const std::uint16_t x = pick(), y = pick(), z = pick();
    const std::uint64_t truth = column_of(tree, x, y, z);
    const auto layers = 1 + static_cast<int>(random.below(63));
    const std::uint64_t lowest = truth & ((std::uint64_t{1} << layers) - 1);
    wrong += cells.column(x, y, z) == truth && cells.column(x, y, z, layers) == lowest ? 0 : 1;
  }
  return wrong;
}

/// Whether two sets hold the same cells about the middle.
bool same_cells(const FreeCells& a, const FreeCells& b) {
  for (int x = -kReach; x < kReach; ++x) {
    for (int y = -kReach; y < kReach; ++y) {
      for (int z = -128; z < 128; z += 64) {
        if (a.column(key_at(x), key_at(y), key_at(z)) != b.column(key_at(x), key_at(y), key_at(z)))
          return false;
      }
    }
  }
  return true;
}

CellWindow random_window(RandomGenerator& random) {
  CellWindow window;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    window.low[axis] = key_at(static_cast<int>(random.below(40)) - 40);
    window.high[axis] = static_cast<std::uint16_t>(window.low[axis] + random.below(80));
  }
  return window;
}

TEST(FreeCells, OracleAfterScansAndTrimmingTheyAreThoseOfTheTree) {
  InsertionWorkspace workspace;
  const std::uint32_t rounds = test::kSanitized ? 20 : 150;
  for (std::uint32_t seed = 0; seed < rounds; ++seed) {
    RandomGenerator random(seed, 6);
    OcTree tree = test::random_tree(random);
    FreeCells cells;
    for (int k = 0; k < 5; ++k) {
      const auto scan = test::random_scan(random, tree.getResolution(), 1);
      const InsertionOptions options = test::random_options(random, tree.getResolution());
      std::vector<FreedCube> freed;
      insert_scan(scan.ends(), scan.starts(), options, workspace, tree, &freed, &cells);
      if (random.below(3) == 0) {
        const CellWindow window = random_window(random);
        trim_tree(window, tree);
        cells.trim(window);
      }
      ASSERT_EQ(wrong_columns(cells, tree, random), 0) << "seed " << seed << ", scan " << k;
    }
    FreeCells from_scratch;
    from_scratch.assign(tree);
    ASSERT_TRUE(same_cells(cells, from_scratch)) << "seed " << seed;
  }
}

TEST(FreeCells, TreesThatAreLeftToOctomapAreReadAgain) {
  InsertionWorkspace workspace;
  RandomGenerator random(1, 7);
  OcTree tree(0.1);
  tree.enableChangeDetection(true);
  FreeCells cells;
  const auto scan = test::random_scan(random, 0.1, 1);
  const test::QuietOctomap quiet;
  const auto result = insert_scan(scan.ends(), scan.starts(), {}, workspace, tree, nullptr, &cells);
  ASSERT_EQ(result.inserter, Inserter::kOctomap);
  EXPECT_EQ(wrong_columns(cells, tree, random), 0);
}

TEST(FreeCells, LiteralCubesAreSetAndUnset) {
  for (int level = 0; level <= 7; ++level) {
    const auto side = 1U << level;
    const std::array<std::uint16_t, 3> low{kMiddle, kMiddle, kMiddle};
    FreeCells cells;
    EXPECT_EQ(cells.column(kMiddle, kMiddle, kMiddle), 0U);
    cells.set(low, level, true);
    const std::uint64_t all = side >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << side) - 1;
    const auto last = static_cast<std::uint16_t>(kMiddle + side - 1);
    EXPECT_EQ(cells.column(kMiddle, kMiddle, kMiddle), all);
    EXPECT_EQ(cells.column(last, last, kMiddle), all);
    EXPECT_EQ(cells.column(last, kMiddle, kMiddle - 1), all << 1);
    EXPECT_EQ(cells.column(static_cast<std::uint16_t>(last + 1), kMiddle, kMiddle), 0U);
    cells.set(low, level, false);
    EXPECT_EQ(cells.column(kMiddle, kMiddle, kMiddle), 0U);
  }
}

TEST(FreeCells, LiteralColumnsEndAtTheHighestKey) {
  FreeCells cells;
  cells.set({0, 0, 65535}, 0, true);
  EXPECT_EQ(cells.column(0, 0, 65535), 1U);
  EXPECT_EQ(cells.column(0, 0, 65534), 2U);
  EXPECT_EQ(cells.column(0, 0, 65535 - 63), std::uint64_t{1} << 63);
  cells.trim({{0, 0, 0}, {65535, 65535, 65534}});
  EXPECT_EQ(cells.column(0, 0, 65535), 0U);
}

}  // namespace
}  // namespace mrpt_terrain::octree
