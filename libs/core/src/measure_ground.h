// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/costs.h"

namespace mrpt_terrain {

/// Points of which the ground consists; borrowed.
struct GroundPoints {
  const ElevationGrid& grid;                   ///< which cells are observed
  CellSelection cells;                         ///< their points; cells may have none
  const std::vector<float>* extent = nullptr;  ///< per slot: highest less lowest; null: the grid's
};

/// Slope, step and roughness of `compute_cell_costs`. Cells without points take part in no surface;
/// their own is that of the best window around, and their height makes no step. Cells that are
/// skipped have no surface and no step.
void measure_ground(const GroundPoints& points, const RobotParams& robot, CostWorkspace& workspace,
                    CellCosts& costs);

/// Leaves the parts that only field mode knows empty.
void clear_field_parts(CellCosts& costs);

}  // namespace mrpt_terrain
