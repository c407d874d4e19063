// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace mrpt_terrain {

/// Number, mean and centred second moments of a set of points: all that a covariance needs.
/// Centred, so that merging many cells far from the origin loses no digits.
struct Moments {
  double n = 0.0;                                   ///< number of points
  double mean_x = 0.0, mean_y = 0.0, mean_z = 0.0;  ///< metres; 0 when n = 0
  double m_xx = 0.0, m_xy = 0.0, m_xz = 0.0;        ///< sums of products of deviations, m^2
  double m_yy = 0.0, m_yz = 0.0, m_zz = 0.0;

  /// Adds another set (pairwise update of Chan, Golub, LeVeque 1983).
  void merge(const Moments& other);

  [[nodiscard]] Eigen::Vector3d mean() const { return {mean_x, mean_y, mean_z}; }
  /// Covariance, divided by n (eq. 4 of the paper), m^2. Requires n > 0.
  [[nodiscard]] Eigen::Matrix3d covariance() const;
};

/// Plain sums of the points of a set, about an origin near them: what `Moments` are made from in
/// one pass. Doubles hold the products of float coordinates within some kilometres of the origin
/// without loss that matters.
struct MomentSums {
  double n = 0.0;
  double x = 0.0, y = 0.0, z = 0.0;
  double xx = 0.0, xy = 0.0, xz = 0.0;
  double yy = 0.0, yz = 0.0, zz = 0.0;

  void add(double px, double py, double pz) {
    n += 1.0;
    x += px;
    y += py;
    z += pz;
    xx += px * px;
    xy += px * py;
    xz += px * pz;
    yy += py * py;
    yz += py * pz;
    zz += pz * pz;
  }
};

/// Moments of the set whose sums these are; means relative to the origin of the sums.
[[nodiscard]] Moments moments_from(const MomentSums& sums);

}  // namespace mrpt_terrain
