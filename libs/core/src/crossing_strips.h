// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thing_pieces.h"

namespace mrpt_terrain {

/// Divides low pieces with sharp edges that consist of straight strips, such as kerbs that cross or
/// run side by side with the ground seen between them, into these strips. A low area, such as a
/// ramp or a lawn, stays one.
/// \param pieces measured and listed; their cells get new parents, so they have to be measured
/// again. Those that were divided since stay as they are.
/// \returns whether any was divided
bool divide_crossing_strips(const ThingPieces& pieces);

}  // namespace mrpt_terrain
