// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/moments.h"

#include <algorithm>
#include <cassert>

namespace mrpt_terrain {

void Moments::merge(const Moments& other) {
  if (other.n == 0.0) return;
  const double total = n + other.n;
  const double share = other.n / total;
  const double weight = n * share;
  const double dx = other.mean_x - mean_x;
  const double dy = other.mean_y - mean_y;
  const double dz = other.mean_z - mean_z;
  m_xx += other.m_xx + weight * dx * dx;
  m_xy += other.m_xy + weight * dx * dy;
  m_xz += other.m_xz + weight * dx * dz;
  m_yy += other.m_yy + weight * dy * dy;
  m_yz += other.m_yz + weight * dy * dz;
  m_zz += other.m_zz + weight * dz * dz;
  mean_x += share * dx;
  mean_y += share * dy;
  mean_z += share * dz;
  n = total;
}

Eigen::Matrix3d Moments::covariance() const {
  assert(n > 0);
  Eigen::Matrix3d c;
  c << m_xx, m_xy, m_xz,  //
      m_xy, m_yy, m_yz,   //
      m_xz, m_yz, m_zz;
  return c / n;
}

Moments moments_from(const MomentSums& sums) {
  Moments m;
  if (sums.n == 0.0) return m;
  m.n = sums.n;
  m.mean_x = sums.x / sums.n;
  m.mean_y = sums.y / sums.n;
  m.mean_z = sums.z / sums.n;
  // Rounding may leave a sum of squares a hair below zero.
  m.m_xx = std::max(0.0, sums.xx - m.mean_x * sums.x);
  m.m_yy = std::max(0.0, sums.yy - m.mean_y * sums.y);
  m.m_zz = std::max(0.0, sums.zz - m.mean_z * sums.z);
  m.m_xy = sums.xy - m.mean_x * sums.y;
  m.m_xz = sums.xz - m.mean_x * sums.z;
  m.m_yz = sums.yz - m.mean_y * sums.z;
  return m;
}

}  // namespace mrpt_terrain
