// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {

/// Heights on the centres of the cells of one level, linear between four of them.
struct LevelView {
  const float* height;
  int side;         ///< cells
  float cell_size;  ///< metres

  /// Height and gradient at a place; beyond the outermost centres that of the nearest place.
  struct Linear {
    float height, gradient_x, gradient_y;
  };
  [[nodiscard]] Linear at(float x, float y) const {
    const float half = 0.5F * static_cast<float>(side) - 0.5F;
    return between(step_at(x / cell_size + half), step_at(y / cell_size + half));
  }
  /// The same at the centre of a cell of the level that is `level` levels finer.
  [[nodiscard]] Linear at_cell(LatticeCell cell, int level) const {
    return between(step_of(cell.row, level), step_of(cell.column, level));
  }
  /// Where a row or column lies, in units of cells from the first centre.
  [[nodiscard]] LevelStep step_at(float u) const {
    const float inside = std::min(std::max(u, 0.0F), static_cast<float>(side - 1));
    const std::int32_t first = std::min(static_cast<std::int32_t>(inside), side - 2);
    return {first, inside - static_cast<float>(first)};
  }
  /// Where the centre of the row or column `index` of the level that is `level` levels finer lies.
  [[nodiscard]] LevelStep step_of(std::int32_t index, int level) const {
    return step_at((static_cast<float>(index) + 0.5F) / static_cast<float>(1 << level) - 0.5F);
  }
  /// Heights at four centres.
  struct Corners {
    float low_left, low_right, high_left, high_right;
  };
  [[nodiscard]] Corners corners_of(LevelStep row, LevelStep column) const {
    const float* q = height + static_cast<std::ptrdiff_t>(row.first) * side + column.first;
    return {q[0], q[1], q[side], q[side + 1]};
  }
  /// Height and gradient between four centres.
  [[nodiscard]] Linear between(const Corners& q, LevelStep row, LevelStep column) const {
    const float low = q.low_left + column.share * (q.low_right - q.low_left);
    const float high = q.high_left + column.share * (q.high_right - q.high_left);
    const float left = q.low_left + row.share * (q.high_left - q.low_left);
    const float right = q.low_right + row.share * (q.high_right - q.low_right);
    return {low + row.share * (high - low), (high - low) / cell_size, (right - left) / cell_size};
  }
  [[nodiscard]] Linear between(LevelStep row, LevelStep column) const {
    return between(corners_of(row, column), row, column);
  }
};

/// Level `level` of the workspace. Requires that it has been made.
[[nodiscard]] LevelView view_of_level(const GroundSurfaceWorkspace& workspace,
                                      const SquareLattice& lattice, int level);

/// The finest level, which is the reference.
[[nodiscard]] inline LevelView view_of(const GroundSurface& surface) {
  return {surface.node.data(), surface.lattice().side, surface.lattice().cell_size};
}

/// Where the centres of all rows, and so columns, of the finest level lie in the level `level`.
void find_steps(const LevelView& view, const SquareLattice& lattice, int level,
                std::vector<LevelStep>& step);

/// From this level on, of 3.2 m, all that is near a place may be one ring on a bush. Cells beside
/// something tall lift these levels by less than rough ground may, and count for less where they
/// do. If they are ground after all, finer levels follow it.
inline constexpr int kCoarseLevel = 3;

/// Takes over what the cells say of the ground, for a level and the finer ones down to the next
/// call or to `kCoarseLevel`, whichever comes first.
void hear_cells(const GroundSurface& surface, int level, GroundSurfaceWorkspace& workspace);

/// Makes the coarsest level from the plane.
void start_levels(const GroundSurface& surface, GroundSurfaceWorkspace& workspace);

/// Makes a level from the next coarser one, which must exist, and the low heights of the cells.
void refine_level(const GroundSurfaceParams& params, int level, GroundSurfaceWorkspace& workspace,
                  const GroundSurface& surface);

/// Moves a level, which must exist, towards the low heights of the cells.
void correct_level(const GroundSurfaceParams& params, int level, GroundSurfaceWorkspace& workspace,
                   const GroundSurface& surface);

}  // namespace mrpt_terrain
