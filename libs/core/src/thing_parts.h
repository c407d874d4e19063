// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/field_cells.h"

namespace mrpt_terrain {

/// Marks the parts of every cell where points above the ground or of raised ground lie. A point
/// that was not measured (BeamOrigins) stands for all parts of its cell.
/// \param raised height of each point above the ground around, 0 for those that are not raised
/// \param point_slots of the points in the grid
/// \param[out] cells parts
void mark_thing_parts(const ScanView& scan, const FieldPoints& points,
                      const std::vector<float>& raised, const PointSlots& point_slots,
                      const ElevationGrid& grid, FieldCells& cells);

}  // namespace mrpt_terrain
