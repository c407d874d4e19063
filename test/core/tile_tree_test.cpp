// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/tile_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "fused_state.h"
#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

std::uint32_t& mark(Tile& tile) { return tile.disorder; }

std::vector<TileIndex> indices_of(const TileTree& tree) {
  std::vector<TileIndex> all;
  tree.for_each([&](TileIndex index, const Tile&) { all.push_back(index); });
  return all;
}

TEST(TileTree, EqualsAMapOfTiles) {
  RandomGenerator random(1);
  TileTree tree;
  TileStore store;
  std::map<TileIndex, std::uint32_t> expected;
  std::vector<std::pair<TileTree, std::map<TileIndex, std::uint32_t>>> snapshots;
  for (std::uint32_t k = 0; k < 4000; ++k) {
    const auto scale = static_cast<std::int32_t>(random.below(2) == 0 ? 12 : 2000000);
    const TileIndex index{static_cast<std::int32_t>(random.below(12)) * (scale / 12) - scale / 2,
                          static_cast<std::int32_t>(random.below(12)) - 6};
    if (random.below(3) == 0) {
      store.drop(tree, index);
      expected.erase(index);
    } else {
      mark(store.writable(tree, index)) = k % 30;
      expected[index] = k % 30;
    }
    if (random.below(50) == 0) snapshots.emplace_back(tree, expected);
    if (random.below(20) == 0) store.collect();
    if (snapshots.size() > 4) snapshots.erase(snapshots.begin());
    if (k % 100 != 0) continue;
    snapshots.emplace_back(tree, expected);
    for (const auto& [old_tree, old_expected] : snapshots) {
      std::map<TileIndex, std::uint32_t> found;
      old_tree.for_each(
          [&found = found](TileIndex at, const Tile& tile) { found[at] = tile.disorder; });
      EXPECT_EQ(found, old_expected);
    }
    snapshots.pop_back();
    for (const auto& [at, value] : expected) {
      ASSERT_NE(tree.find(at), nullptr);
      EXPECT_EQ(tree.find(at)->disorder, value);
    }
  }
}

TEST(TileTree, SnapshotsShareWhatDidNotChange) {
  TileTree tree;
  TileStore store;
  for (std::int32_t k = 0; k < 100; ++k) store.writable(tree, {k, -k});
  const TileTree snapshot = tree;
  Tile& changed = store.writable(tree, {50, -50});
  EXPECT_NE(&changed, snapshot.find({50, -50}));
  for (std::int32_t k = 0; k < 100; ++k) {
    EXPECT_EQ(tree.find({k, -k}) == snapshot.find({k, -k}), k != 50);
  }
  EXPECT_EQ(&store.writable(tree, {50, -50}), &changed) << "its own tile is not copied again";
}

TEST(TileTree, WhatNobodyHoldsIsUsedAgain) {
  TileTree tree;
  TileStore store;
  const Tile* first = &store.writable(tree, {0, 0});
  {
    const TileTree snapshot = tree;
    store.writable(tree, {0, 0});
    store.collect();
    EXPECT_EQ(snapshot.find({0, 0}), first);
    EXPECT_NE(&store.writable(tree, {0, 1}), first) << "the snapshot still holds it";
  }
  store.collect();
  EXPECT_EQ(&store.writable(tree, {0, 2}), first);
  for (const std::int32_t j : {0, 1, 2, 2}) store.drop(tree, {0, j});
  EXPECT_TRUE(indices_of(tree).empty());
}

TEST(TileTree, SnapshotsOutliveTheGrid) {
  FusionParams params;
  FusedSnapshot snapshot;
  {
    FusedGrid grid(params);
    FusionWorkspace workspace;
    Points points;
    points.push_back(0.1F, 0.1F, 0.1F);
    fuse_scan({points.view(), Eigen::Isometry3d::Identity(), 1.0}, params, workspace, grid);
    snapshot = grid.snapshot();
    fuse_scan({points.view(), Eigen::Isometry3d::Identity(), 2.0}, params, workspace, grid);
  }
  FusedCell cell;
  ASSERT_TRUE(read_cell(snapshot, {0, 0}, params, cell));
  EXPECT_EQ(cell.moments.n, 1.0);
  EXPECT_EQ(cell.last_seen, 1.0);
}

// Readers add up what they see while the writer goes on; every snapshot has to add up to the number
// of points that had been fused when it was taken. Meant for the thread sanitizer, too.
TEST(FusedSnapshot, ReadersSeeWholeScansWhileTheWriterGoesOn) {
  FusionParams params;
  params.renew_scans = 0;
  params.extent = FusionExtent::kGrowing;
  FusedGrid grid(params);
  std::mutex mutex;
  FusedSnapshot published = grid.snapshot();
  std::atomic<bool> done{false};
  constexpr std::size_t kPoints = 500;
  const auto read = [&](std::atomic<int>* checked) {
    while (!done) {
      FusedSnapshot snapshot;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        snapshot = published;
      }
      std::size_t points = 0;
      snapshot.tiles.for_each([&](TileIndex, const Tile& tile) {
        for (std::size_t place = 0; place < kTileCells; ++place) {
          for_each_bin(tile, place, [&](const HeightBin& bin) { points += bin.count; });
        }
      });
      ASSERT_EQ(points, kPoints * snapshot.scans);
      ++*checked;
    }
  };
  std::array<std::atomic<int>, 2> checked{};
  std::vector<std::thread> readers;
  for (std::atomic<int>& count : checked) readers.emplace_back(read, &count);
  RandomGenerator random(1);
  FusionWorkspace workspace;
  int k = 0;
  while (k < 300 || ((checked[0] < 5 || checked[1] < 5) && k < 100000)) {
    Points points;
    for (std::size_t i = 0; i < kPoints; ++i) {
      worlds::add_point(points, 20 * random.uniform(), 20 * random.uniform(), random.uniform());
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = 0.01 * k;
    fuse_scan({points.view(), pose, 0.1 * k}, params, workspace, grid);
    const std::lock_guard<std::mutex> lock(mutex);
    published = grid.snapshot();
    ++k;
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_GT(checked[0] + checked[1], 0);
}

}  // namespace
}  // namespace mrpt_terrain
