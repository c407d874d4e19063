// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/error_statistics.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::eval {

ErrorStatistics error_statistics(const std::vector<double>& estimates, double truth) {
  ErrorStatistics result;
  result.n = estimates.size();
  if (estimates.empty()) return result;
  const auto n = static_cast<double>(estimates.size());
  double sum = 0.0;
  double sum_abs = 0.0;
  double sum_square = 0.0;
  for (const double estimate : estimates) {
    const double error = estimate - truth;
    sum += error;
    sum_abs += std::abs(error);
    sum_square += error * error;
    result.max_abs_error = std::max(result.max_abs_error, std::abs(error));
  }
  result.mean_error = sum / n;
  result.mean = truth + result.mean_error;
  result.mean_abs_error = sum_abs / n;
  result.rms_error = std::sqrt(sum_square / n);
  // A second pass about the mean: the difference of two large numbers would lose digits.
  double scatter = 0.0;
  for (const double estimate : estimates) {
    scatter += (estimate - result.mean) * (estimate - result.mean);
  }
  result.variance = scatter / n;
  return result;
}

}  // namespace mrpt_terrain::eval
