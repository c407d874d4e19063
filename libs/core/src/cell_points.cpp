// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/cell_points.h"

#include <cmath>
#include <limits>

#include "prefetch.h"
#include "wide_registers.h"

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

// The cell of every point, -1 for points that are left out: `SquareLattice::cell_at` without
// branches, so that compilers work on many points at once.
MRPT_TERRAIN_WIDE_REGISTERS
void find_cells(const PointsView scan, const SquareLattice lattice, std::int32_t* cell_of) {
  const float half = 0.5F * static_cast<float>(lattice.side);
  const float per_metre = 1.0F / lattice.cell_size;
  const auto end = static_cast<float>(lattice.side);
  for (std::size_t i = 0; i < scan.size; ++i) {
    const float l = scan.x[i] * per_metre + half;
    const float w = scan.y[i] * per_metre + half;
    const bool finite = std::abs(scan.z[i]) <= std::numeric_limits<float>::max();
    const bool inside = (l >= 0.0F) & (l < end) & (w >= 0.0F) & (w < end) & finite;
    const auto row = static_cast<std::int32_t>(inside ? l : 0.0F);
    const auto column = static_cast<std::int32_t>(inside ? w : 0.0F);
    cell_of[i] = inside ? row * lattice.side + column : -1;
  }
}

void count_points(const std::vector<std::int32_t>& cell_of, std::int32_t* count) {
  for (const std::int32_t cell : cell_of) {
    if (cell >= 0) ++count[cell];
  }
}

// Whether any of 16 cells is occupied: most are not.
bool any_occupied(const std::int32_t* count) {
  std::int32_t any = 0;
  for (int k = 0; k < 16; ++k) any |= count[k];
  return any != 0;
}

// Slots of the occupied cells and where their points begin; `count` becomes that, too.
std::int32_t number_cells(std::vector<std::int32_t>& count, CellPoints& result) {
  std::int32_t points = 0;
  const std::int32_t side = result.lattice.side;
  for (std::int32_t row = 0; row < side; ++row) {
    std::int32_t* in_row = count.data() + static_cast<std::ptrdiff_t>(row) * side;
    for (std::int32_t column = 0; column < side; ++column) {
      while (column + 16 <= side && !any_occupied(in_row + column)) column += 16;
      if (column == side) break;
      if (in_row[column] == 0) continue;
      result.slot_of[result.number_of({row, column})] =
          static_cast<std::int32_t>(result.cell.size());
      result.cell.push_back({row, column});
      result.first.push_back(points);
      points += in_row[column];
      in_row[column] = result.first.back();
    }
  }
  result.first.push_back(points);
  return points;
}

// Cells become places; `next` is where the next point of every cell goes.
void find_places(std::int32_t* next, std::vector<std::int32_t>& place_of) {
  for (std::int32_t& place : place_of) {
    if (place >= 0) place = next[place]++;
  }
}

// Fetching places this many points ahead hides most of the way to the outer caches.
constexpr std::size_t kPrefetchAhead = 32;

void place_points(const PointsView scan, const std::int32_t* place_of, CellPoint* points) {
  for (std::size_t i = 0; i < scan.size; ++i) {
    if (i + kPrefetchAhead < scan.size && place_of[i + kPrefetchAhead] >= 0)
      prefetch_for_writing(points[place_of[i + kPrefetchAhead]]);
    if (place_of[i] < 0) continue;
    points[place_of[i]] = {scan.x[i], scan.y[i], scan.z[i], static_cast<std::int32_t>(i)};
  }
}

}  // namespace

void sort_into_cells(const PointsView& scan, const SquareLattice& lattice,
                     CellPointsWorkspace& workspace, CellPoints& result) {
  prepare(lattice, workspace, result);
  std::vector<std::int32_t>& place_of = workspace.place_of;  // cells, until places are known
  place_of.resize(scan.size);
  find_cells(scan, lattice, place_of.data());
  count_points(place_of, workspace.count.data());
  const auto points = static_cast<std::size_t>(number_cells(workspace.count, result));
  result.points.resize(points);
  find_places(workspace.count.data(), place_of);
  place_points(scan, place_of.data(), result.points.data());
  for (const LatticeCell cell : result.cell) workspace.count[result.number_of(cell)] = 0;
}

}  // namespace mrpt_terrain
