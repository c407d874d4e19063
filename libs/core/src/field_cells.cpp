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

// One pass over the points for all that is summed up over them: the sums of a cell lie together.
void sum_points(const PointsView& points, const FieldPoints& field, const PointSlots& point_slots,
                std::vector<FieldCellSums>& sums) {
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (point_slots[i] < 0) continue;
    FieldCellSums& to = sums[static_cast<std::size_t>(point_slots[i])];
    const float height = field.height[i];
    switch (field.support[i]) {
      case Support::kGround:
        to.x += points.x[i];
        to.y += points.y[i];
        to.z += points.z[i];
        ++to.on;
        to.floor += height;
        break;
      case Support::kAbove:
        ++to.above;
        to.low = std::min(to.low, height);
        to.high = std::max(to.high, height);
        break;
      case Support::kBelow:
        ++to.below;
        to.floor += height;
        break;
      case Support::kUnknown:
        break;
    }
  }
}

void resize(std::size_t n, FieldCells& cells, GroundSegmentation& ground) {
  for (auto* values : {&cells.ground, &cells.low, &cells.high, &cells.floor, &ground.h_mean})
    values->resize(n);
  for (auto* counts : {&cells.on, &cells.above, &cells.below}) counts->resize(n);
  ground.rule.resize(n);
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

void measure_field_cells(const PointsView& points, FieldWorkspace& workspace,
                         const ElevationGrid& grid, const PointSlots& point_slots,
                         FieldCells& cells, GroundSegmentation& ground) {
  workspace.sums.assign(grid.observed(), {});
  sum_points(points, workspace.points, point_slots, workspace.sums);
  resize(grid.observed(), cells, ground);
  const LevelView reference = view_of(workspace.surface);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const FieldCellSums& sums = workspace.sums[slot];
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
    cells.ground[slot] =
        reference.at(static_cast<float>(centre.x), static_cast<float>(centre.y)).height;
    cells.on[slot] = sums.on;
    cells.above[slot] = sums.above;
    cells.below[slot] = sums.below;
    cells.low[slot] = sums.above == 0 ? 0.0F : sums.low;
    cells.high[slot] = sums.high;
    const auto low_points = static_cast<float>(sums.on + sums.below);
    cells.floor[slot] = cells.ground[slot] + sums.floor / std::max(low_points, 1.0F);
    ground.h_mean[slot] = grid.h_mean[slot] - cells.ground[slot];
    ground.rule[slot] = sums.above > 0   ? GroundRule::kHigh
                        : sums.below > 0 ? GroundRule::kLow
                                         : GroundRule::kGround;
  }
}

}  // namespace mrpt_terrain
