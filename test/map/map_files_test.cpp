// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>

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

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

CTerrainMap seen_map() {
  CTerrainMap map(small_map());
  map.insertObservation(observation_of(scene_points(), lidar_pose()), CPose3D(10, 5, 0, 0, 0, 0));
  return map;
}

TEST(MapFiles, AllFormsAreWritten) {
  const std::string prefix = fresh_folder() + "/map";
  const CTerrainMap map = seen_map();
  map.saveMetricMapRepresentationToFile(prefix);
  for (const char* end : {".3Dscene", ".ot", ".bt", "_classes.png", "_cost.png", "_clusters.csv",
                          "_cost.pgm", "_cost.yaml"}) {
    EXPECT_GT(content_of(prefix + end).size(), 100U) << end;
  }
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(prefix + ".3Dscene"));
  EXPECT_TRUE(scene.getByName("cells"));
}

// Field mode knows why cells were not seen, holes, and more parts of the costs.
TEST(MapFiles, FieldModeWritesEveryPartOfTheCosts) {
  MapParams params = small_map();
  params.description.description.mode = DescriptionMode::kField;
  params.creation.fusion = Fusion::kScan;
  CTerrainMap map(params);
  map.insertObservation(observation_of(scene_points(), lidar_pose()), CPose3D(10, 5, 0, 0, 0, 0));
  const std::string prefix = fresh_folder() + "/map";
  map.saveMetricMapRepresentationToFile(prefix);
  for (const auto& part : enum_names(CostPart{})) {
    const std::string layer = prefix + "_cost_" + part.name;
    EXPECT_EQ(content_of(layer + ".pgm").substr(0, 2), "P5") << part.name;
    EXPECT_NE(content_of(layer + ".yaml").find(std::string("map_cost_") + part.name + ".pgm"),
              std::string::npos);
  }
  EXPECT_GT(content_of(prefix + "_cost_layers.png").size(), 1000U);
  EXPECT_EQ(content_of(prefix + "_holes.csv").substr(0, 17), "hole,kind,cluster");

  // What the snapshot says of a place agrees with what it holds.
  const TerrainSnapshotPtr now = map.snapshot();
  const GridGeometry& geometry = now->description.grid.geometry;
  ASSERT_EQ(now->costs().unseen.size(), static_cast<std::size_t>(geometry.array_size()));
  int unseen = 0;
  for (int l = 0; l < geometry.cells_l(); ++l) {
    for (int w = 0; w < geometry.cells_w(); ++w) {
      const Position2 place = geometry.centre_of({l, w});
      const CellView cell = now->cell_at(10 + place.x, 5 + place.y);
      const auto id = static_cast<std::size_t>(value_of(geometry.id_of({l, w})));
      ASSERT_EQ(cell.unseen, now->costs().unseen[id]);
      if (cell.status != PlaceStatus::kUnknown) continue;
      const Cost cost = now->cost_at(10 + place.x, 5 + place.y, 0.3);
      EXPECT_EQ(cost.status, CostStatus::kUnknown);
      EXPECT_EQ(cost.cost, cost_of_unseen(cell.unseen, now->robot).cost);
      EXPECT_GE(now->footprint_cost_at(10 + place.x, 5 + place.y, 0.3).cost, cost.cost);
      ++unseen;
    }
  }
  EXPECT_GT(unseen, 10);
  EXPECT_EQ(now->footprint_cost_at(1000.0, 0.0, 0.0).status, CostStatus::kOutside);
}

// Oracle: octomap reads both files back.
TEST(MapFiles, TheOctreeFilesAreOctomaps) {
  const std::string prefix = fresh_folder() + "/map";
  const CTerrainMap map = seen_map();
  map.saveMetricMapRepresentationToFile(prefix);
  const std::unique_ptr<octomap::AbstractOcTree> read(
      octomap::AbstractOcTree::read(prefix + ".ot"));
  const auto* tree = dynamic_cast<const octomap::OcTree*>(read.get());
  ASSERT_TRUE(tree);
  EXPECT_TRUE(*tree == *map.octree());
  std::ostringstream binary;
  map.octree()->writeBinaryConst(binary);
  EXPECT_EQ(content_of(prefix + ".bt"), binary.str());
  std::ostringstream with_odds;
  map.octree()->write(with_odds);
  EXPECT_EQ(content_of(prefix + ".ot"), with_odds.str());
}

TEST(MapFiles, SavingSaysNothing) {
  const std::string prefix = fresh_folder() + "/map";
  const CTerrainMap map = seen_map();
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  map.saveMetricMapRepresentationToFile(prefix);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(MapFiles, TheCostMapLiesWhereItsYamlSays) {
  const std::string prefix = fresh_folder() + "/map";
  const CTerrainMap map = seen_map();
  map.saveMetricMapRepresentationToFile(prefix);
  std::istringstream pgm(content_of(prefix + "_cost.pgm"));
  std::string magic, comment;
  int width = 0, height = 0, most = 0;
  std::getline(pgm, magic);
  std::getline(pgm, comment);
  pgm >> width >> height >> most;
  pgm.get();
  ASSERT_EQ(magic, "P5");
  ASSERT_EQ(comment.front(), '#');
  ASSERT_EQ(most, 255);
  std::string pixels(static_cast<std::size_t>(width * height), '\0');
  pgm.read(pixels.data(), static_cast<std::streamsize>(pixels.size()));
  ASSERT_TRUE(pgm);
  const std::string yaml = content_of(prefix + "_cost.yaml");
  EXPECT_NE(yaml.find("image: map_cost.pgm\nmode: raw\nresolution: 0.1\n"), std::string::npos)
      << yaml;
  double x0 = 0.0, y0 = 0.0;
  ASSERT_EQ(std::sscanf(yaml.c_str() + yaml.find("origin:"), "origin: [%lf, %lf", &x0, &y0), 2);
  int lethal = 0, easy = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = x0 + (column + 0.5) * 0.1, y = y0 + (height - row - 0.5) * 0.1;
      const Cost cost = map.snapshot()->cost_at(x, y);
      const bool known = cost.status == CostStatus::kOk || cost.status == CostStatus::kLethal;
      const auto pixel =
          static_cast<unsigned char>(pixels[static_cast<std::size_t>(row * width + column)]);
      ASSERT_EQ(pixel, known ? std::lround(100.0 * cost.cost) : 255L) << x << " " << y;
      lethal += pixel == 100 ? 1 : 0;
      easy += pixel < 50 ? 1 : 0;
    }
  }
  EXPECT_GT(lethal, 10);
  EXPECT_GT(easy, 100);
}

TEST(MapFiles, ClustersHaveTheirPlaceInTheMap) {
  const std::string prefix = fresh_folder() + "/map";
  const CTerrainMap map = seen_map();
  map.saveMetricMapRepresentationToFile(prefix);
  std::istringstream csv(content_of(prefix + "_clusters.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line,
            "cluster,identity,class,confidence,x,y,z,min_x,min_y,max_x,max_y,cells,points,"
            "height_index,rough,slope_deg");
  std::size_t lines = 0;
  bool box = false;
  for (; std::getline(csv, line); ++lines) {
    const ClusterView& cluster = map.snapshot()->clusters[lines];
    EXPECT_EQ(line.find(std::to_string(lines) + "," + std::to_string(cluster.identity)), 0U);
    box |= line.find(",obstacle,") != std::string::npos &&
           std::abs(cluster.centre.x() - 12.1) < 0.3 && std::abs(cluster.centre.y() - 5.75) < 0.3;
  }
  EXPECT_EQ(lines, map.snapshot()->clusters.size());
  EXPECT_TRUE(box);
}

TEST(MapFiles, WhatCannotBeWrittenIsSaid) {
  const CTerrainMap map = seen_map();
  try {
    map.saveMetricMapRepresentationToFile("/no such folder/map");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("/no such folder/map"), std::string::npos);
  }
}

TEST(MapFiles, AnEmptyMapWritesWhatItHas) {
  const std::string prefix = fresh_folder() + "/map";
  CTerrainMap(small_map()).saveMetricMapRepresentationToFile(prefix);
  EXPECT_TRUE(std::filesystem::exists(prefix + ".3Dscene"));
  EXPECT_TRUE(std::filesystem::exists(prefix + "_clusters.csv"));
  EXPECT_FALSE(std::filesystem::exists(prefix + "_classes.png"));
}

}  // namespace
}  // namespace mrpt_terrain
