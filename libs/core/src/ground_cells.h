// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {

/// Low heights and roughness of all cells, and the weights that follow from them.
/// \param origins of the beams; unknown ones are taken to be 1 m above that of the frame
void measure_ground_cells(const BeamOrigins& origins, const GroundSurfaceParams& params,
                          GroundSurfaceWorkspace& workspace, GroundSurface& surface);

/// The same for heights above a level of the reference, which follows slopes that the cells' own
/// lowest points do not: replaces low heights and weights, keeps the roughness.
void measure_above_level(const GroundSurfaceParams& params, int level,
                         GroundSurfaceWorkspace& workspace, GroundSurface& surface);

}  // namespace mrpt_terrain
