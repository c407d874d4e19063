// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// A square of `side` x `side` cells about the frame's origin, for what is looked up with fixed
/// strides. Cell (l, w) covers [l - side/2, l - side/2 + 1) x [...) cell sizes; its number is
/// l * side + w.
struct SquareLattice {
  int side = 0;
  float cell_size = 0.0F;  ///< metres

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  }
  /// Centre of a row or column of cells, metres.
  [[nodiscard]] float centre(std::int32_t index) const {
    return (static_cast<float>(index - side / 2) + 0.5F) * cell_size;
  }
  /// Number of the cell that holds a place, or -1 outside and for what is not finite.
  [[nodiscard]] std::int32_t cell_at(float x, float y) const {
    const float half = 0.5F * static_cast<float>(side);
    const float per_metre = 1.0F / cell_size;
    const float l = x * per_metre + half;
    const float w = y * per_metre + half;
    const auto end = static_cast<float>(side);
    if (!(l >= 0.0F && l < end && w >= 0.0F && w < end)) return -1;
    return static_cast<std::int32_t>(l) * side + static_cast<std::int32_t>(w);
  }
};

/// Row and column of a cell of a `SquareLattice`.
struct LatticeCell {
  std::int32_t row, column;
};

/// A point, and its place in the scan.
struct CellPoint {
  float x, y, z;  ///< metres
  std::int32_t index;
};

/// The points of a scan, brought together cell by cell. Occupied cells are numbered ("slots") in
/// the order of their cells; the points of slot s are `[first[s], first[s + 1])`, in the order of
/// the scan.
struct CellPoints {
  SquareLattice lattice;
  std::vector<LatticeCell> cell;      ///< per slot
  std::vector<std::int32_t> first;    ///< per slot, and one more
  std::vector<std::int32_t> slot_of;  ///< per cell of the lattice: its slot, or -1
  std::vector<CellPoint> points;      ///< frame of the scan

  [[nodiscard]] std::size_t occupied() const { return cell.size(); }
  /// Number of a cell in arrays over the lattice.
  [[nodiscard]] std::size_t number_of(LatticeCell at) const {
    return static_cast<std::size_t>(at.row * lattice.side + at.column);
  }
};

/// Scratch memory of `sort_into_cells`.
struct CellPointsWorkspace {
  /// Per point of the scan: its place in `CellPoints::points`, or -1.
  std::vector<std::int32_t> place_of;
  std::vector<std::int32_t> count;  ///< per cell; all 0 between calls
};

/// Brings the points of a scan together cell by cell. Points outside the lattice or with a
/// coordinate that is not finite are left out. The cost is that of the points plus one look at
/// every cell of the lattice.
/// \param[in,out] result overwritten; keeps its memory
void sort_into_cells(const PointsView& scan, const SquareLattice& lattice,
                     CellPointsWorkspace& workspace, CellPoints& result);

}  // namespace mrpt_terrain
