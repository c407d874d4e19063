// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/decks.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain {
namespace {

// Cells of a deck are at most this many cells apart: rings leave gaps.
constexpr int kReach = 3;
// Height that two cells of a deck may differ by besides its slope, metres.
constexpr float kSlack = 0.04F;
// A deck of fewer cells shows no surface.
constexpr std::size_t kFewestCells = 4;
// Fewest triples of cells in a row that tell how even a deck is.
constexpr int kFewestTriples = 3;

float height_of(const FieldCells& cells, std::size_t slot) {
  return cells.ground[slot] + 0.5F * (cells.low[slot] + cells.high[slot]);
}

float above_ground(const FieldCells& cells, std::size_t slot) {
  return 0.5F * (cells.low[slot] + cells.high[slot]);
}

/// The search for one deck.
struct DeckSearch {
  const ElevationGrid& grid;
  const FieldCells& cells;
  float rise;  ///< greatest difference in height per metre

  [[nodiscard]] bool connected(std::size_t a, std::size_t b, float distance) const {
    const float step = std::abs(height_of(cells, a) - height_of(cells, b));
    return step <= kSlack + rise * distance;
  }
};

void collect_members(const DeckSearch& search, std::size_t first, DeckWorkspace& workspace) {
  const GridGeometry& geometry = search.grid.geometry;
  const auto cell_size = static_cast<float>(geometry.cell_size());
  workspace.members.assign(1, static_cast<std::int32_t>(first));
  workspace.candidate[first] = 0;
  for (std::size_t next = 0; next < workspace.members.size(); ++next) {
    const auto slot = static_cast<std::size_t>(workspace.members[next]);
    const CellIndex at = geometry.index_of(search.grid.cell[slot]);
    for (int l = at.l - kReach; l <= at.l + kReach; ++l) {
      for (int w = at.w - kReach; w <= at.w + kReach; ++w) {
        const Slot other = search.grid.slot_at({l, w});
        if (other == kUnobserved || workspace.candidate[static_cast<std::size_t>(other)] == 0)
          continue;
        const float distance =
            cell_size * std::hypot(static_cast<float>(l - at.l), static_cast<float>(w - at.w));
        if (!search.connected(slot, static_cast<std::size_t>(other), distance)) continue;
        workspace.candidate[static_cast<std::size_t>(other)] = 0;
        workspace.members.push_back(other);
      }
    }
  }
}

// RMS of the height of a cell against the mean of those before and behind it in its row or column;
// negative if there are too few such triples.
double unevenness_of(const DeckSearch& search, std::int32_t deck, const DeckWorkspace& workspace) {
  const GridGeometry& geometry = search.grid.geometry;
  double sum = 0.0;
  int triples = 0;
  for (const std::int32_t member : workspace.members) {
    const auto slot = static_cast<std::size_t>(member);
    const CellIndex at = geometry.index_of(search.grid.cell[slot]);
    for (const CellIndex step :
         {CellIndex{1, 0}, CellIndex{0, 1}, CellIndex{1, 1}, CellIndex{1, -1}}) {
      const Slot before = search.grid.slot_at({at.l - step.l, at.w - step.w});
      const Slot behind = search.grid.slot_at({at.l + step.l, at.w + step.w});
      if (before == kUnobserved || behind == kUnobserved) continue;
      const auto b = static_cast<std::size_t>(before), f = static_cast<std::size_t>(behind);
      if (workspace.number[b] != deck || workspace.number[f] != deck) continue;
      const float bend = height_of(search.cells, slot) -
                         0.5F * (height_of(search.cells, b) + height_of(search.cells, f));
      sum += double{bend} * bend;
      ++triples;
    }
  }
  return triples < kFewestTriples ? -1.0 : std::sqrt(sum / triples);
}

struct DeckSize {
  float lowest, highest;  // metres above the ground
  double length;          // metres, diagonal of the rectangle around it
};

DeckSize size_of(const DeckSearch& search, const DeckWorkspace& workspace) {
  DeckSize size{1e9F, -1e9F, 0.0};
  CellIndex low{1 << 30, 1 << 30}, high{-1, -1};
  for (const std::int32_t member : workspace.members) {
    const auto slot = static_cast<std::size_t>(member);
    size.lowest = std::min(size.lowest, above_ground(search.cells, slot));
    size.highest = std::max(size.highest, above_ground(search.cells, slot));
    const CellIndex at = search.grid.geometry.index_of(search.grid.cell[slot]);
    low = {std::min(low.l, at.l), std::min(low.w, at.w)};
    high = {std::max(high.l, at.l), std::max(high.w, at.w)};
  }
  size.length =
      search.grid.geometry.cell_size() * std::hypot(high.l - low.l + 1, high.w - low.w + 1);
  return size;
}

bool within_reach(const DeckSearch& search, const DeckParams& params, std::int32_t deck,
                  const DeckWorkspace& workspace) {
  if (workspace.members.size() < kFewestCells) return false;
  const DeckSize size = size_of(search, workspace);
  const double cell = search.grid.geometry.cell_size();
  const double area = static_cast<double>(workspace.members.size()) * cell * cell;
  const bool ramp = size.lowest <= params.foot && size.highest - size.lowest >= params.least_rise;
  const bool curb = size.highest <= params.curb_height && size.length >= params.curb_length;
  const bool terrace = size.lowest <= params.terrace_height && area >= params.terrace_area;
  if (!ramp && !curb && !terrace) return false;
  const double unevenness = unevenness_of(search, deck, workspace);
  return unevenness >= 0.0 && unevenness <= params.unevenness;
}

}  // namespace

void find_decks(const ElevationGrid& grid, const GroundSegmentation& ground,
                const DeckParams& params, DeckWorkspace& workspace, FieldCells& cells) {
  const std::size_t n = grid.observed();
  workspace.candidate.resize(n);
  workspace.number.assign(n, -1);
  cells.deck.assign(n, -1);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const bool thin = cells.high[slot] - cells.low[slot] <= static_cast<float>(params.thickness);
    workspace.candidate[slot] = ground.rule[slot] == GroundRule::kHigh && thin ? 1 : 0;
  }
  const DeckSearch search{grid, cells, static_cast<float>(std::tan(params.max_slope))};
  std::int32_t tried = 0;
  std::int32_t found = 0;
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (workspace.candidate[slot] == 0) continue;
    collect_members(search, slot, workspace);
    for (const std::int32_t member : workspace.members)
      workspace.number[static_cast<std::size_t>(member)] = tried;
    if (within_reach(search, params, tried, workspace)) {
      for (const std::int32_t member : workspace.members)
        cells.deck[static_cast<std::size_t>(member)] = found;
      ++found;
    }
    ++tried;
  }
}

}  // namespace mrpt_terrain
