// SPDX-License-Identifier: BSD-3-Clause
#include "plane_inliers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

Points random_cloud(std::size_t n, RandomGenerator& random) {
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = random.uniform();
    const double y = random.uniform();
    worlds::add_point(points, x, y, 0.2 * random.uniform());
  }
  return points;
}

Plane random_plane(RandomGenerator& random) {
  const double a = random.uniform() - 0.5;
  const double b = random.uniform() - 0.5;
  const double length = std::sqrt(a * a + b * b + 1.0);
  return {static_cast<float>(a / length), static_cast<float>(b / length),
          static_cast<float>(1.0 / length), static_cast<float>(-0.3 * random.uniform())};
}

std::int32_t counted_in_double(const Points& points, const Plane& plane, double tolerance) {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = double{plane.a} * points.x[i] + double{plane.b} * points.y[i] +
                            double{plane.c} * points.z[i] + double{plane.d};
    count += std::abs(distance) <= tolerance ? 1 : 0;
  }
  return count;
}

// Literal: "distance <= T_q", on both sides of the plane.
TEST(PlaneInliers, ToleranceIsIncludedOnBothSides) {
  const Plane plane{0.0F, 0.0F, 1.0F, -1.0F};
  Points points;
  for (const float z : {1.0F, 1.25F, 0.75F, std::nextafter(1.25F, 2.0F), 0.5F, 1.5F}) {
    points.push_back(7.0F, -3.0F, z);
  }
  EXPECT_EQ(count_inliers(points.view(), plane, 0.25F, 0), 3);
  EXPECT_TRUE(is_inlier(points.view(), 2, plane, 0.25F));
  EXPECT_FALSE(is_inlier(points.view(), 3, plane, 0.25F));
}

TEST(PlaneInliers, NoPointsNoInliers) {
  EXPECT_EQ(count_inliers(PointsView{}, {0, 0, 1, 0}, 1.0F, 0), 0);
}

// Oracle: plain count in double. The float distance is wrong by less than 2e-7, which may move a
// point across the tolerance.
TEST(PlaneInliers, EqualAPlainCount) {
  RandomGenerator random(61);
  for (const std::size_t n : {1U, 7U, 511U, 512U, 513U, 1024U, 1025U, 3000U}) {
    const Points points = random_cloud(n, random);
    for (int k = 0; k < 20; ++k) {
      const Plane plane = random_plane(random);
      const std::int32_t inliers = count_inliers(points.view(), plane, 0.02F, -1);
      EXPECT_GE(inliers, counted_in_double(points, plane, 0.02 - 2e-7));
      EXPECT_LE(inliers, counted_in_double(points, plane, 0.02 + 2e-7));
    }
  }
}

// Oracle: giving up early never changes which hypothesis is the best.
TEST(PlaneInliers, GivingUpNeverHidesABetterPlane) {
  RandomGenerator random(62);
  int gave_up = 0;
  for (int k = 0; k < 300; ++k) {
    const Points points = random_cloud(600 + random.below(2000), random);
    const Plane plane = random_plane(random);
    const std::int32_t full = count_inliers(points.view(), plane, 0.03F, -1);
    for (const std::int32_t to_beat :
         {0, full - 1, full, full + 1, static_cast<std::int32_t>(points.size()) - 500}) {
      const std::int32_t inliers = count_inliers(points.view(), plane, 0.03F, to_beat);
      if (full > to_beat) {
        EXPECT_EQ(inliers, full) << "seed 62, cloud " << k;
      } else {
        EXPECT_LE(inliers, to_beat) << "seed 62, cloud " << k;
        gave_up += inliers < full ? 1 : 0;
      }
    }
  }
  EXPECT_GT(gave_up, 50) << "the early exit must be taken to be tested";
}

}  // namespace
}  // namespace mrpt_terrain
