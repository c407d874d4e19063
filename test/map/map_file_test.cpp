// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/map_file.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;

CTerrainMap seen_map() {
  CTerrainMap map(testing::small_map());
  map.insertObservation(testing::observation_of(testing::scene_points(1), testing::lidar_pose()),
                        CPose3D(0.1, 0, 0, 0.3, 0.01, 0.02));
  return map;
}

TEST(MapFile, HoldsTheStoredObject) {
  const std::string file = test::empty_test_folder() + "a.metricmap";
  const CTerrainMap map = seen_map();
  save_map_file(map, file);
  EXPECT_EQ(test::gunzip_file(file), test::stored(map));
  EXPECT_EQ(test::stored(load_map_file(file)), test::stored(map));
  EXPECT_TRUE(is_map_file(file));
}

TEST(MapFile, TheSameMapMakesTheSameBytes) {
  const std::string folder = test::empty_test_folder();
  save_map_file(seen_map(), folder + "a.metricmap");
  save_map_file(seen_map(), folder + "b.metricmap");
  EXPECT_EQ(test::read_file(folder + "a.metricmap"), test::read_file(folder + "b.metricmap"));
}

TEST(MapFile, AFileThatCannotBeWrittenIsNamed) {
  const std::string file = test::empty_test_folder() + "none/a.metricmap";
  EXPECT_EQ(test::message_of<std::runtime_error>([&] { save_map_file(seen_map(), file); }),
            file + ": cannot be written: No such file or directory");
}

TEST(MapFile, WhatIsNoMapIsRefused) {
  const std::string folder = test::empty_test_folder();
  const std::string stored = test::stored(seen_map());
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is empty"},
      {"Dear diary", "is no terrain map: it does not begin with an MRPT object"},
      {test::stored(CPose3D()), "is no terrain map: it holds a mrpt::poses::CPose3D"},
      {test::gzip(stored.substr(0, stored.size() / 2)), "the map in it is cut off"},
      {stored + "x", "there is more in it than a map"}};
  for (const auto& [bytes, reason] : cases) {
    const std::string file = test::write_file(folder + "x.metricmap", bytes);
    EXPECT_EQ(test::message_of<io::ReadError>([&] { (void)load_map_file(file); }),
              file + ": " + reason);
  }
}

// The checksum covers all that the map knows.
TEST(MapFile, AnyFlippedByteIsNoticed) {
  const std::string folder = test::empty_test_folder();
  const std::string stored = test::stored(seen_map());
  const std::size_t step = stored.size() / 60 + 1;
  for (std::size_t at = 0; at < stored.size(); at += step) {
    std::string bytes = stored;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x41);
    const std::string file = test::write_file(folder + "x.metricmap", test::gzip(bytes));
    EXPECT_THROW((void)load_map_file(file), io::ReadError) << at;
  }
}

// Two scans of level ground at z = 1 m with a block of 0.5 m, of a robot at x = 10 and 11 m: stored
// by the first versions that had files of format 1 and of format 2. They must stay readable for
// ever.
TEST(MapFile, FilesOfOlderFormatsAreRead) {
  for (const char* format : {"1", "2"}) {
    const CTerrainMap map = load_map_file(std::string(MRPT_TERRAIN_SOURCE_DIR) +
                                          "/test/data/terrain_map_format_" + format + ".metricmap");
    EXPECT_EQ(map.params().creation.fusion, Fusion::kRolling);
    EXPECT_EQ(map.params().description.grid.cell_size, 0.25);
    EXPECT_FALSE(map.params().octree.protect_ground) << "they know nothing of it";
    EXPECT_EQ(map.snapshot()->revision, 2U);
    EXPECT_EQ(map.snapshot()->T_map_robot.translation().x(), 11.0);
    EXPECT_EQ(map.snapshot()->points.size(), 256U);
    const CellView ground = map.cell_at(9.6, 0.1), block = map.cell_at(12.35, 1.35);
    ASSERT_EQ(ground.status, PlaceStatus::kKnown);
    EXPECT_NEAR(ground.height, 1.0, 1e-4);
    EXPECT_EQ(ground.points, 2);
    ASSERT_EQ(block.status, PlaceStatus::kKnown);
    EXPECT_NEAR(block.highest, 1.5, 1e-4);
    const auto* voxel = map.octree()->search(12.35, 1.35, 1.55);
    ASSERT_TRUE(voxel);
    EXPECT_TRUE(map.octree()->isNodeOccupied(voxel));
  }
}

}  // namespace
}  // namespace mrpt_terrain
