// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/describe_fused.h"

#include <cmath>

#include "describe_field.h"
#include "describe_stages.h"
#include "mrpt_terrain/core/move_points.h"
#include "remembered_points.h"

namespace mrpt_terrain {
namespace {

// Points and origins of the scan in the frame of the window, which is parallel to the map.
void move_scan(const CurrentScan& current, const WindowFrame& frame,
               FusedDescriptionWorkspace& workspace) {
  Eigen::Isometry3d to_window = current.scan.T_map_robot;
  to_window.translation() -= Eigen::Vector3d(frame.x, frame.y, frame.z);
  move_points(current.scan.points, to_window, workspace.points);
  workspace.origins.clear();
  for (std::size_t k = 0; k < current.origin_count; ++k) {
    workspace.origins.push_back(move_point(current.origins.origins[k], to_window));
  }
}

UnknownReason reason_without_cell(float x, float y, float z, float max_height) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return UnknownReason::kNotFinite;
  return z >= max_height ? UnknownReason::kTooHigh : UnknownReason::kOutsideMap;
}

void count_left_out(UnknownReason reason, ProjectionCounts& counts) {
  if (reason == UnknownReason::kNotFinite) ++counts.not_finite;
  if (reason == UnknownReason::kTooHigh) ++counts.too_high;
  if (reason == UnknownReason::kOutsideMap) ++counts.outside_map;
}

// The slots of the scan's points in the window.
ProjectionCounts find_slots(const PointsView& points, float max_height, const ElevationGrid& grid,
                            PointSlots& point_slots) {
  ProjectionCounts counts;
  point_slots.resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    CellIndex cell;
    const bool inside = points.z[i] < max_height && std::isfinite(points.z[i]) &&
                        grid.geometry.cell_at(points.x[i], points.y[i], cell);
    const Slot slot = inside ? grid.slot_at(cell) : kUnobserved;
    if (slot != kUnobserved) {
      point_slots[i] = slot;
      ++counts.in_map;
      continue;
    }
    const UnknownReason reason =
        reason_without_cell(points.x[i], points.y[i], points.z[i], max_height);
    point_slots[i] = point_slot_of(reason);
    count_left_out(reason, counts);
  }
  return counts;
}

// Labels and counts are those of the scan's own points, which come first.
void keep_labels(std::size_t measured, const PointSlots& point_slots, Description& description) {
  PointLabels& labels = description.labels;
  labels.support.resize(measured);
  labels.reason.resize(measured);
  labels.terrain_class.resize(measured);
  labels.cluster.resize(measured);
  ProjectionCounts& counts = description.projection;
  counts = ProjectionCounts{};
  for (std::size_t i = 0; i < measured; ++i) {
    if (point_slots[i] >= 0) {
      ++counts.in_map;
      continue;
    }
    count_left_out(reason_of(point_slots[i]), counts);
  }
}

// What the map knows of the cells of a grid. Points that were not fused may lie in a cell that it
// knows nothing of: that is known by its mean alone.
void look_up_cells(const RememberedWorkspace& remembered, double time, const ElevationGrid& grid,
                   WindowCells& cells) {
  const std::size_t n = grid.observed();
  cells.height.resize(n);
  cells.variance.resize(n);
  cells.last_seen.resize(n);
  cells.clearance.resize(n);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const Slot from = remembered.grid.slot_of[static_cast<std::size_t>(value_of(grid.cell[slot]))];
    const bool known = from != kUnobserved;
    const auto k = static_cast<std::size_t>(known ? from : 0);
    cells.height[slot] = known ? remembered.cells.height[k] : grid.h_mean[slot];
    cells.variance[slot] = known ? remembered.cells.variance[k] : 0.0F;
    cells.last_seen[slot] = known ? remembered.cells.last_seen[k] : time;
    cells.clearance[slot] = known ? remembered.cells.clearance[k] : 0.0F;
  }
}

// Readers of the grid get all that the map knows of a cell instead of the few points that stood for
// it, but where it knows of heights that do not belong to the cell: too high above the ground
// there, or hanging over it.
void take_over_cells(const RememberedWorkspace& remembered, float max_height,
                     Description& description) {
  ElevationGrid& grid = description.grid;
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const Slot from = remembered.grid.slot_of[static_cast<std::size_t>(value_of(grid.cell[slot]))];
    if (from == kUnobserved) continue;
    const auto k = static_cast<std::size_t>(from);
    const float top = description.field.ground[slot] + max_height;
    if (remembered.grid.h_max[k] >= top || remembered.cells.clearance[k] > 0.0F) continue;
    grid.h_min[slot] = remembered.grid.h_min[k];
    grid.h_max[slot] = remembered.grid.h_max[k];
    grid.h_mean[slot] = remembered.grid.h_mean[k];
    grid.sums[slot] = remembered.grid.sums[k];
    description.ground.h_mean[slot] = grid.h_mean[slot] - description.field.ground[slot];
  }
}

// Field mode takes points: those of the scan, and those that stand for what the cells remember.
void describe_fused_field(const FusedSnapshot& map, const BeamOrigins& origins,
                          const FusedDescriptionParams& params,
                          FusedDescriptionWorkspace& workspace, FusedDescription& result,
                          StageListener* listener) {
  const std::size_t measured = workspace.points.size();
  append_remembered(map, result.frame, params.fusion, measured, workspace.remembered,
                    workspace.points);
  BeamOrigins of_scan = origins;
  of_scan.measured = measured;
  DescriptionParams description = params.description;
  description.grid.cell_size = result.frame.geometry.cell_size();
  describe_field({workspace.points.view(), of_scan}, description, workspace.stages,
                 result.description, listener, &params.fusion.points_cover);
  keep_labels(measured, workspace.stages.point_slots, result.description);
  take_over_cells(workspace.remembered, static_cast<float>(description.grid.max_height),
                  result.description);
  look_up_cells(workspace.remembered, map.time, result.description.grid, result.cells);
}

}  // namespace

void describe_fused(const FusedSnapshot& map, const CurrentScan& current,
                    const FusedDescriptionParams& params, FusedDescriptionWorkspace& workspace,
                    FusedDescription& result, StageListener* listener) {
  const Eigen::Isometry3d& T_map_robot = current.scan.T_map_robot;
  const GridParams& extent = params.description.grid;
  Description& description = result.description;
  result.frame = window_around(map.lattice, extent, T_map_robot.translation());
  move_scan(current, result.frame, workspace);
  BeamOrigins origins = current.origins;
  if (origins.known()) origins.origins = workspace.origins.data();
  if (params.description.description.mode == DescriptionMode::kField) {
    describe_fused_field(map, origins, params, workspace, result, listener);
    return;
  }
  description.field = FieldCells{};
  description.holes.clear();
  clear_rows(description.hole_cells);
  read_window(map, result.frame, params.fusion, description.grid, result.cells);
  const PointsView points = workspace.points.view();
  description.projection = find_slots(points, static_cast<float>(extent.max_height),
                                      description.grid, workspace.stages.point_slots);
  const ScanView scan(points, origins);
  describe_cells({scan, params.description, listener, &params.fusion.points_cover},
                 workspace.stages, description);
}

}  // namespace mrpt_terrain
