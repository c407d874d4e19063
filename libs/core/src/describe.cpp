// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/describe.h"

#include "describe_field.h"
#include "describe_stages.h"

namespace mrpt_terrain {

void describe(const ScanView& scan, const DescriptionParams& params,
              DescriptionWorkspace& workspace, Description& description, StageListener* listener) {
  if (params.description.mode == DescriptionMode::kField) {
    describe_field(scan, params, workspace, description, listener);
    return;
  }
  description.field = FieldCells{};
  description.holes.clear();
  clear_rows(description.hole_cells);
  description.projection = build_elevation_grid(scan.points, params.grid, workspace.grid,
                                                description.grid, workspace.point_slots);
  describe_cells({scan, params, listener}, workspace, description);
}

}  // namespace mrpt_terrain
