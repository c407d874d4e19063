// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/paper_tables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt_terrain/eval/published_tables.h"
#include "worlds.h"

namespace mrpt_terrain::eval {
namespace {

using worlds::radians;

PlaneEstimate plane(double degrees) {
  PlaneEstimate result;
  result.status = FeatureStatus::kOk;
  result.angle = radians(degrees);
  return result;
}

/// A slope of 10 deg: "good" is off by up to 0.1 deg, "bad" by ten times that and 1 deg more; beam
/// by a tenth of "good" and says so.
std::vector<Trial> made_up_trials(std::size_t n) {
  RandomGenerator random(17);
  std::vector<Trial> trials;
  for (std::size_t k = 0; k < n; ++k) {
    const double error = 0.1 * worlds::normal_deviate(random);
    Measurement measured;
    measured.clusters = 1;
    measured.planes = {plane(10.0 + error), plane(11.0 + 10.0 * error)};
    measured.beam = {FeatureStatus::kOk, radians(10.0 + 0.1 * error), radians(0.01)};
    measured.description.height.h_f = 0.2;
    trials.push_back({measured});
  }
  return trials;
}

PaperScene scene_of_ten_degrees() {
  PaperScene scene;
  scene.targets = {{"slope", {1}, 0.0, radians(10.0)}};
  return scene;
}

const BootstrapParams kBootstrap{400, 1};

TEST(PaperTables, ASlopeResultHasAllMethodsAndTheirErrors) {
  const auto trials = made_up_trials(100);
  const SlopeResult result =
      slope_result(scene_of_ten_degrees(), 0, {}, {"good", "bad"}, trials, kBootstrap);
  ASSERT_EQ(result.rows.size(), 3U);
  EXPECT_EQ(result.rows[2].method, "beam");
  EXPECT_NEAR(result.truth, 10.0, 1e-9);
  EXPECT_EQ(result.rows[0].summary.statistics.n, 100U);
  EXPECT_NEAR(result.rows[0].summary.statistics.variance, 0.01, 0.006);
  EXPECT_NEAR(result.rows[1].summary.statistics.mean_error,
              1.0 + 10.0 * result.rows[0].summary.statistics.mean_error, 1e-9);
  EXPECT_NEAR(result.rows[2].summary.statistics.mean_error,
              0.1 * result.rows[0].summary.statistics.mean_error, 1e-9);
  ASSERT_TRUE(result.beam_coverage.has_value());
  EXPECT_NEAR(result.beam_coverage->share, 0.9545, 0.085);  // four standard deviations
  EXPECT_FALSE(result.beam_to_ground_coverage.has_value());
}

TEST(PaperTables, BeamIsComparedWithEachMethodButNotWithItself) {
  const SlopeResult result =
      slope_result(scene_of_ten_degrees(), 0, {}, {"good", "bad"}, made_up_trials(100), kBootstrap);
  ASSERT_EQ(result.rows[0].duels.size(), 1U);
  EXPECT_TRUE(result.rows[2].duels.empty());
  for (int k = 0; k < 2; ++k) {
    const Duel& duel = result.rows[static_cast<std::size_t>(k)].duels[0];
    EXPECT_EQ(duel.ours, "beam");
    EXPECT_EQ(duel.trials, 100U);
    EXPECT_EQ(verdict(duel.differences.variance), Comparison::kBetter);
    EXPECT_EQ(verdict(duel.differences.rmse), Comparison::kBetter);
  }
  EXPECT_EQ(verdict(result.rows[1].duels[0].differences.abs_bias), Comparison::kBetter);
}

TEST(PaperTables, TrialsWithoutAnswerAreMissingAndPairedTrialsAreFewer) {
  auto trials = made_up_trials(60);
  trials[3][0].clusters = 0;                                    // nobody
  trials[4][0].planes[0].status = FeatureStatus::kNoConsensus;  // not "good"
  trials[5][0].beam.status = FeatureStatus::kTooFewPoints;      // not beam
  for (std::size_t k = 20; k < 60; ++k) {
    trials[k][0].planes[1].status = FeatureStatus::kNotNeeded;  // "bad" was not asked
  }
  TrialPlan plan;
  plan.limits["bad"] = 20;
  const SlopeResult result =
      slope_result(scene_of_ten_degrees(), 0, plan, {"good", "bad"}, trials, kBootstrap);
  EXPECT_EQ(result.rows[0].summary.missing, 2U);
  EXPECT_EQ(result.rows[1].summary.missing, 1U);
  EXPECT_EQ(result.rows[2].summary.missing, 2U);
  EXPECT_EQ(result.rows[0].duels[0].trials, 57U);
  EXPECT_EQ(result.rows[1].duels[0].trials, 18U);
  EXPECT_EQ(result.beam_coverage->n, 58U);
  EXPECT_FALSE(result.rows[0].summary.series[3].has_value());
}

TEST(PaperTables, HeightsAreCentimetresAndNothingWhereNothingWasFound) {
  auto trials = made_up_trials(2);
  trials[1][0].clusters = 0;
  const Series heights = height_indices(trials, 0);
  EXPECT_NEAR(heights[0].value(), 20.0, 1e-9);
  EXPECT_FALSE(heights[1].has_value());
  EXPECT_FALSE(roughness_flags(trials, 0)[0].has_value()) << "roughness was not needed";
  const SeriesSummary none = summarize({std::nullopt, std::nullopt}, 2, 1.0, kBootstrap);
  EXPECT_EQ(none.missing, 2U);
  EXPECT_EQ(none.statistics.n, 0U);
}

TEST(PublishedTables, HoldWhatIsPrinted) {
  EXPECT_EQ(published_errors("obstacle")->max_abs_error, 0.5121);
  EXPECT_EQ(published_errors("pothole")->truth, -9.0);
  EXPECT_EQ(published_errors("cluster 3")->mean_error, -0.0353);
  EXPECT_FALSE(published_errors("cluster 2").has_value());
  EXPECT_EQ(published_slope("A", "ransac")->mean, 8.102);
  EXPECT_EQ(published_slope("B", "least_squares")->variance, 0.2485);
  EXPECT_EQ(published_slope("A1", "prosac")->variance, 0.1903);
  EXPECT_EQ(published_slope("A3", "paper_method")->variance, 0.0049);
  EXPECT_FALSE(published_slope("A3", "pca")->variance.has_value());
  EXPECT_FALSE(published_slope("A", "beam").has_value());
  EXPECT_FALSE(published_slope("D", "pca").has_value());
  EXPECT_EQ(published_angle("C"), 18.51);
  EXPECT_FALSE(published_angle("cluster 3").has_value());
}

// The paper says of its method that it is better than the others in most cases: its mean is the
// nearest to the truth of all nine on five of the six slopes.
TEST(PublishedTables, ThePapersMethodHasTheBestMeanInMostCases) {
  int best = 0;
  for (const char* slope : {"A", "B", "C", "A1", "A2", "A3"}) {
    const double truth = published_angle(slope).value();
    const double own = std::abs(published_slope(slope, "paper_method")->mean - truth);
    bool is_best = true;
    for (const char* method :
         {"ransac", "lmeds", "msac", "rransac", "mlesac", "prosac", "pca", "least_squares"}) {
      is_best = is_best && own < std::abs(published_slope(slope, method)->mean - truth);
    }
    best += is_best ? 1 : 0;
  }
  EXPECT_EQ(best, 5);
}

}  // namespace
}  // namespace mrpt_terrain::eval
