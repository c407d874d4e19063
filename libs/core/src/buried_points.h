// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {

/// Finds points below ground that their beams would have had to pass through: ends of beams that
/// were reflected, by glass or water. Seen from the point, the beam runs below what other points
/// show and comes out of it without a jump; beams that go down behind an edge, or below a roof, do
/// not.
///
/// Of cells whose low points are few, as `lowest` and `part` of the workspace have it: others are
/// not looked at. Nothing is found where origins are unknown.
///
/// \param band metres: two points that show ground lie no further apart in height
/// \param surface points by cell, and their low heights
/// \param[in,out] workspace `buried` is filled in: cells with such points, and their other points
void find_buried_points(const BeamOrigins& origins, float band, const GroundSurface& surface,
                        GroundSurfaceWorkspace& workspace);

}  // namespace mrpt_terrain
