// SPDX-License-Identifier: BSD-3-Clause
// What the cells of a map look like to the points of a scan.
#include <gtest/gtest.h>

#include <cmath>

#include "likelihood.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

/// The shape of points that `make` gives for u, v in [0, 1).
template <class Make>
CellShape shape_from(Make&& make) {
  RandomGenerator random(3);
  MomentSums sums;
  double low = 1e9, high = -1e9;
  for (int k = 0; k < 400; ++k) {
    const Eigen::Vector3d p = make(random.uniform(), random.uniform());
    sums.add(p.x(), p.y(), p.z());
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  return shape_of(sums, low, high);
}

TEST(LikelihoodField, GroundAndRampsAreSurfacesWithTheirSlopes) {
  const CellShape flat =
      shape_from([](double u, double v) { return Eigen::Vector3d(7 + 0.2 * u, 0.2 * v, 0.5); });
  EXPECT_TRUE(flat.surface);
  EXPECT_NEAR(flat.slope_x, 0.0, 1e-6);
  const CellShape ramp = shape_from(
      [](double u, double v) { return Eigen::Vector3d(0.2 * u, 0.2 * v, 0.08 * u - 0.02 * v); });
  EXPECT_TRUE(ramp.surface);
  EXPECT_NEAR(ramp.slope_x, 0.4, 0.05);
  EXPECT_NEAR(ramp.slope_y, -0.1, 0.02);
}

// A single ring crosses the cell: what lies beside it is not known, and taken to be level.
TEST(LikelihoodField, ALineOfPointsOnGroundIsASurface) {
  const CellShape line =
      shape_from([](double u, double) { return Eigen::Vector3d(0.2 * u, 0.1, 0.02 * u); });
  EXPECT_TRUE(line.surface);
  EXPECT_NEAR(line.slope_y, 0.0, 1e-6);
}

TEST(LikelihoodField, AWallStandsAlongItsDirection) {
  const CellShape wall = shape_from([](double u, double v) {
    return Eigen::Vector3d(3 + 0.1 * u, 0.1 * u, 1.5 * v);  // at 45 degrees
  });
  EXPECT_FALSE(wall.surface);
  EXPECT_NEAR(std::abs(wall.along_x), std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(wall.half_length, 0.5 * 0.1 * std::sqrt(2.0), 0.01);
  EXPECT_NEAR(wall.variance_across, 0.0, 1e-6);
}

}  // namespace
}  // namespace mrpt_terrain
