// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "mrpt_terrain/core/cell_points.h"

namespace mrpt_terrain {

/// Calls f(row, column, slot) with the nine cells about a slot, row by row: how far they are from
/// it, in cells, and their slots. Empty cells have the slot `occupied()`: an entry there that adds
/// nothing costs less than branches on which cells are empty. Cells beyond the edges are left out.
template <class F>
void for_nine_cells(const CellPoints& cells, std::size_t slot, F&& f) {
  const std::int32_t side = cells.lattice.side;
  const LatticeCell cell = cells.cell[slot];
  const auto visit = [&](std::int32_t row, std::int32_t column) {
    const std::int32_t other =
        cells.slot_of[cells.number_of({cell.row + row, cell.column + column})];
    f(row, column, other < 0 ? cells.occupied() : static_cast<std::size_t>(other));
  };
  if (cell.row > 0 && cell.row < side - 1 && cell.column > 0 && cell.column < side - 1) {
    for (std::int32_t row = -1; row <= 1; ++row) {
      for (std::int32_t column = -1; column <= 1; ++column) visit(row, column);
    }
    return;
  }
  for (std::int32_t row = std::max(-1, -cell.row); row <= std::min(1, side - 1 - cell.row); ++row) {
    for (std::int32_t column = std::max(-1, -cell.column);
         column <= std::min(1, side - 1 - cell.column); ++column)
      visit(row, column);
  }
}

}  // namespace mrpt_terrain
