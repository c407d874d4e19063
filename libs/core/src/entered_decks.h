// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "mrpt_terrain/core/decks.h"

namespace mrpt_terrain {

/// Whether a deck is something that beams enter.
[[nodiscard]] bool is_entered(const DeckDepth& deck);

/// Measures how far beams enter decks, as they do short grass that scatters them no more than a
/// surface would: away from its edges, a point here and a point there lies deep below the surface.
/// What a wheel can stand on has none there, and at a side many together. \param measured points of
/// the scan itself, the first ones; others are not looked at \param cells with numbers 0 to `decks`
/// - 1 of decks, and their planes \param deep metres below the surface from which on points count
/// \param[in,out] workspace `points` is read, `depth_of_deck` filled in
void measure_deck_depths(const PointsView& scan, const PointSlots& point_slots,
                         std::size_t measured, const ElevationGrid& grid, const FieldCells& cells,
                         float deep, std::int32_t decks, DeckWorkspace& workspace);

}  // namespace mrpt_terrain
