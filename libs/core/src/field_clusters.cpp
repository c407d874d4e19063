// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_clusters.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain {
namespace {

// Widest gap, cells, however far away.
constexpr int kMostReach = 3;

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t slot) {
  const auto up = [&parent](std::int32_t s) -> std::int32_t& {
    return parent[static_cast<std::size_t>(s)];
  };
  while (up(slot) != slot) {
    up(slot) = up(up(slot));
    slot = up(slot);
  }
  return slot;
}

// The first slot of a thing is its root.
void unite(std::vector<std::int32_t>& parent, std::int32_t a, std::int32_t b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

/// What decides whether two cells are of one thing.
struct Linker {
  const ElevationGrid& grid;
  const GroundSegmentation& ground;
  const FieldCells& cells;
  float step;

  [[nodiscard]] bool compatible(std::size_t a, std::size_t b) const {
    if (ground.rule[a] != ground.rule[b] || cells.deck[a] != cells.deck[b]) return false;
    // What is over a hole is no part of it.
    if (ground.rule[a] == GroundRule::kLow) return true;
    const float gap = std::max(cells.low[a], cells.low[b]) - std::min(cells.high[a], cells.high[b]);
    return gap <= step;
  }
};

int reach_of(const ElevationGrid& grid, const FieldClusterParams& params, CellIndex index) {
  const Position2 centre = grid.geometry.centre_of(index);
  const double gap = params.link + params.link_growth * std::hypot(centre.x, centre.y);
  const int reach = 1 + static_cast<int>(gap / grid.geometry.cell_size());
  return std::min(reach, kMostReach);
}

// Unites a cell with those before it, in the order of the slots, that are near enough.
void link_back(const Linker& linker, std::size_t slot, int reach,
               std::vector<std::int32_t>& parent) {
  const GridGeometry& geometry = linker.grid.geometry;
  const CellIndex at = geometry.index_of(linker.grid.cell[slot]);
  for (int l = std::max(at.l - reach, 0); l <= at.l; ++l) {
    const Slot* slots = linker.grid.slot_of.data() + value_of(geometry.id_of({l, 0}));
    const int last = l == at.l ? at.w - 1 : std::min(at.w + reach, geometry.cells_w() - 1);
    for (int w = std::max(at.w - reach, 0); w <= last; ++w) {
      const Slot other = slots[w];
      if (other == kUnobserved || linker.ground.is_ground(static_cast<std::size_t>(other)))
        continue;
      if (linker.compatible(slot, static_cast<std::size_t>(other)))
        unite(parent, static_cast<std::int32_t>(slot), other);
    }
  }
}

void count_members(const GroundSegmentation& ground, const FieldCells& cells,
                   FieldClusterWorkspace& workspace) {
  const std::size_t n = cells.size();
  workspace.cells_of.assign(n, 0);
  workspace.points_of.assign(n, 0);
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (ground.is_ground(slot)) continue;
    workspace.parent[slot] = root_of(workspace.parent, static_cast<std::int32_t>(slot));
    const auto root = static_cast<std::size_t>(workspace.parent[slot]);
    ++workspace.cells_of[root];
    // The floor of a hole is ground.
    workspace.points_of[root] += ground.rule[slot] == GroundRule::kLow
                                     ? cells.on[slot] + cells.below[slot]
                                     : cells.above[slot];
  }
}

void number_things(const FieldClusterParams& params, FieldClusterWorkspace& workspace,
                   Clusters& result) {
  workspace.number_of.assign(workspace.cells_of.size(), kNoCluster);
  result.slots.first.assign(1, 0);
  result.dropped = 0;
  for (std::size_t root = 0; root < workspace.cells_of.size(); ++root) {
    const std::int32_t cells = workspace.cells_of[root];
    if (cells == 0) continue;
    if (cells < params.t_c && workspace.points_of[root] < params.t_points) {
      ++result.dropped;
      continue;
    }
    workspace.number_of[root] = static_cast<std::int32_t>(result.slots.rows());
    result.slots.first.push_back(result.slots.first.back() + cells);
  }
  result.slots.items.resize(static_cast<std::size_t>(result.slots.first.back()));
}

}  // namespace

void find_field_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                         const FieldCells& cells, const FieldClusterParams& params,
                         FieldClusterWorkspace& workspace, Clusters& result) {
  const Linker linker{grid, ground, cells, static_cast<float>(params.step)};
  const std::size_t n = grid.observed();
  workspace.parent.resize(n);
  for (std::size_t slot = 0; slot < n; ++slot) {
    workspace.parent[slot] = static_cast<std::int32_t>(slot);
    if (ground.is_ground(slot)) continue;
    link_back(linker, slot, reach_of(grid, params, grid.geometry.index_of(grid.cell[slot])),
              workspace.parent);
  }
  count_members(ground, cells, workspace);
  number_things(params, workspace, result);
  result.cluster_of.assign(n, kNoCluster);
  workspace.points_of.assign(result.slots.first.begin(), result.slots.first.end());
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (ground.is_ground(slot)) continue;
    const std::int32_t cluster =
        workspace.number_of[static_cast<std::size_t>(workspace.parent[slot])];
    if (cluster == kNoCluster) continue;
    result.cluster_of[slot] = cluster;
    std::int32_t& next = workspace.points_of[static_cast<std::size_t>(cluster)];
    result.slots.items[static_cast<std::size_t>(next++)] = static_cast<std::int32_t>(slot);
  }
}

}  // namespace mrpt_terrain
