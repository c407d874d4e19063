// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationGPS.h>

#include <cmath>
#include <limits>

#include "mrpt_terrain/map/terrain_map.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::lidar_pose;
using testing::observation_of;
using testing::small_map;

/// A yard with walls, boxes and poles in places that depend on the seed.
worlds::Scene yard(std::uint64_t seed) {
  RandomGenerator random(seed, 9);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  worlds::Scene scene;
  int object = 0;
  for (int k = 0; k < 6; ++k) {
    const double angle = between(0.0, 6.28), distance = between(2.5, 6.0);
    const double x = distance * std::cos(angle), y = distance * std::sin(angle);
    const double half_x = between(0.1, 0.8), half_y = between(0.1, 0.8);
    scene.solids.push_back(worlds::box_solid({x - half_x, x + half_x, y - half_y, y + half_y}, 0.0,
                                             between(0.2, 1.4), ++object));
  }
  const double wall = between(5.0, 7.0);
  scene.solids.push_back(worlds::box_solid({wall, wall + 0.3, -6.0, 4.0}, 0.0, 1.3, ++object));
  return scene;
}

/// The pose of the greatest likelihood within 0.5 m and 10 degrees of the truth, which is where the
/// map was made; a coarse search, then finer ones about the best.
CPose3D best_pose(const CTerrainMap& map, const mrpt::obs::CObservation& observation) {
  CPose3D best;
  double greatest = -1e300, step = 0.1, turn = 2.0 * M_PI / 180.0;
  int n = 5;
  for (int level = 0; level < 3; ++level) {
    const CPose3D middle = best;
    for (int i = -n; i <= n; ++i) {
      for (int j = -n; j <= n; ++j) {
        for (int k = -n; k <= n; ++k) {
          const CPose3D pose(middle.x() + i * step, middle.y() + j * step, 0,
                             middle.yaw() + k * turn, 0, 0);
          const double likelihood = map.computeObservationLikelihood(observation, pose);
          if (likelihood <= greatest) continue;
          greatest = likelihood;
          best = pose;
        }
      }
    }
    step /= 3.0;
    turn /= 3.0;
    n = 2;
  }
  return best;
}

TEST(Likelihood, IsGreatestNearTheTruth) {
  constexpr int kScans = 20;
  int near = 0;
  for (std::uint64_t seed = 0; seed < kScans; ++seed) {
    MapParams params = small_map();
    params.description.grid.length = params.description.grid.width = 16.0;
    params.creation.octree = false;
    params.likelihood.decimation = 40;
    CTerrainMap map(params);
    RandomGenerator first(seed, 1), second(seed, 2);
    const auto model = worlds::thirty_two_beams(0.01);
    map.insertObservation(
        observation_of(worlds::scan(yard(seed), model, first).points, lidar_pose()));
    const auto again = observation_of(worlds::scan(yard(seed), model, second).points, lidar_pose());
    const CPose3D pose = best_pose(map, again);
    const bool good = std::hypot(pose.x(), pose.y()) <= 0.1 && std::abs(pose.yaw()) <= M_PI / 180.0;
    near += good ? 1 : 0;
    EXPECT_TRUE(good) << "seed " << seed << ": " << pose.asString();
  }
  EXPECT_GE(near, 0.95 * kScans);
}

TEST(Likelihood, NeverThrowsAndSaysNothingAboutWhatItCannotJudge) {
  CTerrainMap map(small_map());
  const auto observation = observation_of(testing::scene_points(), lidar_pose());
  EXPECT_EQ(map.computeObservationLikelihood(observation, CPose3D()), 0.0) << "an empty map";
  map.insertObservation(observation);
  EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservationGPS(), CPose3D()), 0.0);
  EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationGPS()));
  EXPECT_TRUE(map.canComputeObservationLikelihood(observation));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW((void)map.computeObservationLikelihood(observation, CPose3D(nan, 0, 0, 0, 0, 0)));
  EXPECT_LT(map.computeObservationLikelihood(observation, CPose3D(0.3, 0, 0, 0, 0, 0)),
            map.computeObservationLikelihood(observation, CPose3D()));
}

}  // namespace
}  // namespace mrpt_terrain
