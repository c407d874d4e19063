// SPDX-License-Identifier: BSD-3-Clause
#include "climbed_sides.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "deck_sides.h"
#include "surface_levels.h"

namespace mrpt_terrain {
namespace {

// The level of 3.2 m hardly follows a curb...
constexpr int kBaseLevel = 3;
// ...so that the reference on it, and points of its side, are this much higher, metres.
constexpr float kLeastRise = 0.03F, kLeastHeight = 0.05F;
// Lines are sought in blocks of cells of this level, 6.4 m.
constexpr int kBlockLevel = 4;

// Lists the cells on which the reference stands out of its coarser level.
void find_risen_cells(const GroundSurface& surface, const LevelView& base,
                      std::vector<LevelStep>& step, std::vector<std::int32_t>& risen) {
  const CellPoints& cells = surface.cells;
  find_steps(base, cells.lattice, kBaseLevel, step);
  risen.clear();
  for (std::size_t slot = 0; slot < cells.occupied(); ++slot) {
    const LatticeCell cell = cells.cell[slot];
    const auto row = static_cast<std::size_t>(cell.row);
    const auto column = static_cast<std::size_t>(cell.column);
    const float coarse = base.between(step[row], step[column]).height;
    if (surface.node[cells.number_of(cell)] - coarse >= kLeastRise)
      risen.push_back(static_cast<std::int32_t>(slot));
  }
}

// The block that a cell lies in.
std::int32_t block_of(const CellPoints& cells, std::int32_t slot) {
  const LatticeCell cell = cells.cell[static_cast<std::size_t>(slot)];
  const std::int32_t blocks = cells.lattice.side >> kBlockLevel;
  return (cell.row >> kBlockLevel) * blocks + (cell.column >> kBlockLevel);
}

/// Calls `visit` with the points of the ground that may be of such a side.
template <class Visitor>
void for_candidates(const FieldWorkspace& field, const LevelView& base,
                    const std::vector<std::int32_t>& risen, Visitor&& visit) {
  const CellPoints& cells = field.surface.cells;
  for (const std::int32_t item : risen) {
    const auto slot = static_cast<std::size_t>(item);
    const std::int32_t block = block_of(cells, item);
    for (auto k = static_cast<std::size_t>(cells.first[slot]);
         k < static_cast<std::size_t>(cells.first[slot + 1]); ++k) {
      const CellPoint& p = cells.points[k];
      if (field.support[k] == Support::kGround && p.z - base.at(p.x, p.y).height >= kLeastHeight)
        visit(DeckSidePoint{block, p.index, p.x, p.y, p.z});
    }
  }
}

// Leaves only cells of blocks with sides.
void keep_beside_sides(const CellPoints& cells, const std::vector<DeckSide>& sides,
                       std::vector<std::int32_t>& risen) {
  const auto has_none = [&](std::int32_t slot) {
    const std::int32_t block = block_of(cells, slot);
    return std::none_of(sides.begin(), sides.end(),
                        [block](const DeckSide& side) { return side.deck == block; });
  };
  risen.erase(std::remove_if(risen.begin(), risen.end(), has_none), risen.end());
}

}  // namespace

void label_climbed_sides(FieldWorkspace& field, float reach, DeckWorkspace& workspace,
                         std::vector<Support>& support) {
  const GroundSurface& surface = field.surface;
  const LevelView base = view_of_level(field.surface_workspace, surface.lattice(), kBaseLevel);
  std::vector<std::int32_t>& risen = workspace.members;
  find_risen_cells(surface, base, field.surface_workspace.step, risen);
  workspace.surface_points.clear();
  workspace.sides.clear();
  for_candidates(field, base, risen, [&workspace](const DeckSidePoint& point) {
    workspace.surface_points.push_back(point);
  });
  find_side_rings(reach, workspace.surface_points, workspace.side_buckets, workspace.sides);
  keep_beside_sides(surface.cells, workspace.sides, risen);
  for_candidates(field, base, risen, [&](const DeckSidePoint& point) {
    if (is_on_side(workspace.sides, point.deck, point.x, point.y, reach))
      support[static_cast<std::size_t>(point.point)] = Support::kAbove;
  });
}

}  // namespace mrpt_terrain
