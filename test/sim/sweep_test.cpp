// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

/// Straight down from 5 m, and obliquely.
MountedSensor down_looking(std::vector<double> elevation_deg, int columns, double height = 5.0) {
  for (double& angle : elevation_deg) angle *= kDegrees;
  return mounted(perfect_sensor(std::move(elevation_deg), columns), height);
}

struct Statistics {
  double mean = 0.0, sigma = 0.0;
  std::size_t count = 0;
};

/// Of measured minus true range in one ring, lost returns left out.
Statistics errors_of_ring(const Sweep& sweep, std::size_t ring) {
  Statistics result;
  double sum = 0.0, squares = 0.0;
  for (std::size_t column = 0; column < sweep.columns; ++column) {
    const std::size_t slot = column * sweep.rings + ring;
    if (sweep.range[slot] == 0.0F) continue;
    const double error =
        static_cast<double>(sweep.range[slot]) - static_cast<double>(sweep.true_range[slot]);
    sum += error;
    squares += error * error;
    ++result.count;
  }
  const auto n = static_cast<double>(result.count);
  result.mean = sum / n;
  result.sigma = std::sqrt(squares / n - result.mean * result.mean);
  return result;
}

// Tolerances are four standard deviations of a mean (sigma / sqrt(n)) and of a standard deviation
// (sigma / sqrt(2 n)).
TEST(SweepNoise, GrowsWithRangeAndIncidenceAsDocumented) {
  constexpr int kColumns = 20000;
  MountedSensor sensor = down_looking({-90, -30, -5}, kColumns);
  sensor.model.noise.range_sigma = 0.01;
  sensor.model.noise.range_growth = 0.001;
  sensor.model.noise.incidence_growth = 0.5;
  sensor.model.noise.incidence_limit = 4.0;
  const Sweep sweep = sweep_of(level_world(200.0), sensor);
  // 5 m straight on; 10 m at 60 degrees; 57.4 m where 1 / cos = 11.5 counts as 4.
  const double far = 5.0 / std::sin(5 * kDegrees);
  const double expected[] = {0.01 + 0.005, (0.01 + 0.01) * 1.5, (0.01 + 0.001 * far) * 2.5};
  for (std::size_t ring = 0; ring < 3; ++ring) {
    const Statistics errors = errors_of_ring(sweep, ring);
    ASSERT_EQ(errors.count, static_cast<std::size_t>(kColumns));
    EXPECT_NEAR(errors.mean, 0.0, 4.0 * expected[ring] / std::sqrt(kColumns)) << ring;
    EXPECT_NEAR(errors.sigma, expected[ring], 4.0 * expected[ring] / std::sqrt(2.0 * kColumns))
        << ring;
  }
}

TEST(SweepNoise, RingsHaveConstantOffsetsThatBelongToTheUnit) {
  MountedSensor sensor = down_looking(std::vector<double>(256, -90.0), 4);
  sensor.model.noise.ring_bias_sigma = 0.02;
  const World world = level_world(10.0);
  const Sweep sweep = sweep_of(world, sensor), later = sweep_of(world, sensor, Motion(), 2, 5);
  EXPECT_EQ(sweep.range, later.range);
  double squares = 0.0;
  for (std::size_t ring = 0; ring < 256; ++ring) {
    const Statistics errors = errors_of_ring(sweep, ring);
    EXPECT_NEAR(errors.sigma, 0.0, 1e-6);
    squares += errors.mean * errors.mean;
  }
  EXPECT_NEAR(std::sqrt(squares / 256.0), 0.02, 4.0 * 0.02 / std::sqrt(512.0));
  sensor.model.noise.unit_seed = 2;
  EXPECT_NE(sweep.range, sweep_of(world, sensor).range);
}

TEST(SweepNoise, RangesAreWholeMultiplesOfTheQuantum) {
  MountedSensor sensor = down_looking({-50.0}, 500);
  sensor.model.noise.range_sigma = 0.01;
  sensor.model.noise.range_quantum = 0.002;
  const Sweep sweep = sweep_of(level_world(20.0), sensor);
  for (const float range : sweep.range) {
    const double steps = static_cast<double>(range) / 0.002;
    // A float of 6.5 m has a step of 4.8e-7 m.
    EXPECT_NEAR(steps, std::round(steps), 2.4e-7 / 0.002);
  }
}

TEST(SweepNoise, LosesTheShareOfReturnsThatItSays) {
  constexpr int kColumns = 20000;
  MountedSensor sensor = down_looking({-90.0}, kColumns);
  sensor.model.noise.dropout = 0.1;
  const Sweep sweep = sweep_of(level_world(20.0), sensor);
  const double lost = 1.0 - static_cast<double>(sweep.points.size()) / kColumns;
  EXPECT_NEAR(lost, 0.1, 4.0 * std::sqrt(0.1 * 0.9 / kColumns));
  for (std::size_t slot = 0; slot < sweep.range.size(); ++slot) {
    EXPECT_FLOAT_EQ(sweep.true_range[slot], 5.0F);
    EXPECT_EQ(sweep.solid[slot], kGroundSolid) << "the truth of a lost return stays";
  }
}

double share_seen(const World& world, double detection_range, double elevation_deg, double height) {
  constexpr int kColumns = 20000;
  MountedSensor sensor = down_looking({elevation_deg}, kColumns, height);
  sensor.model.noise.detection_range = detection_range;
  return static_cast<double>(sweep_of(world, sensor).points.size()) / kColumns;
}

// A surface of reflectivity c sends as much light back as one of 10 % at sqrt(c / 10 %) times the
// range, and half of that is seen at the detection range.
TEST(SweepNoise, DarkFarAndObliqueSurfacesAreLostMoreOften) {
  World world = level_world(300.0);
  const double light = std::sqrt(reflectivity(Material::kConcrete) / 0.1);
  const double tolerance = 4.0 * std::sqrt(0.25 / 20000);
  EXPECT_NEAR(share_seen(world, 10.0, -90.0, 10.0 * light), 0.5, tolerance);
  // Half the light: lost with 2^-(1/4). 0.84 = 2^(-1/4) of 1 is lost.
  EXPECT_NEAR(share_seen(world, 10.0, -90.0, 10.0 * light * std::sqrt(2.0)), 1.0 - std::exp2(-0.25),
              tolerance);
  EXPECT_LT(share_seen(world, 10.0, -30.0, 5.0 * light), 0.5 - tolerance);
  world.solids[0].material = Material::kAsphalt;
  EXPECT_LT(share_seen(world, 10.0, -90.0, 10.0 * light), 0.5 - tolerance);
  EXPECT_EQ(share_seen(world, 0.0, -10.0, 15.0), 1.0);
}

TEST(SweepNoise, ReturnsNearerThanTheSensorSeesAreLost) {
  MountedSensor sensor = down_looking({-90.0, -30.0}, 10, 0.6);
  sensor.model.min_range = 1.0;
  const Sweep sweep = sweep_of(level_world(20.0), sensor);
  EXPECT_EQ(sweep.points.size(), 10U);
  EXPECT_EQ(sweep.range[0], 0.0F);
  EXPECT_FLOAT_EQ(sweep.true_range[0], 0.6F);
  EXPECT_FLOAT_EQ(sweep.range[1], 1.2F);
}

MountedSensor noisy_sensor() {
  MountedSensor sensor = down_looking({-40, -20, -10, 0}, 360, 1.0);
  sensor.model.noise.range_sigma = 0.01;
  sensor.model.noise.dropout = 0.05;
  sensor.model.noise.beam_divergence = 0.003;
  sensor.model.noise.sub_rays = 5;
  return sensor;
}

void expect_same_bytes(const Sweep& a, const Sweep& b) {
  EXPECT_EQ(a.range, b.range);
  EXPECT_EQ(a.true_range, b.true_range);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.slot, b.slot);
  EXPECT_EQ(a.points.x, b.points.x);
  EXPECT_EQ(a.true_points.z, b.true_points.z);
}

/// A sphere full of leaves about a point.
Medium bush(const Eigen::Vector3d& centre, double radius, double density, std::int32_t solid) {
  Medium medium;
  medium.solid = solid;
  medium.form = Medium::Form::kEllipsoid;
  medium.T_map_medium.translation() = centre;
  medium.half_extent.setConstant(radius);
  medium.density = density;
  return medium;
}

World world_with_bush() {
  World world = level_world(30.0);
  world.solids.resize(3);
  world.media.push_back(bush({5, 0, 0}, 2.0, 1.0, 2));
  return world;
}

TEST(Sweep, SameSeedGivesTheSameBytesAndOthersDoNot) {
  const World world = world_with_bush();
  const MountedSensor sensor = noisy_sensor();
  const Sweep sweep = sweep_of(world, sensor, Motion(), 3, 4);
  expect_same_bytes(sweep, sweep_of(world, sensor, Motion(), 3, 4));
  EXPECT_NE(sweep.range, sweep_of(world, sensor, Motion(), 4, 4).range);
  EXPECT_NE(sweep.range, sweep_of(world, sensor, Motion(), 3, 5).range);
}

TEST(Sweep, ChangeOfTheSceneChangesOnlyTheSlotsThatSeeIt) {
  const World plain = world_with_bush();
  World changed = world_with_bush();
  worlds::add_box(changed.mesh, {-4, -1, 0}, {-3, 1, 1}, 1);
  const Sweep before = sweep_of(plain, noisy_sensor()), after = sweep_of(changed, noisy_sensor());
  std::size_t different = 0;
  for (std::size_t slot = 0; slot < before.range.size(); ++slot) {
    // The box spans less than 20 degrees to either side of the first and last column.
    const std::size_t column = slot / before.rings;
    const bool towards_box = column < 20 || column > 340;
    if (before.range[slot] != after.range[slot]) {
      ++different;
      EXPECT_TRUE(towards_box) << slot;
    }
  }
  EXPECT_GT(different, 20U);
}

TEST(Sweep, FreePathsInAMediumAreExponential) {
  World world;
  world.solids.resize(2);
  world.media.push_back(bush({0, 0, 0}, 50.0, 0.5, 1));
  constexpr int kColumns = 20000;
  const Sweep sweep = sweep_of(world, mounted(perfect_sensor({0.1}, kColumns), 0.0));
  ASSERT_EQ(sweep.points.size(), static_cast<std::size_t>(kColumns));
  double sum = 0.0;
  std::size_t near = 0;
  for (const float range : sweep.range) {
    sum += static_cast<double>(range);
    if (range < 1.0F) ++near;
  }
  // Mean and standard deviation 2 m; the share within 1 m is 1 - exp(-1/2).
  EXPECT_NEAR(sum / kColumns, 2.0, 4.0 * 2.0 / std::sqrt(kColumns));
  EXPECT_NEAR(static_cast<double>(near) / kColumns, 1.0 - std::exp(-0.5),
              4.0 * std::sqrt(0.25 / kColumns));
  EXPECT_EQ(sweep.solid[0], 1);
}

TEST(Sweep, MediaLetThroughWhatTheirDensitySaysAndBeginWhereTheyAre) {
  World world = level_world(30.0);
  world.solids.resize(2);
  // Straight down through the middle of a flat ellipsoid: 2 m of path between z = 1 and 3.
  world.media.push_back(bush({0, 0, 2}, 1.0, 0.4, 1));
  world.media[0].half_extent = {3.0, 2.0, 1.0};
  constexpr int kColumns = 20000;
  const Sweep sweep = sweep_of(world, down_looking({-90.0}, kColumns));
  std::size_t through = 0;
  for (std::size_t slot = 0; slot < sweep.range.size(); ++slot) {
    if (sweep.solid[slot] == kGroundSolid) {
      ++through;
      EXPECT_FLOAT_EQ(sweep.range[slot], 5.0F);
    } else {
      EXPECT_GE(sweep.range[slot], 2.0F);
      EXPECT_LE(sweep.range[slot], 4.0F);
    }
  }
  const double expected = std::exp(-0.8);
  EXPECT_NEAR(static_cast<double>(through) / kColumns, expected,
              4.0 * std::sqrt(expected * (1.0 - expected) / kColumns));
}

/// Ground that rises by 20 degrees along x, with grass of 0.3 m in the half x > 0.
World grassy_slope() {
  const double rise = std::tan(20.0 * kDegrees);
  World world;
  world.solids.resize(2);
  worlds::add_height_field(world, 200, 0.2, [&](double x, double) { return rise * x; });
  Medium grass;
  grass.solid = 1;
  grass.height = 0.3;
  grass.density = 3.0;
  grass.T_map_medium.translation().x() = 10.0;
  grass.half_extent = {10.0, 20.0, 0.0};
  world.media.push_back(grass);
  return world;
}

// A ray that comes down to the slope passes height * n_z / |n . d| of grass, the distance of two
// planes that are 0.3 m apart vertically.
TEST(Sweep, LayersFollowTheSlopeUnderThem) {
  constexpr int kColumns = 100000;
  const double rise = std::tan(20.0 * kDegrees);
  const Sweep sweep =
      sweep_of(grassy_slope(), mounted(perfect_sensor({-25 * kDegrees}, kColumns), 3));
  const Eigen::Vector3d normal = Eigen::Vector3d(-rise, 0, 1).normalized();
  std::size_t through = 0, seen = 0;
  double expected = 0.0, variance = 0.0;
  for (std::size_t k = 0; k < sweep.slot.size(); ++k) {
    const Eigen::Vector3d point(static_cast<double>(sweep.true_points.x[k]),
                                static_cast<double>(sweep.true_points.y[k]),
                                static_cast<double>(sweep.true_points.z[k]));
    const double above = point.z() - rise * point.x();
    if (sweep.solid[sweep.slot[k]] == 1) {
      ASSERT_GT(point.x(), -1e-4);
      ASSERT_GT(above, -1e-4);
      ASSERT_LT(above, 0.3 + 1e-4);
    }
    const Eigen::Vector3d direction = (point - Eigen::Vector3d(0, 0, 3)).normalized();
    const double path = 0.3 * normal.z() / -normal.dot(direction);
    // Rays that enter the grass from above, not through its edge at x = 0.
    const double entry_x = 3.0 * direction.x() / (rise * direction.x() - direction.z());
    if (entry_x - path * direction.x() < 0.0) continue;
    ++seen;
    const double p = std::exp(-3.0 * path);
    expected += p;
    variance += p * (1.0 - p);
    if (sweep.solid[sweep.slot[k]] == kGroundSolid) ++through;
  }
  ASSERT_GT(seen, 40000U);
  EXPECT_NEAR(static_cast<double>(through), expected, 4.0 * std::sqrt(variance));
}

TEST(Sweep, SensorWithinALayerSeesTheLayerAtOnce) {
  const World world = grassy_slope();
  MountedSensor sensor = mounted(perfect_sensor({0.0}, 4), 0.0);
  sensor.T_robot_sensor.translation() = Eigen::Vector3d(10, 0, 10 * std::tan(20 * kDegrees) + 0.1);
  const RayCaster caster(world);
  SweepWorkspace workspace;
  Sweep sweep;
  constexpr int kSweeps = 4000;
  double sum = 0.0;
  for (int k = 0; k < kSweeps; ++k) {
    simulate_sweep(caster, sensor, Motion(), 0.0, 1, static_cast<std::uint64_t>(k), workspace,
                   sweep);
    ASSERT_EQ(sweep.solid[1], 1);  // to the left, along the contour
    sum += static_cast<double>(sweep.range[1]);
  }
  EXPECT_NEAR(sum / kSweeps, 1.0 / 3.0, 4.0 / 3.0 / std::sqrt(kSweeps));
}

/// Straight on along x, and turning.
Motion driving(double speed, double yaw_rate) {
  std::vector<double> times;
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k <= 100; ++k) {
    times.push_back(0.002 * k);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = speed * times.back();
    pose.rotate(Eigen::AngleAxisd(yaw_rate * times.back(), Eigen::Vector3d::UnitZ()));
    poses.push_back(pose);
  }
  return {times, poses};
}

TEST(Sweep, RangesToAWallShrinkWhileTheRobotDrivesTowardsIt) {
  World world = level_world(60.0);
  world.solids.resize(2);
  worlds::add_patch(world.mesh, {10, -60, 0}, {0, 120, 0}, {0, 0, 60}, 1, SurfaceKind::kObject);
  const Sweep sweep = sweep_of(world, mounted(perfect_sensor({0.0}, 360), 1.0), driving(15.0, 0.0));
  std::size_t seen = 0;
  for (std::size_t column = 0; column < 360; ++column) {
    const double azimuth = (180.0 - static_cast<double>(column)) * kDegrees;
    if (std::cos(azimuth) < 0.2) continue;
    ++seen;
    const double time = static_cast<double>(column) / 3600.0;
    EXPECT_NEAR(sweep.range[column], (10.0 - 15.0 * time) / std::cos(azimuth), 1e-5) << column;
  }
  EXPECT_EQ(sweep.points.size(), sweep.slot.size());
  EXPECT_GT(seen, 150U);
  for (const float x : sweep.true_points.x) EXPECT_NEAR(x, 10.0F, 1e-5F);
}

TEST(Sweep, TurningRobotSeesTheWallWhereItLooksAtThatTime) {
  World world = level_world(60.0);
  world.solids.resize(2);
  worlds::add_patch(world.mesh, {10, -60, 0}, {0, 120, 0}, {0, 0, 60}, 1, SurfaceKind::kObject);
  const Sweep sweep = sweep_of(world, mounted(perfect_sensor({0.0}, 360), 1.0), driving(0.0, 2.0));
  for (std::size_t column = 120; column < 240; ++column) {
    const double azimuth = (180.0 - static_cast<double>(column)) * kDegrees;
    const double time = static_cast<double>(column) / 3600.0;
    EXPECT_NEAR(sweep.range[column], 10.0 / std::cos(azimuth + 2.0 * time), 1e-5) << column;
  }
}

TEST(Sweep, RingsFireOneAfterTheOtherWhileTheHeadTurns) {
  MountedSensor sensor = down_looking({-45, -45}, 10, 1.0);
  sensor.model.laser_interval = 1e-3;
  const Sweep sweep = sweep_of(level_world(10.0), sensor);
  ASSERT_EQ(sweep.points.size(), 20U);
  for (std::size_t slot = 0; slot < 20; ++slot) {
    // Ring 1 looks a tenth of a column of 10 ms further, clockwise.
    const double azimuth =
        (180.0 - 36.0 * static_cast<double>(slot / 2) - 3.6 * static_cast<double>(slot % 2)) *
        kDegrees;
    EXPECT_NEAR(sweep.points.x[slot], std::cos(azimuth), 1e-6) << slot;
    EXPECT_NEAR(sweep.points.y[slot], std::sin(azimuth), 1e-6) << slot;
    EXPECT_NEAR(sweep.time[slot],
                0.01 * static_cast<double>(slot / 2) + 0.001 * static_cast<double>(slot % 2), 1e-6);
  }
}

TEST(Sweep, PlanarScannerSeesItsSpanCounterClockwise) {
  World world = level_world(60.0);
  world.solids.resize(2);
  worlds::add_box(world.mesh, {-3, -3, -1}, {3, 3, 5}, 1);
  sensors::SensorModel model =
      sensors::load_sensor_model(MRPT_TERRAIN_SOURCE_DIR "/params/sensors/lms111.yaml");
  model.noise = {};
  const Sweep sweep = sweep_of(world, mounted(model, 1.0));
  ASSERT_EQ(sweep.points.size(), 1081U);
  EXPECT_NEAR(sweep.points.x[0], -3.0, 1e-5);
  EXPECT_NEAR(sweep.points.y[0], -3.0, 1e-5);
  EXPECT_NEAR(sweep.range[540], 3.0, 1e-6);
  EXPECT_NEAR(sweep.points.x[1080], -3.0, 1e-5);
  EXPECT_NEAR(sweep.points.y[1080], 3.0, 1e-5);
  EXPECT_NEAR(sweep.time[1080], 0.03F, 1e-7F);
}

/// A wall at x = 10 and, to the left of y = 0, one in front of it.
World two_walls(double front_x) {
  World world;
  world.solids.resize(3);
  for (auto& solid : world.solids) solid.material = Material::kConcrete;
  worlds::add_patch(world.mesh, {10, -50, -9}, {0, 100, 0}, {0, 0, 18}, 1, SurfaceKind::kObject);
  worlds::add_patch(world.mesh, {front_x, 0, -9}, {0, 50, 0}, {0, 0, 18}, 2, SurfaceKind::kObject);
  return world;
}

/// x of the returns of a wide beam that looks ahead.
std::vector<double> depths_of(const World& world, double pulse_length) {
  sensors::SensorModel model = perfect_sensor({0.0}, 401);
  model.start_azimuth = 0.05;
  model.end_azimuth = -0.05;
  model.noise.beam_divergence = 0.01;
  model.noise.sub_rays = 5;
  model.noise.pulse_length = pulse_length;
  const Sweep sweep = sweep_of(world, mounted(model, 0.0));
  std::vector<double> depths;
  for (const float x : sweep.points.x) depths.push_back(static_cast<double>(x));
  return depths;
}

std::size_t between(const std::vector<double>& depths, double low, double high) {
  return static_cast<std::size_t>(
      std::count_if(depths.begin(), depths.end(), [&](double x) { return x > low && x < high; }));
}

// The beam is 10 mrad wide, columns are 0.25 mrad apart: about 40 columns touch the edge.
TEST(Sweep, EdgesWithinAPulseAreMixedAndOthersAreNot) {
  const std::vector<double> mixed = depths_of(two_walls(9.7), 0.5);
  ASSERT_EQ(mixed.size(), 401U);
  EXPECT_NEAR(static_cast<double>(between(mixed, 9.72, 9.98)), 40.0, 4.0);
  EXPECT_EQ(between(depths_of(two_walls(9.7), 0.1), 9.72, 9.98), 0U);
  const std::vector<double> apart = depths_of(two_walls(7.0), 0.5);
  EXPECT_EQ(between(apart, 7.02, 9.98), 0U);
  EXPECT_EQ(apart.size(), 401U);
}

// The weights are 1/2 for the centre and 1/8 for each ray around it.
TEST(Sweep, MixedRangeIsTheMeanByStrength) {
  const std::vector<double> depths = depths_of(two_walls(9.7), 0.5);
  // All but the ray to the left look past the edge: 7/8 of the light comes from 10 m.
  const double expected = 10.0 - 0.3 / 8.0;
  EXPECT_GT(between(depths, expected - 0.003, expected + 0.003), 10U);
}

TEST(Sweep, ModelWithoutTimingIsRefused) {
  sensors::SensorModel model = perfect_sensor({0.0}, 10);
  model.rate = 0.0;
  EXPECT_THROW(static_cast<void>(sweep_of(level_world(5.0), mounted(model, 1.0))),
               std::invalid_argument);
}

}  // namespace
}  // namespace mrpt_terrain::sim
