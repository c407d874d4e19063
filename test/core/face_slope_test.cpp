// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/face_slope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, 1.2F};

double normal_deviate(RandomGenerator& random) {
  double sum = -6.0;  // of twelve: variance 1
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

/// What rings of a sensor 1.2 m up see of a face about (5, 0) that rises along `direction`: beams 1
/// deg apart, columns 0.3 deg apart, with noise of every point and an error of every ring.
struct FaceScan {
  double angle, direction;
  double half = 0.8;  ///< metres from the middle in x and y
  double noise = 0.015, ring_noise = 0.0;

  [[nodiscard]] Points seen(RandomGenerator& random) const {
    Points points;
    const double gradient = std::tan(angle);
    const double gx = gradient * std::cos(direction), gy = gradient * std::sin(direction);
    for (int ring = 0; ring < 40; ++ring) {
      const double error = ring_noise * normal_deviate(random);
      const double e = (-30.0 + ring) * kDegree;
      for (int column = -60; column <= 60; ++column) {
        const double a = 0.3 * kDegree * column;
        const double dx = std::cos(e) * std::cos(a), dy = std::cos(e) * std::sin(a);
        const double dz = std::sin(e);
        // z = 0.3 + gx (x - 5) + gy y along the beam.
        const double range = (0.3 - 5.0 * gx - 1.2) / (dz - gx * dx - gy * dy);
        if (!(range > 0.0) || std::abs(range * dx - 5.0) > half || std::abs(range * dy) > half)
          continue;
        const double r = range + error + noise * normal_deviate(random);
        points.push_back(static_cast<float>(r * dx), static_cast<float>(r * dy),
                         static_cast<float>(1.2 + r * dz));
      }
    }
    return points;
  }
};

BeamSlopeParams without_ring_errors() {
  BeamSlopeParams params;
  params.ring_sigma = 0.0;
  return params;
}

Slope slope_of(const Points& points, const BeamSlopeParams& params = {}) {
  std::vector<std::int32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  FaceSlopeWorkspace workspace;
  return estimate_face_slope(points.view(), {&kOrigin, nullptr}, all_of(all), params, 1, 0,
                             workspace);
}

TEST(FaceSlope, ExactFacesHaveTheirAngleAndDirection) {
  for (const double angle : {6.0, 12.0, 20.0}) {
    for (const double direction : {0.0, 40.0, 90.0, -80.0}) {
      RandomGenerator random(91, 0);
      const Slope slope =
          slope_of(FaceScan{angle * kDegree, direction * kDegree, 0.8, 0.0, 0.0}.seen(random));
      ASSERT_EQ(slope.status, FeatureStatus::kOk) << angle << ' ' << direction;
      EXPECT_NEAR(slope.angle, angle * kDegree, 1e-4) << angle << ' ' << direction;
      EXPECT_NEAR(std::remainder(slope.direction - direction * kDegree, 2 * M_PI), 0.0, 1e-3);
    }
  }
}

// Of 400 scans, twice the stated deviation covers 95.4 % if it is right: 381 or 382, give or take
// 4.2. With errors of rings and without, and never much less than it says.
TEST(FaceSlope, StatedDeviationsHold) {
  for (const double ring_noise : {0.0, 0.013}) {
    BeamSlopeParams params;
    params.ring_sigma = ring_noise;
    int angle_in = 0, direction_in = 0, measured = 0;
    for (std::uint64_t trial = 0; trial < 400; ++trial) {
      RandomGenerator random(92, trial);
      const double direction = M_PI * (random.uniform() - 0.5);
      const Slope slope = slope_of(
          FaceScan{14.0 * kDegree, direction, 0.8, 0.015, ring_noise}.seen(random), params);
      if (slope.status != FeatureStatus::kOk) continue;
      ++measured;
      angle_in += std::abs(slope.angle - 14.0 * kDegree) <= 2.0 * slope.angle_sigma ? 1 : 0;
      direction_in += std::abs(std::remainder(slope.direction - direction, 2.0 * M_PI)) <=
                              2.0 * slope.direction_sigma
                          ? 1
                          : 0;
    }
    EXPECT_GT(measured, 380) << ring_noise;
    EXPECT_NEAR(angle_in / static_cast<double>(measured), 0.954, 0.03) << ring_noise;
    EXPECT_NEAR(direction_in / static_cast<double>(measured), 0.954, 0.03) << ring_noise;
  }
}

// A ramp that rises to the left, seen from its side, which has a third of the points.
TEST(FaceSlope, SidesOfARampAreNotItsFace) {
  RandomGenerator random(93, 0);
  Points points = FaceScan{15.0 * kDegree, 90.0 * kDegree}.seen(random);
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n / 2; ++k) {
    const double y = 1.6 * random.uniform() - 0.8;
    const double top = 0.3 + y * std::tan(15.0 * kDegree);
    points.push_back(4.2F, static_cast<float>(y), static_cast<float>(top * random.uniform()));
  }
  const Slope slope = slope_of(points);
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, 15.0 * kDegree, 1.5 * kDegree);
  EXPECT_NEAR(slope.direction, 90.0 * kDegree, 3.0 * kDegree);
  EXPECT_LT(slope.inliers, static_cast<int>(1.15 * static_cast<double>(n)));
}

// Rubble: half of the points lie on a plane, the others above and below it at the same places.
TEST(FaceSlope, WhatIsSeenThroughIsNoFace) {
  RandomGenerator random(97, 0);
  Points points = FaceScan{10.0 * kDegree, 0.0, 0.8, 0.005}.seen(random);
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; k += 2) {
    const auto off = static_cast<float>(0.3 * (random.uniform() - 0.5));
    points.push_back(points.x[k], points.y[k], points.z[k] + off);
  }
  EXPECT_EQ(slope_of(points).status, FeatureStatus::kNotPlanar);
}

TEST(FaceSlope, WhatIsNoFaceHasAStatus) {
  RandomGenerator random(94, 0);
  Points wall, ring, heap;
  for (int k = 0; k < 400; ++k) {
    wall.push_back(5.0F + 0.015F * static_cast<float>(normal_deviate(random)),
                   static_cast<float>(2.0 * random.uniform()),
                   static_cast<float>(1.5 * random.uniform()));
    ring.push_back(5.0F + 0.015F * static_cast<float>(normal_deviate(random)),
                   static_cast<float>(2.0 * random.uniform()) - 1.0F, 0.4F);
    heap.push_back(5.0F + static_cast<float>(random.uniform()),
                   static_cast<float>(random.uniform()), static_cast<float>(random.uniform()));
  }
  EXPECT_EQ(slope_of(wall).status, FeatureStatus::kNotPlanar);
  EXPECT_NE(slope_of(ring).status, FeatureStatus::kOk) << "a single ring shows no slope";
  EXPECT_EQ(slope_of(heap,
                     [] {
                       BeamSlopeParams params;
                       params.least_share = 0.5;
                       return params;
                     }())
                .status,
            FeatureStatus::kNotPlanar);
  EXPECT_EQ(slope_of(Points{}).status, FeatureStatus::kTooFewPoints);
  FaceSlopeWorkspace workspace;
  const std::vector<std::int32_t> all{0, 1, 2};
  EXPECT_EQ(estimate_face_slope(wall.view(), {}, all_of(all), {}, 1, 0, workspace).status,
            FeatureStatus::kNoOrigin);
}

/// A ramp of 1.6 m by 1.6 m about (5, 0) on level ground that rises along x from z = 0, seen by
/// rings 2 deg apart with an error of each; the ramp's points come first.
struct RampScan {
  double angle = 15.0 * kDegree;
  double ring_noise = 0.015, noise = 0.008;
  std::size_t on_ramp = 0;

  [[nodiscard]] Points seen(RandomGenerator& random) {
    Points ramp, ground;
    for (int ring = 0; ring < 14; ++ring) {
      const double error = ring_noise * normal_deviate(random);
      const double e = (-31.0 + 2.0 * ring) * kDegree;
      for (int column = -120; column <= 120; ++column) {
        const double a = 0.3 * kDegree * column;
        const double dx = std::cos(e) * std::cos(a), dy = std::cos(e) * std::sin(a);
        const double dz = std::sin(e);
        // z = tan(angle) (x - 4.2) along the beam, or z = 0.
        const double slope = std::tan(angle);
        const double to_ramp = (-4.2 * slope - 1.2) / (dz - slope * dx);
        const bool meets =
            to_ramp > 0.0 && std::abs(to_ramp * dx - 5.0) <= 0.8 && std::abs(to_ramp * dy) <= 0.8;
        const double range = meets ? to_ramp : -1.2 / dz;
        // What is behind the ramp is hidden, or near its edge.
        if (!meets && range * dx > 4.2 && std::abs(range * dy) <= 1.0) continue;
        const double r = range + error + noise * normal_deviate(random);
        (meets ? ramp : ground)
            .push_back(static_cast<float>(r * dx), static_cast<float>(r * dy),
                       static_cast<float>(1.2 + r * dz));
      }
    }
    on_ramp = ramp.size();
    for (std::size_t i = 0; i < ground.size(); ++i)
      ramp.push_back(ground.x[i], ground.y[i], ground.z[i]);
    return ramp;
  }
};

// The rings that meet a ramp meet the ground beside it, too, and are as wrong there.
TEST(FaceSlope, TheGroundBesideTellsErrorsOfRings) {
  constexpr int kTrials = 60;
  double with = 0.0, without = 0.0;
  int in_two_sigma = 0;
  BeamSlopeParams params;
  params.ring_sigma = 0.015;
  FieldWorkspace field;
  FaceSlopeWorkspace workspace;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomGenerator random(95, static_cast<std::uint64_t>(trial));
    RampScan scan;
    const Points points = scan.seen(random);
    find_field_ground(points.view(), GroundSurfaceParams{}, GroundLabelParams{}, field);
    const std::vector<float> raised(points.size(), 0.0F);
    std::vector<std::int32_t> all(scan.on_ramp);
    std::iota(all.begin(), all.end(), 0);
    // What is known of the ground to begin with is a little wrong.
    const FaceSurroundings around{
        field, raised, {Eigen::Vector3d(0.01, -0.01, 1.0).normalized(), -0.05}, {5.0, 0.0, 0.0}};
    const BeamOrigins origins{&kOrigin, nullptr};
    const Slope plain =
        estimate_face_slope(points.view(), origins, all_of(all), params, 1, 0, workspace);
    const Slope slope =
        estimate_face_slope(points.view(), origins, all_of(all), params, 1, 0, workspace, &around);
    ASSERT_EQ(plain.status, FeatureStatus::kOk) << trial;
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << trial;
    EXPECT_LT(slope.angle_sigma, plain.angle_sigma) << trial;
    const double error = slope.angle - scan.angle;
    with += error * error / kTrials;
    without += (plain.angle - scan.angle) * (plain.angle - scan.angle) / kTrials;
    in_two_sigma += std::abs(error) <= 2.0 * slope.angle_sigma ? 1 : 0;
  }
  EXPECT_LT(std::sqrt(with), 0.7 * std::sqrt(without));
  EXPECT_GE(in_two_sigma, 52);
}

// A level platform behind a ramp has as many points, and is off the plane of the ramp by little
// where they meet.
TEST(FaceSlope, TheFaceBesideDoesNotTurnIt) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    RandomGenerator random(96, trial);
    Points points = FaceScan{12.0 * kDegree, 0.0, 0.8, 0.01, 0.0}.seen(random);
    const double top = 0.3 + 0.8 * std::tan(12.0 * kDegree);
    const auto n = points.size();
    for (std::size_t k = 0; k < 3 * n / 4; ++k) {
      const double e = 0.01 * normal_deviate(random);
      const double x = 5.8 + random.uniform(), y = 1.6 * random.uniform() - 0.8;
      const double range = std::hypot(x, y, top - 1.2);
      points.push_back(static_cast<float>(x + e * x / range), static_cast<float>(y),
                       static_cast<float>(top + e * (top - 1.2) / range));
    }
    const Slope slope = slope_of(points);
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << trial;
    EXPECT_NEAR(slope.angle, 12.0 * kDegree, 0.6 * kDegree) << trial;
  }
}

/// A ramp about (5, 0) that rises to the left by 15 deg, with an upright front at x = 4.2 m that
/// the same beams meet below its edge.
Points ramp_with_front(RandomGenerator& random, double noise) {
  const double gradient = std::tan(15.0 * kDegree);
  Points points;
  for (int ring = 0; ring < 40; ++ring) {
    const double e = (-30.0 + ring) * kDegree;
    for (int column = -60; column <= 60; ++column) {
      const double a = 0.3 * kDegree * column;
      const Eigen::Vector3d d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      const double front = 4.2 / d.x();
      double range = (0.3 - 1.2) / (d.z() - gradient * d.y());
      if (1.2 + front * d.z() < 0.3 + gradient * front * d.y()) range = front;
      const Eigen::Vector3d at = Eigen::Vector3d(0.0, 0.0, 1.2) + range * d;
      if (!(range > 0.0) || at.x() > 5.8 || std::abs(at.y()) > 0.8 || at.z() < 0.05) continue;
      const Eigen::Vector3f measured = (at + noise * normal_deviate(random) * d).cast<float>();
      points.push_back(measured.x(), measured.y(), measured.z());
    }
  }
  return points;
}

// Points of the front just below the edge are within the noise of the face, and all on one side.
TEST(FaceSlope, WhatJoinsOnAtItsEdgeDoesNotTurnIt) {
  constexpr int kTrials = 200;
  double mean = 0.0;
  int in_two_sigma = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    RandomGenerator random(97, trial);
    const Slope slope = slope_of(ramp_with_front(random, 0.02), without_ring_errors());
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << trial;
    const double error = (slope.direction - 90.0 * kDegree) / slope.direction_sigma;
    mean += error / kTrials;
    in_two_sigma += std::abs(error) <= 2.0 ? 1 : 0;
  }
  EXPECT_LT(std::abs(mean), 0.5);
  EXPECT_GT(in_two_sigma, 0.9 * kTrials);
}

// Rings that run up the face tell its angle by themselves, though their errors tilt it as a whole.
TEST(FaceSlope, RingsTellMoreByTheirCourseThanByTheirHeight) {
  constexpr int kTrials = 100;
  BeamSlopeParams params;
  params.ring_sigma = 0.013;
  double with = 0.0, without = 0.0;
  int in_two_sigma = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    RandomGenerator random(98, trial);
    FaceScan scan{20.0 * kDegree, 60.0 * kDegree, 0.8, 0.008, 0.013};
    const Points points = scan.seen(random);
    const Slope plain = slope_of(points, without_ring_errors());
    const Slope slope = slope_of(points, params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << trial;
    const double error = slope.angle - 20.0 * kDegree;
    with += error * error / kTrials;
    without += (plain.angle - 20.0 * kDegree) * (plain.angle - 20.0 * kDegree) / kTrials;
    in_two_sigma += std::abs(error) <= 2.0 * slope.angle_sigma ? 1 : 0;
  }
  EXPECT_LT(with, 0.8 * without);
  EXPECT_GE(in_two_sigma, 90);
}

TEST(FaceSlope, NearlyLevelFacesRiseInNoDirection) {
  int undecided = 0;
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    RandomGenerator random(99, trial);
    const Slope slope = slope_of(FaceScan{0.05 * kDegree, 0.0}.seen(random));
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << trial;
    const double error = std::abs(std::remainder(slope.direction, 2.0 * M_PI));
    EXPECT_TRUE(error <= 4.0 * slope.direction_sigma) << trial;
    undecided += slope.direction_sigma > 3.0 ? 1 : 0;
  }
  EXPECT_GT(undecided, 40);
}

}  // namespace
}  // namespace mrpt_terrain
