// SPDX-License-Identifier: BSD-3-Clause
#include "gentle_rises.h"

namespace mrpt_terrain {
namespace {

// Gentle rises are lower than this above the reference, and their points extend over less height in
// each cell, metres: less than the side of any thing that beams meet.
constexpr float kLow = 0.45F;
constexpr float kUpright = 0.1F;
// A step leads down to less than this share of a cell's mean height, at most so many cells away.
constexpr float kStep = 0.5F;
constexpr int kReach = 2;
// A deck is a step up from the ground around it: of the edges of one, at least this share are
// steps.
constexpr float kDeckSteps = 0.5F;

/// Steps of a cell down to the ground beside, and its edges to the ground that are none.
struct Edges {
  std::int32_t steps = 0, gentle = 0;
};

// The edges of raised ground are known, against the plane of the ground around.
Edges edges_of(const ThingPieces& pieces, std::size_t slot) {
  const FieldCells& cells = pieces.cells;
  if (cells.above[slot] == 0) return {cells.sharp_edges[slot], cells.smooth_edges[slot]};
  const ElevationGrid& grid = pieces.grid;
  const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
  const float height = 0.5F * (low_of(cells, slot) + high_of(cells, slot));
  Edges edges;
  for (const CellIndex direction :
       {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
    Slot other = kUnobserved;
    for (int k = 1; k <= kReach && other == kUnobserved; ++k)
      other = grid.slot_at({at.l + k * direction.l, at.w + k * direction.w});
    if (other == kUnobserved) continue;
    const auto beside = static_cast<std::size_t>(other);
    if (!pieces.ground.is_ground(beside) || cells.raised[beside] > 0 || cells.on[beside] == 0)
      continue;
    const bool step = cells.floor[beside] - cells.ground[beside] < kStep * height;
    ++(step ? edges.steps : edges.gentle);
  }
  return edges;
}

}  // namespace

void find_gentle_rises(const ThingPieces& pieces) {
  FieldClusterWorkspace& workspace = pieces.workspace;
  const FieldCells& cells = pieces.cells;
  const std::vector<std::int32_t>& members = workspace.points_of;
  std::vector<std::int32_t>& surplus = workspace.border_of;  // points above less raised ones
  std::vector<float>& balance = workspace.tops;              // steps less their least share
  std::vector<std::int32_t>& decks = workspace.steps_of;     // cells of decks less others
  workspace.gentle.assign(cells.size(), 0);
  surplus.resize(cells.size());
  balance.resize(cells.size());
  decks.resize(cells.size());
  for (const std::int32_t member : members) {
    const auto slot = static_cast<std::size_t>(member);
    workspace.parent[slot] = root_of(workspace.parent, member);
    const auto root = static_cast<std::size_t>(workspace.parent[slot]);
    if (root == slot) {  // the first of its cells
      workspace.gentle[root] = 1;
      surplus[root] = 0;
      balance[root] = 0.0F;
      decks[root] = 0;
    }
    if (workspace.gentle[root] == 0) continue;
    surplus[root] += cells.above[slot] - cells.raised[slot];
    const bool deck = cells.deck[slot] >= 0;
    decks[root] += deck ? 1 : -1;
    const float low = low_of(cells, slot), high = high_of(cells, slot);
    if ((high >= kLow && !deck) || high - low >= kUpright) workspace.gentle[root] = 0;
  }
  const auto sharp = static_cast<float>(pieces.params.sharp);
  for (const std::int32_t member : members) {
    const auto root = static_cast<std::size_t>(workspace.parent[static_cast<std::size_t>(member)]);
    if (workspace.gentle[root] == 0 || surplus[root] <= 0) continue;
    const Edges edges = edges_of(pieces, static_cast<std::size_t>(member));
    const auto steps = static_cast<float>(edges.steps), gentle = static_cast<float>(edges.gentle);
    const float least = decks[root] > 0 ? kDeckSteps : sharp;
    balance[root] += steps - least * (steps + gentle);
  }
  for (const std::int32_t member : members) {
    const auto slot = static_cast<std::size_t>(member);
    if (workspace.gentle[slot] != 0 && balance[slot] >= 0.0F) workspace.gentle[slot] = 0;
  }
}

}  // namespace mrpt_terrain
