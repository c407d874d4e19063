// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {

/// Marks the cells in ditches and other hollows with steep sides: ground that the reference is not
/// to follow, because it would go down beside them, too. Requires weights and the plane.
///
/// Along rows or columns of the lattice, a cell in a ditch has smooth ground on both sides, up to
/// 4 m away, that is 12 cm to 0.8 m higher, goes on behind its edge, and is as high on one side as
/// on the other. And such ground is common around, while what lies as low as the cell is rare: a
/// gap in high grass, or a road between raised lawns, shows the ground instead.
/// \param[out] workspace in_ditch
void find_ditch_cells(const GroundSurface& surface, GroundSurfaceWorkspace& workspace);

}  // namespace mrpt_terrain
