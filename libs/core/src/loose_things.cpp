// SPDX-License-Identifier: BSD-3-Clause
#include "loose_things.h"

#include <cmath>

namespace mrpt_terrain {
namespace {

// Loose things are at most so high, metres, and have less than this share of sharp edges.
constexpr float kLow = 0.45F;
constexpr float kSharpShare = 0.3F;

bool are_loose(const ThingPiece& a, const ThingPiece& b) {
  return a.sharp + b.sharp < kSharpShare * std::max(1.0F, a.edges + b.edges);
}

}  // namespace

void link_loose_things(const ThingPieces& pieces) {
  const FieldClusterParams& params = pieces.params;
  const auto level = static_cast<float>(params.level);
  const GridGeometry& geometry = pieces.grid.geometry;
  const int reach = static_cast<int>(std::lround(params.unseen / geometry.cell_size()));
  CellBits& low = pieces.workspace.raised;
  low.clear(geometry);
  for (const std::int32_t member : pieces.workspace.points_of) {
    const ThingPiece& piece = *pieces.of(static_cast<std::size_t>(member));
    // With a swell, a thing would rather be raised ground.
    if (piece.high >= kLow ||
        is_swell(piece.above, piece.above + piece.raised, piece.sharp, piece.edges, params))
      continue;
    const CellIndex at = geometry.index_of(pieces.grid.cell[static_cast<std::size_t>(member)]);
    low.for_marked_before(at, reach, [&](CellIndex near) {
      const ThingPiece& other = *pieces.of(static_cast<std::size_t>(pieces.grid.slot_at(near)));
      if (&other == &piece || std::abs(other.top - piece.top) >= level) return;
      const int dl = near.l - at.l, dw = near.w - at.w;
      if (dl * dl + dw * dw > reach * reach || !are_loose(piece, other)) return;
      pieces.unite(piece.slot, other.slot);
    });
    low.mark(at);
  }
}

}  // namespace mrpt_terrain
