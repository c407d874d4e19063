// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/holes.h"

namespace mrpt_terrain {

/// Takes cells back that lie below the ground only because of a few points, or because of points
/// that cannot be where they seem to be: reflections in windows and water put ground far below the
/// ground. The beam of such a point passes through ground that others have met.
/// \param least_points a group of low cells needs so many points below the ground
/// \param[out] workspace `stray` marks the points that their own beams speak against
/// \param[in,out] ground low cells without support become ground
void take_back_stray_cells(const HoleInput& input, int least_points, const FieldCells& cells,
                           HoleWorkspace& workspace, GroundSegmentation& ground);

}  // namespace mrpt_terrain
