// SPDX-License-Identifier: BSD-3-Clause
// Terrain maps in field mode, with single and with fused scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fused_worlds.h"
#include "mrpt_terrain/map/map_file.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::bytes_of;
using testing::lidar_pose;
using testing::map_from;
using testing::observation_of;

MapParams field_map(Fusion fusion) {
  MapParams params;
  params.creation.fusion = fusion;
  params.creation.octree_resolution = 0.2;
  params.description.description.mode = DescriptionMode::kField;
  params.description.grid = {20.0, 20.0, 0.2, 3.0};
  params.description.ground_surface.reach = 25.0;
  params.description.classes.t_neg = -0.03;
  params.fusion.length = params.fusion.width = 30.0;
  return params;
}

constexpr worlds::Rect kBox{3.0, 3.6, 1.0, 1.6};
// A child: rays pass over its head, too.
constexpr worlds::Rect kPerson{3.0, 3.4, -1.2, -0.8};
constexpr worlds::Rect kHole{-2.7, -1.9, -0.4, 0.4};

/// Walls give returns to rays that would else tell of no free space.
worlds::Scene yard(bool box, bool person) {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({8.0, 8.4, -9.0, 9.0}, 0.0, 2.5, 1));
  scene.solids.push_back(worlds::box_solid({-8.4, -8.0, -9.0, 9.0}, 0.0, 2.5, 2));
  if (box) scene.solids.push_back(worlds::box_solid(kBox, 0.0, 0.5, 3));
  if (person) scene.solids.push_back(worlds::box_solid(kPerson, 0.0, 1.1, 4));
  scene.holes.push_back(worlds::box_solid(kHole, -0.15, 0.0, 5));
  return scene;
}

/// What the sensor sees on one of both sides, or on both.
enum class Side { kBoth, kAhead, kBehind };

void look(const worlds::Scene& scene, Side side, int number, CTerrainMap& map) {
  RandomGenerator random(static_cast<std::uint64_t>(number), 3);
  const Points all = worlds::scan(scene, worlds::thirty_two_beams(0.005), random).points;
  Points seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool ahead = all.x[i] > 0.0F;
    if (side == Side::kBoth || ahead == (side == Side::kAhead))
      seen.push_back(all.x[i], all.y[i], all.z[i]);
  }
  ASSERT_TRUE(
      map.insertObservation(observation_of(seen, lidar_pose(), 1000.0 + 0.2 * number), CPose3D()));
}

/// Identities of the clusters at a place; the middle of a box may be out of sight.
std::vector<std::uint64_t> identities_at(const CTerrainMap& map, const worlds::Rect& r) {
  std::vector<std::uint64_t> identities;
  for (const ClusterView& cluster :
       map.clusters_in({{r.x0 + 0.05, r.y0 + 0.05}, {r.x1 - 0.05, r.y1 - 0.05}}))
    identities.push_back(cluster.identity);
  return identities;
}

class FieldMap : public ::testing::TestWithParam<Fusion> {};

TEST_P(FieldMap, FindsBoxAndPothole) {
  CTerrainMap map(field_map(GetParam()));
  for (int k = 0; k < 3; ++k) look(yard(true, false), Side::kBoth, k, map);
  const TerrainSnapshotPtr now = map.snapshot();
  EXPECT_EQ(map.cell_at(kBox.x0 + 0.1, 1.3).terrain_class, TerrainClass::kObstacle);
  EXPECT_EQ(map.cell_at(-2.3, 0.1).terrain_class, TerrainClass::kPothole);
  EXPECT_EQ(map.cell_at(2.0, 0.1).support, Support::kGround);
  EXPECT_EQ(now->description.labels.support.size(), now->points.size());
  ASSERT_FALSE(now->clusters.empty());
  for (std::size_t k = 0; k < now->clusters.size(); ++k) {
    EXPECT_NE(now->clusters[k].identity, 0U);
    EXPECT_EQ(now->clusters[k].identity, now->description.things[k].identity);
  }
}

// With single scans, the tracker remembers the box that the map does not.
TEST_P(FieldMap, AThingThatWasHiddenIsTheSameAgain) {
  CTerrainMap map(field_map(GetParam()));
  for (int k = 0; k < 3; ++k) look(yard(true, false), Side::kBoth, k, map);
  const std::vector<std::uint64_t> first = identities_at(map, kBox);
  ASSERT_EQ(first.size(), 1U);
  for (int k = 3; k < 6; ++k) {
    look(yard(true, false), Side::kBehind, k, map);
    const bool remembered = GetParam() == Fusion::kRolling;
    EXPECT_EQ(identities_at(map, kBox), remembered ? first : std::vector<std::uint64_t>{});
  }
  CTerrainMap read = map_from(bytes_of(map)), copy(map);
  for (CTerrainMap* each : {&map, &read, &copy}) {
    look(yard(true, false), Side::kBoth, 6, *each);
    EXPECT_EQ(identities_at(*each, kBox), first);
  }
  EXPECT_EQ(bytes_of(map), bytes_of(read));
  EXPECT_EQ(bytes_of(map), bytes_of(copy));
}

TEST_P(FieldMap, NotABitChangesWhenItIsStored) {
  CTerrainMap map(field_map(GetParam()));
  look(yard(true, true), Side::kBoth, 0, map);
  look(yard(true, false), Side::kAhead, 1, map);
  const CTerrainMap read = map_from(bytes_of(map));
  const TerrainSnapshotPtr a = map.snapshot(), b = read.snapshot();
  EXPECT_EQ(a->description.grid.h_mean, b->description.grid.h_mean);
  EXPECT_EQ(a->description.cells.support, b->description.cells.support);
  EXPECT_EQ(a->description.labels.cluster, b->description.labels.cluster);
  EXPECT_EQ(a->window_cells.height, b->window_cells.height);
  ASSERT_EQ(a->clusters.size(), b->clusters.size());
  for (std::size_t k = 0; k < a->clusters.size(); ++k)
    EXPECT_EQ(a->clusters[k].identity, b->clusters[k].identity);
  EXPECT_EQ(bytes_of(map), bytes_of(read));
}

TEST_P(FieldMap, IdentitiesAreNotUsedAgainAfterClearing) {
  CTerrainMap map(field_map(GetParam()));
  look(yard(true, false), Side::kBoth, 0, map);
  std::uint64_t last = 0;
  for (const ClusterView& cluster : map.snapshot()->clusters)
    last = std::max(last, cluster.identity);
  map.clear();
  CTerrainMap read = map_from(bytes_of(map));
  for (CTerrainMap* each : {&map, &read}) {
    look(yard(true, false), Side::kBoth, 1, *each);
    for (const ClusterView& cluster : each->snapshot()->clusters) EXPECT_GT(cluster.identity, last);
  }
}

INSTANTIATE_TEST_SUITE_P(Fusions, FieldMap, ::testing::Values(Fusion::kScan, Fusion::kRolling),
                         [](const auto& fusion) { return std::string(name_of(fusion.param)); });

// The robot drives on, with what is ahead in sight.
void drive_on(const worlds::Scene& scene, int number, CTerrainMap& map) {
  RandomGenerator random(static_cast<std::uint64_t>(number), 3);
  const double x = 0.04 * number;
  const worlds::DriveScan scan = worlds::drive_scan(scene, worlds::thirty_two_beams(0.005), x, 0.0,
                                                    random, number < 5 ? 180.0 : 60.0);
  ASSERT_TRUE(
      map.insertObservation(observation_of(scan.points, lidar_pose(), 1000.0 + 0.2 * number),
                            CPose3D(x, 0.0, 0.0, 0.0, 0.0, 0.0)));
}

TEST(FusedFieldMap, WhatIsBehindIsRememberedAndWhoLeftIsGone) {
  CTerrainMap map(field_map(Fusion::kRolling));
  for (int k = 0; k < 5; ++k) drive_on(yard(true, true), k, map);
  EXPECT_EQ(map.cell_at(-2.3, 0.1).terrain_class, TerrainClass::kPothole);
  EXPECT_EQ(identities_at(map, kPerson).size(), 1U);
  for (int k = 5; k < 25; ++k) drive_on(yard(true, false), k, map);
  EXPECT_EQ(map.cell_at(-2.3, 0.1).terrain_class, TerrainClass::kPothole) << "out of sight";
  EXPECT_EQ(identities_at(map, kBox).size(), 1U) << "in sight";
  EXPECT_TRUE(identities_at(map, kPerson).empty()) << "the person has left";
  EXPECT_NE(map.cell_at(kPerson.x0 + 0.1, -1.0).support, Support::kAbove);
}

// Two curbs, seen by a simulated robot and stored in field mode by the last version
// that wrote format 2, which knew nothing of a tracker: identities go on from what was stored.
TEST(FieldMapFile, OfFormat2GoesOnWithItsIdentities) {
  CTerrainMap map =
      load_map_file(MRPT_TERRAIN_SOURCE_DIR "/test/data/terrain_map_field_format_2.metricmap");
  EXPECT_EQ(map.params().description.description.mode, DescriptionMode::kField);
  const TerrainSnapshotPtr before = map.snapshot();
  EXPECT_EQ(before->revision, 2U);
  EXPECT_EQ(before->points.size(), 2343U);
  std::vector<std::uint64_t> stored;
  for (const ClusterView& cluster : before->clusters) stored.push_back(cluster.identity);
  EXPECT_EQ(stored, (std::vector<std::uint64_t>{2, 3}));
  io::Scan scan;
  scan.points = before->points;
  scan.ray_origins = before->ray_origins;
  scan.origin_of = before->origin_of;
  scan.stamp = before->stamp + 0.1;
  ASSERT_TRUE(map.insert_scan(scan, CPose3D(2.0, 0.0, 0.0, 0.0, 0.0, 0.0)));
  std::vector<std::uint64_t> again;
  for (const ClusterView& cluster : map.snapshot()->clusters) again.push_back(cluster.identity);
  EXPECT_EQ(again, stored);
  EXPECT_EQ(map_from(bytes_of(map)).snapshot()->clusters.size(), 2U) << "in the format of today";
}

}  // namespace
}  // namespace mrpt_terrain
