// SPDX-License-Identifier: BSD-3-Clause
#include "rays.h"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace mrpt_terrain::octree {

bool CellGrid::find_key(const Place& place, CellKey& key) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cell = cells_per_metre * double{place[axis]};
    if (!(cell >= -32768.0 && cell < 32768.0)) return false;
    const int truncated = static_cast<int>(cell);
    key[axis] = static_cast<std::uint16_t>(truncated - (cell < truncated ? 1 : 0) + 32768);
  }
  return true;
}

double distance_between(const Place& from, const Place& to) {
  const float x = to[0] - from[0];
  const float y = to[1] - from[1];
  const float z = to[2] - from[2];
  return std::sqrt(double{x * x + y * y + z * z});
}

Place cut_ray(const Place& origin, const Place& end, double range) {
  const double distance = distance_between(origin, end);
  Place cut{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float direction = end[axis] - origin[axis];
    if (distance > 0.0) direction /= static_cast<float>(distance);
    cut[axis] = origin[axis] + direction * static_cast<float>(range);
  }
  return cut;
}

void RayBatch::add(const CellGrid& grid, const Place& origin, const CellKey& origin_key,
                   const Place& end, const CellKey& end_key) {
  constexpr double kNever = std::numeric_limits<double>::max();
  const auto ray_length = static_cast<float>(distance_between(origin, end));
  const std::size_t k = size++;
  length[k] = double{ray_length};
  first[k] = code_of(origin_key);
  last[k] = code_of(end_key);
  cells[k] = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float direction = (end[axis] - origin[axis]) / ray_length;
    cells[k] += static_cast<std::uint32_t>(std::abs(int{end_key[axis]} - int{origin_key[axis]}));
    if (!(direction > 0.0F || direction < 0.0F)) {
      step[axis][k] = 0;
      crossing[axis][k] = spacing[axis][k] = kNever;
      continue;
    }
    const double sign = direction > 0.0F ? 1.0 : -1.0;
    const auto half_cell = static_cast<float>(sign * grid.resolution * 0.5);
    const double border = grid.centre(origin_key[axis]) + double{half_cell};
    step[axis][k] = direction > 0.0F ? CellCode{1} << axis : kAxisBits[axis];
    crossing[axis][k] = (border - double{origin[axis]}) / double{direction};
    spacing[axis][k] = grid.resolution / double{std::abs(direction)};
  }
  // Coordinates so small that the length of the ray is no number above zero: OctoMap's walk ends
  // in the first step or never.
  if (!(length[k] > 0.0 && length[k] <= kNever)) last[k] = first[k];
}

}  // namespace mrpt_terrain::octree
