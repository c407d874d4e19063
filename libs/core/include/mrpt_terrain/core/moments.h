// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace mrpt_terrain {

/// Number, mean and centred second moments of a set of points: all that a covariance needs.
/// Centred, so that merging many cells far from the origin loses no digits.
struct Moments {
  double n = 0.0;                                    ///< number of points
  double mean_x = 0.0, mean_y = 0.0, mean_z = 0.0;   ///< metres; 0 when n = 0
  double m_xx = 0.0, m_xy = 0.0, m_xz = 0.0;         ///< sums of products of deviations, m^2
  double m_yy = 0.0, m_yz = 0.0, m_zz = 0.0;

  /// Adds another set (pairwise update of Chan, Golub, LeVeque 1983).
  void merge(const Moments& other);

  [[nodiscard]] Eigen::Vector3d mean() const { return {mean_x, mean_y, mean_z}; }
  /// Covariance, divided by n (eq. 4 of the paper), m^2. Requires n > 0.
  [[nodiscard]] Eigen::Matrix3d covariance() const;
};

}  // namespace mrpt_terrain
