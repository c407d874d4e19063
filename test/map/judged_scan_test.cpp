// SPDX-License-Identifier: BSD-3-Clause
#include "judged_scan.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>

#include <set>
#include <thread>
#include <vector>

#include "mrpt_terrain/map/terrain_map.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using testing::lidar_pose;
using testing::observation_of;
using testing::scene_points;
using testing::small_map;

const sensors::SensorModels kNoModels;

TEST(JudgedScan, TheSameObservationIsConvertedOnce) {
  const MapParams params = small_map();
  const JudgedScans scans;
  const auto observation = observation_of(scene_points(), lidar_pose());
  const auto first = scans.of(observation, params, kNoModels);
  ASSERT_TRUE(first->usable);
  EXPECT_EQ(scans.of(observation, params, kNoModels), first);
  const auto equal = observation_of(scene_points(), lidar_pose());
  EXPECT_EQ(scans.of(equal, params, kNoModels), first) << "another object with the same content";
  const auto other = scans.of(observation_of(scene_points(2), lidar_pose()), params, kNoModels);
  EXPECT_NE(other, first);
  EXPECT_NE(scans.of(observation, params, kNoModels), other);
  EXPECT_FALSE(scans.of(mrpt::obs::CObservationGPS(), params, kNoModels)->usable);
}

// An object that is used again for the next scan is another observation, whatever its address.
TEST(JudgedScan, EveryChangeMakesAnotherFingerprint) {
  auto observation = observation_of(scene_points(), lidar_pose());
  std::set<std::uint64_t> seen;
  const auto is_new = [&] {
    const auto fingerprint = fingerprint_of(observation);
    return fingerprint && seen.insert(*fingerprint).second;
  };
  EXPECT_TRUE(is_new());
  EXPECT_FALSE(is_new());
  observation.timestamp += std::chrono::milliseconds(1);
  EXPECT_TRUE(is_new());
  observation.sensorPose = mrpt::poses::CPose3D(0, 0, 0.9, 0, 0, 0);
  EXPECT_TRUE(is_new());
  const std::size_t n = observation.pointcloud->size();
  for (const std::size_t k : {std::size_t{0}, n / 2, n - 1}) {
    observation.pointcloud->setPoint(k, 1.0F, 2.0F, 3.0F);
    EXPECT_TRUE(is_new()) << k;
  }
  observation.pointcloud->insertPoint(1.0F, 2.0F, 3.0F);
  EXPECT_TRUE(is_new());
  observation.setAsExternalStorage(
      "cloud.bin", mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
  EXPECT_FALSE(fingerprint_of(observation)) << "its points may change without the observation";
}

TEST(JudgedScan, DepthImagesHaveFingerprints) {
  mrpt::obs::CObservation3DRangeScan image;
  image.hasRangeImage = true;
  image.rangeImage.setZero(4, 6);
  const auto before = fingerprint_of(image);
  ASSERT_TRUE(before);
  image.rangeImage(3, 5) = 1;
  const auto after = fingerprint_of(image);
  EXPECT_NE(before, after);
  image.rangeUnits = 0.002F;
  EXPECT_NE(fingerprint_of(image), after);
}

TEST(JudgedScan, AChangedObservationIsJudgedAnew) {
  CTerrainMap map(small_map());
  auto observation = observation_of(scene_points(), lidar_pose());
  map.insertObservation(observation);
  const double good = map.computeObservationLikelihood(observation, {});
  for (std::size_t k = 0; k < observation.pointcloud->size(); ++k) {
    float x, y, z;
    observation.pointcloud->getPoint(k, x, y, z);
    observation.pointcloud->setPoint(k, x, y, z + 0.3F);
  }
  EXPECT_LT(map.computeObservationLikelihood(observation, {}), good - 100.0);
}

TEST(JudgedScan, ThinnedTakesEveryRingOfASensor) {
  constexpr std::size_t kRings = 16;
  Points points;
  for (std::size_t k = 0; k < 1600; ++k) points.push_back(static_cast<float>(k % kRings), 0, 0);
  EXPECT_EQ(thinned(points, 1).size(), points.size());
  const Points few = thinned(points, kRings);
  EXPECT_EQ(few.size(), 100U);
  EXPECT_EQ(std::set<float>(few.x.begin(), few.x.end()).size(), kRings);
  EXPECT_EQ(thinned(few, 1000).size(), 1U);
  EXPECT_EQ(thinned(Points{}, 10).size(), 0U);
}

}  // namespace
}  // namespace mrpt_terrain
