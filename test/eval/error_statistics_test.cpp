// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/error_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace mrpt_terrain::eval {
namespace {

TEST(ErrorStatistics, FourEstimatesByHand) {
  // Errors -1, 0, 2, 3 about 10; estimates about their mean 11: -2, -1, 1, 2.
  const ErrorStatistics result = error_statistics({9.0, 10.0, 12.0, 13.0}, 10.0);
  EXPECT_EQ(result.n, 4U);
  EXPECT_DOUBLE_EQ(result.mean, 11.0);
  EXPECT_DOUBLE_EQ(result.mean_error, 1.0);
  EXPECT_DOUBLE_EQ(result.mean_abs_error, 1.5);
  EXPECT_DOUBLE_EQ(result.rms_error, std::sqrt(14.0 / 4.0));
  EXPECT_DOUBLE_EQ(result.max_abs_error, 3.0);
  EXPECT_DOUBLE_EQ(result.variance, 10.0 / 4.0);
}

TEST(ErrorStatistics, NoEstimatesAndOneEstimate) {
  const ErrorStatistics none = error_statistics({}, 5.0);
  EXPECT_EQ(none.n, 0U);
  EXPECT_EQ(none.rms_error, 0.0);
  const ErrorStatistics one = error_statistics({4.5}, 5.0);
  EXPECT_DOUBLE_EQ(one.mean_error, -0.5);
  EXPECT_DOUBLE_EQ(one.rms_error, 0.5);
  EXPECT_DOUBLE_EQ(one.variance, 0.0);
}

TEST(ErrorStatistics, RmsIsBiasAndSpreadTogetherFarFromZeroToo) {
  const std::vector<double> estimates{1e8 + 0.25, 1e8 + 0.5, 1e8 + 1.25};
  const ErrorStatistics result = error_statistics(estimates, 1e8);
  // Multiples of 1/4 near 1e8 are exact: mean 2/3, squares 0.0625 + 0.25 + 1.5625.
  EXPECT_NEAR(result.variance, 1.875 / 3.0 - 4.0 / 9.0, 1e-7);
  EXPECT_NEAR(result.rms_error * result.rms_error,
              result.mean_error * result.mean_error + result.variance, 1e-7);
}

/// A row of Tables 2 and 3 of the paper, as printed (paper/tables.csv: the paper's own method).
struct PublishedRow {
  const char* name;
  double mean_error, mean_abs_error, third_column, max_abs_error;
};
constexpr PublishedRow kTable2Obstacle{"obstacle, cm", 0.1992, 0.3688, 0.3907, 0.5121};
constexpr PublishedRow kTable2Pothole{"pothole, cm", 0.4385, 0.4385, 0.4463, 0.5851};
constexpr PublishedRow kTable3{"cluster 3, deg", -0.0353, 0.0666, 0.0779, 0.1636};
constexpr double kHalfDigit = 0.00005;  // the tables have four decimals

/// Greatest possible RMS of errors with these mean and greatest magnitudes: e^2 <= max |e|.
double greatest_rms(const PublishedRow& row) {
  return std::sqrt((row.mean_abs_error + kHalfDigit) * (row.max_abs_error + kHalfDigit));
}

// Reading "third numeric column of Tables 2, 3": mean error = mean absolute error says that all
// errors of the pothole row lie in [0, max]. Bhatia and Davis 2000: numbers in [m, M] with mean mu
// have a variance of at most (M - mu)(mu - m).
TEST(ErrorStatistics, ThirdColumnOfTable2PotholeRowIsNoSpreadAboutTheMean) {
  const PublishedRow& row = kTable2Pothole;
  ASSERT_EQ(row.mean_error, row.mean_abs_error);
  const double most = (row.max_abs_error + kHalfDigit - (row.mean_error - kHalfDigit)) *
                      (row.mean_error + kHalfDigit);
  EXPECT_GT(row.third_column - kHalfDigit, std::sqrt(most)) << "as a standard deviation";
  EXPECT_GT(row.third_column - kHalfDigit, most) << "as a variance";
}

TEST(ErrorStatistics, ThirdColumnOfTable2IsConsistentWithRmsAboutTheTruth) {
  for (const PublishedRow& row : {kTable2Obstacle, kTable2Pothole, kTable3}) {
    EXPECT_GE(row.third_column + kHalfDigit, row.mean_abs_error - kHalfDigit) << row.name;
    EXPECT_LE(row.third_column - kHalfDigit, greatest_rms(row)) << row.name;
  }
}

// With the third column as the spread s, the RMS would be sqrt(mean^2 + s^2).
TEST(ErrorStatistics, ThirdColumnAsASpreadContradictsBothRowsOfTable2ButNotTable3) {
  const auto implied_rms = [](const PublishedRow& row) {
    return std::hypot(std::abs(row.mean_error) - kHalfDigit, row.third_column - kHalfDigit);
  };
  EXPECT_GT(implied_rms(kTable2Obstacle), greatest_rms(kTable2Obstacle));
  EXPECT_GT(implied_rms(kTable2Pothole), greatest_rms(kTable2Pothole));
  EXPECT_LT(implied_rms(kTable3), greatest_rms(kTable3)) << "Table 3 alone would allow both";
}

// Errors like those of the pothole row exist, and the function gives the row back: two values a < b
// with the published mean, RMS and maximum.
TEST(ErrorStatistics, APotholeLikeSampleReproducesTheRow) {
  const PublishedRow& row = kTable2Pothole;
  std::vector<double> estimates;
  // k of 50 at the maximum, the others at a, so that the mean is the published one.
  const int k = 12;
  const double a = (50.0 * row.mean_error - k * row.max_abs_error) / (50.0 - k);
  for (int n = 0; n < 50; ++n) estimates.push_back(-9.0 + (n < k ? row.max_abs_error : a));
  const ErrorStatistics result = error_statistics(estimates, -9.0);
  EXPECT_NEAR(result.mean_error, row.mean_error, 1e-9);
  EXPECT_NEAR(result.mean_abs_error, row.mean_abs_error, 1e-9);
  EXPECT_NEAR(result.max_abs_error, row.max_abs_error, 1e-9);
  EXPECT_NEAR(result.rms_error, row.third_column, 0.002);
  EXPECT_LT(std::sqrt(result.variance), 0.1);
}

}  // namespace
}  // namespace mrpt_terrain::eval
