// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

/// \file
/// The numbers of Tables 2 to 5 of Meng, Cao et al. 2018 (DOI 10.1177/1729881417751530), each of 50
/// measurements.
namespace mrpt_terrain::eval {

/// A row of Table 2 (centimetres) or Table 3 (degrees). The paper heads `rms_error` "standard
/// variance"; in Table 2 it can only be the root mean square about the truth.
struct PublishedErrors {
  double truth = 0.0;
  double mean_error = 0.0;
  double mean_abs_error = 0.0;
  double rms_error = 0.0;
  double max_abs_error = 0.0;
};

/// Row of Table 2 or 3 of a target: "obstacle", "pothole" or "cluster 3". Nothing for others.
[[nodiscard]] std::optional<PublishedErrors> published_errors(const std::string& target);

/// A cell of Table 4 or 5. The variances of A3 cannot be read in the copy at hand but for the
/// paper's own method.
struct PublishedSlope {
  double mean = 0.0;               ///< degrees
  std::optional<double> variance;  ///< degrees^2
};

/// Cell of Table 4 (slopes "A", "B", "C") or 5 ("A1", "A2", "A3") and of a method, by the names of
/// the estimators. Nothing for others.
[[nodiscard]] std::optional<PublishedSlope> published_slope(const std::string& slope,
                                                            const std::string& method);

/// The true angle that the paper states for a slope, degrees. Nothing for others.
[[nodiscard]] std::optional<double> published_angle(const std::string& slope);

}  // namespace mrpt_terrain::eval
