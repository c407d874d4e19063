// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace mrpt_terrain {

/// Sums of points about some centre, in single precision: for small neighbourhoods, where centre
/// and points are near each other.
struct HeightSums {
  float n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;

  void add(float px, float py, float pz) { add_weighted(px, py, pz, 1.0F); }

  /// Adds a point that counts `weight` times.
  void add_weighted(float px, float py, float pz, float weight) {
    const float wx = weight * px, wy = weight * py, wz = weight * pz;
    n += weight;
    x += wx;
    y += wy;
    z += wz;
    xx += wx * px;
    xy += wx * py;
    yy += wy * py;
    xz += wx * pz;
    yz += wy * pz;
    zz += wz * pz;
  }

  /// Adds sums whose centre lies at (dx, dy, dz) from this one.
  void add_shifted(const HeightSums& from, float dx, float dy, float dz) {
    const float fx = from.x + from.n * dx, fy = from.y + from.n * dy, fz = from.z + from.n * dz;
    n += from.n;
    x += fx;
    y += fy;
    z += fz;
    xx += from.xx + dx * (from.x + fx);
    xy += from.xy + dx * from.y + dy * fx;
    yy += from.yy + dy * (from.y + fy);
    xz += from.xz + dz * from.x + dx * fz;
    yz += from.yz + dz * from.y + dy * fz;
    zz += from.zz + dz * (from.z + fz);
  }
};

/// Plane z = mean_z + gradient_x (x - mean_x) + gradient_y (y - mean_y), about the sums' centre.
struct SumsPlane {
  float mean_x, mean_y, mean_z;
  float gradient_x, gradient_y;
  float variance;  ///< mean square of the differences in z, m^2

  /// Height at the sums' centre.
  [[nodiscard]] float at_centre() const {
    return mean_z - gradient_x * mean_x - gradient_y * mean_y;
  }
};

/// Plane of least squares through at least one point.
/// \param hold m^2, > 0: added to the variances in x and y; holds the gradient to zero in
/// directions in which the points do not spread
[[nodiscard]] inline SumsPlane fit_plane(const HeightSums& s, float hold) {
  const float x = s.x / s.n, y = s.y / s.n, z = s.z / s.n;
  const float xx = s.xx / s.n - x * x, xy = s.xy / s.n - x * y, yy = s.yy / s.n - y * y;
  const float xz = s.xz / s.n - x * z, yz = s.yz / s.n - y * z, zz = s.zz / s.n - z * z;
  const float determinant = (xx + hold) * (yy + hold) - xy * xy;
  const float gx = (xz * (yy + hold) - yz * xy) / determinant;
  const float gy = (yz * (xx + hold) - xz * xy) / determinant;
  const float variance =
      zz - 2.0F * (gx * xz + gy * yz) + gx * gx * xx + 2.0F * gx * gy * xy + gy * gy * yy;
  return {x, y, z, gx, gy, std::max(variance, 0.0F)};
}

}  // namespace mrpt_terrain
