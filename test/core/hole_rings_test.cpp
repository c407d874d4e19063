// SPDX-License-Identifier: BSD-3-Clause
#include "hole_rings.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "hole_rim.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, 1.0F};
constexpr double kDepth = 0.1;
constexpr double kStep = 0.2 * M_PI / 180.0;

/// Points of rings at 5 m and farther, over 20 degrees, whose depths are told by the numbers of the
/// ring and of the step; beams that fall by the same angle go on to the floor. Zones as they lie at
/// the hole.
std::vector<HolePoint> points_of(int count, const std::function<double(int, int)>& depth_of) {
  std::vector<HolePoint> points;
  for (int ring = 0; ring < count; ++ring) {
    const double fall = std::tan(std::atan(1.0 / 5.0) - ring * 0.01);
    for (int step = -50; step <= 50; ++step) {
      const double depth = depth_of(ring, step);
      const double range = (1.0 + depth) / fall, azimuth = step * kStep;
      const HoleZone zone = depth > 0.5 * kDepth ? HoleZone::kFloor : HoleZone::kRim;
      points.push_back({static_cast<float>(range * std::cos(azimuth)),
                        static_cast<float>(range * std::sin(azimuth)), static_cast<float>(-depth),
                        static_cast<std::int32_t>(points.size()), 0, static_cast<float>(depth),
                        zone});
    }
  }
  return points;
}

/// The same depths on all rings.
std::vector<HolePoint> rings_of(int count, const std::function<double(int)>& depth_of) {
  return points_of(count, [&](int, int step) { return depth_of(step); });
}

RingEvidence evidence_of(const std::vector<HolePoint>& points) {
  HoleWorkspace workspace;
  return follow_rings(points, {&kOrigin, nullptr}, kDepth, workspace);
}

// 21 points of each ring are on the floor.
TEST(HoleRings, WallsEndTraces) {
  for (const int rings : {1, 2, 5}) {
    const RingEvidence evidence =
        evidence_of(rings_of(rings, [](int step) { return std::abs(step) <= 10 ? kDepth : 0.0; }));
    EXPECT_EQ(evidence.rings, rings);
    EXPECT_EQ(evidence.traces, rings);
    EXPECT_EQ(evidence.walled, 21 * rings);
    EXPECT_EQ(evidence.strictly, 21 * rings);
    EXPECT_NEAR(evidence.noise, 0.0, 1e-6);
  }
}

// From 0.3 of the depth to 0.55 in 25 steps on each side, 0.45 m: more than kWidestWall.
TEST(HoleRings, GradualSidesAreNoWalls) {
  const RingEvidence evidence = evidence_of(
      rings_of(3, [](int step) { return std::max(0.0, kDepth * (1.0 - std::abs(step) * 0.01)); }));
  EXPECT_EQ(evidence.rings, 0);
  EXPECT_EQ(evidence.walled, 0);
}

/// On the floor for 21 points, and halfway down the wall for so many steps at both ends.
double oblique(int step, int halfway) {
  if (std::abs(step) <= 10) return kDepth;
  return std::abs(step) <= 10 + halfway ? 0.4 * kDepth : 0.0;
}

// A ring that runs along walls at both ends, over 11 steps or 0.19 m: no more than kWidestWall, but
// more than 2.6 steps and than the depth. 20 steps are 0.37 m.
TEST(HoleRings, ObliqueWallsAreCountedApart) {
  const auto second = [](int halfway) {
    return points_of(2, [halfway](int ring, int step) { return oblique(step, ring * halfway); });
  };
  RingEvidence evidence = evidence_of(second(10));
  EXPECT_EQ(evidence.walled, 21);
  EXPECT_EQ(evidence.rings, 1);
  EXPECT_EQ(evidence.oblique, 21);
  EXPECT_EQ(evidence.oblique_traces, 1);
  EXPECT_EQ(evidence.oblique_rings, 1);
  count_oblique(evidence);
  EXPECT_EQ(evidence.walled, 42);
  EXPECT_EQ(evidence.strictly, 42);
  EXPECT_EQ(evidence.traces, 2);
  EXPECT_EQ(evidence.rings, 2);
  evidence = evidence_of(second(20));
  EXPECT_EQ(evidence.walled, 21);
  EXPECT_EQ(evidence.oblique, 0);
}

// Hollows of rolling ground deepen from 0.56 of the depth at both ends to 1.4 in the middle (a
// fifth of a floor's points lies deeper than its depth), and a few steps that are steeper than the
// others make no walls of their ends. Without the six points that a wall may have, the outermost
// eighths lie at 0.90, all at 1.19: 0.76, less than 0.8. A floor that begins as deep has walls.
TEST(HoleRings, WhatDeepensTowardsTheMiddleHasNoWalls) {
  const auto within = [](int step) { return std::abs(step) <= 45; };
  const RingEvidence hollow = evidence_of(rings_of(3, [&](int step) {
    const double share = 1.4 - 0.84 * step * step / 2025.0;
    return within(step) ? kDepth * share : 0.25 * kDepth;
  }));
  EXPECT_EQ(hollow.walled, 0);
  const RingEvidence floor = evidence_of(
      rings_of(3, [&](int step) { return within(step) ? 0.9 * kDepth : 0.25 * kDepth; }));
  EXPECT_EQ(floor.walled, 3 * 91);
}

// The rim and the floor of a hole differ by more than the points of the rim do.
TEST(HoleRings, NoiseHidesWalls) {
  for (const double noise : {0.002, 0.03}) {
    RandomGenerator random(303);
    std::vector<HolePoint> points =
        rings_of(3, [](int step) { return std::abs(step) <= 10 ? kDepth : 0.0; });
    for (HolePoint& p : points) {
      if (p.zone == HoleZone::kRim)
        p.depth += static_cast<float>(noise * worlds::normal_deviate(random));
    }
    EXPECT_EQ(evidence_of(points).walled > 0, noise < 0.01) << noise;
  }
}

// One side alone is a step; where the ring leaves what is looked at, it may be a hole.
TEST(HoleRings, OneWallIsEnoughOnlyWhereTheOtherIsOutOfSight) {
  const auto step_down = [](int step) { return step > 0 ? kDepth : 0.0; };
  std::vector<HolePoint> open = rings_of(2, step_down);
  RingEvidence evidence = evidence_of(open);
  EXPECT_EQ(evidence.rings, 2);
  EXPECT_EQ(evidence.strictly, 0) << "not both ends";
  // The same, but the low ground goes on beyond the cells of the hole.
  for (HolePoint& p : open) {
    if (p.depth > 0.0F && p.y > 0.8F) p.zone = HoleZone::kRim;
  }
  evidence = evidence_of(open);
  EXPECT_EQ(evidence.rings, 0);
}

// Neighbours differ by sqrt(2) sigma: 202 points give their median within 10 %.
TEST(HoleRings, NoiseIsToldFromNeighbours) {
  RandomGenerator random(301);
  std::vector<HolePoint> points = rings_of(2, [](int) { return 0.0; });
  for (HolePoint& p : points) p.depth += static_cast<float>(0.01 * worlds::normal_deviate(random));
  points[50].zone = HoleZone::kFloor;
  EXPECT_NEAR(evidence_of(points).noise, 0.01, 0.002);
}

// All points count the same.
constexpr RimArea kEverywhere{{-1000.0, -1000.0}, {1000.0, 1000.0}, 0.0};

// A plane with a third of its points 0.1 m lower: those do not count.
TEST(HoleRim, LowPointsDoNotCount) {
  RandomGenerator random(302);
  std::vector<HolePoint> points;
  for (int k = 0; k < 900; ++k) {
    const double x = 2.0 * random.uniform() - 1.0, y = 2.0 * random.uniform() - 1.0;
    const bool low = k % 3 == 0;
    const double z =
        0.1 * x - 0.05 * y + 0.3 + 0.005 * worlds::normal_deviate(random) - (low ? 0.1 : 0.0);
    points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), k, 0,
                      0.0F, low ? HoleZone::kNear : HoleZone::kRim});
  }
  RimPoints scratch;
  RimSurface rim;
  ASSERT_TRUE(fit_rim(points, kEverywhere, 0.03, false, scratch, rim));
  // Three standard errors of a mean of 600 points, and of gradients.
  EXPECT_NEAR(rim.height_at(0.0, 0.0), 0.3, 0.0015);
  EXPECT_NEAR(rim.height_at(0.5, 0.5) - rim.height_at(-0.5, -0.5), 0.05, 0.003);
  EXPECT_NEAR(rim.sigma, 0.005, 0.0005);
}

// Half as much 0.2 m away from the area, and so much less at its corners.
TEST(HoleRim, NearPointsCountMore) {
  const std::vector<Position2> places = {{0.4, -0.1}, {0.7, 0.0}, {-0.7, 0.0}, {0.7, -0.7}};
  const std::vector<double> weights = {1.0, 0.5, 0.5, 1.0 / 3.0};
  std::vector<HolePoint> points;
  for (int k = 0; k < 12; ++k) {
    const Position2& at = places[static_cast<std::size_t>(k % 4)];
    points.push_back(
        {static_cast<float>(at.x), static_cast<float>(at.y), 0.0F, k, 0, 0.0F, HoleZone::kRim});
  }
  RimPoints scratch;
  RimSurface rim;
  ASSERT_TRUE(fit_rim(points, {{-0.3, -0.3}, {0.3, 0.3}, 0.2}, 0.03, false, scratch, rim));
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_NEAR(scratch.weight[k], weights[k % 4], 1e-5) << k;
}

// A third of the points lie on walls, 0.01 to 0.03 m low. The scatter of all holds a band of 2.5 of
// its deviations open to most of them, that of those above the surface, 4 mm and less, does not.
TEST(HoleRim, WallsDoNotHoldTheBandOpen) {
  RandomGenerator random(304);
  std::vector<HolePoint> points;
  for (int k = 0; k < 900; ++k) {
    const double x = 2.0 * random.uniform() - 1.0, y = 2.0 * random.uniform() - 1.0;
    const double low = k % 3 == 0 ? 0.01 + 0.02 * random.uniform() : 0.0;
    const double z = 0.003 * worlds::normal_deviate(random) - low;
    points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), k, 0,
                      0.0F, HoleZone::kRim});
  }
  RimPoints scratch;
  RimSurface all, above;
  ASSERT_TRUE(fit_rim(points, kEverywhere, 0.03, false, scratch, all));
  ASSERT_TRUE(fit_rim(points, kEverywhere, 0.03, true, scratch, above));
  EXPECT_GT(all.sigma, 1.5 * above.sigma);
  EXPECT_LT(above.sigma, 0.006);
  EXPECT_NEAR(above.height_at(0.0, 0.0), 0.0, 0.002);
}

// z = 0.1 x^2 without noise. The weight of "no bending" is 30; the points' own is the sum of the
// fourth moments of u^2 about its mean, 4 / 45 times 4 000.
TEST(HoleRim, FollowsGroundThatBends) {
  std::vector<HolePoint> points;
  RandomGenerator random(303);
  for (int k = 0; k < 4000; ++k) {
    const double x = 2.0 * random.uniform() - 1.0, y = 2.0 * random.uniform() - 1.0;
    points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(0.1 * x * x),
                      k, 0, 0.0F, HoleZone::kRim});
  }
  RimPoints scratch;
  RimSurface rim;
  ASSERT_TRUE(fit_rim(points, kEverywhere, 0.2, false, scratch, rim));
  EXPECT_NEAR(rim.bend_xx, 0.1 / (1.0 + 30.0 / (4000 * 4.0 / 45.0)), 0.005);
  EXPECT_NEAR(rim.bend_yy, 0.0, 0.005);
}

TEST(HoleRim, TooFewPointsOrALineAreNoSurface) {
  std::vector<HolePoint> points;
  RimPoints scratch;
  RimSurface rim;
  for (int k = 0; k < 7; ++k)
    points.push_back(
        {static_cast<float>(k), static_cast<float>(k * k), 0.0F, k, 0, 0.0F, HoleZone::kRim});
  EXPECT_FALSE(fit_rim(points, kEverywhere, 0.03, false, scratch, rim));
  for (int k = 0; k < 20; ++k) points.push_back({0.0F, 0.0F, 0.0F, k, 0, 0.0F, HoleZone::kFloor});
  EXPECT_FALSE(fit_rim(points, kEverywhere, 0.03, false, scratch, rim))
      << "the floor does not count";
  points.clear();
  for (int k = 0; k < 20; ++k)
    points.push_back({static_cast<float>(k), 0.0F, 0.0F, k, 0, 0.0F, HoleZone::kRim});
  EXPECT_FALSE(fit_rim(points, kEverywhere, 0.03, false, scratch, rim)) << "a line";
}

}  // namespace
}  // namespace mrpt_terrain
