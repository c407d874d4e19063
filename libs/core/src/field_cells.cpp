// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface_levels.h"

namespace mrpt_terrain {
namespace {

// From the order of the cells to that of the scan.
void put_in_order(const PointsView& scan, const std::vector<std::int32_t>& place_of,
                  const GroundSurface& surface, const std::vector<Support>& support,
                  FieldPoints& points) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  points.height.resize(scan.size);
  points.support.resize(scan.size);
  for (std::size_t i = 0; i < scan.size; ++i) {
    const auto place = static_cast<std::size_t>(place_of[i]);
    if (place_of[i] >= 0) {
      points.height[i] = surface.height[place];
      points.support[i] = support[place];
      continue;
    }
    const bool finite =
        std::isfinite(scan.x[i]) && std::isfinite(scan.y[i]) && std::isfinite(scan.z[i]);
    points.height[i] = finite ? 0.0F : kNan;
    points.support[i] = Support::kUnknown;
  }
}

void reset(std::size_t n, FieldCells& cells) {
  cells.ground.resize(n);
  for (auto* counts : {&cells.on, &cells.above, &cells.below}) counts->assign(n, 0);
  cells.low.assign(n, std::numeric_limits<float>::max());
  cells.high.assign(n, 0.0F);
  cells.floor.assign(n, 0.0F);
}

void count_points(const FieldPoints& points, const PointSlots& point_slots, FieldCells& cells) {
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (point_slots[i] < 0) continue;
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    const float height = points.height[i];
    switch (points.support[i]) {
      case Support::kGround:
        ++cells.on[slot];
        cells.floor[slot] += height;
        break;
      case Support::kAbove:
        ++cells.above[slot];
        cells.low[slot] = std::min(cells.low[slot], height);
        cells.high[slot] = std::max(cells.high[slot], height);
        break;
      case Support::kBelow:
        ++cells.below[slot];
        cells.floor[slot] += height;
        break;
      case Support::kUnknown:
        break;
    }
  }
}

}  // namespace

void find_field_ground(const ScanView& scan, const GroundSurfaceParams& surface,
                       const GroundLabelParams& labels, FieldWorkspace& workspace) {
  find_ground_surface(scan, surface, workspace.surface_workspace, workspace.surface);
  label_by_height(workspace.surface, labels, workspace.label_workspace, workspace.threshold,
                  workspace.support);
  put_in_order(scan.points, workspace.surface_workspace.sort.place_of, workspace.surface,
               workspace.support, workspace.points);
}

void measure_field_cells(const FieldWorkspace& workspace, const ElevationGrid& grid,
                         const PointSlots& point_slots, FieldCells& cells,
                         GroundSegmentation& ground) {
  reset(grid.observed(), cells);
  count_points(workspace.points, point_slots, cells);
  ground.rule.resize(grid.observed());
  ground.h_mean.resize(grid.observed());
  const LevelView reference = view_of(workspace.surface);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
    cells.ground[slot] =
        reference.at(static_cast<float>(centre.x), static_cast<float>(centre.y)).height;
    ground.h_mean[slot] = grid.h_mean[slot] - cells.ground[slot];
    ground.rule[slot] = cells.above[slot] > 0   ? GroundRule::kHigh
                        : cells.below[slot] > 0 ? GroundRule::kLow
                                                : GroundRule::kGround;
    if (cells.above[slot] == 0) cells.low[slot] = 0.0F;
    const auto low_points = static_cast<float>(cells.on[slot] + cells.below[slot]);
    cells.floor[slot] = cells.ground[slot] + cells.floor[slot] / std::max(low_points, 1.0F);
  }
}

}  // namespace mrpt_terrain
