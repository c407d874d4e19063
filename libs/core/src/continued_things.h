// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "thing_pieces.h"

namespace mrpt_terrain {

/// Unites long things that go on behind a gap through which no beam has passed, such as a wall
/// behind a car, and low ones that two rings meet, such as a curb.
/// \param pieces measured
/// \param sensor where the beams begin, frame of the grid, metres
void link_continued_things(const ThingPieces& pieces, const std::array<float, 3>& sensor);

}  // namespace mrpt_terrain
