// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Points in another frame, computed in double and rounded to float at the end. What is not finite
/// does not become so.
/// \param T pose of the points' frame in the other one
/// \param[out] moved as many points, metres; not those that `points` borrows
void move_points(const PointsView& points, const Eigen::Isometry3d& T, Points& moved);

/// The same of a single one, such as the origin of beams.
[[nodiscard]] inline std::array<float, 3> move_point(const std::array<float, 3>& point,
                                                     const Eigen::Isometry3d& T) {
  const Eigen::Vector3f p =
      (T * Eigen::Vector3f(point[0], point[1], point[2]).cast<double>()).cast<float>();
  return {p.x(), p.y(), p.z()};
}

}  // namespace mrpt_terrain
