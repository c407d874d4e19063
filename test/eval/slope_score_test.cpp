// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/slope_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mrpt_terrain::eval {
namespace {

Eigen::Vector3d normal_of(double angle, double direction) {
  return {-std::sin(angle) * std::cos(direction), -std::sin(angle) * std::sin(direction),
          std::cos(angle)};
}

/// A ramp that was found as cluster 0, with points on two faces.
struct Case {
  ScanTruth truth;
  PointLabels labels;
  std::vector<ClusterDescription> clusters{1};
  ClusterMatching matching;

  Case() {
    truth.things.resize(2);
    truth.things[1].terrain_class = TerrainClass::kSlope;
    truth.faces.push_back({1, normal_of(0.2, 3.1), 0.2});
    truth.faces.push_back({1, normal_of(0.2, 0.0), 0.2});
    matching.things.push_back({1, 0, 0.9, 1, 5.0});
    clusters[0].slope.status = FeatureStatus::kOk;
    clusters[0].slope.angle = 0.21;
    clusters[0].slope.direction = -3.1;
    clusters[0].slope.angle_sigma = 0.004;
    clusters[0].slope.direction_sigma = 0.05;
  }
  Case& on_face(int n, std::int32_t face) {
    for (int k = 0; k < n; ++k) {
      truth.face.push_back(face);
      truth.thing.push_back(1);
      labels.cluster.push_back(0);
    }
    return *this;
  }
  [[nodiscard]] SlopeScore score() const {
    SlopeScore result;
    add_slopes(matching, truth, labels, clusters, result);
    return result;
  }
};

TEST(SlopeScore, ErrorsAgainstTheFaceThatWasSeen) {
  const SlopeScore score = Case().on_face(95, 0).on_face(5, 1).on_face(50, kNoFace).score();
  ASSERT_EQ(score.samples.size(), 1U);
  const SlopeSample& sample = score.samples[0];
  EXPECT_NEAR(sample.truth, 0.2, 1e-12);
  EXPECT_NEAR(sample.angle_error, 0.01, 1e-12);
  // Across the back: from 3.1 to -3.1 is a short way on.
  EXPECT_NEAR(sample.direction_error, 2.0 * M_PI - 6.2, 1e-12);
  EXPECT_FALSE(angle_summary(score).in_two_sigma.hits);
  EXPECT_TRUE(direction_summary(score).in_two_sigma.hits);
}

TEST(SlopeScore, SeveralFacesAndNoAngle) {
  EXPECT_EQ(Case().on_face(60, 0).on_face(40, 1).score().several, 1U);
  Case level;
  level.truth.faces[0].inclination = 0.001;
  EXPECT_EQ(level.on_face(100, 0).score().several, 1U);
  Case none;
  none.clusters[0].slope.status = FeatureStatus::kTooFewPoints;
  const SlopeScore score = none.on_face(100, 0).score();
  EXPECT_EQ(score.no_angle, 1U);
  EXPECT_EQ(score.ramps, 1U);
  EXPECT_TRUE(score.samples.empty());
}

TEST(SlopeScore, OnlySlopesThatWereFound) {
  Case obstacle;
  obstacle.truth.things[1].terrain_class = TerrainClass::kObstacle;
  EXPECT_EQ(obstacle.on_face(100, 0).score().ramps, 0U);
  Case missed;
  missed.matching.things[0].cluster = kNoCluster;
  EXPECT_EQ(missed.on_face(100, 0).score().ramps, 0U);
}

TEST(ErrorSummary, ByHand) {
  std::vector<double> errors, sigmas;
  for (int k = 1; k <= 20; ++k) {
    errors.push_back(k % 2 == 0 ? k : -k);
    sigmas.push_back(k <= 10 ? 2.0 : 0.0);  // the others state none
  }
  const ErrorSummary summary = summarise(errors, sigmas);
  EXPECT_EQ(summary.samples, 20U);
  EXPECT_DOUBLE_EQ(summary.bias, 0.5);
  EXPECT_DOUBLE_EQ(summary.rmse, std::sqrt(2870.0 / 20.0));
  EXPECT_DOUBLE_EQ(summary.p95, 19.0);
  EXPECT_DOUBLE_EQ(summary.greatest, 20.0);
  EXPECT_EQ(summary.in_two_sigma.hits, 4U);
  EXPECT_EQ(summary.in_two_sigma.total, 10U);
  EXPECT_TRUE(std::isnan(summarise({}, {}).rmse));
}

}  // namespace
}  // namespace mrpt_terrain::eval
