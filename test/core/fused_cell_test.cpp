// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/core/tile_state.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

FusionParams growing() {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  params.cell_size = params.layer_height = 0.25;
  return params;
}

/// A grid that has seen points of these heights in its cell (0, 0), a scan each row.
FusedGrid grid_of(const std::vector<std::vector<float>>& scans, const FusionParams& params) {
  FusedGrid grid(params);
  FusionWorkspace workspace;
  double time = 0.0;
  for (const std::vector<float>& heights : scans) {
    Points points;
    for (const float z : heights) points.push_back(0.125F, 0.125F, z);
    fuse_scan({points.view(), Eigen::Isometry3d::Identity(), time}, params, workspace, grid);
    time += 1.0;
  }
  return grid;
}

FusedCell read(const FusedGrid& grid, const FusionParams& params) {
  FusedCell cell;
  EXPECT_TRUE(read_cell(grid.now(), {0, 0}, params, cell));
  return cell;
}

/// Sets the free space that the cell (0, 0) knows.
void set_free(LayerSpan free, FusedGrid& grid) {
  TileState state;
  save_tile({0, 0}, *grid.now().tiles.find({0, 0}), state);
  state.cells.at(0).free = free;
  ASSERT_EQ(restore_tile(state, grid), RestoreStatus::kOk);
}

TEST(ReadCell, GroundAndExtremesByHand) {
  const FusionParams params = growing();
  const FusedGrid grid = grid_of({{0.0625F, 0.125F}, {0.0625F, 0.125F, 1.5F}}, params);
  const FusedCell cell = read(grid, params);
  EXPECT_EQ(cell.height, 0.09375);
  EXPECT_EQ(cell.variance, 0.03125 * 0.03125);
  EXPECT_EQ(cell.h_min, 0.0625);
  EXPECT_EQ(cell.h_max, 1.5);
  EXPECT_EQ(cell.moments.n, 5.0);
  EXPECT_NEAR(cell.moments.mean_z, (2 * 0.1875 + 1.5) / 5, 1e-12);
  EXPECT_EQ(cell.moments.mean_x, 0.125);
  EXPECT_EQ(cell.last_seen, 1.0);
  EXPECT_EQ(cell.bins, 2);
  EXPECT_FALSE(cell.overhung);
}

TEST(ReadCell, GroundOnTheBorderOfTwoLayersIsOneSurface) {
  const FusionParams params = growing();
  const FusedCell cell = read(grid_of({{0.24F, 0.24F, 0.26F, 0.26F}}, params), params);
  EXPECT_NEAR(cell.height, 0.25, 1e-4);
  const FusedCell wall = read(grid_of({{0.01F, 0.12F, 0.24F, 0.26F, 0.4F, 0.49F}}, params), params);
  EXPECT_NEAR(wall.height, (0.01 + 0.12 + 0.24) / 3, 1e-4) << "a wall goes on for longer";
}

TEST(ReadCell, FewPointsBelowAreNoGround) {
  const FusionParams params = growing();
  std::vector<float> ground(40, 0.1F);
  ground.push_back(-1.0F);  // a reflection
  const FusedCell cell = read(grid_of({ground, ground}, params), params);
  EXPECT_NEAR(cell.height, 0.1, 1e-4);
  EXPECT_NEAR(cell.h_min, 0.1, 1e-4);
  EXPECT_EQ(cell.below, 2);
  EXPECT_EQ(cell.moments.n, 80.0) << "they are in no statistics";
  const FusedCell seen = read(grid_of({ground, ground, ground}, params), params);
  EXPECT_NEAR(seen.height, -1.0, 1e-4) << "what three scans see is there";
}

TEST(ReadCell, WildExtremesAreCut) {
  const FusionParams params = growing();
  std::vector<float> heights;
  for (int k = 0; k < 500; ++k) heights.push_back(k % 2 == 0 ? 0.09F : 0.11F);
  heights.push_back(0.2F);
  const FusedCell cell = read(grid_of({heights}, params), params);
  EXPECT_NEAR(cell.h_max, 0.2, 1e-4);
  // sigma^2 = 0.01^2 + 0.1^2 / 501 nearly
  EXPECT_NEAR(cell.high, 0.1 + 3 * std::sqrt(1.2e-4), 1e-3);
  EXPECT_NEAR(cell.low, cell.h_min, 1e-12);
  const FusedCell few = read(grid_of({{0.1F, 0.1F, 0.1F, 0.2F}}, params), params);
  EXPECT_EQ(few.high, few.h_max) << "a few points cannot be told from their outliers";
}

TEST(ReadCell, WhatHangsOverFreeSpaceIsNoPartOfTheGround) {
  const FusionParams params = growing();
  FusedGrid grid = grid_of({{0.1F, 2.6F, 2.8F, 0.1F}}, params);
  EXPECT_NEAR(read(grid, params).h_max, 2.8, 1e-4) << "nothing is known of what is between";
  set_free({1, 10}, grid);  // 0.25 to 2.5
  const FusedCell cell = read(grid, params);
  EXPECT_TRUE(cell.overhung);
  EXPECT_NEAR(cell.overhang, 2.6, 1e-4);
  EXPECT_NEAR(cell.h_max, 0.1, 1e-4);
  EXPECT_EQ(cell.moments.n, 2.0);
  set_free({3, 10}, grid);  // begins too far above the ground
  EXPECT_FALSE(read(grid, params).overhung);
  set_free({1, 8}, grid);  // is too low: 1.75 m
  EXPECT_FALSE(read(grid, params).overhung);
}

TEST(ReadCell, AHitEndsFreeSpace) {
  const FusionParams params = growing();
  FusedGrid grid = grid_of({{0.1F}}, params);
  set_free({1, 10}, grid);
  FusionWorkspace workspace;
  Points points;
  points.push_back(0.125F, 0.125F, 2.1F);  // layer 8
  fuse_scan({points.view(), Eigen::Isometry3d::Identity(), 5.0}, params, workspace, grid);
  EXPECT_EQ(read(grid, params).free, (LayerSpan{1, 8}));
  points.z[0] = 0.6F;  // layer 2
  fuse_scan({points.view(), Eigen::Isometry3d::Identity(), 6.0}, params, workspace, grid);
  EXPECT_EQ(read(grid, params).free, (LayerSpan{3, 8}));
}

TEST(ReadCell, LayersFromTheCeilingUpAreNotRead) {
  const FusionParams params = growing();
  const FusedGrid grid = grid_of({{0.1F, 1.4F, 1.6F}}, params);
  FusedCell cell;
  const Tile& tile = *grid.now().tiles.find({0, 0});
  ASSERT_TRUE(read_cell({grid.now(), params, 1.5}, {0, 0}, tile, 0, cell));
  EXPECT_NEAR(cell.h_max, 1.4, 1e-4);
  EXPECT_FALSE(read_cell({grid.now(), params, 0.05}, {0, 0}, tile, 0, cell));
}

TEST(ReadCell, NothingIsKnownElsewhere) {
  const FusionParams params = growing();
  const FusedGrid grid = grid_of({{0.1F}}, params);
  FusedCell cell;
  cell.h_max = 42.0;
  EXPECT_FALSE(read_cell(grid.now(), {1, 0}, params, cell));
  EXPECT_FALSE(read_cell(grid.now(), {1000000, -1000000}, params, cell));
  EXPECT_FALSE(read_cell(FusedGrid(params).now(), {0, 0}, params, cell));
  EXPECT_EQ(cell.h_max, 42.0);
}

}  // namespace
}  // namespace mrpt_terrain
