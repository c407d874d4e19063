// SPDX-License-Identifier: BSD-3-Clause
// Terrain maps with fusion = rolling: what the grid and the OctoMap do for each other.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>

#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::lidar_pose;
using testing::observation_of;
using testing::small_map;

MapParams rolling_map() {
  MapParams params = small_map();
  params.creation.fusion = Fusion::kRolling;
  params.description.grid.length = params.description.grid.width = 12.0;
  params.fusion.length = params.fusion.width = 20.0;
  return params;
}

/// A curb of 10 cm, and a bridge 1.6 m above the ground behind the robot.
worlds::Scene street() {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({-6.0, 6.0, 2.0, 3.0}, 0.0, 0.1, 1));
  scene.solids.push_back(worlds::box_solid({-4.0, -2.5, -1.5, 1.5}, 1.6, 1.8, 2));
  return scene;
}

/// Where a person stands for a while.
const Position2 kPerson{3.0, -0.5};

worlds::Scene street_with_person() {
  worlds::Scene scene = street();
  const worlds::Rect feet{kPerson.x - 0.2, kPerson.x + 0.2, kPerson.y - 0.2, kPerson.y + 0.2};
  scene.solids.push_back(worlds::box_solid(feet, 0.0, 1.7, 3));
  return scene;
}

/// Inserts what the sensor sees from where it stands; the robot creeps forward.
void drive(const worlds::Scene& scene, int scans, int first, CTerrainMap& map) {
  for (int k = first; k < first + scans; ++k) {
    worlds::LidarModel model = worlds::thirty_two_beams(0.01);
    const double x = 0.02 * k;
    worlds::Scene moved = scene;
    for (worlds::Solid& solid : moved.solids) {
      for (worlds::HalfSpace& face : solid.faces) face.bound -= face.normal.x * x;
    }
    RandomGenerator random(static_cast<std::uint64_t>(k), 1);
    const Points points = worlds::scan(moved, model, random).points;
    ASSERT_TRUE(map.insertObservation(observation_of(points, lidar_pose(), 1000.0 + 0.1 * k),
                                      CPose3D(x, 0, 0, 0, 0, 0)));
  }
}

/// Greatest height over the ground of the cells about a place.
double highest_about(const CTerrainMap& map, Position2 place) {
  double highest = -1.0;
  for (double dx = -0.2; dx < 0.25; dx += 0.1) {
    for (double dy = -0.2; dy < 0.25; dy += 0.1) {
      const CellView cell = map.cell_at(place.x + dx, place.y + dy);
      if (cell.status == PlaceStatus::kKnown) highest = std::max(highest, cell.highest);
    }
  }
  return highest;
}

TEST(FusedTerrainMap, APersonWhoWalkedAwayIsGoneAndACurbStays) {
  CTerrainMap map(rolling_map());
  drive(street_with_person(), 6, 0, map);
  EXPECT_GT(highest_about(map, kPerson), 1.0);
  EXPECT_EQ(map.clusters_in({{2.9, -0.6}, {3.1, -0.4}}).size(), 1U);
  drive(street(), 25, 6, map);
  EXPECT_LT(highest_about(map, kPerson), 0.2);
  EXPECT_TRUE(map.clusters_in({{2.95, -0.55}, {3.05, -0.45}}).empty());
  int curb = 0, seen = 0;
  for (double x = -1.5; x < 3.0; x += 0.1) {
    const CellView cell = map.cell_at(x, 2.55);
    if (cell.status != PlaceStatus::kKnown) continue;
    ++seen;
    curb += std::abs(cell.height - 0.1) < 0.03 ? 1 : 0;
  }
  EXPECT_GT(seen, 10);
  EXPECT_GT(curb, 0.95 * seen) << "of " << seen;
}

TEST(FusedTerrainMap, WithoutTheOctoMapNothingIsForgotten) {
  MapParams params = rolling_map();
  params.creation.octree = false;
  CTerrainMap map(params);
  drive(street_with_person(), 6, 0, map);
  drive(street(), 25, 6, map);
  EXPECT_GT(highest_about(map, kPerson), 1.0);
}

TEST(FusedTerrainMap, UnderABridgeIsGroundAndFreeSpace) {
  CTerrainMap map(rolling_map());
  drive(street(), 20, 0, map);
  const TerrainSnapshotPtr now = map.snapshot();
  int seen = 0, free = 0;
  for (double x = -3.6; x < -2.6; x += 0.1) {
    for (double y = -1.0; y < 1.0; y += 0.1) {
      MapCell where;
      FusedCell cell;
      ASSERT_TRUE(now->fused.lattice.cell_at(x, y, where));
      if (!read_cell(now->fused, where, now->fusion, cell)) continue;
      ++seen;
      EXPECT_NEAR(cell.height, 0.0, 0.05) << x << " " << y;
      const auto* node = map.octree()->search(x, y, 0.85);
      free += node != nullptr && !map.octree()->isNodeOccupied(node) ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(free, seen / 2);
}

TEST(FusedTerrainMap, CellsBeyondTheWindowAreKnown) {
  CTerrainMap map(rolling_map());
  drive(street(), 3, 0, map);
  int known = 0;
  for (double y = -9.0; y < -6.5; y += 0.05) {
    const CellView cell = map.cell_at(0.0, y);
    EXPECT_NE(cell.status, PlaceStatus::kOutside);
    known += cell.status == PlaceStatus::kKnown ? 1 : 0;
  }
  EXPECT_GT(known, 0);
  EXPECT_EQ(map.cell_at(0.0, -11.0).status, PlaceStatus::kOutside);
}

// Oracle: a map that grows without limit, restricted to the window.
TEST(FusedTerrainMap, TheOctoMapIsTrimmedWithTheWindow) {
  MapParams rolling = rolling_map(), growing = rolling_map();
  growing.fusion.extent = FusionExtent::kGrowing;
  CTerrainMap small(rolling), large(growing);
  for (int k = 0; k < 8; ++k) {
    for (CTerrainMap* map : {&small, &large}) {
      RandomGenerator random(static_cast<std::uint64_t>(k), 1);
      const Points points = worlds::scan(street(), worlds::thirty_two_beams(0.01), random).points;
      map->insertObservation(observation_of(points, lidar_pose()), CPose3D(4.0 * k, 0, 0, 0, 0, 0));
    }
  }
  const auto trimmed = small.octree(), whole = large.octree();
  EXPECT_LT(trimmed->size(), 0.7 * static_cast<double>(whole->size()));
  const MapCellRect window = small.snapshot()->fused.window;
  const double cell = small.snapshot()->fused.lattice.cell_size();
  std::size_t compared = 0;
  for (auto leaf = trimmed->begin_leafs(); leaf != trimmed->end_leafs(); ++leaf) {
    EXPECT_GT(leaf.getX(), window.low.i * cell);
    EXPECT_LT(leaf.getX(), window.high.i * cell);
    const auto* same = whole->search(leaf.getKey());
    ASSERT_TRUE(same);
    EXPECT_EQ(same->getLogOdds(), leaf->getLogOdds());
    ++compared;
  }
  EXPECT_GT(compared, 1000U);
}

TEST(FusedTerrainMap, TheVoxelsMustGoIntoACell) {
  const auto refused = [](double resolution) {
    MapParams params = rolling_map();
    params.creation.octree_resolution = resolution;
    try {
      check_together(params, "test");
    } catch (const std::exception&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(0.1));
  EXPECT_FALSE(refused(0.05));
  EXPECT_TRUE(refused(0.2));
  EXPECT_TRUE(refused(0.07));
}

}  // namespace
}  // namespace mrpt_terrain
