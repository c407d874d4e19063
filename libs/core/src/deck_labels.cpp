// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "deck_sides.h"
#include "mrpt_terrain/core/decks.h"
#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Points higher above the ground may be of a deck's side, metres...
constexpr float kLeastSide = 0.03F;
// ...and are, whatever the ground around is like, where they are so high and on its line.
constexpr float kSideFoot = 0.07F;

/// Where points of sides lie, in parts of cells.
struct SideMap {
  const ElevationGrid& grid;
  std::vector<std::uint64_t>& parts;  ///< per slot: one bit for each of 8 x 8 parts

  [[nodiscard]] int part_of(double position, double half, int cells) const {
    const double place = (position + half) / grid.geometry.cell_size() * kParts;
    return std::min(static_cast<int>(place), cells * kParts - 1);
  }
  [[nodiscard]] CellIndex part_at(double x, double y) const {
    return {part_of(x, grid.geometry.half_length(), grid.geometry.cells_l()),
            part_of(y, grid.geometry.half_width(), grid.geometry.cells_w())};
  }
  static std::uint64_t bit_of(CellIndex part) {
    return std::uint64_t{1} << ((part.l % kParts) * kParts + part.w % kParts);
  }
  void mark(std::size_t slot, double x, double y) { parts[slot] |= bit_of(part_at(x, y)); }
  [[nodiscard]] bool is_near(double x, double y, int reach) const {
    const CellIndex at = part_at(x, y);
    for (int l = std::max(at.l - reach, 0); l <= at.l + reach; ++l) {
      for (int w = std::max(at.w - reach, 0); w <= at.w + reach; ++w) {
        const Slot slot = grid.slot_at({l / kParts, w / kParts});
        if (slot != kUnobserved && (parts[static_cast<std::size_t>(slot)] & bit_of({l, w})) != 0)
          return true;
      }
    }
    return false;
  }

  static constexpr int kParts = 8;
};

// The cells of decks are their own; a cell beside one is that of the highest deck there, as it may
// hold its side.
void find_deck_cells(const ElevationGrid& grid, const FieldCells& cells,
                     std::vector<std::int32_t>& deck_cell) {
  deck_cell.assign(grid.observed(), -1);
  const auto height = [&cells](std::size_t slot) { return cells.deck_plane[slot].height; };
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (cells.deck[slot] < 0) continue;
    deck_cell[slot] = static_cast<std::int32_t>(slot);
    for_slots_around(grid, slot, 1, [&](std::size_t near) {
      if (cells.deck[near] >= 0) return;
      const std::int32_t other = deck_cell[near];
      if (other < 0 || height(static_cast<std::size_t>(other)) < height(slot))
        deck_cell[near] = static_cast<std::int32_t>(slot);
    });
  }
}

// Tells the points of decks' sides from those near their surfaces.
void sort_deck_points(const PointsView& scan, const FieldPoints& points,
                      const PointSlots& point_slots, const FieldCells& cells, float side,
                      const std::vector<Support>& support, SideMap& map, DeckWorkspace& workspace) {
  workspace.on_deck.clear();
  workspace.low_side.clear();
  workspace.side_points.clear();
  workspace.surface_points.clear();
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (point_slots[i] < 0 || points.height[i] < kLeastSide) continue;
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (workspace.deck_cell[slot] < 0) continue;
    const auto deck_cell = static_cast<std::size_t>(workspace.deck_cell[slot]);
    const bool is_above = support[i] == Support::kAbove;
    const DeckPlane& plane = cells.deck_plane[deck_cell];
    const float below = plane.at(scan.x[i], scan.y[i]) - scan.z[i];
    const DeckSidePoint side_point{cells.deck[deck_cell], static_cast<std::int32_t>(i), scan.x[i],
                                   scan.y[i], scan.z[i]};
    if (deck_cell != slot) {
      if (is_above && below > side) workspace.side_points.push_back(side_point);
      continue;
    }
    if (below > plane.side) {
      map.mark(slot, scan.x[i], scan.y[i]);
      workspace.side_points.push_back(side_point);
      if (support[i] == Support::kGround && points.height[i] >= kSideFoot)
        workspace.low_side.push_back(static_cast<std::int32_t>(i));
    }
    if (is_above && std::abs(below) <= side) {
      workspace.on_deck.push_back(static_cast<std::int32_t>(i));
      workspace.surface_points.push_back(side_point);
    }
  }
}

}  // namespace

void label_deck_points(const PointsView& scan, const FieldPoints& points,
                       const PointSlots& point_slots, const ElevationGrid& grid,
                       const FieldCells& cells, const DeckParams& params, DeckWorkspace& workspace,
                       std::vector<Support>& support) {
  const auto side = static_cast<float>(params.side);
  workspace.side.assign(grid.observed(), 0);
  SideMap map{grid, workspace.side};
  find_deck_cells(grid, cells, workspace.deck_cell);
  sort_deck_points(scan, points, point_slots, cells, side, support, map, workspace);
  find_deck_sides(side, workspace.side_points, workspace.side_buckets, workspace.sides);
  find_side_rings(side, workspace.surface_points, workspace.side_buckets, workspace.sides);
  const double part = grid.geometry.cell_size() / SideMap::kParts;
  const int reach = std::clamp(static_cast<int>(params.side / part + 0.5), 1, SideMap::kParts);
  const auto on_side = [&](std::size_t i) {
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    return is_on_side(workspace.sides, cells.deck[slot], scan.x[i], scan.y[i], side);
  };
  for (const std::int32_t point : workspace.on_deck) {
    const auto i = static_cast<std::size_t>(point);
    if (!map.is_near(scan.x[i], scan.y[i], reach) && !on_side(i)) support[i] = Support::kGround;
  }
  for (const std::int32_t point : workspace.low_side) {
    const auto i = static_cast<std::size_t>(point);
    if (on_side(i)) support[i] = Support::kAbove;
  }
}

}  // namespace mrpt_terrain
