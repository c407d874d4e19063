// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/param_info.h"

/// \file
/// How sure statistics of repeated estimates are, and which of two estimators is the better one, by
/// the percentile bootstrap (Efron 1979). Errors are estimate minus truth, in any unit; variances
/// are about the mean, divided by n, in the square of that unit.
namespace mrpt_terrain::eval {

struct BootstrapParams {
  int resamples = 2000;    ///< at least 40, so that 2.5 % is a resample
  std::uint64_t seed = 1;  ///< of the draws; the same seed gives the same intervals
};

/// Holds the true value in 95 of 100 cases.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % intervals of the statistics of one estimator.
struct ErrorIntervals {
  Interval bias;      ///< mean error
  Interval variance;  ///< about the mean
  Interval rmse;      ///< root of the mean square error
};

/// \param errors at least one, finite
[[nodiscard]] ErrorIntervals bootstrap_intervals(const std::vector<double>& errors,
                                                 const BootstrapParams& params);

/// Better and worse: the 95 % interval of the difference leaves out zero. Otherwise a tie.
enum class Comparison : std::uint8_t { kBetter, kTie, kWorse };
constexpr EnumNames<Comparison, 3> enum_names(Comparison) {
  return {
      {{Comparison::kBetter, "better"}, {Comparison::kTie, "tie"}, {Comparison::kWorse, "worse"}}};
}

/// Verdict on a difference "ours minus theirs" of which less is better.
[[nodiscard]] Comparison verdict(const Interval& difference);

/// Differences ours minus theirs with their 95 % intervals.
struct PairedDifferences {
  Interval abs_bias;  ///< of the magnitudes of the mean errors
  Interval variance;
  Interval rmse;
};

/// Trials are drawn as pairs: what both estimators owe to the same scan cancels out.
/// \param ours,theirs errors of the same trials in the same order, at least one
[[nodiscard]] PairedDifferences bootstrap_differences(const std::vector<double>& ours,
                                                      const std::vector<double>& theirs,
                                                      const BootstrapParams& params);

/// How often the truth lies within twice the uncertainty that an estimator states.
struct Coverage {
  std::size_t n = 0;
  double share = 0.0;  ///< 0 to 1; 0 for no trials
  Interval interval;   ///< 95 %, Wilson 1927
};

/// \param sigmas stated standard deviations, one per error
[[nodiscard]] Coverage two_sigma_coverage(const std::vector<double>& errors,
                                          const std::vector<double>& sigmas);

}  // namespace mrpt_terrain::eval
