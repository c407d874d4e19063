// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/overhangs.h"

#include "slots_around.h"

namespace mrpt_terrain {

void find_overhangs(const ElevationGrid& grid, const OverhangParams& params, FieldCells& cells) {
  const auto height = static_cast<float>(params.robot_height);
  cells.under.assign(grid.observed(), 0);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (cells.above[slot] == 0 || cells.low[slot] < height) continue;
    bool ground = false;
    for_slots_around(grid, slot, 1,
                     [&](std::size_t near) { ground = ground || cells.on[near] > 0; });
    cells.under[slot] = ground ? 1 : 0;
  }
}

}  // namespace mrpt_terrain
