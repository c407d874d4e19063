// SPDX-License-Identifier: BSD-3-Clause
// Terrain maps with fusion = rolling: what the grid and the OctoMap do for each other.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "fused_worlds.h"
#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/map/map_file.h"
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

/// A curb of 10 cm, and a bridge 1.6 m above the ground behind the robot. Walls before and behind
/// give returns to rays that would else tell of no free space.
worlds::Scene street() {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({8.0, 8.3, -6.0, 6.0}, 0.0, 3.0, 4));
  scene.solids.push_back(worlds::box_solid({-8.3, -8.0, -6.0, 6.0}, 0.0, 3.0, 5));
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

/// Inserts what the sensor sees from where it stands; the robot stands still, so that its rays
/// later cross all that they have hit.
void drive(const worlds::Scene& scene, int scans, int first, CTerrainMap& map) {
  for (int k = first; k < first + scans; ++k) {
    RandomGenerator random(static_cast<std::uint64_t>(k), 1);
    const Points points = worlds::scan(scene, worlds::thirty_two_beams(0.01), random).points;
    ASSERT_TRUE(
        map.insertObservation(observation_of(points, lidar_pose(), 1000.0 + 0.1 * k), CPose3D()));
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
  // Lower heights are guarded like curbs where no ring meets the ground beside them again.
  const FusionParams fusion = fusion_of(map.params());
  EXPECT_LT(highest_about(map, kPerson), fusion.guard_height + fusion.layer_height);
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

// What a negative obstacle is told by: rays go down where there should be ground, and no point was
// ever in the cell.
TEST(FusedTerrainMap, FreeSpaceIsToldOfCellsWithoutPointsToo) {
  worlds::Scene scene = street();
  scene.holes.push_back(worlds::box_solid({2.0, 5.0, -1.5, 1.5}, -3.0, 0.0, 6));
  for (const Fusion fusion : {Fusion::kRolling, Fusion::kScan}) {
    MapParams params = rolling_map();
    params.creation.fusion = fusion;
    CTerrainMap map(params);
    drive(scene, 12, 0, map);
    const FreeSpaceGrid pit = map.free_space({{2.0, -1.5}, {5.0, 1.5}}, -1.0, 0.5);
    int below = 0, never_hit = 0;
    const auto tree = map.octree();
    for (std::size_t k = 0; k < pit.size(); ++k) {
      const Position2 centre = pit.lattice.centre_of(pit.cell[k]);
      for (const LayerSpan* span = pit.begin_of(k); span != pit.end_of(k); ++span) {
        for (std::int32_t layer = span->low; layer < span->high; ++layer) {
          const auto* node = tree->search(centre.x, centre.y, pit.lattice.bottom_of(layer) + 0.05);
          ASSERT_TRUE(node != nullptr && !tree->isNodeOccupied(node));
        }
      }
      if (pit.lowest_free(k) > -0.35) continue;
      ++below;
      never_hit += map.cell_at(centre.x, centre.y).status == PlaceStatus::kUnknown ? 1 : 0;
    }
    EXPECT_GT(below, 200);
    EXPECT_GT(never_hit, 50);
    const FreeSpaceGrid bridge = map.free_space({{-3.5, -1.0}, {-2.9, 1.0}}, 0.3, 1.3);
    EXPECT_GT(bridge.size(), 50U);
    EXPECT_EQ(bridge.find({-100, 0}), bridge.size());
    const FreeSpaceGrid wall = map.free_space({{8.15, -1.0}, {8.2, 1.0}}, 0.5, 1.5);
    EXPECT_EQ(wall.size(), 0U) << "nothing was seen inside the wall";
  }
  MapParams params = rolling_map();
  params.creation.octree = false;
  CTerrainMap map(params);
  drive(street(), 1, 0, map);
  EXPECT_EQ(map.free_space({{-3.5, -1.0}, {-2.9, 1.0}}, 0.3, 1.3).size(), 0U);
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
  // Rays end within the window, and the robot does not come back: nothing is seen, trimmed, and
  // seen again, which a growing map would remember.
  rolling.octree.max_range = growing.octree.max_range = 6.0;
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

// --- Protected insertion into the OctoMap --------------------------------------------------------

MapParams protected_map(bool protect, double cell_size = 0.2) {
  MapParams params = rolling_map();
  params.creation.octree_resolution = 0.2;
  params.description.grid.cell_size = cell_size;
  params.description.grid.length = params.description.grid.width = 24.0;
  params.fusion.length = params.fusion.width = 60.0;
  params.octree.max_range = 0.0;  // what is hit from afar only is occupied, too
  params.octree.protect_ground = protect;
  return params;
}

/// Where z = 0 of the robot's world lies in the map: within a layer, not on the border of two.
constexpr double kGroundHeight = 0.09;

/// Drives 12 m over level ground past a wall, on which far rays end.
void drive_over_a_plain(CTerrainMap& map) {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({34.0, 34.4, -20.0, 20.0}, 0.0, 4.0, 1));
  worlds::LidarModel sensor = worlds::thirty_two_beams(0.01);
  sensor.height = 1.2;
  sensor.azimuth_step_deg = 0.5;
  RandomGenerator random(5);
  for (int k = 0; k < 24; ++k) {
    const worlds::DriveScan scan = worlds::drive_scan(scene, sensor, 0.5 * k, 0.0, random, 60.0);
    io::Scan inserted;
    inserted.stamp = 100.0 + 0.1 * k;
    inserted.points = scan.points;
    inserted.ray_origins.push_back({0.0F, 0.0F, static_cast<float>(sensor.height)});
    map.insert_scan(inserted, CPose3D(0.5 * k, 0.0, kGroundHeight, 0, 0, 0));
  }
}

/// Share of the cells known as level ground whose voxel the OctoMap says to be occupied.
double occupied_share_of_ground(const CTerrainMap& map) {
  const TerrainSnapshotPtr now = map.snapshot();
  const auto tree = map.octree();
  int ground = 0, occupied = 0;
  for (double x = 5.1; x < 25.0; x += 0.2) {
    for (double y = -5.9; y < 6.0; y += 0.2) {
      MapCell where;
      FusedCell cell;
      if (!now->fused.lattice.cell_at(x, y, where)) continue;
      if (!read_cell(now->fused, where, now->fusion, cell) || cell.h_max > 0.2) continue;
      const auto* node = tree->search(x, y, kGroundHeight);
      ++ground;
      occupied += node != nullptr && tree->isNodeOccupied(node) ? 1 : 0;
    }
  }
  EXPECT_GT(ground, 3000);
  return static_cast<double>(occupied) / ground;
}

TEST(ProtectedOctoMap, GrazingRaysTakeNoGroundOnADrive) {
  CTerrainMap plain(protected_map(false)), guarded(protected_map(true));
  for (CTerrainMap* map : {&plain, &guarded}) drive_over_a_plain(*map);
  const double without = occupied_share_of_ground(plain), with = occupied_share_of_ground(guarded);
  std::printf("ground that is occupied: %.1f %% without, %.1f %% with\n", 100 * without,
              100 * with);
  EXPECT_LT(without, 0.7) << "rays did graze";
  EXPECT_GT(with, 0.99);
}

TEST(ProtectedOctoMap, SeveralVoxelsPerCellAreGuardedToo) {
  CTerrainMap plain(protected_map(false, 0.4)), guarded(protected_map(true, 0.4));
  for (CTerrainMap* map : {&plain, &guarded}) drive_over_a_plain(*map);
  const double without = occupied_share_of_ground(plain), with = occupied_share_of_ground(guarded);
  EXPECT_GT(with, without + 0.25);
}

int occupied_voxels_of_person(const CTerrainMap& map) {
  const auto tree = map.octree();
  int occupied = 0;
  for (double x = kPerson.x - 0.25; x < kPerson.x + 0.3; x += 0.1) {
    for (double y = kPerson.y - 0.25; y < kPerson.y + 0.3; y += 0.1) {
      for (double z = 0.25; z < 2.0; z += 0.1) {
        const auto* node = tree->search(x, y, z);
        occupied += node != nullptr && tree->isNodeOccupied(node) ? 1 : 0;
      }
    }
  }
  return occupied;
}

TEST(ProtectedOctoMap, APersonWhoWalkedAwayIsGone) {
  int after[2] = {};
  for (const bool protect : {false, true}) {
    MapParams params = rolling_map();
    params.octree.protect_ground = protect;
    CTerrainMap map(params);
    drive(street_with_person(), 6, 0, map);
    EXPECT_GT(occupied_voxels_of_person(map), 30);
    drive(street(), 25, 6, map);
    after[protect ? 1 : 0] = occupied_voxels_of_person(map);
  }
  EXPECT_EQ(after[1], after[0]) << "as without the guard";
  EXPECT_LT(after[1], 3);
}

TEST(ProtectedOctoMap, APlatformThatWasTakenAwayIsGone) {
  // 1 m high and so wide that its top is all the ground there is, but for its surroundings.
  worlds::Scene with = street(), without = street();
  with.solids.push_back(worlds::box_solid({2.0, 5.0, -3.0, 1.0}, 0.0, 0.5, 7));
  MapParams params = rolling_map();
  params.octree.protect_ground = true;
  CTerrainMap map(params);
  drive(with, 6, 0, map);
  const auto occupied = [&map] {
    const auto tree = map.octree();
    int voxels = 0;
    for (double x = 2.05; x < 5.0; x += 0.1) {
      for (double y = -2.95; y < 1.0; y += 0.1) {
        for (double z = 0.25; z < 0.6; z += 0.1) {
          const auto* node = tree->search(x, y, z);
          voxels += node != nullptr && tree->isNodeOccupied(node) ? 1 : 0;
        }
      }
    }
    return voxels;
  };
  const int before = occupied();
  EXPECT_GT(before, 200);
  drive(without, 40, 6, map);
  EXPECT_LT(occupied(), before / 20);
}

TEST(ProtectedOctoMap, NeedsFusedScansAndIsRefusedWithoutThem) {
  MapParams params = protected_map(true);
  check_together(params, "test");
  params.creation.fusion = Fusion::kScan;
  EXPECT_THROW(check_together(params, "test"), std::exception);
  params = protected_map(true);
  params.creation.octree = false;
  EXPECT_THROW(check_together(params, "test"), std::exception);
  EXPECT_FALSE(MapParams{}.octree.protect_ground);
}

// What is guarded comes from the grid, which is stored: a map that was read goes on as it would
// have.
TEST(ProtectedOctoMap, AStoredMapGoesOnAsItWouldHave) {
  const auto stored = [](const CTerrainMap& map) {
    std::ostringstream bytes;
    map.octree()->writeData(bytes);
    return bytes.str();
  };
  CTerrainMap map(protected_map(true));
  drive_over_a_plain(map);
  const std::string folder = ::testing::TempDir();
  save_map_file(map, folder + "protected.metricmap");
  CTerrainMap read = load_map_file(folder + "protected.metricmap");
  EXPECT_TRUE(read.params().octree.protect_ground);
  for (CTerrainMap* each : {&map, &read}) drive_over_a_plain(*each);
  EXPECT_EQ(stored(map), stored(read));
}

}  // namespace
}  // namespace mrpt_terrain
