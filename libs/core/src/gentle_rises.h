// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thing_pieces.h"

namespace mrpt_terrain {

/// Marks things that are rises of the ground, which the reference does not follow: low, mostly
/// above it, none of their cells upright, and with hardly a step to the ground that is seen beside
/// them.
/// \param[out] pieces.workspace.gentle per slot that stands for a thing: 1 if it is such a rise
void find_gentle_rises(const ThingPieces& pieces);

}  // namespace mrpt_terrain
