// SPDX-License-Identifier: BSD-3-Clause
#include "entered_decks.h"

#include <algorithm>

#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Cells are away from the edges of a deck where nothing else is seen up to so many cells away, and
// so many of the 25 cells are its own.
constexpr int kToEdge = 2;
constexpr int kFewestAround = 18;
// A cell of fewer points tells nothing.
constexpr std::int32_t kFewestPoints = 4;
// Where more than one in so many points are deep, they are of a side or of a hole.
constexpr std::int32_t kOneDeepIn = 5;
// Beams enter a deck where they enter so many of its cells, and more than this share.
constexpr std::int32_t kFewestEntered = 3;
constexpr float kEnteredShare = 0.06F;

// Whether a cell of a deck is away from its edges.
bool is_inside(const ElevationGrid& grid, const std::vector<std::int32_t>& deck, std::size_t slot) {
  int own = 0, others = 0;
  for_slots_around(grid, slot, kToEdge,
                   [&](std::size_t near) { ++(deck[near] == deck[slot] ? own : others); });
  return others == 0 && own >= kFewestAround;
}

// Counts the points of every cell of a deck, and the deep ones.
void count_points(const PointsView& scan, const PointSlots& point_slots, std::size_t measured,
                  const FieldCells& cells, float deep, DeckWorkspace& workspace) {
  workspace.depth.assign(cells.size(), {});
  for (const std::int32_t point : workspace.points) {
    const auto i = static_cast<std::size_t>(point);
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (cells.deck[slot] < 0 || i >= measured) continue;
    DeckCellDepth& depth = workspace.depth[slot];
    ++depth.points;
    depth.deep += scan.z[i] < cells.deck_plane[slot].at(scan.x[i], scan.y[i]) - deep ? 1 : 0;
  }
}

}  // namespace

bool is_entered(const DeckDepth& deck) {
  return deck.entered >= kFewestEntered &&
         static_cast<float>(deck.entered) > kEnteredShare * static_cast<float>(deck.cells);
}

void measure_deck_depths(const PointsView& scan, const PointSlots& point_slots,
                         std::size_t measured, const ElevationGrid& grid, const FieldCells& cells,
                         float deep, std::int32_t decks, DeckWorkspace& workspace) {
  workspace.depth_of_deck.assign(static_cast<std::size_t>(decks), {});
  if (decks == 0) return;
  count_points(scan, point_slots, measured, cells, deep, workspace);
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    const DeckCellDepth& cell = workspace.depth[slot];
    if (cell.points < kFewestPoints || !is_inside(grid, cells.deck, slot)) continue;
    DeckDepth& deck = workspace.depth_of_deck[static_cast<std::size_t>(cells.deck[slot])];
    ++deck.cells;
    if (cell.deep == 0) continue;
    // A cell with many deep points takes one with few back: it may be beside it.
    deck.entered += cell.deep <= std::max(1, cell.points / kOneDeepIn) ? 1 : -1;
  }
}

}  // namespace mrpt_terrain
