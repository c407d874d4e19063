// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "passed_beams.h"
#include "thing_pieces.h"

namespace mrpt_terrain {

/// Unites what hangs above ground that is seen with its legs: narrow things beside it that end
/// there. And three or four posts at the corners of a rectangle, which carry something that no ring
/// meets. \param pieces measured
void link_carried_things(const ThingPieces& pieces);

/// Unites two walls opposite each other that are as high and long as abutments of a bridge; one may
/// be hidden in part.
/// \param pieces measured
/// \param beams null: unknown
void link_abutments(const ThingPieces& pieces, const PassedBeams* beams);

}  // namespace mrpt_terrain
