// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Points in another frame, computed in double and rounded to float at the end. What is not finite
/// does not become so.
/// \param T pose of the points' frame in the other one
/// \param[out] moved as many points, metres; not those that `points` borrows
void move_points(const PointsView& points, const Eigen::Isometry3d& T, Points& moved);

}  // namespace mrpt_terrain
