// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/clusters.h"

#include <algorithm>
#include <numeric>

namespace mrpt_terrain {
namespace {

// Union-find over slots whose roots are the smallest slot of their group.
std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t slot) {
  auto up = [&parent](std::int32_t s) -> std::int32_t& {
    return parent[static_cast<std::size_t>(s)];
  };
  while (up(slot) != slot) {
    up(slot) = up(up(slot));
    slot = up(slot);
  }
  return slot;
}

void unite(std::vector<std::int32_t>& parent, std::int32_t a, std::int32_t b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

// Joins every non-ground cell with those of its eight neighbours that come before it in row order;
// the other four join it in their turn.
void connect(const ElevationGrid& grid, const GroundSegmentation& ground,
             std::vector<std::int32_t>& parent) {
  const std::int32_t stride = grid.geometry.stride();
  parent.resize(grid.observed());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (ground.is_ground(slot)) continue;
    const std::int32_t id = value_of(grid.cell[slot]);
    for (const std::int32_t before : {id - stride - 1, id - stride, id - stride + 1, id - 1}) {
      const Slot neighbour = grid.slot_of[static_cast<std::size_t>(before)];
      if (neighbour == kUnobserved || ground.is_ground(static_cast<std::size_t>(neighbour)))
        continue;
      unite(parent, static_cast<std::int32_t>(slot), neighbour);
    }
  }
}

// Turns sizes in `first[1..]` into the starts of the rows.
void sizes_to_starts(std::vector<std::int32_t>& first) {
  std::partial_sum(first.begin(), first.end(), first.begin());
}

// Undoes the shift that filling the rows has made to their starts.
void restore_starts(std::vector<std::int32_t>& first) {
  std::rotate(first.rbegin(), first.rbegin() + 1, first.rend());
  first.front() = 0;
}

}  // namespace

void find_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                   const ClusterParams& params, ClusterWorkspace& workspace, Clusters& result) {
  const std::size_t n = grid.observed();
  std::vector<std::int32_t>& parent = workspace.parent;
  connect(grid, ground, parent);

  std::vector<std::int32_t>& cells_of_root = workspace.cells_of_root;
  cells_of_root.assign(n, 0);
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (ground.is_ground(slot)) continue;
    // Row order: the parent of a slot comes before it and is a root by now.
    parent[slot] = root_of(parent, parent[slot]);
    ++cells_of_root[static_cast<std::size_t>(parent[slot])];
  }

  result.cluster_of.assign(n, kNoCluster);
  result.slots.first.assign(1, 0);
  result.dropped = 0;
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (cells_of_root[slot] == 0) continue;
    if (cells_of_root[slot] < params.t_c) {
      ++result.dropped;
      continue;
    }
    result.cluster_of[slot] = static_cast<std::int32_t>(result.slots.first.size() - 1);
    result.slots.first.push_back(cells_of_root[slot]);
  }
  sizes_to_starts(result.slots.first);
  result.slots.items.resize(static_cast<std::size_t>(result.slots.first.back()));
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (ground.is_ground(slot)) continue;
    const std::int32_t cluster = result.cluster_of[static_cast<std::size_t>(parent[slot])];
    result.cluster_of[slot] = cluster;
    if (cluster == kNoCluster) continue;
    std::int32_t& next = result.slots.first[static_cast<std::size_t>(cluster)];
    result.slots.items[static_cast<std::size_t>(next++)] = static_cast<std::int32_t>(slot);
  }
  restore_starts(result.slots.first);
}

void gather_points(const PointSlots& point_slots, const Clusters& clusters,
                   const std::vector<std::uint8_t>& wanted, IndexRows& rows) {
  const auto cluster_of_point = [&](std::size_t i) {
    const std::int32_t slot = point_slots[i];
    if (slot < 0) return kNoCluster;
    const std::int32_t cluster = clusters.cluster_of[static_cast<std::size_t>(slot)];
    if (cluster == kNoCluster || wanted[static_cast<std::size_t>(cluster)] == 0) return kNoCluster;
    return cluster;
  };
  rows.first.assign(clusters.size() + 1, 0);
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    const std::int32_t cluster = cluster_of_point(i);
    if (cluster != kNoCluster) ++rows.first[static_cast<std::size_t>(cluster) + 1];
  }
  sizes_to_starts(rows.first);
  rows.items.resize(static_cast<std::size_t>(rows.first.back()));
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    const std::int32_t cluster = cluster_of_point(i);
    if (cluster == kNoCluster) continue;
    rows.items[static_cast<std::size_t>(rows.first[static_cast<std::size_t>(cluster)]++)] =
        static_cast<std::int32_t>(i);
  }
  restore_starts(rows.first);
}

}  // namespace mrpt_terrain
