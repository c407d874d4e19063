// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/decks.h"

namespace mrpt_terrain {

/// Finds the upright sides of decks: seen from above, their points lie on lines. Of the points of
/// each deck the line through most of them is one, along a stretch without long gaps; then that of
/// those left over, and so on. Where points lie beside the line as they do on it, it is none.
/// \param reach metres: how far points may be off their line
/// \param[in,out] points of sides; used up
/// \param buckets scratch memory
/// \param[out] sides sorted by deck
void find_deck_sides(float reach, std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets,
                     std::vector<DeckSide>& sides);

/// Finds sides that one ring alone meets near their edge, so that it was taken for the surface.
/// From above such a ring is straight, while its height falls to both ends, as its beams go down
/// with distance; on a surface that a wheel can stand on it would bend, too.
/// \param reach metres: how far points may be off their line
/// \param[in,out] points on the surfaces of decks; used up
/// \param buckets scratch memory
/// \param[in,out] sides sorted by deck; those that are found are added
void find_side_rings(float reach, std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets,
                     std::vector<DeckSide>& sides);

/// Whether a place is at most `reach` metres off one of the sides of a deck.
[[nodiscard]] bool is_on_side(const std::vector<DeckSide>& sides, std::int32_t deck, float x,
                              float y, float reach);

}  // namespace mrpt_terrain
