// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/height_sums.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

void expect_equal(const FourFloats& values, float a, float b, float c) {
  EXPECT_EQ(values[0], a);
  EXPECT_EQ(values[1], b);
  EXPECT_EQ(values[2], c);
}

// Literal: whole numbers, so that every sum is exact.
TEST(HeightSums, OfTwoPointsByHand) {
  HeightSums sums;
  sums.add(1.0F, 2.0F, 3.0F);
  sums.add_weighted(FourFloats{-2.0F, 4.0F, 5.0F, 1.0F}, 2.0F);
  EXPECT_EQ(sums.n(), 3.0F);
  expect_equal(sums.sum, -3.0F, 10.0F, 13.0F);
  expect_equal(sums.squares, 9.0F, 36.0F, 59.0F);
  expect_equal(sums.products, -14.0F, -17.0F, 46.0F);  // xy, xz, yz
}

TEST(HeightSums, OfNoWeightAddNothing) {
  HeightSums sums;
  sums.add_weighted(FourFloats{3.0F, -4.0F, 5.0F, 1.0F}, 0.0F);
  EXPECT_EQ(sums.n(), 0.0F);
  expect_equal(sums.squares, 0.0F, 0.0F, 0.0F);
}

// Invariant: shifted sums are those of shifted points. Whole numbers again.
TEST(HeightSums, ShiftedAreThoseOfShiftedPoints) {
  RandomGenerator random(1);
  const auto next = [&random] { return static_cast<float>(random.below(21)) - 10.0F; };
  for (int trial = 0; trial < 100; ++trial) {
    const float dx = next(), dy = next(), dz = next();
    HeightSums here, there, expected;
    for (int k = 0; k < 7; ++k) {
      const float x = next(), y = next(), z = next();
      there.add(x, y, z);
      expected.add(x + dx, y + dy, z + dz);
    }
    here.add_shifted(there, dx, dy, dz);
    EXPECT_EQ(here.n(), expected.n());
    expect_equal(here.sum, expected.sum[0], expected.sum[1], expected.sum[2]);
    expect_equal(here.squares, expected.squares[0], expected.squares[1], expected.squares[2]);
    expect_equal(here.products, expected.products[0], expected.products[1], expected.products[2]);
  }
}

// Analytic: four points of the plane z = 2 + x / 2 - y / 4 and one above the middle.
TEST(HeightSums, PlaneThroughFourPointsAndAHigherOne) {
  HeightSums sums;
  for (const float x : {-1.0F, 1.0F})
    for (const float y : {-1.0F, 1.0F}) sums.add(x, y, 2.0F + 0.5F * x - 0.25F * y);
  sums.add(0.0F, 0.0F, 3.0F);
  const SumsPlane plane = fit_plane(sums, 1e-6F);
  EXPECT_NEAR(plane.gradient_x, 0.5F, 1e-5F);
  EXPECT_NEAR(plane.gradient_y, -0.25F, 1e-5F);
  EXPECT_NEAR(plane.at_centre(), 2.2F, 1e-5F);
  EXPECT_NEAR(plane.variance, 0.16F, 1e-5F);  // mean of 0.2^2 four times and 0.8^2
}

// Oracle: 1 / (b' C^-1 b) with Eigen's inverse, in double precision. `spread` is that along the
// axes of a turned box of points.
TEST(HeightSums, VarianceAlongIsThatOfTheInverseCovariance) {
  RandomGenerator random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Quaterniond turned =
        Eigen::Quaterniond(random.uniform(), random.uniform(), random.uniform(), 1.0).normalized();
    const Eigen::Vector3d spread(0.5, 0.1 + 0.2 * random.uniform(), 0.05);
    HeightSums sums;
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    constexpr int kPoints = 200;
    for (int k = 0; k < kPoints; ++k) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = spread[axis] * worlds::normal_deviate(random);
      const Eigen::Vector3f single = (turned * point).cast<float>();
      sums.add(single.x(), single.y(), single.z());
    }
    const HeightMoments m(sums);
    const FourFloats &v = m.variances, &c = m.covariances;
    products << v[0], c[0], c[1], c[0], v[1], c[2], c[1], c[2], v[2];
    products.diagonal().array() += 1e-5;
    const Eigen::Vector3d b = (turned * Eigen::Vector3d(1.0, 2.0, random.uniform())).normalized();
    const double expected = 1.0 / b.dot(products.inverse() * b);
    const float along = variance_along(
        v, c, {static_cast<float>(b.x()), static_cast<float>(b.y()), static_cast<float>(b.z())});
    EXPECT_NEAR(double{along}, expected, 2e-3 * expected);
  }
}

// Analytic: of a straight ring across the beam nothing is left but the noise that gives it a
// volume, of one whose points scatter along the beam their variance, and of a plane seen by many
// rings, inclined by atan(1 / 4) to the beam, that noise over the squared sine.
TEST(HeightSums, VarianceAlongABeamIsScatterNotPlace) {
  HeightSums ring, loose, plane;
  for (int k = -10; k <= 10; ++k) {
    const float y = 0.05F * static_cast<float>(k), jump = k % 2 == 0 ? 0.1F : -0.1F;
    ring.add(0.5F * y, y, 0.0F);
    loose.add(0.5F * y + jump, y, 0.0F);
    for (int l = -10; l <= 10; ++l)
      plane.add(0.05F * static_cast<float>(l), y, 0.0125F * static_cast<float>(l));
  }
  const auto along_x = [](const HeightSums& sums) {
    const HeightMoments m(sums);
    return std::sqrt(variance_along(m.variances, m.covariances, {1.0F, 0.0F, 0.0F}));
  };
  EXPECT_LT(along_x(ring), 0.004F);
  EXPECT_NEAR(along_x(loose), 0.1F, 0.001F);
  EXPECT_LT(along_x(plane), 0.014F);
}

}  // namespace
}  // namespace mrpt_terrain
