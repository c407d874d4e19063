// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/plane_estimators.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plane_clouds.h"

namespace mrpt_terrain::eval {
namespace {

using worlds::radians;
using worlds::WholeCloud;

constexpr double kThreshold = 0.01;

PlaneEstimators all_estimators() {
  PlaneEstimators list;
  list.push_back(pca_estimator());
  list.push_back(least_squares_estimator());
  list.push_back(paper_estimator({}));
  return list;
}

PlaneEstimate estimate(const PlaneEstimator& estimator, const WholeCloud& cloud,
                       std::uint64_t seed = 1) {
  return estimator.estimate(cloud.points(), cloud.members(), kThreshold, seed);
}

TEST(PlaneEstimators, AnExactPlaneHasItsExactAngle) {
  for (const double degrees : {0.0, 0.5, 7.74, 13.86, 18.51, 45.0}) {
    const WholeCloud cloud(worlds::ramp_cloud(degrees, 0.0, 1));
    for (const auto& estimator : all_estimators()) {
      const PlaneEstimate result = estimate(*estimator, cloud);
      ASSERT_EQ(result.status, FeatureStatus::kOk) << estimator->name();
      // Coordinates up to 2.5 m in float are rounded by 1.2e-7 m, spread over a metre.
      EXPECT_NEAR(result.angle, radians(degrees), 1e-6) << estimator->name() << " " << degrees;
      EXPECT_NEAR(result.normal.x(), -std::sin(radians(degrees)), 1e-6) << estimator->name();
      EXPECT_NEAR(result.normal.z(), std::cos(radians(degrees)), 1e-6) << estimator->name();
    }
  }
}

// Four points, sums by hand: about the mean (x, y, z) = (-1,0,-1), (0,1,0), (1,0,3), (0,-1,-2);
// m_xx = 2, m_yy = 2, m_xy = 0, m_xz = 4, m_yz = 2, hence A = 2 and B = 1.
TEST(PlaneEstimators, LeastSquaresOfFourPointsByHand) {
  Points points;
  points.push_back(9.0F, 20.0F, 4.0F);
  points.push_back(10.0F, 21.0F, 5.0F);
  points.push_back(11.0F, 20.0F, 8.0F);
  points.push_back(10.0F, 19.0F, 3.0F);
  const PlaneEstimate result = estimate(*least_squares_estimator(), WholeCloud(points));
  ASSERT_EQ(result.status, FeatureStatus::kOk);
  EXPECT_NEAR(result.angle, std::acos(1.0 / std::sqrt(6.0)), 1e-12);
}

TEST(PlaneEstimators, PrincipalComponentsSeeAWallAndLeastSquaresDoNot) {
  RandomGenerator random(3);
  Points points;
  worlds::add_wall(points, 1.5, -0.5, 0.5, 1.0, 0.05, 0.02, random);
  const WholeCloud cloud(points);
  EXPECT_NEAR(estimate(*pca_estimator(), cloud).angle, radians(90.0), radians(1.0));
  EXPECT_LT(estimate(*least_squares_estimator(), cloud).angle, radians(70.0));
}

TEST(PlaneEstimators, ABoxOnTheRampTurnsThoseWithoutOutliers) {
  const WholeCloud cloud(worlds::ramp_with_box(7.74, 0.003, 5, 8));
  EXPECT_GT(std::abs(estimate(*pca_estimator(), cloud).angle - radians(7.74)), radians(2.0));
  EXPECT_GT(std::abs(estimate(*least_squares_estimator(), cloud).angle - radians(7.74)),
            radians(2.0));
  EXPECT_NEAR(estimate(*paper_estimator({}), cloud).angle, radians(7.74), radians(0.3));
}

TEST(PlaneEstimators, OnlyThePaperMethodDependsOnTheSeedAndThreshold) {
  const WholeCloud cloud(worlds::ramp_with_box(7.74, 0.01, 6, 5));
  for (const auto& estimator : all_estimators()) {
    const auto angle = [&](double threshold, std::uint64_t seed) {
      return estimator->estimate(cloud.points(), cloud.members(), threshold, seed).angle;
    };
    EXPECT_EQ(angle(0.01, 1), angle(0.01, 1)) << estimator->name();
    const bool random = estimator->name() == "paper_method";
    EXPECT_EQ(angle(0.01, 1) != angle(0.01, 2), random) << estimator->name();
    EXPECT_EQ(angle(0.01, 1) != angle(0.02, 1), random) << estimator->name();
  }
}

TEST(PlaneEstimators, PoorClustersHaveAStatusInsteadOfAnAngle) {
  Points two;
  two.push_back(1.0F, 0.0F, 0.0F);
  two.push_back(2.0F, 0.0F, 0.0F);
  Points line;
  for (int k = 0; k < 20; ++k) line.push_back(static_cast<float>(k), static_cast<float>(k), 0.0F);
  Points spot;
  for (int k = 0; k < 20; ++k) spot.push_back(1.0F, 2.0F, 3.0F);
  for (const auto& estimator : all_estimators()) {
    EXPECT_EQ(estimate(*estimator, WholeCloud(Points{})).status, FeatureStatus::kTooFewPoints);
    EXPECT_EQ(estimate(*estimator, WholeCloud(two)).status, FeatureStatus::kTooFewPoints);
    EXPECT_EQ(estimate(*estimator, WholeCloud(line)).status, FeatureStatus::kDegenerate)
        << estimator->name();
    EXPECT_EQ(estimate(*estimator, WholeCloud(spot)).status, FeatureStatus::kDegenerate)
        << estimator->name();
  }
}

}  // namespace
}  // namespace mrpt_terrain::eval
