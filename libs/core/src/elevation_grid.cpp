// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/elevation_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "prefetch.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

UnknownReason reason_for(float x, float y, float z, float max_height) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return UnknownReason::kNotFinite;
  if (z >= max_height) return UnknownReason::kTooHigh;
  return UnknownReason::kOutsideMap;
}

void count(UnknownReason reason, ProjectionCounts& counts) {
  switch (reason) {
    case UnknownReason::kNotFinite:
      ++counts.not_finite;
      break;
    case UnknownReason::kTooHigh:
      ++counts.too_high;
      break;
    default:
      ++counts.outside_map;
      break;
  }
}

// Leaves the CellId of each point in `point_slots`, -1 for points without one. Views and geometry
// are copies so that the compiler can keep them in registers: a store to the results could change
// what a reference leads to.
MRPT_TERRAIN_WIDE_REGISTERS
void find_cells(const PointsView points, const float* heights, const float max_height,
                const GridGeometry geometry, std::int32_t* point_slots) {
  constexpr float kLowest = std::numeric_limits<float>::lowest();
  for (std::size_t i = 0; i < points.size; ++i) {
    const bool wanted = (heights[i] < max_height) & (heights[i] >= kLowest);
    point_slots[i] = geometry.number_at(points.x[i], points.y[i], wanted);
  }
}

// Marks the cells that were hit; points without a cell get the code of their reason.
ProjectionCounts mark_hits(const PointsView points, const float* heights, const float max_height,
                           std::uint8_t* hit, std::int32_t* point_slots) {
  ProjectionCounts counts;
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t id = point_slots[i];
    if (id >= 0) {
      hit[id] = 1;
    } else {
      const UnknownReason reason = reason_for(points.x[i], points.y[i], heights[i], max_height);
      count(reason, counts);
      point_slots[i] = point_slot_of(reason);
    }
  }
  counts.in_map = points.size - counts.not_finite - counts.too_high - counts.outside_map;
  return counts;
}

// Takes the first byte in memory that is not 0 out of eight that are 0 or 1. Requires one.
// \return its position
std::size_t take_first_one(std::uint64_t& eight) {
#if defined(__GNUC__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  const auto first = static_cast<std::size_t>(__builtin_ctzll(eight)) / 8;
  eight &= eight - 1;
  return first;
#else
  std::array<std::uint8_t, 8> bytes;
  std::memcpy(bytes.data(), &eight, 8);
  const auto found =
      std::find_if(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b != 0; });
  *found = 0;
  std::memcpy(&eight, bytes.data(), 8);
  return static_cast<std::size_t>(found - bytes.begin());
#endif
}

// Gives the cells that were hit their slots, in the order of the cells, and forgets the hits.
void number_observed_cells(std::vector<std::uint8_t>& hit, ElevationGrid& grid) {
  for (std::size_t base = 0; base < hit.size(); base += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &hit[base], 8);
    if (eight == 0) continue;
    std::memset(&hit[base], 0, 8);
    while (eight != 0) {
      const std::size_t id = base + take_first_one(eight);
      grid.slot_of[id] = static_cast<Slot>(grid.cell.size());
      grid.cell.push_back(CellId{static_cast<std::int32_t>(id)});
    }
  }
}

void replace_cells_by_slots(const Slot* slot_of, PointSlots& point_slots) {
  for (std::int32_t& point_slot : point_slots) {
    if (point_slot >= 0) point_slot = slot_of[point_slot];
  }
}

// Fetching a cell's sums this many points ahead hides most of the way to the outer caches.
constexpr std::size_t kPrefetchAhead = 12;

void accumulate(const PointsView points, const PointSlots& point_slots, ElevationGrid& grid) {
  const std::int32_t* slots = point_slots.data();
  MomentSums* sums = grid.sums.data();
  float* h_min = grid.h_min.data();
  float* h_max = grid.h_max.data();
  for (std::size_t i = 0; i < points.size; ++i) {
    if (i + kPrefetchAhead < points.size && slots[i + kPrefetchAhead] >= 0) {
      prefetch_for_writing(sums[slots[i + kPrefetchAhead]]);
    }
    const std::int32_t slot = slots[i];
    if (slot < 0) continue;
    const float z = points.z[i];
    h_min[slot] = std::min(h_min[slot], z);
    h_max[slot] = std::max(h_max[slot], z);
    sums[slot].add(points.x[i], points.y[i], z);
  }
}

void find_means(ElevationGrid& grid) {
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    grid.h_mean[slot] = static_cast<float>(grid.sums[slot].z / grid.sums[slot].n);
  }
}

}  // namespace

void clear_grid(const GridGeometry& geometry, ElevationGrid& grid) {
  const auto size = static_cast<std::size_t>(geometry.array_size());
  if (grid.geometry != geometry || grid.slot_of.size() != size) {
    grid.geometry = geometry;
    grid.slot_of.assign(size, kUnobserved);
  } else {
    // Undoing the last scan's cells costs less than filling the whole array.
    for (const CellId id : grid.cell) {
      grid.slot_of[static_cast<std::size_t>(value_of(id))] = kUnobserved;
    }
  }
  grid.cell.clear();
  grid.h_min.clear();
  grid.h_max.clear();
  grid.h_mean.clear();
  grid.sums.clear();
}

ProjectionCounts build_elevation_grid(const PointsView& points, const GridParams& params,
                                      ElevationGridWorkspace& workspace, ElevationGrid& grid,
                                      PointSlots& point_slots, const float* heights) {
  clear_grid(GridGeometry(params.length, params.width, params.cell_size), grid);
  // Read eight at a time and left empty by number_observed_cells.
  workspace.hit.resize((grid.slot_of.size() + 7) / 8 * 8);
  point_slots.resize(points.size);
  if (heights == nullptr) heights = points.z;
  const auto max_height = static_cast<float>(params.max_height);
  find_cells(points, heights, max_height, grid.geometry, point_slots.data());
  const ProjectionCounts counts =
      mark_hits(points, heights, max_height, workspace.hit.data(), point_slots.data());
  number_observed_cells(workspace.hit, grid);
  replace_cells_by_slots(grid.slot_of.data(), point_slots);
  grid.h_min.assign(grid.observed(), std::numeric_limits<float>::max());
  grid.h_max.assign(grid.observed(), std::numeric_limits<float>::lowest());
  grid.h_mean.resize(grid.observed());
  grid.sums.assign(grid.observed(), MomentSums{});
  accumulate(points, point_slots, grid);
  find_means(grid);
  return counts;
}

}  // namespace mrpt_terrain
