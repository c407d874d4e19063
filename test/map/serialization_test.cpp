// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/OcTree.h>

#include <sstream>
#include <string>

#include "mrpt_terrain/map/terrain_map.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::bytes_of;
using testing::lidar_pose;
using testing::map_from;
using testing::observation_of;
using testing::scene_points;
using testing::small_map;

std::string refusal_of(const std::string& bytes) {
  try {
    (void)map_from(bytes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

CTerrainMap seen_map(Fusion fusion = Fusion::kScan) {
  MapParams params = small_map();
  params.creation.fusion = fusion;
  params.fusion.length = params.fusion.width = 20.0;
  params.description.slope.method = SlopeMethod::kBeam;
  params.robot.max_step = 0.123;
  CTerrainMap map(params);
  map.genericMapParams.enableObservationLikelihood = false;
  for (const std::uint64_t seed : {1, 2}) {
    map.insertObservation(observation_of(scene_points(seed), lidar_pose()),
                          CPose3D(0.1 * static_cast<double>(seed), 0, 0, 0.3, 0.01, 0.02));
  }
  return map;
}

std::string tree_bytes(const CTerrainMap& map) {
  std::ostringstream out;
  map.octree()->writeData(out);
  return out.str();
}

void expect_equal(const CTerrainMap& a, const CTerrainMap& b) {
  const TerrainSnapshotPtr x = a.snapshot(), y = b.snapshot();
  EXPECT_EQ(x->revision, y->revision);
  EXPECT_EQ(x->T_map_window.matrix(), y->T_map_window.matrix());
  EXPECT_EQ(x->description.grid.h_mean, y->description.grid.h_mean);
  EXPECT_EQ(x->description.labels.cluster, y->description.labels.cluster);
  EXPECT_EQ(x->costs().step, y->costs().step);
  ASSERT_EQ(x->clusters.size(), y->clusters.size());
  for (std::size_t k = 0; k < x->clusters.size(); ++k) {
    EXPECT_EQ(x->clusters[k].identity, y->clusters[k].identity);
    EXPECT_EQ(x->clusters[k].description.slope.angle, y->clusters[k].description.slope.angle);
  }
  EXPECT_EQ(tree_bytes(a), tree_bytes(b));
  EXPECT_EQ(bytes_of(a), bytes_of(b));
}

class SerializationOf : public ::testing::TestWithParam<Fusion> {};

TEST_P(SerializationOf, NotABitChanges) {
  const CTerrainMap map = seen_map(GetParam());
  const CTerrainMap read = map_from(bytes_of(map));
  expect_equal(map, read);
  EXPECT_EQ(read.params().robot.max_step, 0.123);
  EXPECT_FALSE(read.genericMapParams.enableObservationLikelihood);
  const CTerrainMap empty;
  EXPECT_TRUE(map_from(bytes_of(empty)).isEmpty());
}

TEST_P(SerializationOf, AMapThatWasReadGoesOnAsBefore) {
  CTerrainMap map = seen_map(GetParam());
  CTerrainMap read = map_from(bytes_of(map)), copy(map);
  for (CTerrainMap* each : {&map, &read, &copy}) {
    each->insertObservation(observation_of(scene_points(5), lidar_pose()), CPose3D());
  }
  expect_equal(map, read);
  expect_equal(map, copy);
}

TEST_P(SerializationOf, SurvivesTheCopyOfAMultiMetricMap) {
  mrpt::maps::CMultiMetricMap maps;
  maps.maps.push_back(std::make_shared<CTerrainMap>(seen_map(GetParam())));
  const mrpt::maps::CMultiMetricMap copy(maps);
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << maps;
  stream.Seek(0);
  mrpt::maps::CMultiMetricMap read;
  mrpt::serialization::archiveFrom(stream) >> read;
  expect_equal(*maps.mapByClass<CTerrainMap>(), *copy.mapByClass<CTerrainMap>());
  expect_equal(*maps.mapByClass<CTerrainMap>(), *read.mapByClass<CTerrainMap>());
}

INSTANTIATE_TEST_SUITE_P(Fusions, SerializationOf,
                         ::testing::Values(Fusion::kScan, Fusion::kRolling),
                         [](const auto& fusion) { return std::string(name_of(fusion.param)); });

// MRPT's generic parameters stand before the map's own bytes.
TEST(Serialization, DamagedGenericParametersAreRefused) {
  const CTerrainMap map;
  const std::string good = bytes_of(map);
  const std::size_t end = good.find("TERRAIN\n");
  ASSERT_NE(end, std::string::npos);
  for (std::size_t k = end - 5; k < end; ++k) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 0x01);
    EXPECT_NE(refusal_of(bad), "") << end - k << " bytes before the map's own";
  }
}

// Every byte of a small map, changed one at a time: never a crash, never a map.
TEST(Serialization, DamagedBytesAreRefused) {
  MapParams params = small_map(0.5);
  CTerrainMap map(params);
  Points few;
  for (int k = 0; k < 40; ++k) few.push_back(1.0F + 0.05F * static_cast<float>(k), 0.3F, 0.0F);
  map.insertObservation(observation_of(few, lidar_pose()), CPose3D());
  const std::string good = bytes_of(map);
  std::size_t refused = 0, flips = 0;
  // The first 64 bytes hold MRPT's own header, which names the class.
  for (std::size_t k = 64; k < good.size(); k += 3) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 0x10);
    ++flips;
    refused += refusal_of(bad).empty() ? 0 : 1;
  }
  EXPECT_EQ(refused, flips);
  for (const std::size_t n : {good.size() - 1, good.size() / 2, std::size_t{70}}) {
    EXPECT_NE(refusal_of(good.substr(0, n)), "") << n;
  }
}

TEST(Serialization, ARefusedReadLeavesTheMapAsItWas) {
  CTerrainMap map = seen_map();
  const std::string before = bytes_of(map);
  std::string bad = before;
  bad[bad.size() - 20] = static_cast<char>(bad[bad.size() - 20] ^ 1);
  mrpt::io::CMemoryStream stream;
  stream.Write(bad.data(), bad.size());
  stream.Seek(0);
  auto archive = mrpt::serialization::archiveFrom(stream);
  EXPECT_THROW(archive >> map, std::exception);
  EXPECT_EQ(bytes_of(map), before);
}

}  // namespace
}  // namespace mrpt_terrain
