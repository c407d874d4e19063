// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/holes.h"

namespace mrpt_terrain {

/// The ground around a hole as a surface of second order:
/// z = z0 + g . (u, v) + c . (u^2, u v, v^2), u = x - x0, v = y - y0.
struct RimSurface {
  double x = 0.0, y = 0.0, z = 0.0;
  double gradient_x = 0.0, gradient_y = 0.0;
  double bend_xx = 0.0, bend_xy = 0.0, bend_yy = 0.0;  ///< per metre
  double sigma = 0.0;  ///< standard deviation of the points that count, metres

  [[nodiscard]] double height_at(double px, double py) const {
    const double u = px - x, v = py - y;
    return z + gradient_x * u + gradient_y * v + bend_xx * u * u + bend_xy * u * v +
           bend_yy * v * v;
  }
};

/// A rectangle along the axes, and what lies up to `margin` around it; metres.
struct RimArea {
  Position2 low, high;
  double margin = 0.0;
};

/// Fits the surface to the points around a hole (zones kRim and kNear) by weighted least squares,
/// the weights being 1 in an area and a half at 0.2 m from it, repeatedly without those that lie
/// more than 2.5 standard deviations below it, of the points above it alone where that is less and
/// `from_above` is set. Bending is held towards 0. \param area of the hole \param low metres:
/// points deeper than this never count \param from_above what lies low may be walls, and rings tell
/// walls: their scatter does not count \param scratch overwritten; keeps its memory \return false
/// if there are fewer than eight points, or they do not span a plane
[[nodiscard]] bool fit_rim(const std::vector<HolePoint>& points, const RimArea& area, double low,
                           bool from_above, RimPoints& scratch, RimSurface& rim);

}  // namespace mrpt_terrain
