// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What a robot fits under.
struct OverhangParams {
  double robot_height = 2.0;  ///< metres

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.robot_height, ParamInfo{"robot_height", "", "m", 0.0, 100.0,
                                       "cells are free under what hangs at least this high above "
                                       "the ground; the height of the robot with some reserve"});
  }
};

/// Finds the cells that are free underneath: the lowest of their points above the ground is at
/// least the robot's height above it, and the ground is seen, in the cell or next to it. What hangs
/// there stays a thing of its own; the support of the cell is ground. A wall of which only the
/// upper part is seen has no ground next to it and stays above.
/// \param[in,out] cells `under` is filled in
void find_overhangs(const ElevationGrid& grid, const OverhangParams& params, FieldCells& cells);

}  // namespace mrpt_terrain
