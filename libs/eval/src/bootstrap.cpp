// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/bootstrap.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::eval {
namespace {

/// Statistics of one resample, from sums about the mean of all errors so that no digits are lost.
class ResampledErrors {
 public:
  explicit ResampledErrors(const std::vector<double>& errors) : deviations_(errors) {
    for (const double error : errors) centre_ += error;
    centre_ /= static_cast<double>(errors.size());
    for (double& deviation : deviations_) deviation -= centre_;
  }
  void begin() { sum_ = sum_square_ = 0.0; }
  void add(std::size_t trial) {
    sum_ += deviations_[trial];
    sum_square_ += deviations_[trial] * deviations_[trial];
  }
  [[nodiscard]] double bias() const { return centre_ + mean_deviation(); }
  [[nodiscard]] double variance() const {
    return std::max(0.0, sum_square_ / n() - mean_deviation() * mean_deviation());
  }
  [[nodiscard]] double rmse() const { return std::sqrt(bias() * bias() + variance()); }

 private:
  [[nodiscard]] double n() const { return static_cast<double>(deviations_.size()); }
  [[nodiscard]] double mean_deviation() const { return sum_ / n(); }

  std::vector<double> deviations_;
  double centre_ = 0.0;
  double sum_ = 0.0, sum_square_ = 0.0;
};

/// What a statistic was in each resample.
struct Samples {
  std::vector<double> bias, variance, rmse;
};

// Value below which `share` of the sorted values lie, linear between neighbours.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Interval interval_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

// Calls `draw(trial)` for n trials drawn with replacement, then `done()`, once per resample.
template <class Begin, class Draw, class Done>
void resample(std::size_t n, const BootstrapParams& params, Begin&& begin, Draw&& draw,
              Done&& done) {
  assert(n > 0 && params.resamples >= 40);
  RandomGenerator random(params.seed);
  for (int k = 0; k < params.resamples; ++k) {
    begin();
    for (std::size_t i = 0; i < n; ++i) draw(random.below(static_cast<std::uint32_t>(n)));
    done();
  }
}

}  // namespace

ErrorIntervals bootstrap_intervals(const std::vector<double>& errors,
                                   const BootstrapParams& params) {
  ResampledErrors resampled(errors);
  Samples samples;
  resample(
      errors.size(), params, [&] { resampled.begin(); },
      [&](std::size_t trial) { resampled.add(trial); },
      [&] {
        samples.bias.push_back(resampled.bias());
        samples.variance.push_back(resampled.variance());
        samples.rmse.push_back(resampled.rmse());
      });
  return {interval_of(std::move(samples.bias)), interval_of(std::move(samples.variance)),
          interval_of(std::move(samples.rmse))};
}

Comparison verdict(const Interval& difference) {
  if (difference.high < 0.0) return Comparison::kBetter;
  return difference.low > 0.0 ? Comparison::kWorse : Comparison::kTie;
}

PairedDifferences bootstrap_differences(const std::vector<double>& ours,
                                        const std::vector<double>& theirs,
                                        const BootstrapParams& params) {
  assert(ours.size() == theirs.size());
  ResampledErrors a(ours);
  ResampledErrors b(theirs);
  Samples differences;
  resample(
      ours.size(), params,
      [&] {
        a.begin();
        b.begin();
      },
      [&](std::size_t trial) {
        a.add(trial);
        b.add(trial);
      },
      [&] {
        differences.bias.push_back(std::abs(a.bias()) - std::abs(b.bias()));
        differences.variance.push_back(a.variance() - b.variance());
        differences.rmse.push_back(a.rmse() - b.rmse());
      });
  return {interval_of(std::move(differences.bias)), interval_of(std::move(differences.variance)),
          interval_of(std::move(differences.rmse))};
}

Coverage two_sigma_coverage(const std::vector<double>& errors, const std::vector<double>& sigmas) {
  assert(errors.size() == sigmas.size());
  Coverage result;
  result.n = errors.size();
  if (errors.empty()) return result;
  std::size_t covered = 0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (std::abs(errors[k]) <= 2.0 * sigmas[k]) ++covered;
  }
  const auto n = static_cast<double>(result.n);
  result.share = static_cast<double>(covered) / n;
  constexpr double kZ = 1.959963984540054;  // 97.5 % point of the normal distribution
  const double shrink = 1.0 / (1.0 + kZ * kZ / n);
  const double centre = shrink * (result.share + kZ * kZ / (2.0 * n));
  const double half =
      shrink * kZ * std::sqrt(result.share * (1.0 - result.share) / n + kZ * kZ / (4.0 * n * n));
  result.interval = {centre - half, centre + half};
  return result;
}

}  // namespace mrpt_terrain::eval
