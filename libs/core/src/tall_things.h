// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {

/// Finds the cells that are part of something tall or stand beside it: `workspace.beside_tall`, 0
/// or 1 per slot.
///
/// Where rings are far apart, the foot of a tree, a hedge or a vehicle may be all that is seen for
/// metres around, by one ring, which looks as smooth as a road. What gives it away is what stands
/// above it: low heights of other cells, 3 m to 6 m away at most, that are 1.6 m to 3.2 m higher
/// (with cells of 0.4 m; both grow with them). Those are of the thing, too, so that as much lower
/// ones count the same. Slopes of less than 1 : 4 about the plane do not differ that much. Where
/// the ground at a thing's foot is seen in all of its cells, their low heights are those of the
/// ground, and nothing is found.
/// \param surface cells, low heights and plane
void find_tall_things(const GroundSurface& surface, GroundSurfaceWorkspace& workspace);

}  // namespace mrpt_terrain
