// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/move_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

// Oracle: one point at a time. Far from the origin, where digits are few.
TEST(MovePoints, OracleEachPointIsMovedByThePose) {
  RandomGenerator random(1, 0);
  Eigen::Isometry3d T(Eigen::Translation3d(20000.0, -3000.0, 70.0));
  T.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.1, -0.3, 0.9).normalized()));
  for (const std::size_t n : {0, 1, 7, 1000}) {
    Points points, moved;
    moved.push_back(1.0F, 2.0F, 3.0F);  // goes
    for (std::size_t k = 0; k < n; ++k) {
      const auto coordinate = [&] { return static_cast<float>(160.0 * random.uniform() - 80.0); };
      points.push_back(coordinate(), coordinate(), coordinate());
    }
    move_points(points.view(), T, moved);
    ASSERT_EQ(moved.size(), n);
    for (std::size_t k = 0; k < n; ++k) {
      const Eigen::Vector3d p = T * Eigen::Vector3d(points.x[k], points.y[k], points.z[k]);
      EXPECT_FLOAT_EQ(moved.x[k], static_cast<float>(p.x()));
      EXPECT_FLOAT_EQ(moved.y[k], static_cast<float>(p.y()));
      EXPECT_FLOAT_EQ(moved.z[k], static_cast<float>(p.z()));
    }
  }
}

TEST(MovePoints, WhatIsNotFiniteStaysSo) {
  Points points, moved;
  points.push_back(std::numeric_limits<float>::quiet_NaN(), 1.0F, 2.0F);
  points.push_back(0.0F, std::numeric_limits<float>::infinity(), 2.0F);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  move_points(points.view(), T, moved);
  EXPECT_TRUE(std::isnan(moved.x[0]));
  EXPECT_FALSE(std::isfinite(moved.y[1]));
}

}  // namespace
}  // namespace mrpt_terrain
