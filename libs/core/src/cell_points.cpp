// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/cell_points.h"

#include <cmath>

namespace mrpt_terrain {
namespace {

void prepare(const SquareLattice& lattice, CellPointsWorkspace& workspace, CellPoints& result) {
  const bool same = result.lattice.side == lattice.side && result.slot_of.size() == lattice.size();
  if (same) {
    for (const LatticeCell cell : result.cell) result.slot_of[result.number_of(cell)] = -1;
  } else {
    result.slot_of.assign(lattice.size(), -1);
  }
  if (workspace.count.size() != lattice.size()) workspace.count.assign(lattice.size(), 0);
  result.lattice = lattice;
  result.cell.clear();
  result.first.clear();
}

void count_points(const PointsView scan, const SquareLattice lattice,
                  CellPointsWorkspace& workspace) {
  workspace.cell_of.resize(scan.size);
  std::int32_t* cell_of = workspace.cell_of.data();
  std::int32_t* count = workspace.count.data();
  for (std::size_t i = 0; i < scan.size; ++i) {
    std::int32_t cell = lattice.cell_at(scan.x[i], scan.y[i]);
    if (!std::isfinite(scan.z[i])) cell = -1;
    cell_of[i] = cell;
    if (cell >= 0) ++count[cell];
  }
}

// Slots of the occupied cells and where their points begin; `count` becomes that, too.
std::int32_t number_cells(std::vector<std::int32_t>& count, CellPoints& result) {
  std::int32_t points = 0;
  const std::int32_t side = result.lattice.side;
  std::size_t number = 0;
  for (std::int32_t row = 0; row < side; ++row) {
    for (std::int32_t column = 0; column < side; ++column, ++number) {
      if (count[number] == 0) continue;
      result.slot_of[number] = static_cast<std::int32_t>(result.cell.size());
      result.cell.push_back({row, column});
      result.first.push_back(points);
      points += count[number];
      count[number] = result.first.back();
    }
  }
  result.first.push_back(points);
  return points;
}

}  // namespace

void sort_into_cells(const PointsView& scan, const SquareLattice& lattice,
                     CellPointsWorkspace& workspace, CellPoints& result) {
  prepare(lattice, workspace, result);
  count_points(scan, lattice, workspace);
  const auto points = static_cast<std::size_t>(number_cells(workspace.count, result));
  result.points.resize(points);
  std::int32_t* next = workspace.count.data();
  for (std::size_t i = 0; i < scan.size; ++i) {
    const std::int32_t cell = workspace.cell_of[i];
    if (cell < 0) continue;
    result.points[static_cast<std::size_t>(next[cell]++)] = {scan.x[i], scan.y[i], scan.z[i],
                                                             static_cast<std::int32_t>(i)};
  }
  for (const LatticeCell cell : result.cell) workspace.count[result.number_of(cell)] = 0;
}

}  // namespace mrpt_terrain
