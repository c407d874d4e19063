// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/decks.h"

#include <algorithm>
#include <cmath>

#include "height_plane.h"
#include "mrpt_terrain/core/beam_slope.h"

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
    const int first_w = std::max(at.w - kReach, 0);
    const int last_w = std::min(at.w + kReach, geometry.cells_w() - 1);
    for (int l = std::max(at.l - kReach, 0); l <= std::min(at.l + kReach, geometry.cells_l() - 1);
         ++l) {
      const Slot* slots = search.grid.slot_of.data() + value_of(geometry.id_of({l, 0}));
      for (int w = first_w; w <= last_w; ++w) {
        const Slot other = slots[w];
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

// RMS of the height of a cell against the mean of those before and behind it, in four directions;
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
  for (const std::int32_t member : workspace.members) {
    const auto slot = static_cast<std::size_t>(member);
    size.lowest = std::min(size.lowest, above_ground(search.cells, slot));
    size.highest = std::max(size.highest, above_ground(search.cells, slot));
  }
  const CellBox box = cells_around(search.grid, all_of(workspace.members), 0.0);
  size.length = search.grid.geometry.cell_size() *
                std::hypot(box.high.l - box.low.l + 1, box.high.w - box.low.w + 1);
  return size;
}

// RMS of the cells' heights about the plane of least squares through them, metres; a plane that is
// steeper than permitted fits nothing.
double scatter_about_plane(const DeckSearch& search, const DeckParams& params,
                           const DeckWorkspace& workspace) {
  constexpr double kNoPlane = 1e9;
  MomentSums sums;
  for (const std::int32_t member : workspace.members) {
    const auto slot = static_cast<std::size_t>(member);
    const Position2 at =
        search.grid.geometry.centre_of(search.grid.geometry.index_of(search.grid.cell[slot]));
    sums.add(at.x, at.y, height_of(search.cells, slot));
  }
  const Moments moments = moments_from(sums);
  HeightPlane plane;
  if (!fit_height_plane(moments, plane)) return kNoPlane;
  if (std::hypot(plane.gradient_x, plane.gradient_y) > std::tan(params.max_slope)) return kNoPlane;
  return std::sqrt(plane.squares / moments.n);
}

enum class DeckKind { kNone, kRamp, kLevel };

DeckKind kind_of(const DeckSearch& search, const DeckParams& params, std::int32_t deck,
                 const DeckWorkspace& workspace) {
  if (workspace.members.size() < kFewestCells) return DeckKind::kNone;
  const DeckSize size = size_of(search, workspace);
  const double cell = search.grid.geometry.cell_size();
  const double area = static_cast<double>(workspace.members.size()) * cell * cell;
  const double rise = size.highest - size.lowest;
  const bool ramp = size.lowest <= params.foot && rise >= params.least_rise &&
                    scatter_about_plane(search, params, workspace) <= params.bent * rise;
  const bool curb = size.highest <= params.curb_height && size.length >= params.curb_length;
  const bool terrace = size.lowest <= params.terrace_height && area >= params.terrace_area;
  if (!ramp && !curb && !terrace) return DeckKind::kNone;
  const double unevenness = unevenness_of(search, deck, workspace);
  if (unevenness < 0.0 || unevenness > params.unevenness) return DeckKind::kNone;
  return curb ? DeckKind::kLevel : DeckKind::kRamp;
}

// Top of a deck at a cell: of the cell and those of the deck beside it.
float top_at(const DeckSearch& search, std::size_t slot, std::int32_t deck,
             const DeckWorkspace& workspace) {
  const CellIndex at = search.grid.geometry.index_of(search.grid.cell[slot]);
  float top = search.cells.high[slot];
  for (int l = at.l - 1; l <= at.l + 1; ++l) {
    for (int w = at.w - 1; w <= at.w + 1; ++w) {
      const Slot other = search.grid.slot_at({l, w});
      if (other == kUnobserved) continue;
      const auto o = static_cast<std::size_t>(other);
      if (workspace.number[o] == deck) top = std::max(top, search.cells.high[o]);
    }
  }
  return top;
}

}  // namespace

void find_decks(const ElevationGrid& grid, const GroundSegmentation& ground,
                const DeckParams& params, DeckWorkspace& workspace, FieldCells& cells) {
  const std::size_t n = grid.observed();
  workspace.candidate.resize(n);
  workspace.number.assign(n, -1);
  cells.deck.assign(n, -1);
  cells.deck_low.assign(n, 0.0F);
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
    const DeckKind kind = kind_of(search, params, tried, workspace);
    if (kind != DeckKind::kNone) {
      for (const std::int32_t member : workspace.members) {
        const auto s = static_cast<std::size_t>(member);
        cells.deck[s] = found;
        cells.deck_low[s] = kind == DeckKind::kRamp ? cells.low[s]
                                                    : top_at(search, s, tried, workspace) -
                                                          static_cast<float>(params.side);
      }
      ++found;
    }
    ++tried;
  }
}

}  // namespace mrpt_terrain
