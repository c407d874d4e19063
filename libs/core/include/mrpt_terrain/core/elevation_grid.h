// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Extent and resolution of the elevation grid.
struct GridParams {
  double length = 5.0;      ///< L, extent along x, metres
  double width = 5.0;       ///< W, extent along y, metres
  double cell_size = 0.05;  ///< c_size, side of a cell, metres
  double max_height = 1.5;  ///< points at this height or above are not considered, metres

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.length, ParamInfo{"length", "L", "m", 0.1, 1000.0, "extent of the map along x"});
    visit(self.width, ParamInfo{"width", "W", "m", 0.1, 1000.0, "extent of the map along y"});
    visit(self.cell_size, ParamInfo{"cell_size", "c_size", "m", 0.01, 10.0, "side of a cell"});
    visit(self.max_height, ParamInfo{"max_height", "", "m", -100.0, 1000.0,
                                     "points at this height or above are left out"});
  }
};

/// Number of an observed cell: its place in the arrays of `ElevationGrid`.
using Slot = std::int32_t;
/// Slot of cells that no point has hit.
inline constexpr Slot kUnobserved = -1;

/// Elevation grid of one scan: heights of every cell that holds at least one point.
///
/// Only observed cells have entries in the height arrays: "slots", sorted by `CellId` (row by
/// row), so that nothing depends on the order of the points. `slot_of` leads from a cell to its
/// slot. All heights are metres in the frame of the points.
struct ElevationGrid {
  GridGeometry geometry;
  std::vector<Slot> slot_of;     ///< per CellId, frame included: slot, or kUnobserved
  std::vector<CellId> cell;      ///< per slot: which cell it is
  std::vector<float> h_min;      ///< per slot: smallest height
  std::vector<float> h_max;      ///< per slot: greatest height
  std::vector<float> h_mean;     ///< per slot: mean height
  std::vector<MomentSums> sums;  ///< per slot: what covariances need, about the frame's origin

  /// Number of observed cells.
  [[nodiscard]] std::size_t observed() const { return cell.size(); }
  /// Slot of a cell; kUnobserved also for cells outside the grid.
  [[nodiscard]] Slot slot_at(CellIndex index) const {
    return geometry.contains(index) ? slot_within(index) : kUnobserved;
  }
  /// The same for a cell that is known to lie in the grid.
  [[nodiscard]] Slot slot_within(CellIndex index) const {
    return slot_of[static_cast<std::size_t>(value_of(geometry.id_of(index)))];
  }
  /// Number, mean and scatter of the points of a slot.
  [[nodiscard]] Moments moments(std::size_t slot) const { return moments_from(sums[slot]); }
  /// h_diff of the paper: h_max - h_min of a slot.
  [[nodiscard]] float h_diff(std::size_t slot) const { return h_max[slot] - h_min[slot]; }
};

/// Leaves a grid without observed cells. It keeps its memory, and where the geometry stays the same
/// the cost is that of the cells that were observed before.
void clear_grid(const GridGeometry& geometry, ElevationGrid& grid);

/// How many points became what when the grid was built; the four add up to the number of points.
struct ProjectionCounts {
  std::size_t in_map = 0;
  std::size_t not_finite = 0;
  std::size_t too_high = 0;
  std::size_t outside_map = 0;
};

/// Slot of every point, or for points without one the negative code of the reason.
using PointSlots = std::vector<std::int32_t>;
[[nodiscard]] constexpr std::int32_t point_slot_of(UnknownReason reason) {
  return -1 - static_cast<std::int32_t>(reason);
}
/// The reason why a point has no slot; kNone if it has one.
[[nodiscard]] constexpr UnknownReason reason_of(std::int32_t point_slot) {
  return point_slot >= 0 ? UnknownReason::kNone : static_cast<UnknownReason>(-1 - point_slot);
}

/// Scratch memory of `build_elevation_grid`; empty of any scan between calls.
struct ElevationGridWorkspace {
  std::vector<std::uint8_t> hit;  ///< per CellId: a point fell into it
};

/// Projects points into the grid (paper, section "Elevation grid map") and gathers the heights and
/// moments of each cell. Points that are not finite, at or above `max_height`, or outside the grid
/// are counted and otherwise ignored.
///
/// \param points in the robot frame, metres
/// \param[in,out] grid overwritten; keeps its memory, so that equal geometry does not allocate
/// \param[out] point_slots per point: its slot, or a reason why it has none
/// \param heights per point: what `max_height` limits, metres; null: its z
ProjectionCounts build_elevation_grid(const PointsView& points, const GridParams& params,
                                      ElevationGridWorkspace& workspace, ElevationGrid& grid,
                                      PointSlots& point_slots, const float* heights = nullptr);

}  // namespace mrpt_terrain
