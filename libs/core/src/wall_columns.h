// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "passed_beams.h"
#include "thing_pieces.h"

namespace mrpt_terrain {

/// Unites the pieces of walls that are seen at so flat an angle that columns of beams meet them
/// farther apart than cells are: three in a row, as high, with no column between any two that
/// follow each other. Two may be a thing and another one behind it.
/// \param pieces measured
/// \return whether there were any
bool link_wall_columns(const ThingPieces& pieces, const PassedBeams& beams);

}  // namespace mrpt_terrain
