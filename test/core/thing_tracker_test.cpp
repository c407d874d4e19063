// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/thing_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using Identities = std::vector<std::uint64_t>;
const Eigen::Isometry3d kStill = Eigen::Isometry3d::Identity();

ClusterDescription thing(double x, double y, double length = 1.0, double width = 1.0,
                         double yaw = 0.0, float low = 0.0F, float high = 1.0F) {
  ClusterDescription result;
  result.box = {{x, y}, yaw, length, width, low, high};
  return result;
}

// Oracle: points drawn in one of the boxes.
TEST(ThingTracker, CommonAreaIsTheShareOfPointsInBoth) {
  RandomGenerator random(81, 0);
  const auto contains = [](const OrientedBox& box, double x, double y) {
    const double dx = x - box.centre.x, dy = y - box.centre.y;
    const double u = std::cos(box.yaw) * dx + std::sin(box.yaw) * dy;
    const double v = std::cos(box.yaw) * dy - std::sin(box.yaw) * dx;
    return std::abs(u) <= 0.5 * box.length && std::abs(v) <= 0.5 * box.width;
  };
  for (int trial = 0; trial < 20; ++trial) {
    const OrientedBox a = thing(random.uniform(), random.uniform(), 2.0, 1.0, random.uniform()).box;
    const OrientedBox b =
        thing(random.uniform(), random.uniform(), 1.5, 0.5, 3.0 * random.uniform()).box;
    int both = 0;
    constexpr int kDraws = 40000;
    for (int k = 0; k < kDraws; ++k) {
      const double x = 6.0 * random.uniform() - 2.5, y = 6.0 * random.uniform() - 2.5;
      both += contains(a, x, y) && contains(b, x, y) ? 1 : 0;
    }
    // At most 0.75 m^2 of 36: standard deviation 36 sqrt(p (1 - p) / n) < 0.026.
    EXPECT_NEAR(common_area(a, b, 0.0), 36.0 * both / kDraws, 0.11) << trial;
    EXPECT_NEAR(common_area(a, b, 0.1), common_area(b, a, 0.1), 1e-12);
  }
  EXPECT_EQ(common_area(thing(0, 0).box, thing(3, 0).box, 0.0), 0.0);
  EXPECT_NEAR(common_area(thing(0, 0).box, thing(3, 0).box, 1.1), 0.2 * 3.2, 1e-12);
}

// A tracker that takes over the state of another goes on as that does.
TEST(ThingTracker, GoesOnFromAState) {
  ThingTracker tracker;
  tracker.update({thing(1, 0), thing(5, 0)}, kStill, 0.0);
  tracker.update({thing(5, 0)}, kStill, 1.0);
  ThingTracker other;
  other.restore(tracker.state());
  EXPECT_EQ(other.update({thing(9, 0), thing(1, 0)}, kStill, 2.0), (Identities{3, 1}));
  tracker.forget();
  EXPECT_EQ(tracker.remembered(), 0U);
  EXPECT_EQ(tracker.update({thing(5, 0)}, kStill, 2.0), (Identities{3})) << "not used again";
}

// The robot drives and turns; the things stand still.
TEST(ThingTracker, ThingsThatStandStillKeepTheirIdentities) {
  ThingTracker tracker;
  const std::vector<Eigen::Vector2d> places{{5.0, 1.0}, {8.0, -2.0}, {6.0, 4.0}};
  for (int scan = 0; scan < 30; ++scan) {
    Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();
    T_map_robot.translation() = Eigen::Vector3d(0.1 * scan, 0.02 * scan, 0.0);
    const double yaw = 0.03 * scan;
    T_map_robot.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    std::vector<ClusterDescription> things;
    // In another order every time.
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Eigen::Vector2d& place = places[(k + static_cast<std::size_t>(scan)) % places.size()];
      const Eigen::Vector3d p = T_map_robot.inverse() * Eigen::Vector3d(place.x(), place.y(), 0.0);
      things.push_back(thing(p.x(), p.y(), 1.0, 0.5, -yaw));
    }
    const Identities identities = tracker.update(things, T_map_robot, 0.1 * scan);
    for (std::size_t k = 0; k < places.size(); ++k)
      EXPECT_EQ(identities[k], 1 + (k + static_cast<std::size_t>(scan)) % places.size()) << scan;
  }
}

// Two persons pass each other at 1.5 m/s each, 0.9 m apart.
TEST(ThingTracker, ThingsThatCrossKeepTheirIdentities) {
  ThingTracker tracker;
  for (int scan = 0; scan < 40; ++scan) {
    const double x = 0.15 * (scan - 20);
    const Identities identities =
        tracker.update({thing(x, 0.45, 0.5, 0.5), thing(-x, -0.45, 0.5, 0.5)}, kStill, 0.1 * scan);
    EXPECT_EQ(identities, (Identities{1, 2})) << scan;
  }
}

TEST(ThingTracker, WhatIsHiddenIsRememberedForAWhile) {
  ThingTracker tracker;
  EXPECT_EQ(tracker.update({thing(5, 0)}, kStill, 0.0), Identities{1});
  EXPECT_TRUE(tracker.update({}, kStill, 1.0).empty());
  EXPECT_EQ(tracker.update({thing(5, 0)}, kStill, 4.9), Identities{1});
  EXPECT_TRUE(tracker.update({}, kStill, 10.0).empty());
  EXPECT_EQ(tracker.remembered(), 0U);
  EXPECT_EQ(tracker.update({thing(5, 0)}, kStill, 10.1), Identities{2}) << "never used again";
}

TEST(ThingTracker, TheLargerPartKeepsTheIdentity) {
  ThingTracker tracker;
  EXPECT_EQ(tracker.update({thing(0, 0, 4.0)}, kStill, 0.0), Identities{1});
  EXPECT_EQ(tracker.update({thing(-1.6, 0, 0.8), thing(0.6, 0, 2.8)}, kStill, 0.1),
            (Identities{2, 1}));
  EXPECT_EQ(tracker.update({thing(0, 0, 4.0)}, kStill, 0.2), Identities{1}) << "whole again";
  EXPECT_EQ(tracker.update({thing(-1.6, 0, 0.8), thing(0.6, 0, 2.8)}, kStill, 0.3),
            (Identities{2, 1}))
      << "the other part was remembered";
}

TEST(ThingTracker, ThingsAboveEachOtherAreTwo) {
  ThingTracker tracker;
  EXPECT_EQ(tracker.update({thing(0, 0)}, kStill, 0.0), Identities{1});
  EXPECT_EQ(tracker.update({thing(0, 0, 1, 1, 0, 2.0F, 3.0F), thing(0, 0)}, kStill, 0.1),
            (Identities{2, 1}));
}

// Invariant: no identity twice in a scan, and the same input gives the same.
TEST(ThingTracker, IdentitiesAreUnique) {
  RandomGenerator random(82, 0);
  ThingTracker tracker, again;
  for (int scan = 0; scan < 50; ++scan) {
    std::vector<ClusterDescription> things;
    for (int k = 0; k < 30; ++k)
      things.push_back(thing(5.0 * random.uniform(), 5.0 * random.uniform(), 1.0 + random.uniform(),
                             random.uniform(), random.uniform()));
    const Identities identities = tracker.update(things, kStill, 0.1 * scan);
    EXPECT_EQ(std::set<std::uint64_t>(identities.begin(), identities.end()).size(), 30U);
    EXPECT_EQ(again.update(things, kStill, 0.1 * scan), identities);
  }
}

}  // namespace
}  // namespace mrpt_terrain
