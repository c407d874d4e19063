// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thing_pieces.h"

namespace mrpt_terrain {

/// Divides pieces that are low for the most part, such as a lawn or a kerb, from what stands in
/// them: cells with points well above the others, many of them upright, with a step down to the low
/// ones all around. What rises gradually, such as a ramp, stays one.
/// \param pieces measured; their cells get new parents, so they have to be measured again
/// \returns whether any was divided
bool divide_standing_things(const ThingPieces& pieces);

}  // namespace mrpt_terrain
