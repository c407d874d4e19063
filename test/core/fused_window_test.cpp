// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

FusionParams growing() {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  params.cell_size = params.layer_height = 0.25;
  return params;
}

TEST(WindowAround, ByHand) {
  GridParams params;
  params.length = 2.0;
  params.width = 1.5;
  params.max_height = 1.0;
  const WindowFrame frame =
      window_around(MapLattice(0.5, 0.25), params, Eigen::Vector3d(10.2, -3.3, 7.0));
  EXPECT_EQ(frame.geometry.cells_l(), 4);
  EXPECT_EQ(frame.geometry.cells_w(), 3);
  // Four cells: the origin is a corner, 10.0; three: the middle of a cell, -3.25.
  EXPECT_EQ(frame.x, 10.0);
  EXPECT_EQ(frame.y, -3.25);
  EXPECT_EQ(frame.z, 7.0);
  EXPECT_EQ(frame.first, (MapCell{18, -8}));
  EXPECT_EQ(frame.map_cell_of({1, 2}), (MapCell{19, -6}));
}

TEST(WindowAround, CellsCoincideWithThoseOfTheMapAndTheRobotIsInTheMiddle) {
  RandomGenerator random(1);
  for (int k = 0; k < 1000; ++k) {
    const double c = 0.05 + random.uniform();
    GridParams params;
    params.length = 3.0 + 20.0 * random.uniform();
    params.width = 3.0 + 20.0 * random.uniform();
    const Eigen::Vector3d robot(2000.0 * (random.uniform() - 0.5),
                                2000.0 * (random.uniform() - 0.5), random.uniform());
    const MapLattice lattice(c, c);
    const WindowFrame frame = window_around(lattice, params, robot);
    EXPECT_LE(std::abs(frame.x - robot.x()), 0.5 * c + 1e-9);
    EXPECT_LE(std::abs(frame.y - robot.y()), 0.5 * c + 1e-9);
    const CellIndex cell{frame.geometry.cells_l() / 2, 1};
    const Position2 here = frame.geometry.centre_of(cell);
    const Position2 there = lattice.centre_of(frame.map_cell_of(cell));
    EXPECT_NEAR(here.x + frame.x, there.x, 1e-9);
    EXPECT_NEAR(here.y + frame.y, there.y, 1e-9);
  }
}

// One scan fused and read back is what the grid of the scan is, but for rounding by 2^-17 m.
TEST(ReadWindow, OfOneScanEqualsItsElevationGrid) {
  FusionParams fusion = growing();
  fusion.spread_limit = 1e6;
  fusion.least_share = 0.0;
  GridParams params;
  params.length = 8.0;
  params.width = 6.0;
  params.cell_size = 0.25;
  params.max_height = 2.0;
  RandomGenerator random(4);
  Points points;
  for (int k = 0; k < 5000; ++k) {
    worlds::add_point(points, 10.0 * (random.uniform() - 0.5), 10.0 * (random.uniform() - 0.5),
                      1.9 * random.uniform());
  }
  FusedGrid map(fusion);
  FusionWorkspace workspace;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(-300.0, 77.5, 4.0);  // whole cells and layers
  fuse_scan({points.view(), pose, 2.5}, fusion, workspace, map);
  const WindowFrame frame = window_around(map.now().lattice, params, pose.translation());
  ElevationGrid grid;
  WindowCells cells;
  read_window(map.now(), frame, fusion, grid, cells);

  ElevationGrid expected;
  ElevationGridWorkspace grid_workspace;
  PointSlots slots;
  build_elevation_grid(points.view(), params, grid_workspace, expected, slots);
  ASSERT_EQ(grid.geometry, expected.geometry);
  EXPECT_EQ(grid.cell, expected.cell);
  EXPECT_EQ(grid.slot_of, expected.slot_of);
  ASSERT_GT(grid.observed(), 500U);
  ASSERT_EQ(cells.height.size(), grid.observed());
  ASSERT_EQ(cells.clearance.size(), grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    EXPECT_NEAR(grid.h_min[slot], expected.h_min[slot], 1e-5);
    EXPECT_NEAR(grid.h_max[slot], expected.h_max[slot], 1e-5);
    EXPECT_NEAR(grid.h_mean[slot], expected.h_mean[slot], 1e-5);
    const Moments a = grid.moments(slot);
    const Moments b = expected.moments(slot);
    EXPECT_EQ(a.n, b.n);
    EXPECT_NEAR(a.mean_x, b.mean_x, 1e-5);
    EXPECT_NEAR(a.mean_y, b.mean_y, 1e-5);
    EXPECT_NEAR(a.mean_z, b.mean_z, 1e-5);
    EXPECT_NEAR(a.m_xx, b.m_xx, 1e-5);
    EXPECT_NEAR(a.m_xy, b.m_xy, 1e-5);
    EXPECT_NEAR(a.m_yz, b.m_yz, 1e-4);
    EXPECT_NEAR(a.m_zz, b.m_zz, 1e-4);
    EXPECT_EQ(cells.last_seen[slot], 2.5);
    EXPECT_EQ(cells.clearance[slot], 0.0F);
  }
  const std::vector<float> once = grid.h_mean;
  read_window(map.now(), frame, fusion, grid, cells);
  EXPECT_EQ(grid.h_mean, once) << "memory is used again";
  EXPECT_EQ(cells.height.size(), grid.observed());
}

TEST(ReadWindow, OfAnEmptyMapIsEmpty) {
  const FusionParams fusion = growing();
  FusedGrid map(fusion);
  ElevationGrid grid;
  WindowCells cells;
  read_window(map.now(), window_around(map.now().lattice, {}, Eigen::Vector3d::Zero()), fusion,
              grid, cells);
  EXPECT_EQ(grid.observed(), 0U);
  EXPECT_TRUE(cells.height.empty());
}

}  // namespace
}  // namespace mrpt_terrain
