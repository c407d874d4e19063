// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "passed_beams.h"
#include "thing_pieces.h"

namespace mrpt_terrain {

/// Unites long things that go on behind a gap through which no beam has passed, such as a wall
/// behind a car, and low ones that two rings meet, such as a curb.
/// \param pieces measured
void link_continued_things(const ThingPieces& pieces, const PassedBeams& beams);

}  // namespace mrpt_terrain
