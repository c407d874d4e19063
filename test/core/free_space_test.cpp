// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/free_space.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

TEST(FreeSpaceGrid, SpansAndGapsByHand) {
  FreeSpaceGrid grid;
  grid.lattice = MapLattice(0.5, 0.5);
  grid.begin_cell({-1, 4});
  grid.add_span({-2, 1});
  grid.add_span({4, 5});
  grid.add_span({5, 9});
  grid.begin_cell({0, 0});
  grid.add_span({0, 1});
  ASSERT_EQ(grid.size(), 2U);
  EXPECT_EQ(grid.lowest_free(0), -1.0);
  EXPECT_EQ(grid.highest_free(0), 4.5);
  ASSERT_EQ(grid.gaps(0), 1U);
  EXPECT_EQ(grid.gap(0, 0), (LayerSpan{1, 4}));
  EXPECT_EQ(grid.gaps(1), 0U);
  EXPECT_TRUE(grid.is_free({-1, 4}, 2.0, 4.5)) << "spans that touch are one";
  EXPECT_FALSE(grid.is_free({-1, 4}, 0.4, 0.6));
  EXPECT_FALSE(grid.is_free({-1, 5}, 2.0, 2.1)) << "nothing is known there";
  EXPECT_EQ(grid.find({0, 0}), 1U);
  EXPECT_EQ(grid.find({0, 1}), grid.size());
  grid.clear();
  EXPECT_EQ(grid.size(), 0U);
}

TEST(CollectFreeSpace, ALayerIsFreeIfAllItsVoxelsAre) {
  std::vector<VoxelIndex> voxels = {{-1, 0, 3}, {-2, 0, 3}, {-1, 1, 3}, {-2, 1, 3},
                                    {-1, 1, 3}, {-1, 0, 4}, {-2, 0, 4}, {-2, 1, 4}};
  FreeSpaceGrid grid;
  collect_free_space(MapLattice(0.2, 0.1), 2, 5.0, voxels, grid);
  ASSERT_EQ(grid.size(), 1U);
  EXPECT_EQ(grid.cell[0], (MapCell{-1, 0}));
  EXPECT_EQ(grid.gaps(0), 0U);
  EXPECT_EQ(*grid.begin_of(0), (LayerSpan{3, 4})) << "one voxel of layer 4 is not free";
  EXPECT_EQ(grid.time, 5.0);
}

TEST(CollectFreeSpace, EqualsCountingInAMap) {
  for (const int side : {1, 2, 3}) {
    RandomGenerator random(static_cast<std::uint64_t>(side));
    std::vector<VoxelIndex> voxels;
    std::map<std::tuple<int, int, int>, std::set<std::pair<int, int>>> count;
    for (int k = 0; k < 3000; ++k) {
      const VoxelIndex v{static_cast<int>(random.below(12)) - 6,
                         static_cast<int>(random.below(12)) - 6,
                         static_cast<int>(random.below(6)) - 3};
      voxels.push_back(v);
      const auto down = [side](int a) { return (a + 12 * side) / side - 12; };
      count[{down(v.x), down(v.y), v.z}].insert({v.x, v.y});
    }
    FreeSpaceGrid grid;
    collect_free_space(MapLattice(side * 0.1, 0.1), side, 0.0, voxels, grid);
    std::size_t layers = 0;
    for (std::size_t k = 0; k < grid.size(); ++k) {
      for (const LayerSpan* span = grid.begin_of(k); span != grid.end_of(k); ++span) {
        layers += static_cast<std::size_t>(span->layers());
        for (int z = span->low; z < span->high; ++z) {
          const auto found = count.find({grid.cell[k].i, grid.cell[k].j, z});
          ASSERT_NE(found, count.end());
          EXPECT_EQ(found->second.size(), static_cast<std::size_t>(side * side));
        }
      }
    }
    std::size_t expected = 0;
    for (const auto& entry : count) {
      expected += entry.second.size() == static_cast<std::size_t>(side * side) ? 1U : 0U;
    }
    EXPECT_EQ(layers, expected);
    EXPECT_GT(layers, 50U);
  }
}

TEST(CollectFreeSpace, OfNothingIsNothing) {
  std::vector<VoxelIndex> none;
  FreeSpaceGrid grid;
  grid.begin_cell({1, 1});
  grid.add_span({0, 1});
  collect_free_space(MapLattice(0.2, 0.2), 1, 0.0, none, grid);
  EXPECT_EQ(grid.size(), 0U);
  EXPECT_EQ(grid.find({1, 1}), 0U);
}

}  // namespace
}  // namespace mrpt_terrain
