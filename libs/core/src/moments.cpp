// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/moments.h"

#include <cassert>

namespace mrpt_terrain {

Eigen::Matrix3d Moments::covariance() const {
  assert(n > 0);
  Eigen::Matrix3d c;
  c << m_xx, m_xy, m_xz,  //
      m_xy, m_yy, m_yz,   //
      m_xz, m_yz, m_zz;
  return c / n;
}

}  // namespace mrpt_terrain
