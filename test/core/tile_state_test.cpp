// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/tile_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "fused_state.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

FusionParams growing() {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  return params;
}

void drive(FusedGrid& grid, int from, int to) {
  FusionWorkspace workspace;
  for (int k = from; k < to; ++k) {
    RandomGenerator random(static_cast<std::uint64_t>(k));
    Points points;
    for (int i = 0; i < 2000; ++i) {
      worlds::add_point(points, 10 * random.uniform(), 10 * random.uniform(), 2 * random.uniform());
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = 0.1 * k;
    fuse_scan({points.view(), pose, 0.1 * k}, growing(), workspace, grid);
  }
}

std::vector<TileState> tiles_of(const FusedSnapshot& map) {
  std::vector<TileState> tiles;
  map.tiles.for_each([&](TileIndex index, const Tile& tile) {
    tiles.emplace_back();
    save_tile(index, tile, tiles.back());
  });
  return tiles;
}

TEST(TileState, AMapSurvivesWithoutAChangedBitAndGoesOn) {
  FusedGrid original(growing());
  drive(original, 0, 30);
  FusedGrid restored(growing());
  for (const TileState& tile : tiles_of(original.now())) {
    ASSERT_EQ(restore_tile(tile, restored), RestoreStatus::kOk);
  }
  const FusedSnapshot& now = original.now();
  restore_progress(now.window, now.time, now.scans, restored);
  EXPECT_TRUE(test::bytes_of(now) == test::bytes_of(restored.now()));
  EXPECT_EQ(restored.now().scans, 30U);
  EXPECT_EQ(restored.now().time, now.time);
  drive(original, 30, 45);
  drive(restored, 30, 45);
  EXPECT_TRUE(test::bytes_of(original.now()) == test::bytes_of(restored.now()));
  EXPECT_EQ(memory_of(original).bins, memory_of(restored).bins);
}

TEST(TileState, RestoringReplacesWhatIsThere) {
  FusedGrid grid(growing());
  drive(grid, 0, 3);
  const std::string before = test::bytes_of(grid.now());
  const std::vector<TileState> tiles = tiles_of(grid.now());
  drive(grid, 3, 6);
  for (const TileState& tile : tiles) ASSERT_EQ(restore_tile(tile, grid), RestoreStatus::kOk);
  EXPECT_TRUE(test::bytes_of(grid.now()) == before);
}

TEST(TileState, DamageIsRefusedAndChangesNothing) {
  FusedGrid grid(growing());
  drive(grid, 0, 3);
  const std::string before = test::bytes_of(grid.now());
  const TileState good = tiles_of(grid.now()).front();
  ASSERT_GT(good.cells.size(), 2U);
  ASSERT_GT(good.bins.size(), 3U);
  struct Damage {
    RestoreStatus expected;
    std::function<void(TileState&)> make;
  };
  const std::vector<Damage> damages = {
      {RestoreStatus::kBadIndex, [](TileState& s) { s.tile.i = 1 << 20; }},
      {RestoreStatus::kBadIndex, [](TileState& s) { s.tile.j = -(1 << 20) - 1; }},
      {RestoreStatus::kBadCells, [](TileState& s) { s.cells[1].place = s.cells[0].place; }},
      {RestoreStatus::kBadCells, [](TileState& s) { s.cells[0].bins = 0; }},
      {RestoreStatus::kBadCells, [](TileState& s) { s.cells.pop_back(); }},
      {RestoreStatus::kBadCells, [](TileState& s) { s.bins.pop_back(); }},
      {RestoreStatus::kBadCells,
       [](TileState& s) {
         s.cells[0].free = {3, 3};
       }},
      {RestoreStatus::kBadCells,
       [](TileState& s) {
         s.cells[0].free = {3, 1 << 25};
       }},
      {RestoreStatus::kBadBins, [](TileState& s) { s.bins[0].count = 0; }},
      {RestoreStatus::kBadBins, [](TileState& s) { s.bins[0].layer = 1 << 24; }},
      {RestoreStatus::kBadBins,
       [](TileState& s) {
         s.cells.resize(1);
         s.cells[0].bins = 2;
         s.bins.resize(2);
         s.bins[0].layer = s.bins[1].layer + 1;
       }},
      {RestoreStatus::kBadBins,
       [](TileState& s) {
         s.cells.resize(1);
         s.cells[0].bins = 3;
         s.bins.resize(3);
         s.bins[0].layer = s.bins[1].layer = s.bins[2].layer;
       }},
      {RestoreStatus::kNotFinite, [](TileState& s) { s.bins[1].m_xy = std::nanf(""); }},
      {RestoreStatus::kNotFinite,
       [](TileState& s) { s.bins[1].last_seen = std::numeric_limits<double>::infinity(); }},
      {RestoreStatus::kTooMany, [](TileState& s) { s.bins.resize(kMostBins + 1); }},
  };
  for (std::size_t k = 0; k < damages.size(); ++k) {
    TileState bad = good;
    damages[k].make(bad);
    EXPECT_EQ(restore_tile(bad, grid), damages[k].expected) << "damage " << k;
    EXPECT_TRUE(test::bytes_of(grid.now()) == before) << "damage " << k;
  }
}

TEST(TileState, AFullTileLeavesPointsOutAndCountsThem) {
  FusionParams params = growing();
  params.layer_height = 0.01;
  params.max_height = 300.0;
  FusedGrid grid(params);
  FusionWorkspace workspace;
  Points points;
  for (int k = 0; k < 256; ++k) {
    for (int layer = 0; layer < 260; ++layer) {
      points.push_back(0.1F + 0.2F * static_cast<float>(k / 16),
                       0.1F + 0.2F * static_cast<float>(k % 16),
                       0.005F + 0.01F * static_cast<float>(layer));
    }
  }
  const FusionCounts counts =
      fuse_scan({points.view(), Eigen::Isometry3d::Identity(), 0.0}, params, workspace, grid);
  EXPECT_EQ(counts.fused + counts.no_room, points.size());
  EXPECT_EQ(memory_of(grid).bins, kMostBins);
  TileState state;
  save_tile({0, 0}, *grid.now().tiles.find({0, 0}), state);
  EXPECT_EQ(restore_tile(state, grid), RestoreStatus::kOk);
  EXPECT_EQ(memory_of(grid).bins, kMostBins);
}

}  // namespace
}  // namespace mrpt_terrain
