// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thing_pieces.h"

namespace mrpt_terrain {

/// Unites low pieces without sharp edges, such as those of a lawn, that are as high as each other
/// and no farther apart than raised ground where nothing was seen.
/// \param pieces measured
void link_loose_things(const ThingPieces& pieces);

}  // namespace mrpt_terrain
