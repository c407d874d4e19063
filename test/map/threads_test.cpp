// SPDX-License-Identifier: BSD-3-Clause
// Two threads insert while others read, draw, save, copy, convert and localise. Means most under
// the thread sanitizer (preset tsan).
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/OcTree.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "mrpt_terrain/map/map_file.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "observations.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::fresh_folder;
using testing::lidar_pose;
using testing::observation_of;
using testing::scene_points;
using testing::small_map;

class TerrainMapThreads : public ::testing::TestWithParam<Fusion> {};

TEST_P(TerrainMapThreads, ReadersNeverSeeHalfAScan) {
  MapParams params = small_map();
  params.creation.fusion = GetParam();
  params.fusion.length = params.fusion.width = 20.0;
  CTerrainMap map(params);
  const auto observation = observation_of(scene_points(), lidar_pose());
  std::atomic<bool> done{false};
  std::atomic<int> reads{0};
  const auto reader = [&](auto&& read) {
    return std::thread([&done, &reads, read] {
      do {
        read();
        ++reads;
      } while (!done);
    });
  };
  std::vector<std::thread> readers;
  readers.push_back(reader([&map] {
    const TerrainSnapshotPtr now = map.snapshot();
    EXPECT_EQ(now->clusters.size(), now->description.things.size());
    EXPECT_EQ(now->costs().size(), now->description.grid.observed());
    EXPECT_EQ(now->description.labels.support.size(), now->points.size());
    (void)now->cell_at(2.05, 0.75);
    (void)map.cost_at(2.05, 0.75, 0.3);
  }));
  readers.push_back(reader([&map] {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << map;
    stream.Seek(0);
    CTerrainMap copy;
    mrpt::serialization::archiveFrom(stream) >> copy;
    EXPECT_EQ(copy.isEmpty(), copy.octree()->size() == 0);
  }));
  readers.push_back(reader([&map, &observation] {
    mrpt::opengl::CSetOfObjects objects;
    map.getVisualizationInto(objects);
    EXPECT_LE(map.computeObservationLikelihood(observation, CPose3D()), 0.0);
  }));
  readers.push_back(reader([&map] {
    const CTerrainMap copy(map);
    const TerrainSnapshotPtr now = copy.snapshot();
    EXPECT_EQ(now->revision == 0, copy.octree()->size() == 0);
    EXPECT_EQ(now->clusters.size(), now->description.things.size());
    (void)map.as_points_map();
    (void)map.as_occupancy_grid();
    (void)map.as_voxels();
  }));
  const std::filesystem::path folder = fresh_folder();
  readers.push_back(reader([&map, &folder] {
    save_map_file(map, (folder / "map.metricmap").string());
    map.saveMetricMapRepresentationToFile((folder / "map").string());
    (void)load_map_file((folder / "map.metricmap").string());
  }));
  std::vector<std::thread> writers;
  map.insertObservation(observation, CPose3D());
  map.clear();
  for (const double side : {0.0, 0.4}) {
    writers.emplace_back([&map, &observation, side] {
      for (int k = 0; k < 6; ++k) {
        EXPECT_TRUE(map.insertObservation(observation, CPose3D(0.2 * k, side, 0, 0, 0, 0)));
        EXPECT_EQ(map.last_refusal(), "");
      }
    });
  }
  for (std::thread& thread : writers) thread.join();
  done = true;
  for (std::thread& thread : readers) thread.join();
  EXPECT_GE(reads.load(), static_cast<int>(readers.size()));
  EXPECT_EQ(map.snapshot()->revision, 12U);
}

void expect_same(const CellCosts& a, const CellCosts& b) {
  EXPECT_EQ(a.gradient_x, b.gradient_x);
  EXPECT_EQ(a.gradient_y, b.gradient_y);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.status, b.status);
}

// Oracle: a map that one thread alone asks, scan by scan. Snapshots that were computed at the same
// time hand their memory to each other; with the second scan it is used again.
TEST_P(TerrainMapThreads, CostsAreTheSameWhoeverAsksFirst) {
  MapParams params = small_map();
  params.creation.fusion = GetParam();
  params.fusion.length = params.fusion.width = 20.0;
  CTerrainMap map(params), quiet(params);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto observation = observation_of(scene_points(seed), lidar_pose());
    const CPose3D pose(0.3 * static_cast<double>(seed), 0, 0, 0, 0, 0);
    const TerrainSnapshotPtr before = map.snapshot();
    ASSERT_TRUE(map.insertObservation(observation, pose));
    ASSERT_TRUE(quiet.insertObservation(observation, pose));
    const TerrainSnapshotPtr now = map.snapshot();
    EXPECT_EQ(now->known_costs(), nullptr);
    std::atomic<int> waiting{5};
    const auto ask = [&waiting](const TerrainSnapshot& snapshot) {
      --waiting;
      while (waiting > 0) std::this_thread::yield();  // all at once
      return &snapshot.costs();
    };
    std::vector<const CellCosts*> answers(4);
    std::vector<std::thread> readers;
    for (const CellCosts*& answer : answers) {
      readers.emplace_back([&, to = &answer] { *to = ask(*now); });
    }
    readers.emplace_back([&] { (void)ask(*before); });
    for (std::thread& reader : readers) reader.join();
    for (const CellCosts* answer : answers) EXPECT_EQ(answer, now->known_costs());
    ASSERT_GT(now->costs().size(), 100U);
    expect_same(now->costs(), quiet.snapshot()->costs());
  }
}

INSTANTIATE_TEST_SUITE_P(Fusions, TerrainMapThreads,
                         ::testing::Values(Fusion::kScan, Fusion::kRolling),
                         [](const auto& fusion) { return std::string(name_of(fusion.param)); });

}  // namespace
}  // namespace mrpt_terrain
