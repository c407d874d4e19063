// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {

/// Plane a x + b y + c z + d = 0 with unit normal (a, b, c).
struct Plane {
  float a, b, c, d;
};

/// The same plane for fits in double precision.
[[nodiscard]] inline BeamPlane beam_plane_of(const Plane& plane) {
  return {Eigen::Vector3f(plane.a, plane.b, plane.c).cast<double>().normalized(),
          static_cast<double>(plane.d)};
}

/// Plane through three random points of different index; nothing if the three are on one line.
/// Requires at least three points.
[[nodiscard]] std::optional<Plane> random_plane(const PointsView& cloud, RandomGenerator& random);

/// Distance of point `i` from the plane at most `tolerance`, metres.
inline bool is_inlier(const PointsView& cloud, std::size_t i, const Plane& plane, float tolerance) {
  const float distance =
      plane.a * cloud.x[i] + plane.b * cloud.y[i] + plane.c * cloud.z[i] + plane.d;
  return std::abs(distance) <= tolerance;
}

/// Number of points within `tolerance` of the plane. Gives up, with a number of at most `to_beat`,
/// as soon as the points left cannot lift the count above `to_beat`: the best of many hypotheses
/// is the same as without giving up.
[[nodiscard]] std::int32_t count_inliers(const PointsView& cloud, const Plane& plane,
                                         float tolerance, std::int32_t to_beat);

}  // namespace mrpt_terrain
