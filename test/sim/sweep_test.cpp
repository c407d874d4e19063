// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sweeps.h"

namespace mrpt_terrain::sim {
namespace {

using worlds::level_world;
using worlds::mounted;
using worlds::perfect_sensor;

constexpr double kDegrees = M_PI / 180.0;

Sweep sweep_of(const World& world, const MountedSensor& sensor, const Motion& motion = Motion(),
               std::uint64_t seed = 1, std::uint64_t stream = 0) {
  const RayCaster caster(world);
  SweepWorkspace workspace;
  Sweep sweep;
  simulate_sweep(caster, sensor, motion, 0.0, seed, stream, workspace, sweep);
  return sweep;
}

TEST(Sweep, PerfectSensorOverLevelGroundGivesClosedFormRanges) {
  const Sweep sweep = sweep_of(
      level_world(50.0), mounted(perfect_sensor({-30 * kDegrees, -10 * kDegrees, 0.1}, 100), 0.8));
  ASSERT_EQ(sweep.rings, 3U);
  ASSERT_EQ(sweep.columns, 100U);
  ASSERT_EQ(sweep.points.size(), 200U);
  for (std::size_t column = 0; column < 100; ++column) {
    EXPECT_FLOAT_EQ(sweep.range[3 * column], 1.6F);
    EXPECT_FLOAT_EQ(sweep.range[3 * column + 1], static_cast<float>(0.8 / std::sin(10 * kDegrees)));
    EXPECT_EQ(sweep.range[3 * column + 2], 0.0F);
    EXPECT_EQ(sweep.true_range[3 * column + 2], 0.0F);
    EXPECT_EQ(sweep.solid[3 * column + 2], kNoSolid);
    EXPECT_EQ(sweep.solid[3 * column], kGroundSolid);
    EXPECT_FLOAT_EQ(sweep.time[3 * column], static_cast<float>(column) * 1e-3F);
  }
  EXPECT_EQ(sweep.slot[2], 3U);
}

TEST(Sweep, HeadTurnsClockwiseFromTheBack) {
  const Sweep sweep =
      sweep_of(level_world(50.0), mounted(perfect_sensor({-30 * kDegrees}, 4), 1.0));
  ASSERT_EQ(sweep.points.size(), 4U);
  const double level = std::sqrt(3.0);
  const double expected[4][2] = {{-level, 0}, {0, level}, {level, 0}, {0, -level}};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(sweep.points.x[k], expected[k][0], 1e-6) << k;
    EXPECT_NEAR(sweep.points.y[k], expected[k][1], 1e-6) << k;
    EXPECT_NEAR(sweep.points.z[k], -1.0, 1e-6) << k;
    EXPECT_NEAR(sweep.true_points.z[k], 0.0, 1e-6) << k;
  }
}

}  // namespace
}  // namespace mrpt_terrain::sim
