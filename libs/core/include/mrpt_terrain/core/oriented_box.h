// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Upright box about points: the rectangle of least area around them, and their heights. Metres.
struct OrientedBox {
  Position2 centre;     ///< of the rectangle
  double yaw = 0.0;     ///< of its longer side, from x towards y, radians, (-pi/2, pi/2]
  double length = 0.0;  ///< longer side
  double width = 0.0;   ///< shorter side
  float low = 0.0F;     ///< z of the lowest point
  float high = 0.0F;    ///< z of the highest point
};

/// Scratch memory of `box_around`.
struct OrientedBoxWorkspace {
  std::vector<double> x, y;    ///< of the members that may be corners of the hull
  std::vector<double> inside;  ///< of each: least distance from an edge of the polygon, scaled
  std::vector<Position2> candidates;
  std::vector<Position2> hull;
};

/// Box around some points of a scan. The rectangle has a side along an edge of the convex hull
/// (Freeman and Shapira 1975); the hull is Andrew's (1979), of the points that lie outside of the
/// octagon of extreme points (Akl and Toussaint 1978) and of finer polygons made of it. No points
/// give an empty box at the origin, points on a line one of width 0.
[[nodiscard]] OrientedBox box_around(const PointsView& points, IndexRange members,
                                     OrientedBoxWorkspace& workspace);

}  // namespace mrpt_terrain
