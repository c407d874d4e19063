// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "worlds.h"

namespace mrpt_terrain::eval {
namespace {

std::vector<double> normal_errors(std::size_t n, double mean, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  std::vector<double> errors(n);
  for (double& error : errors) error = mean + sigma * worlds::normal_deviate(random);
  return errors;
}

// For many normal errors the intervals are those of the textbook: mean +- 1.96 s / sqrt(n),
// s^2 (1 +- 1.96 sqrt(2 / n)). With 4000 resamples a 2.5 % point is known to 2 % of the half width
// (standard deviation of a quantile, sqrt(p (1 - p) / N) / density); five times that is 10 %, and
// the sample's own third and fourth moments add a little for the variance.
TEST(Bootstrap, IntervalsOfManyNormalErrorsAreTheClosedForm) {
  const std::size_t n = 2000;
  const std::vector<double> errors = normal_errors(n, 0.3, 2.0, 11);
  double mean = 0.0;
  for (const double error : errors) mean += error / static_cast<double>(n);
  double variance = 0.0;
  for (const double error : errors) variance += std::pow(error - mean, 2) / static_cast<double>(n);

  const ErrorIntervals result = bootstrap_intervals(errors, {4000, 5});
  const double half_mean = 1.96 * std::sqrt(variance / static_cast<double>(n));
  EXPECT_NEAR(result.bias.low, mean - half_mean, 0.1 * half_mean);
  EXPECT_NEAR(result.bias.high, mean + half_mean, 0.1 * half_mean);
  const double half_variance = 1.96 * variance * std::sqrt(2.0 / static_cast<double>(n));
  EXPECT_NEAR(result.variance.low, variance - half_variance, 0.15 * half_variance);
  EXPECT_NEAR(result.variance.high, variance + half_variance, 0.15 * half_variance);
  const double rmse = std::sqrt(mean * mean + variance);
  EXPECT_LT(result.rmse.low, rmse);
  EXPECT_GT(result.rmse.high, rmse);
}

TEST(Bootstrap, EqualErrorsHaveNoWidth) {
  const ErrorIntervals result = bootstrap_intervals(std::vector<double>(30, -0.25), {100, 1});
  EXPECT_DOUBLE_EQ(result.bias.low, -0.25);
  EXPECT_DOUBLE_EQ(result.bias.high, -0.25);
  EXPECT_EQ(result.variance.high, 0.0);
  EXPECT_DOUBLE_EQ(result.rmse.low, 0.25);
}

// 300 samples of 100: the truth is in about 95 % of the intervals; four standard deviations of a
// share of 300 are 5 %.
TEST(Bootstrap, IntervalsHoldTheTruthAsOftenAsTheySay) {
  int with_mean = 0;
  int with_variance = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const ErrorIntervals result =
        bootstrap_intervals(normal_errors(100, 0.5, 1.0, 1000 + seed), {400, seed});
    with_mean += result.bias.low <= 0.5 && 0.5 <= result.bias.high ? 1 : 0;
    with_variance += result.variance.low <= 1.0 && 1.0 <= result.variance.high ? 1 : 0;
  }
  EXPECT_NEAR(with_mean / 300.0, 0.95, 0.05);
  // Variances of 100 are skewed to the left; the percentile interval covers a little less there.
  EXPECT_NEAR(with_variance / 300.0, 0.93, 0.06);
}

TEST(Bootstrap, ASeedRepeatsAndAnotherDiffers) {
  const std::vector<double> errors = normal_errors(60, 0.0, 1.0, 3);
  EXPECT_EQ(bootstrap_intervals(errors, {200, 7}).bias.low,
            bootstrap_intervals(errors, {200, 7}).bias.low);
  EXPECT_NE(bootstrap_intervals(errors, {200, 7}).bias.low,
            bootstrap_intervals(errors, {200, 8}).bias.low);
}

TEST(Bootstrap, PairsCancelWhatBothShare) {
  // Variances 1.0009 and 1.0825 over 200 trials. Unpaired, their difference has a standard
  // deviation of 0.14: a tie. Paired, it is 0.08 of the sample's variance.
  const std::vector<double> common = normal_errors(200, 0.0, 1.0, 21);
  const std::vector<double> own = normal_errors(200, 0.0, 0.03, 22);
  std::vector<double> ours = common;
  std::vector<double> theirs = common;
  for (std::size_t k = 0; k < common.size(); ++k) {
    ours[k] += own[k];
    theirs[k] *= 1.04;
  }
  const PairedDifferences result = bootstrap_differences(ours, theirs, {1000, 1});
  EXPECT_EQ(verdict(result.variance), Comparison::kBetter);
  const PairedDifferences swapped = bootstrap_differences(theirs, ours, {1000, 1});
  EXPECT_EQ(verdict(swapped.variance), Comparison::kWorse);
  EXPECT_DOUBLE_EQ(swapped.variance.low, -result.variance.high);
  // Their error of the next trial instead of the same one.
  std::rotate(theirs.begin(), theirs.begin() + 1, theirs.end());
  EXPECT_EQ(verdict(bootstrap_differences(ours, theirs, {1000, 1}).variance), Comparison::kTie);
}

TEST(Bootstrap, BiasIsComparedByItsMagnitude) {
  const std::vector<double> ours = normal_errors(400, -0.05, 0.1, 31);
  const std::vector<double> theirs = normal_errors(400, 0.2, 0.1, 32);
  const PairedDifferences result = bootstrap_differences(ours, theirs, {1000, 1});
  EXPECT_EQ(verdict(result.abs_bias), Comparison::kBetter);
  EXPECT_NEAR(0.5 * (result.abs_bias.low + result.abs_bias.high), 0.05 - 0.2, 0.02);
  EXPECT_EQ(verdict(result.variance), Comparison::kTie);
  EXPECT_EQ(verdict(result.rmse), Comparison::kBetter);
}

// Two estimators of the same quality: about one verdict in twenty is wrong. Four standard
// deviations of a share of 200 are 6 %.
TEST(Bootstrap, EqualEstimatorsTieNineteenTimesInTwenty) {
  int bias_ties = 0;
  int rmse_ties = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const PairedDifferences result =
        bootstrap_differences(normal_errors(100, 0.4, 1.0, 5000 + seed),
                              normal_errors(100, 0.4, 1.0, 9000 + seed), {400, seed});
    bias_ties += verdict(result.abs_bias) == Comparison::kTie ? 1 : 0;
    rmse_ties += verdict(result.rmse) == Comparison::kTie ? 1 : 0;
  }
  EXPECT_NEAR(bias_ties / 200.0, 0.95, 0.06);
  EXPECT_NEAR(rmse_ties / 200.0, 0.95, 0.06);
}

TEST(Bootstrap, AVerdictNeedsAnIntervalWithoutZero) {
  EXPECT_EQ(verdict({-0.2, -0.1}), Comparison::kBetter);
  EXPECT_EQ(verdict({0.1, 0.2}), Comparison::kWorse);
  EXPECT_EQ(verdict({-0.1, 0.2}), Comparison::kTie);
  EXPECT_EQ(verdict({0.0, 0.0}), Comparison::kTie);
  EXPECT_EQ(verdict({-0.1, 0.0}), Comparison::kTie);
}

TEST(TwoSigmaCoverage, CountsAndWilsonInterval) {
  // Wilson's interval of 8 out of 10 by hand: z^2 = 3.8415, centre (0.8 + 0.19207) / 1.38415,
  // half width 1.95996 / 1.38415 * sqrt(0.016 + 0.0096036).
  std::vector<double> errors(10, 0.1);
  errors[3] = 0.5;
  errors[7] = -0.3;
  std::vector<double> sigmas(10, 0.1);
  const Coverage result = two_sigma_coverage(errors, sigmas);
  EXPECT_EQ(result.n, 10U);
  EXPECT_DOUBLE_EQ(result.share, 0.8);
  EXPECT_NEAR(result.interval.low, 0.71674 - 0.22657, 1e-4);
  EXPECT_NEAR(result.interval.high, 0.71674 + 0.22657, 1e-4);
  sigmas[3] = 0.25;  // exactly twice
  EXPECT_DOUBLE_EQ(two_sigma_coverage(errors, sigmas).share, 0.9);
  EXPECT_EQ(two_sigma_coverage({}, {}).n, 0U);
}

TEST(TwoSigmaCoverage, OfNormalErrorsWithTheirOwnSigmaIs9545PerCent) {
  const Coverage result =
      two_sigma_coverage(normal_errors(20000, 0.0, 0.3, 41), std::vector<double>(20000, 0.3));
  EXPECT_NEAR(result.share, 0.9545, 0.006);  // four standard deviations
  EXPECT_LT(result.interval.low, 0.9545);
  EXPECT_GT(result.interval.high, 0.9545);
}

}  // namespace
}  // namespace mrpt_terrain::eval
