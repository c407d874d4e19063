// SPDX-License-Identifier: BSD-3-Clause
#include "loose_things.h"

#include <cmath>

namespace mrpt_terrain {
namespace {

// Loose things are at most so high, metres, and have less than this share of sharp edges.
constexpr float kLow = 0.45F;
constexpr float kSharpShare = 0.3F;

// Together with a swell, a loose thing would rather be one.
bool is_loose(const ThingPiece& piece, const FieldClusterParams& params) {
  return piece.high < kLow && piece.sharp < kSharpShare * std::max(1.0F, piece.edges) &&
         !is_swell(piece.above, piece.above + piece.raised, piece.sharp, piece.edges, params);
}

}  // namespace

void link_loose_things(const ThingPieces& pieces) {
  const FieldClusterParams& params = pieces.params;
  const auto level = static_cast<float>(params.level);
  const GridGeometry& geometry = pieces.grid.geometry;
  const int reach = static_cast<int>(std::lround(params.unseen / geometry.cell_size()));
  std::vector<std::int32_t>& loose = pieces.workspace.steps_of;
  loose.clear();
  for (const ThingPiece& piece : pieces.all()) loose.push_back(is_loose(piece, params) ? 1 : 0);
  CellBits& low = pieces.workspace.raised;
  low.clear(geometry);
  for (const std::int32_t member : pieces.workspace.points_of) {
    const std::int32_t number = pieces.workspace.number_of[static_cast<std::size_t>(member)];
    if (loose[static_cast<std::size_t>(number)] == 0) continue;
    const ThingPiece& piece = pieces.all()[static_cast<std::size_t>(number)];
    const CellIndex at = geometry.index_of(pieces.grid.cell[static_cast<std::size_t>(member)]);
    low.for_marked_before(at, reach, [&](CellIndex near) {
      const ThingPiece& other = *pieces.of(static_cast<std::size_t>(pieces.grid.slot_at(near)));
      if (&other == &piece || std::abs(other.top - piece.top) >= level) return;
      const int dl = near.l - at.l, dw = near.w - at.w;
      if (dl * dl + dw * dw <= reach * reach) pieces.unite(piece.slot, other.slot);
    });
    low.mark(at);
  }
}

}  // namespace mrpt_terrain
