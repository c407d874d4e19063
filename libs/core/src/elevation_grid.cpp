// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/elevation_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace mrpt_terrain {
namespace {

void prepare(const GridParams& params, ElevationGridWorkspace& workspace, ElevationGrid& grid) {
  const GridGeometry geometry(params.length, params.width, params.cell_size);
  const auto size = static_cast<std::size_t>(geometry.array_size());
  if (grid.geometry != geometry || grid.slot_of.size() != size) {
    grid.geometry = geometry;
    grid.slot_of.assign(size, kUnobserved);
  } else {
    // Undoing the last scan's cells costs less than filling the whole array.
    for (const CellId id : grid.cell)
      grid.slot_of[static_cast<std::size_t>(value_of(id))] = kUnobserved;
  }
  grid.cell.clear();
  workspace.hit.assign(size + 8, 0);  // read eight at a time, see number_observed_cells
}

UnknownReason reason_for(float x, float y, float z, const GridParams& params) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return UnknownReason::kNotFinite;
  if (z >= params.max_height) return UnknownReason::kTooHigh;
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

// Leaves the CellId of each point, or the code of its reason, in `point_slots`.
ProjectionCounts project(const PointsView& points, const GridParams& params,
                         const GridGeometry& geometry, std::vector<std::uint8_t>& hit,
                         PointSlots& point_slots) {
  constexpr float kLowest = std::numeric_limits<float>::lowest();
  point_slots.resize(points.size);
  ProjectionCounts counts;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float z = points.z[i];
    CellIndex cell;
    if (z < params.max_height && z >= kLowest && geometry.cell_at(points.x[i], points.y[i], cell)) {
      const std::int32_t id = value_of(geometry.id_of(cell));
      hit[static_cast<std::size_t>(id)] = 1;
      point_slots[i] = id;
    } else {
      const UnknownReason reason = reason_for(points.x[i], points.y[i], z, params);
      count(reason, counts);
      point_slots[i] = point_slot_of(reason);
    }
  }
  counts.in_map = points.size - counts.not_finite - counts.too_high - counts.outside_map;
  return counts;
}

// Gives the cells that were hit their slots, in the order of the cells.
void number_observed_cells(const std::vector<std::uint8_t>& hit, ElevationGrid& grid) {
  for (std::size_t base = 0; base + 8 <= hit.size(); base += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &hit[base], 8);
    if (eight == 0) continue;
    for (std::size_t k = base; k < base + 8; ++k) {
      if (hit[k] == 0) continue;
      grid.slot_of[k] = static_cast<Slot>(grid.cell.size());
      grid.cell.push_back(CellId{static_cast<std::int32_t>(k)});
    }
  }
}

// Heights and moments of the observed cells; x and y of the sums are about the cell's centre.
void accumulate(const PointsView& points, PointSlots& point_slots,
                ElevationGridWorkspace& workspace, ElevationGrid& grid) {
  const std::size_t n = grid.observed();
  workspace.centre.resize(n);
  for (std::size_t slot = 0; slot < n; ++slot) {
    workspace.centre[slot] = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
  }
  workspace.sums.assign(n, MomentSums{});
  grid.h_min.assign(n, std::numeric_limits<float>::max());
  grid.h_max.assign(n, std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < points.size; ++i) {
    if (point_slots[i] < 0) continue;
    const Slot slot_number = grid.slot_of[static_cast<std::size_t>(point_slots[i])];
    const auto slot = static_cast<std::size_t>(slot_number);
    point_slots[i] = slot_number;
    const float z = points.z[i];
    grid.h_min[slot] = std::min(grid.h_min[slot], z);
    grid.h_max[slot] = std::max(grid.h_max[slot], z);
    const Position2 centre = workspace.centre[slot];
    workspace.sums[slot].add(points.x[i] - centre.x, points.y[i] - centre.y, z);
  }
}

void finish(const ElevationGridWorkspace& workspace, ElevationGrid& grid) {
  grid.h_mean.resize(grid.observed());
  grid.moments.resize(grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    Moments& moments = grid.moments[slot];
    moments = moments_from(workspace.sums[slot]);
    moments.mean_x += workspace.centre[slot].x;
    moments.mean_y += workspace.centre[slot].y;
    grid.h_mean[slot] = static_cast<float>(moments.mean_z);
  }
}

}  // namespace

ProjectionCounts build_elevation_grid(const PointsView& points, const GridParams& params,
                                      ElevationGridWorkspace& workspace, ElevationGrid& grid,
                                      PointSlots& point_slots) {
  prepare(params, workspace, grid);
  const ProjectionCounts counts =
      project(points, params, grid.geometry, workspace.hit, point_slots);
  number_observed_cells(workspace.hit, grid);
  accumulate(points, point_slots, workspace, grid);
  finish(workspace, grid);
  return counts;
}

}  // namespace mrpt_terrain
