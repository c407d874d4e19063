// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/height_sums.h"

#include <gtest/gtest.h>

#include "mrpt_terrain/core/random.h"

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

}  // namespace
}  // namespace mrpt_terrain
