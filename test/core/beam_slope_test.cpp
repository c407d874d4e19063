// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/beam_slope.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>

#include "allocation_counter.h"
#include "beam_worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::beam_params;
using worlds::described;
using worlds::kPi;
using worlds::largest;
using worlds::radians;

Points ramp_scan(double angle, double sigma, std::uint64_t seed, double box = 0.0) {
  RandomGenerator random(seed);
  return worlds::scan(worlds::ramp_scene(angle, box), worlds::thirty_two_beams(sigma), random)
      .points;
}

struct Errors {
  double mean = 0.0, rms = 0.0;
  double covered = 0.0;  ///< share within two stated standard deviations
};

template <class Estimate, class Sigma>
Errors errors_of(double angle, double sigma, double box, int trials, Estimate&& estimate,
                 Sigma&& stated) {
  Errors errors;
  for (int k = 0; k < trials; ++k) {
    const Description description =
        described(ramp_scan(angle, sigma, 500 + static_cast<std::uint64_t>(k), box));
    const Slope& slope = largest(description).slope;
    EXPECT_EQ(slope.status, FeatureStatus::kOk);
    const double error = estimate(slope) - angle;
    errors.mean += error / trials;
    errors.rms += error * error / trials;
    errors.covered += (std::abs(error) <= 2.0 * stated(slope) ? 1.0 : 0.0) / trials;
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

// Analytic: without noise the angle is that of the ramp. Points are floats of at most 3 m.
TEST(BeamSlope, ExactRampsHaveTheirAngle) {
  for (const double degrees : {5.0, 7.74, 13.86, 18.51, 30.0, 60.0}) {
    const Description description = described(ramp_scan(radians(degrees), 0.0, 1));
    const Slope& slope = largest(description).slope;
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << degrees;
    EXPECT_NEAR(slope.angle, radians(degrees), 5e-5) << degrees;
    EXPECT_NEAR(slope.direction, 0.0, 5e-4) << degrees;
    ASSERT_EQ(slope.to_ground.status, FeatureStatus::kOk) << degrees;
    EXPECT_NEAR(slope.to_ground.angle, radians(degrees), 2e-3) << degrees;
  }
}

// Statistics of 80 trials: the bias is at most 0.1 degrees, the stated uncertainty covers
// (95.4 +- 2.3 %, one standard deviation of a share of 80), with and without an object on the ramp.
TEST(BeamSlope, IsUnbiasedAndStatesItsUncertaintyWithObjectsOnTheRamp) {
  for (const double box : {0.0, 0.15}) {
    const Errors errors = errors_of(
        radians(7.74), 0.02, box, 80, [](const Slope& slope) { return slope.angle; },
        [](const Slope& slope) { return slope.angle_sigma; });
    EXPECT_LT(std::abs(errors.mean), radians(0.03)) << "box of " << box;
    EXPECT_LT(errors.rms, radians(0.075)) << "box of " << box;
    EXPECT_GT(errors.covered, 0.88) << "box of " << box;
  }
}

// A robot that leans turns the whole scan: the angle against the ground does not feel it.
TEST(BeamSlope, AngleToTheGroundIsThatOfTheRampWhenTheRobotLeans) {
  Points points = ramp_scan(radians(13.86), 0.005, 4);
  const double pitch = radians(0.5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i];
    const double z = points.z[i] - 0.81;
    points.x[i] = static_cast<float>(std::cos(pitch) * x - std::sin(pitch) * z);
    points.z[i] = static_cast<float>(0.81 + std::sin(pitch) * x + std::cos(pitch) * z);
  }
  const Description description = described(points);
  const Slope& slope = largest(description).slope;
  ASSERT_EQ(slope.to_ground.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, radians(14.36), radians(0.1));
  EXPECT_NEAR(slope.to_ground.angle, radians(13.86), radians(0.1));
  EXPECT_NEAR(std::acos(slope.to_ground.ground_normal.z()), pitch, radians(0.1));
}

// Closed form: upright planes at any distance of the sensor from them, also in the plane itself.
TEST(BeamSlope, WallsReadNinetyDegreesRadialOnesIncluded) {
  for (const double aside : {0.0, 0.03, 0.1, 0.4, 1.0}) {
    RandomGenerator random(11);
    Points points;
    worlds::add_surface(points, {1.0, 2.4, 0.05, 1.4}, 0.02, [](double, double) { return 0.0; });
    for (std::size_t i = 0; i < points.size(); ++i) {
      points.z[i] = points.y[i];
      points.y[i] = static_cast<float>(aside + 0.002 * worlds::normal_deviate(random));
    }
    worlds::add_flat(points, {0.5, 2.4, -2.0, -0.2}, 0.03, 0.0);
    worlds::add_beam_noise(points, 0.01, random);
    const Description description = described(points);
    const ClusterDescription& wall = largest(description);
    ASSERT_EQ(wall.slope.status, FeatureStatus::kOk) << "wall " << aside << " m aside";
    EXPECT_NEAR(wall.slope.angle, kPi / 2, radians(1.0)) << "wall " << aside << " m aside";
    EXPECT_NEAR(std::abs(std::cos(wall.slope.direction)), 0.0, 0.02) << aside;
  }
}

TEST(BeamSlope, WallsAcrossTheBeamsReadNinetyDegreesToo) {
  RandomGenerator random(12);
  Points points;
  worlds::add_wall(points, 2.0, -1.0, 1.0, 1.4, 0.02, 0.0, random);
  worlds::add_beam_noise(points, 0.02, random);
  const Description description = described(points);
  const Slope& slope = largest(description).slope;
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, kPi / 2, radians(1.0));
  EXPECT_EQ(slope.to_ground.status, FeatureStatus::kTooFewPoints) << "no ground was seen";
}

// Invariant: where a short piece of one ring is all that is seen of the ground, the angle to the
// ground is right within its stated uncertainty or is not called right.
TEST(BeamSlope, GroundSeenInOneRingIsKnownToSayLittle) {
  int trusted = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    RandomGenerator random(seed);
    Points points;
    worlds::add_wall(points, 2.0, -1.0, 1.0, 1.4, 0.02, 0.0, random);
    for (int k = 0; k < 300; ++k) {
      const double azimuth = 0.55 + 0.01 * static_cast<double>(seed) / 300.0 * k;
      points.push_back(static_cast<float>(2.3 * std::cos(azimuth)),
                       static_cast<float>(2.3 * std::sin(azimuth)), 0.0F);
    }
    worlds::add_beam_noise(points, 0.01, random);
    const Description description = described(points);
    const SlopeToGround& ground = largest(description).slope.to_ground;
    if (ground.status != FeatureStatus::kOk) continue;
    ++trusted;
    EXPECT_NEAR(ground.angle, kPi / 2, 4.0 * ground.angle_sigma + radians(0.5)) << "seed " << seed;
  }
  EXPECT_GT(trusted, 10);
  EXPECT_LT(trusted, 50);
}

TEST(BeamSlope, SteepRampsAreNoSpecialCase) {
  for (const double degrees : {70.0, 80.0, 87.0}) {
    RandomGenerator random(13);
    Points points;
    worlds::add_surface(points, {-0.8, 0.8, 0.06, 1.4}, 0.02, [](double, double) { return 0.0; });
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float y = points.x[i];
      points.z[i] = points.y[i];
      points.x[i] = static_cast<float>(1.5 + points.z[i] / std::tan(radians(degrees)));
      points.y[i] = y;
    }
    worlds::add_beam_noise(points, 0.01, random);
    const Description description = described(points);
    const Slope& slope = largest(description).slope;
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << degrees;
    EXPECT_NEAR(slope.angle, radians(degrees), radians(0.5)) << degrees;
  }
}

// A fit that cannot be trusted says so.
TEST(BeamSlope, AHeapWithoutASurfaceIsNotPlanar) {
  RandomGenerator random(14);
  Points points;
  worlds::add_heap(points, {1.2, 2.0, -0.4, 0.4}, 0.6, 3000, random);
  const Description description = described(points);
  const FeatureStatus status = largest(description).slope.status;
  EXPECT_TRUE(status == FeatureStatus::kNotPlanar || status == FeatureStatus::kUncertain)
      << name_of(status);
}

TEST(BeamSlope, AFewPointsLeaveTheAngleOpen) {
  RandomGenerator random(15);
  Points points;
  worlds::add_surface(points, {1.5, 1.8, -0.05, 0.05}, 0.05,
                      [](double x, double) { return 0.1 + 0.2 * (x - 1.5); });
  worlds::add_beam_noise(points, 0.03, random);
  const Description description = described(points);
  ASSERT_FALSE(description.things.empty());
  EXPECT_NE(largest(description).slope.status, FeatureStatus::kOk);
}

TEST(BeamSlope, UnknownOriginsOfBeamsAreAStatus) {
  const Points points = ramp_scan(0.2, 0.005, 1);
  DescriptionWorkspace workspace;
  Description description;
  describe(points.view(), beam_params(), workspace, description);
  ASSERT_FALSE(description.things.empty());
  for (const ClusterDescription& thing : description.things) {
    EXPECT_EQ(thing.slope.status, FeatureStatus::kNoOrigin);
  }
}

// Origins per point: the same origin written once for each point changes no bit.
TEST(BeamSlope, OriginsPerPointAreUsed) {
  const Points points = ramp_scan(0.2, 0.01, 6);
  const std::vector<std::array<float, 3>> origins{{9.0F, 9.0F, 9.0F}, worlds::kLidarOrigin};
  std::vector<std::uint32_t> origin_of(points.size(), 1);
  origin_of[0] = 1;
  DescriptionWorkspace workspace;
  Description description;
  const std::array<std::array<float, 3>, 2> both{worlds::kLidarOrigin, worlds::kLidarOrigin};
  describe({points.view(), {both.data(), origin_of.data()}}, beam_params(), workspace, description);
  const Description without_list = described(points);
  EXPECT_EQ(largest(description).slope.angle, largest(without_list).slope.angle);
  describe({points.view(), {origins.data(), origin_of.data()}}, beam_params(), workspace,
           description);
  EXPECT_NEAR(largest(description).slope.angle, 0.2, 0.01);
}

// Invariant: a quarter turn of the scan turns the direction and leaves the angle.
TEST(BeamSlope, TurnsWithTheScan) {
  const Points points = ramp_scan(0.25, 0.01, 8);
  const Description description = described(points);
  const Description turned = described(worlds::turned_left(points));
  const Slope& before = largest(description).slope;
  const Slope& after = largest(turned).slope;
  ASSERT_EQ(after.status, FeatureStatus::kOk);
  // Cells and samples come in another order, so the last digits differ.
  EXPECT_NEAR(after.angle, before.angle, 0.5 * before.angle_sigma);
  EXPECT_NEAR(after.direction - before.direction, kPi / 2, before.direction_sigma);
}

TEST(BeamSlope, SameScanSameBytesAndNoAllocationInSteadyState) {
  const Points points = ramp_scan(0.25, 0.01, 8, 0.15);
  DescriptionWorkspace workspace;
  Description first, second;
  const ScanView scan{points.view(), {&worlds::kLidarOrigin, nullptr}};
  describe(scan, beam_params(), workspace, first);
  describe(scan, beam_params(), workspace, second);
  const std::size_t before = bench::allocations();
  describe(scan, beam_params(), workspace, second);
  EXPECT_EQ(bench::allocations(), before);
  ASSERT_EQ(first.things.size(), second.things.size());
  for (std::size_t k = 0; k < first.things.size(); ++k) {
    EXPECT_EQ(
        std::memcmp(&first.things[k].slope.angle, &second.things[k].slope.angle, sizeof(double)),
        0);
  }
}

}  // namespace
}  // namespace mrpt_terrain
