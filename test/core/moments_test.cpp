// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/moments.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using Cloud = std::vector<Eigen::Vector3d>;

MomentSums sums_of(const Cloud& cloud) {
  MomentSums sums;
  for (const auto& p : cloud) sums.add(p.x(), p.y(), p.z());
  return sums;
}

/// Oracle: mean first, deviations second, as in Algorithm 1.
Eigen::Matrix3d covariance_by_two_passes(const Cloud& cloud) {
  // About the first point, so that the oracle itself loses no digits.
  Eigen::Vector3d mean = cloud.front();
  for (const auto& p : cloud) mean += (p - cloud.front()) / static_cast<double>(cloud.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : cloud) covariance += (p - mean) * (p - mean).transpose();
  return covariance / static_cast<double>(cloud.size());
}

/// Float coordinates, like those of scans, about `centre`.
Cloud random_cloud(std::size_t n, const Eigen::Vector3d& centre, RandomGenerator& random) {
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p =
        centre + Eigen::Vector3d(random.uniform(), 2 * random.uniform(), 0.1 * random.uniform());
    cloud.push_back(p.cast<float>().cast<double>());
  }
  return cloud;
}

// Literal: (0,0,0), (2,0,0), (0,4,0), (2,4,8).
TEST(Moments, FourPointsByHand) {
  const Moments m = moments_from(sums_of({{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {2, 4, 8}}));
  EXPECT_EQ(m.n, 4.0);
  EXPECT_EQ(m.mean(), Eigen::Vector3d(1, 2, 2));
  EXPECT_EQ(m.m_xx, 4.0);
  EXPECT_EQ(m.m_yy, 16.0);
  EXPECT_EQ(m.m_zz, 48.0);
  EXPECT_EQ(m.m_xy, 0.0);
  EXPECT_EQ(m.m_xz, 8.0);
  EXPECT_EQ(m.m_yz, 16.0);
}

// Row "Algorithm 1 sums versus eq. (4)": two points at distance 2 have variance 1, not 2.
TEST(PaperReading, CovarianceIsDividedByN) {
  const Eigen::Matrix3d c = moments_from(sums_of({{-1, 0, 0}, {1, 0, 0}})).covariance();
  EXPECT_EQ(c(0, 0), 1.0);
}

// The same row: T_L and T_S do not depend on the number of points.
TEST(PaperReading, CovarianceDoesNotGrowWithTheNumberOfPoints) {
  const Cloud once = {{0, 0, 0}, {2, 0, 1}, {0, 4, 0}, {2, 4, 8}};
  Cloud often;
  for (int k = 0; k < 64; ++k) often.insert(often.end(), once.begin(), once.end());
  EXPECT_EQ(moments_from(sums_of(once)).covariance(), moments_from(sums_of(often)).covariance());
}

TEST(Moments, CovarianceIsSymmetric) {
  RandomGenerator random(1);
  const Eigen::Matrix3d c =
      moments_from(sums_of(random_cloud(100, {1, 2, 3}, random))).covariance();
  EXPECT_EQ(c, c.transpose());
}

// Tolerance: every sum carries at most n rounding errors of 1.1e-16 times itself, and the sums of
// squares are n |p|^2; with n = 1000 and |p| < 10 m that is 1.1e-11 m^2 per term of the difference.
TEST(Moments, EqualTwoPasses) {
  RandomGenerator random(2);
  for (int k = 0; k < 20; ++k) {
    const Cloud cloud = random_cloud(1000, {-5.0 + k / 2.0, 3.0, -1.0}, random);
    const Eigen::Matrix3d difference =
        moments_from(sums_of(cloud)).covariance() - covariance_by_two_passes(cloud);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 3e-11) << "seed 2, cloud " << k;
  }
}

// What the documentation of MomentSums promises for the clusters of a map of 1000 m.
TEST(Moments, StayExactFarFromTheOrigin) {
  RandomGenerator random(3);
  for (const std::size_t n : {10U, 1000U, 10000U}) {
    for (int k = 0; k < 10; ++k) {
      const Cloud cloud = random_cloud(n, {499.0, -499.0, 1.0}, random);
      const Eigen::Matrix3d difference =
          moments_from(sums_of(cloud)).covariance() - covariance_by_two_passes(cloud);
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-8) << n << " points";
    }
  }
}

TEST(Moments, SumsOfPartsAreTheSumOfTheWhole) {
  RandomGenerator random(4);
  const Cloud all = random_cloud(300, {1, 1, 1}, random);
  MomentSums parts = sums_of(Cloud(all.begin(), all.begin() + 100));
  parts.add(sums_of(Cloud(all.begin() + 100, all.end())));
  const Moments merged = moments_from(parts);
  const Moments whole = moments_from(sums_of(all));
  EXPECT_EQ(merged.n, whole.n);
  // 300 additions of numbers below 1200 in another order.
  EXPECT_LT((merged.mean() - whole.mean()).norm(), 1e-12);
  EXPECT_LT((merged.covariance() - whole.covariance()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Moments, OfNothingAreZero) {
  const Moments m = moments_from(MomentSums{});
  EXPECT_EQ(m.n, 0.0);
  EXPECT_EQ(m.mean(), Eigen::Vector3d::Zero());
  EXPECT_EQ(m.m_xx + m.m_yy + m.m_zz, 0.0);
}

TEST(Moments, VariancesAreNeverNegative) {
  for (int n = 1; n <= 200; ++n) {
    const Cloud same(static_cast<std::size_t>(n), Eigen::Vector3d(0.1F, -77.7F, 499.9F));
    const Moments m = moments_from(sums_of(same));
    EXPECT_GE(m.m_xx, 0.0) << n;
    EXPECT_GE(m.m_yy, 0.0) << n;
    EXPECT_GE(m.m_zz, 0.0) << n;
  }
}

}  // namespace
}  // namespace mrpt_terrain
