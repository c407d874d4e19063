// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "mrpt_terrain/core/moments.h"

namespace mrpt_terrain {

/// Least squares of heights over x and y: gradient, and what is left.
struct HeightPlane {
  double gradient_x = 0.0, gradient_y = 0.0;
  double squares = 0.0;  ///< sum of the squared differences, m^2
};

/// Fits the plane through the mean of the points; false if they lie on a line in x and y.
inline bool fit_height_plane(const Moments& m, HeightPlane& plane) {
  const double determinant = m.m_xx * m.m_yy - m.m_xy * m.m_xy;
  if (determinant <= 1e-6 * m.m_xx * m.m_yy) return false;
  plane.gradient_x = (m.m_xz * m.m_yy - m.m_yz * m.m_xy) / determinant;
  plane.gradient_y = (m.m_yz * m.m_xx - m.m_xz * m.m_xy) / determinant;
  plane.squares = std::max(0.0, m.m_zz - plane.gradient_x * m.m_xz - plane.gradient_y * m.m_yz);
  return true;
}

}  // namespace mrpt_terrain
