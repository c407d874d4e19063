// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/describe_fused.h"

#include <cmath>

#include "describe_stages.h"

namespace mrpt_terrain {
namespace {

/// From the robot's frame to that of the window.
struct ToWindow {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;

  ToWindow(const Eigen::Isometry3d& T_map_robot, const WindowFrame& frame)
      : rotation(T_map_robot.linear()),
        translation(T_map_robot.translation() - Eigen::Vector3d(frame.x, frame.y, frame.z)) {}

  [[nodiscard]] std::array<float, 3> operator()(float x, float y, float z) const {
    const Eigen::Vector3f p =
        (rotation * Eigen::Vector3d(x, y, z) + translation).cast<float>().eval();
    return {p.x(), p.y(), p.z()};
  }
};

void move_scan(const CurrentScan& current, const ToWindow& to_window,
               FusedDescriptionWorkspace& workspace) {
  const PointsView& from = current.scan.points;
  workspace.points.resize(from.size);
  for (std::size_t i = 0; i < from.size; ++i) {
    const std::array<float, 3> p = to_window(from.x[i], from.y[i], from.z[i]);
    workspace.points.x[i] = p[0];
    workspace.points.y[i] = p[1];
    workspace.points.z[i] = p[2];
  }
  workspace.origins.clear();
  for (std::size_t k = 0; k < current.origin_count; ++k) {
    const std::array<float, 3>& origin = current.origins.origins[k];
    workspace.origins.push_back(to_window(origin[0], origin[1], origin[2]));
  }
}

UnknownReason reason_without_cell(float x, float y, float z, float max_height) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return UnknownReason::kNotFinite;
  return z >= max_height ? UnknownReason::kTooHigh : UnknownReason::kOutsideMap;
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
    if (reason == UnknownReason::kNotFinite) ++counts.not_finite;
    if (reason == UnknownReason::kTooHigh) ++counts.too_high;
    if (reason == UnknownReason::kOutsideMap) ++counts.outside_map;
  }
  return counts;
}

}  // namespace

void describe_fused(const FusedSnapshot& map, const CurrentScan& current,
                    const FusedDescriptionParams& params, FusedDescriptionWorkspace& workspace,
                    FusedDescription& result, StageListener* listener) {
  const Eigen::Isometry3d& T_map_robot = current.scan.T_map_robot;
  const GridParams& extent = params.description.grid;
  Description& description = result.description;
  result.frame = window_around(map.lattice, extent, T_map_robot.translation());
  read_window(map, result.frame, params.fusion, description.grid, result.cells);
  move_scan(current, ToWindow(T_map_robot, result.frame), workspace);
  const PointsView points = workspace.points.view();
  description.projection = find_slots(points, static_cast<float>(extent.max_height),
                                      description.grid, workspace.stages.point_slots);
  BeamOrigins origins = current.origins;
  if (origins.known()) origins.origins = workspace.origins.data();
  const ScanView scan(points, origins);
  describe_cells({scan, params.description, listener, &params.fusion.points_cover},
                 workspace.stages, description);
}

}  // namespace mrpt_terrain
