// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "mrpt_terrain/core/elevation_grid.h"

namespace mrpt_terrain {

/// The slot of a place; kUnobserved outside of the grid, too.
[[nodiscard]] inline Slot slot_at(const ElevationGrid& grid, const Position2& at) {
  CellIndex cell;
  return grid.geometry.cell_at(at.x, at.y, cell) ? grid.slot_at(cell) : kUnobserved;
}

/// Calls f with every observed slot up to `reach` cells away from a cell, its own included.
template <class F>
void for_slots_around(const ElevationGrid& grid, CellIndex at, int reach, F&& f) {
  for (int l = std::max(at.l - reach, 0); l <= std::min(at.l + reach, grid.geometry.cells_l() - 1);
       ++l) {
    for (int w = std::max(at.w - reach, 0);
         w <= std::min(at.w + reach, grid.geometry.cells_w() - 1); ++w) {
      const Slot other =
          grid.slot_of[static_cast<std::size_t>(value_of(grid.geometry.id_of({l, w})))];
      if (other != kUnobserved) f(static_cast<std::size_t>(other));
    }
  }
}

/// The same around a slot.
template <class F>
void for_slots_around(const ElevationGrid& grid, std::size_t slot, int reach, F&& f) {
  for_slots_around(grid, grid.geometry.index_of(grid.cell[slot]), reach, f);
}

}  // namespace mrpt_terrain
