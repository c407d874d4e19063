// SPDX-License-Identifier: BSD-3-Clause
#include "rays.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "wide_registers.h"

namespace mrpt_terrain::octree {
namespace {

// What the loops below read in every turn has a variable of its own: the compiler cannot know that
// it is not changed by what they write, and would take the rays one by one.

constexpr double kNever = std::numeric_limits<double>::max();

MRPT_TERRAIN_WIDE_REGISTERS
void find_lengths(RayBatch& rays) {
  const std::size_t size = rays.size;
  for (std::size_t k = 0; k < size; ++k) {
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
  const std::size_t size = rays.size;
  for (std::size_t k = 0; k < size; ++k) {
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

MRPT_TERRAIN_WIDE_REGISTERS
void measure_lengths(const Place& from, double max_range, EndBatch& ends) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  const std::size_t size = ends.size;
  for (std::size_t k = 0; k < size; ++k) {
    const float x = ends.place[0][k], y = ends.place[1][k], z = ends.place[2][k];
    const bool finite =
        (std::abs(x) <= kGreatest) & (std::abs(y) <= kGreatest) & (std::abs(z) <= kGreatest);
    const float dx = x - from[0];
    const float dy = y - from[1];
    const float dz = z - from[2];
    ends.length[k] = std::sqrt(double{dx * dx + dy * dy + dz * dz});
    const bool is_short = (max_range < 0.0) | (ends.length[k] <= max_range);
    // That it lies in the cells is taken back where it does not.
    ends.flags[k] = (finite ? std::uint32_t{kFiniteEnd} | kEndInRange : 0U) |
                    (is_short ? std::uint32_t{kShort} : 0U) | kInRange;
  }
}

// Looks whether the ends lie in the cells, and cuts those that are too far away.
MRPT_TERRAIN_WIDE_REGISTERS
void cut_along(std::size_t axis, const Place& from, const CellGrid& grid, double range,
               EndBatch& ends) {
  const std::size_t size = ends.size;
  const double cells_per_metre = grid.cells_per_metre;
  const float origin = from[axis];
  for (std::size_t k = 0; k < size; ++k) {
    const float end = ends.place[axis][k];
    const double cell = cells_per_metre * double{end};
    const bool in_range = (cell >= -32768.0) & (cell < 32768.0);
    const float direction = (end - origin) / static_cast<float>(ends.length[k]);
    const float cut = origin + direction * static_cast<float>(range);
    const std::uint32_t flags = ends.flags[k];
    ends.place[axis][k] = (flags & kShort) != 0 ? end : cut;
    ends.flags[k] = in_range ? flags : flags & ~std::uint32_t{kEndInRange};
  }
}

MRPT_TERRAIN_WIDE_REGISTERS
void find_keys(std::size_t axis, const CellGrid& grid, EndBatch& ends) {
  const std::size_t size = ends.size;
  const double cells_per_metre = grid.cells_per_metre;
  for (std::size_t k = 0; k < size; ++k) {
    const double cell = cells_per_metre * double{ends.place[axis][k]};
    const bool in_range = (cell >= -32768.0) & (cell < 32768.0);
    // Within what an integer holds, also for NaN; in range, it is the same number.
    const double above = cell > -32768.0 ? cell : -32768.0;
    const double kept = above < 32768.0 ? above : 32768.0;
    const auto truncated = static_cast<std::int32_t>(kept);
    ends.key[axis][k] = truncated - static_cast<std::int32_t>(kept < truncated) + 32768;
    const std::uint32_t flags = ends.flags[k];
    ends.flags[k] = in_range ? flags : flags & ~std::uint32_t{kInRange};
  }
}

MRPT_TERRAIN_WIDE_REGISTERS
void find_codes(const CellKey& from, EndBatch& ends) {
  const std::size_t size = ends.size;
  for (std::size_t k = 0; k < size; ++k) {
    CellCode code = 0;
    std::int32_t steps = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t key = ends.key[axis][k];
      code |= spread_bits(static_cast<std::uint16_t>(key)) << axis;
      steps += std::abs(key - std::int32_t{from[axis]});
    }
    ends.code[k] = code;
    ends.cells[k] = static_cast<std::uint32_t>(steps);
  }
}

}  // namespace

void EndBatch::measure(const RayOrigin& from, const CellGrid& grid, double max_range) {
  measure_lengths(from.place, max_range, *this);
  for (std::size_t axis = 0; axis < 3; ++axis) cut_along(axis, from.place, grid, max_range, *this);
  for (std::size_t axis = 0; axis < 3; ++axis) find_keys(axis, grid, *this);
  find_codes(from.key, *this);
}

bool CellGrid::find_key(const Place& place, CellKey& key) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cell = cells_per_metre * double{place[axis]};
    if (!(cell >= -32768.0 && cell < 32768.0)) return false;
    const int truncated = static_cast<int>(cell);
    key[axis] = static_cast<std::uint16_t>(truncated - (cell < truncated ? 1 : 0) + 32768);
  }
  return true;
}

RayOrigin::RayOrigin(const CellGrid& grid, const Place& at, const CellKey& its_key)
    : place(at), key(its_key), code(code_of(its_key)) {
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = grid.centre(key[axis]);
}

void RayBatch::prepare(double resolution) {
  find_lengths(*this);
  for (std::size_t axis = 0; axis < 3; ++axis) find_borders(axis, resolution, *this);
}

}  // namespace mrpt_terrain::octree
