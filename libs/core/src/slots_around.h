// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

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
  const GridGeometry& geometry = grid.geometry;
  const int first_w = std::max(at.w - reach, 0);
  const int last_w = std::min(at.w + reach, geometry.cells_w() - 1);
  const int last_l = std::min(at.l + reach, geometry.cells_l() - 1);
  for (int l = std::max(at.l - reach, 0); l <= last_l; ++l) {
    const Slot* slots = grid.slot_of.data() + value_of(geometry.id_of({l, 0}));
    for (int w = first_w; w <= last_w; ++w) {
      if (slots[w] != kUnobserved) f(static_cast<std::size_t>(slots[w]));
    }
  }
}

/// The same around a slot.
template <class F>
void for_slots_around(const ElevationGrid& grid, std::size_t slot, int reach, F&& f) {
  for_slots_around(grid, grid.geometry.index_of(grid.cell[slot]), reach, f);
}

/// Moves by a number of cells in so many equal steps, each to the nearest cell, of two as near to
/// the one farther on.
class CellSteps {
 public:
  CellSteps(int cells, int steps)
      : sign_(cells < 0 ? -1 : 1),
        twice_cells_(2 * std::abs(cells)),
        twice_steps_(2 * steps),
        rest_(steps) {}
  /// Requires that there are no more cells than steps.
  void next() {
    rest_ += twice_cells_;
    const bool moves = rest_ >= twice_steps_;
    at_ += moves ? sign_ : 0;
    rest_ -= moves ? twice_steps_ : 0;
  }
  [[nodiscard]] int at() const { return at_; }

 private:
  int sign_, twice_cells_, twice_steps_, rest_;
  int at_ = 0;
};

/// Whether one of the observed slots on the line between two cells is such a one; theirs do not
/// count.
template <class Predicate>
bool any_slot_between(const ElevationGrid& grid, CellIndex a, CellIndex b, Predicate&& is_such) {
  const int steps = std::max(std::abs(a.l - b.l), std::abs(a.w - b.w));
  CellSteps l(b.l - a.l, steps), w(b.w - a.w, steps);
  for (int k = 1; k < steps; ++k) {
    l.next();
    w.next();
    const Slot slot = grid.slot_within({a.l + l.at(), a.w + w.at()});
    if (slot != kUnobserved && is_such(static_cast<std::size_t>(slot))) return true;
  }
  return false;
}

}  // namespace mrpt_terrain
