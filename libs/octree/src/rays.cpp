// SPDX-License-Identifier: BSD-3-Clause
#include "rays.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "wide_registers.h"

namespace mrpt_terrain::octree {
namespace {

constexpr double kNever = std::numeric_limits<double>::max();

MRPT_TERRAIN_WIDE_REGISTERS
void find_lengths(RayBatch& rays) {
  for (std::size_t k = 0; k < rays.size; ++k) {
    const float x = rays.end[0][k] - rays.origin[0][k];
    const float y = rays.end[1][k] - rays.origin[1][k];
    const float z = rays.end[2][k] - rays.origin[2][k];
    rays.length[k] = double{static_cast<float>(std::sqrt(double{x * x + y * y + z * z}))};
    // Coordinates so small that the length of the ray is no number above zero: OctoMap's walk ends
    // in the first step or never.
    const bool walks = (rays.length[k] > 0.0) & (rays.length[k] <= kNever);
    rays.last[k] = walks ? rays.last[k] : rays.first[k];
  }
}

// Directions in float, borders in double, as in OctoMap.
MRPT_TERRAIN_WIDE_REGISTERS
void find_borders(std::size_t axis, double resolution, RayBatch& rays) {
  const double half_cell = double{static_cast<float>(resolution * 0.5)};
  const CellCode up = CellCode{1} << axis;
  const CellCode down = kAxisBits[axis];
  for (std::size_t k = 0; k < rays.size; ++k) {
    const float origin = rays.origin[axis][k];
    const float direction = (rays.end[axis][k] - origin) / static_cast<float>(rays.length[k]);
    const double border = rays.centre[axis][k] + (direction > 0.0F ? half_cell : -half_cell);
    const double crossing = (border - double{origin}) / double{direction};
    const double spacing = resolution / double{std::abs(direction)};
    const bool moves = (direction > 0.0F) | (direction < 0.0F);
    rays.crossing[axis][k] = moves ? crossing : kNever;
    rays.spacing[axis][k] = moves ? spacing : kNever;
    rays.step[axis][k] = direction > 0.0F ? up : (direction < 0.0F ? down : 0);
  }
}

}  // namespace

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

RayOrigin::RayOrigin(const CellGrid& grid, const Place& at, const CellKey& its_key)
    : place(at), key(its_key), code(code_of(its_key)) {
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = grid.centre(key[axis]);
}

void RayBatch::add(const RayOrigin& from, const Place& to, const CellKey& to_key,
                   CellCode to_code) {
  const std::size_t k = size++;
  first[k] = from.code;
  last[k] = to_code;
  cells[k] = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis][k] = from.place[axis];
    end[axis][k] = to[axis];
    centre[axis][k] = from.centre[axis];
    cells[k] += static_cast<std::uint32_t>(std::abs(int{to_key[axis]} - int{from.key[axis]}));
  }
}

void RayBatch::prepare(double resolution) {
  find_lengths(*this);
  for (std::size_t axis = 0; axis < 3; ++axis) find_borders(axis, resolution, *this);
}

}  // namespace mrpt_terrain::octree
