// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace mrpt_terrain::eval {

/// How repeated estimates of one quantity lie about its true value, as in Tables 2 to 5 of Meng,
/// Cao et al. 2018. In the unit of the estimates; the variance in its square.
struct ErrorStatistics {
  std::size_t n = 0;            ///< number of estimates; with 0 of them all else is 0
  double mean = 0.0;            ///< of the estimates
  double mean_error = 0.0;      ///< mean of estimate - truth
  double mean_abs_error = 0.0;  ///< mean of |estimate - truth|
  double rms_error = 0.0;       ///< root of the mean of (estimate - truth)^2: about the truth
  double max_abs_error = 0.0;   ///< greatest |estimate - truth|
  double variance = 0.0;        ///< about the mean of the estimates, divided by n
};

/// \param estimates finite numbers
[[nodiscard]] ErrorStatistics error_statistics(const std::vector<double>& estimates, double truth);

}  // namespace mrpt_terrain::eval
