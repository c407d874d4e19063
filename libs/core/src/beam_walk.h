// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "length_of.h"
#include "mrpt_terrain/core/cell_points.h"

namespace mrpt_terrain {

/// Where to look at the beam of a point on the way back to the sensor, metres in x and y.
struct BeamWalk {
  float first;     ///< from the point
  float step;      ///< from one place to the next
  float farthest;  ///< from the point
};

/// Calls visit(x, y, z) with places on the beam of a point, from the point back to where the beam
/// begins, until it returns false.
/// \return whether it has come to where the beam begins
template <class Visitor>
bool walk_back(const CellPoint& p, const std::array<float, 3>& origin, const BeamWalk& walk,
               Visitor&& visit) {
  const float dx = origin[0] - p.x, dy = origin[1] - p.y, dz = origin[2] - p.z;
  const float range = length_of(dx, dy);
  const float end = std::min(range, walk.farthest);
  for (float t = walk.first; t < end; t += walk.step) {
    const float share = t / range;
    if (!visit(p.x + share * dx, p.y + share * dy, p.z + share * dz)) return false;
  }
  return end == range;
}

}  // namespace mrpt_terrain
