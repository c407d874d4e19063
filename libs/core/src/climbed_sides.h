// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/decks.h"
#include "mrpt_terrain/core/field_cells.h"

namespace mrpt_terrain {

/// Labels points of upright sides onto which the reference climbed, because one ring alone met them
/// between others on the ground: points that were ground by their heights where the reference
/// stands out of its own coarser level, on the lines of rings that run along a face
/// (`find_side_rings`).
/// \param field with its reference and labels; scratch memory of the reference is overwritten
/// \param reach metres: how far points may be off their line
/// \param workspace scratch memory, whatever it holds
/// \param[in,out] support per point of the scan; what is found becomes above
void label_climbed_sides(FieldWorkspace& field, float reach, DeckWorkspace& workspace,
                         std::vector<Support>& support);

}  // namespace mrpt_terrain
