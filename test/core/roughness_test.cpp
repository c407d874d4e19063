// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/roughness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;

/// Moments whose covariance is diag(x, y, z) exactly.
Moments diagonal(double x, double y, double z) {
  Moments m;
  m.n = 4.0;
  m.m_xx = 4.0 * x;
  m.m_yy = 4.0 * y;
  m.m_zz = 4.0 * z;
  return m;
}

Moments moments_of(const Points& points) {
  MomentSums sums;
  for (std::size_t i = 0; i < points.size(); ++i) sums.add(points.x[i], points.y[i], points.z[i]);
  return moments_from(sums);
}

bool is_rough(const Moments& m, const RoughnessParams& params = {}) {
  const Roughness result = roughness(m, params);
  EXPECT_EQ(result.status, FeatureStatus::kOk);
  return result.rough;
}

// Literal: T_ratio, T_L and T_S each decide alone, and each includes its limit. Powers of two, so
// that products are exact.
TEST(Roughness, EachThresholdDecidesAndIsIncluded) {
  const RoughnessParams params{16.0, 0.25, 0.015625, false};
  EXPECT_FALSE(is_rough(diagonal(1.0, 0.25, 0.015625), params));
  const auto below = [](double value) { return std::nextafter(value, 0.0); };
  const auto above = [](double value) { return std::nextafter(value, 1.0); };
  EXPECT_TRUE(is_rough(diagonal(1.0, below(0.25), 0.0078125), params)) << "T_L";
  EXPECT_TRUE(is_rough(diagonal(1.0, 0.5, above(0.015625)), params)) << "T_S";
  EXPECT_FALSE(is_rough(diagonal(64.0, 0.5, 0.015625), {32.0, 0.25, 1.0, false}));
  EXPECT_TRUE(is_rough(diagonal(64.0, 0.5, above(0.015625)), {32.0, 0.25, 1.0, false})) << "ratio";
}

TEST(Roughness, AxesDoNotMatter) {
  std::array<double, 3> l = {0.0001, 0.02, 0.5};
  do {
    const Roughness result = roughness(diagonal(l[0], l[1], l[2]), {});
    EXPECT_FALSE(result.rough);
    EXPECT_NEAR(result.lambda[0], 0.0001, 1e-15);
    EXPECT_NEAR(result.lambda[1], 0.02, 1e-15);
    EXPECT_NEAR(result.lambda[2], 0.5, 1e-15);
  } while (std::next_permutation(l.begin(), l.end()));
}

// Row "l0 = 0": a perfect plane is flat, without a division.
TEST(PaperReading, PerfectPlaneIsFlat) {
  const Roughness result = roughness(diagonal(1.0, 0.5, 0.0), {});
  EXPECT_EQ(result.status, FeatureStatus::kOk);
  EXPECT_EQ(result.lambda[0], 0.0);
  EXPECT_FALSE(result.rough);
}

// The same row: the printed form of Algorithm 1 demands lambda_0 != 0.
TEST(PaperReading, PerfectPlaneIsRoughInThePrintedForm) {
  RoughnessParams printed;
  printed.perfect_plane_is_rough = true;
  EXPECT_TRUE(is_rough(diagonal(1.0, 0.5, 0.0), printed));
  EXPECT_FALSE(is_rough(diagonal(1.0, 0.5, 1e-12), printed));
}

// Row "Algorithm 1 sums versus eq. (4)": T_L is compared with a variance; the sum over these four
// points would be four times that.
TEST(PaperReading, ThresholdsOfRoughnessAreVariances) {
  const RoughnessParams params{20.0, 0.25, 4e-4, false};
  EXPECT_TRUE(is_rough(diagonal(1.0, 0.125, 0.0), params));
  EXPECT_FALSE(is_rough(diagonal(1.0, 0.25, 0.0), params));
}

// Analytic: a plate of a x b with normal noise s has the eigenvalues s^2, a^2/12, b^2/12 whatever
// its attitude. With n points the standard deviation of the first is s^2 sqrt(2/n), the lattice of
// k points per side makes the others smaller by 1 - 1/k^2, and the noise adds up to s^2.
TEST(Roughness, NoisyPlatesHaveTheirNoiseAsSmallestEigenvalue) {
  for (const double s : {0.002, 0.005, 0.01}) {
    for (const double tilt : {0.0, 18.51, 60.0, 90.0}) {
      RandomGenerator random(51);
      Points flat;
      worlds::add_surface(flat, {-0.5, 0.5, -0.4, 0.4}, 0.02,
                          [&](double, double) { return s * worlds::normal_deviate(random); });
      const Eigen::Matrix3d turn = (Eigen::AngleAxisd(radians(tilt), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(radians(30.0), Eigen::Vector3d::UnitZ()))
                                       .toRotationMatrix();
      Points points;
      for (std::size_t i = 0; i < flat.size(); ++i) {
        const Eigen::Vector3d p = turn * Eigen::Vector3d(flat.x[i], flat.y[i], flat.z[i]);
        worlds::add_point(points, p.x() + 2.0, p.y() - 1.0, p.z());
      }
      const auto n = static_cast<double>(points.size());
      const Roughness result = roughness(moments_of(points), {});
      ASSERT_EQ(result.status, FeatureStatus::kOk);
      EXPECT_FALSE(result.rough);
      EXPECT_NEAR(result.lambda[0], s * s, 5.0 * s * s * std::sqrt(2.0 / n)) << s << " " << tilt;
      EXPECT_NEAR(result.lambda[1], 0.64 / 12.0, 0.64 / 12.0 / 1600.0 + s * s + 1e-6);
      EXPECT_NEAR(result.lambda[2], 1.0 / 12.0, 1.0 / 12.0 / 2500.0 + s * s + 1e-6);
    }
  }
}

// Analytic: points spread over a cube of side a have a^2/12 in all directions; the variance of
// z^2 about it is a^4/180.
TEST(Roughness, AFilledCubeIsRough) {
  RandomGenerator random(52);
  Points points;
  worlds::add_heap(points, {1.0, 1.5, 0.0, 0.5}, 0.5, 3000, random);
  const Roughness result = roughness(moments_of(points), {});
  ASSERT_EQ(result.status, FeatureStatus::kOk);
  EXPECT_TRUE(result.rough);
  for (const double l : result.lambda) EXPECT_NEAR(l, 0.25 / 12.0, 0.25 * 0.10);
}

// Invariant: turning the points about z changes nothing but rounding.
TEST(Roughness, TurningThePointsDoesNotMatter) {
  RandomGenerator random(53);
  Points points;
  worlds::add_ramp(points, {1.0, 2.0, -0.5, 0.5}, 0.05, radians(13.86), 0.005, random);
  const Roughness a = roughness(moments_of(points), {});
  const Roughness b = roughness(moments_of(worlds::turned_left(points)), {});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.lambda[k], b.lambda[k], 1e-12);
}

// Table of degenerate clusters.
TEST(Roughness, DegenerateClustersSayWhy) {
  struct Case {
    const char* name;
    std::vector<std::array<float, 3>> points;
    FeatureStatus status;
  };
  const std::array<float, 3> p = {0.1F, -1.7F, 0.3F};
  const std::vector<Case> cases = {
      {"no point", {}, FeatureStatus::kTooFewPoints},
      {"one point", {p}, FeatureStatus::kTooFewPoints},
      {"two points", {p, {1, 1, 1}}, FeatureStatus::kTooFewPoints},
      {"three points", {p, {1, 1, 1}, {0, 1, 0}}, FeatureStatus::kOk},
      {"three times one point", {p, p, p}, FeatureStatus::kDegenerate},
      {"seven times one point", {p, p, p, p, p, p, p}, FeatureStatus::kDegenerate},
      {"seven far away", std::vector<std::array<float, 3>>(7, {499.9F, -333.3F, 1.1F}),
       FeatureStatus::kDegenerate},
      {"a line",
       {{0, 0, 0}, {0.1F, 0.1F, 0.1F}, {0.2F, 0.2F, 0.2F}, {0.3F, 0.3F, 0.3F}},
       FeatureStatus::kOk},
      {"a line far away",
       {{400, 300, 0}, {400.5F, 300, 0}, {401, 300, 0}, {401.5F, 300, 0}},
       FeatureStatus::kOk},
  };
  for (const Case& c : cases) {
    Points points;
    for (const auto& q : c.points) points.push_back(q[0], q[1], q[2]);
    const Roughness result = roughness(moments_of(points), {});
    EXPECT_STREQ(name_of(result.status), name_of(c.status)) << c.name;
    // A line has eigenvalues, and eq. (4) calls it rough: there is no second direction.
    EXPECT_TRUE(result.rough || c.points.size() == 3) << c.name;
    for (const double l : result.lambda) EXPECT_TRUE(std::isfinite(l) && l >= 0.0) << c.name;
  }
}

// Whatever the rounding of the sums leaves of it, one spot is no cluster with a shape.
TEST(Roughness, PointsOnOneSpotAreDegenerateWhereverTheyAre) {
  RandomGenerator random(54);
  for (int k = 0; k < 1000; ++k) {
    Points points;
    const auto coordinate = [&] { return static_cast<float>(1000.0 * random.uniform() - 500.0); };
    const std::array<float, 3> p = {coordinate(), coordinate(), coordinate()};
    const std::uint32_t n = 3 + random.below(200);
    for (std::uint32_t i = 0; i < n; ++i) points.push_back(p[0], p[1], p[2]);
    EXPECT_EQ(roughness(moments_of(points), {}).status, FeatureStatus::kDegenerate)
        << "seed 54, case " << k;
  }
}

TEST(Roughness, ExtremeScalesStayFinite) {
  for (const double huge : {1e10, 1e30, 1e60}) {
    const Roughness result = roughness(diagonal(0.01, 0.01, huge), {});
    for (const double l : result.lambda) EXPECT_TRUE(std::isfinite(l) && l >= 0.0) << huge;
    EXPECT_TRUE(std::is_sorted(result.lambda.begin(), result.lambda.end()));
  }
}

}  // namespace
}  // namespace mrpt_terrain
