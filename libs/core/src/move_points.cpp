// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/move_points.h"

#include <cstddef>

#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

// One coordinate of the moved points: a row of the rotation, and a translation.
MRPT_TERRAIN_WIDE_REGISTERS
void move_along(const PointsView points, double rx, double ry, double rz, double t, float* moved) {
  for (std::size_t i = 0; i < points.size; ++i) {
    const double x = points.x[i], y = points.y[i], z = points.z[i];
    moved[i] = static_cast<float>(rx * x + ry * y + rz * z + t);
  }
}

}  // namespace

void move_points(const PointsView& points, const Eigen::Isometry3d& T, Points& moved) {
  moved.resize(points.size);
  const Eigen::Matrix4d& m = T.matrix();
  move_along(points, m(0, 0), m(0, 1), m(0, 2), m(0, 3), moved.x.data());
  move_along(points, m(1, 0), m(1, 1), m(1, 2), m(1, 3), moved.y.data());
  move_along(points, m(2, 0), m(2, 1), m(2, 2), m(2, 3), moved.z.data());
}

}  // namespace mrpt_terrain
