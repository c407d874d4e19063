// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/clusters.h"

#include <algorithm>
#include <cassert>
#include <numeric>

// The flood fill works on runs of cells instead of single cells: slots are sorted row by row, so
// that one sweep over the slots finds the runs and one sweep over the runs, with a second pointer
// one row behind, finds all touching pairs without looking a single neighbour up in the grid.

namespace mrpt_terrain {
namespace {

std::int32_t& parent_of(std::vector<CellRun>& runs, std::int32_t run) {
  return runs[static_cast<std::size_t>(run)].parent;
}

// Union-find whose roots are the first run of their group.
std::int32_t root_of(std::vector<CellRun>& runs, std::int32_t run) {
  while (parent_of(runs, run) != run) {
    parent_of(runs, run) = parent_of(runs, parent_of(runs, run));
    run = parent_of(runs, run);
  }
  return run;
}

void unite(std::vector<CellRun>& runs, std::int32_t a, std::int32_t b) {
  a = root_of(runs, a);
  b = root_of(runs, b);
  parent_of(runs, std::max(a, b)) = std::min(a, b);
}

void find_runs(const ElevationGrid& grid, const GroundSegmentation& ground,
               std::vector<CellRun>& runs) {
  runs.clear();
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (ground.is_ground(slot)) continue;
    const std::int32_t id = value_of(grid.cell[slot]);
    if (!runs.empty() && runs.back().last_id == id - 1) {
      runs.back().last_id = id;
    } else {
      runs.push_back({id, id, static_cast<Slot>(slot), static_cast<std::int32_t>(runs.size())});
    }
  }
}

// Unites the runs of neighbouring rows that touch, corners included. Rows end in a cell of the
// frame, which is never observed, so that no run reaches into the next row.
void connect_runs(std::int32_t stride, std::vector<CellRun>& runs) {
  std::size_t behind = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::int32_t from = runs[k].first_id - stride - 1;
    const std::int32_t to = runs[k].last_id - stride + 1;
    while (runs[behind].last_id < from) ++behind;
    for (std::size_t q = behind; runs[q].first_id <= to; ++q) {
      unite(runs, static_cast<std::int32_t>(k), static_cast<std::int32_t>(q));
    }
  }
}

std::int32_t length_of(const CellRun& run) { return run.last_id - run.first_id + 1; }

// Flattens the union-find and counts the cells of each group.
void count_cells(ClusterWorkspace& workspace) {
  std::vector<CellRun>& runs = workspace.runs;
  workspace.cells_of_root.assign(runs.size(), 0);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    runs[k].parent = root_of(runs, static_cast<std::int32_t>(k));
    workspace.cells_of_root[static_cast<std::size_t>(runs[k].parent)] += length_of(runs[k]);
  }
}

// Numbers the groups that are large enough and reserves their rows.
void number_clusters(const ClusterParams& params, ClusterWorkspace& workspace, Clusters& result) {
  workspace.cluster_of_root.assign(workspace.runs.size(), kNoCluster);
  result.slots.first.assign(1, 0);
  result.dropped = 0;
  for (std::size_t k = 0; k < workspace.runs.size(); ++k) {
    const std::int32_t cells = workspace.cells_of_root[k];
    if (cells == 0) continue;
    if (cells < params.t_c) {
      ++result.dropped;
      continue;
    }
    workspace.cluster_of_root[k] = static_cast<std::int32_t>(result.slots.rows());
    result.slots.first.push_back(result.slots.first.back() + cells);
  }
  result.slots.items.resize(static_cast<std::size_t>(result.slots.first.back()));
}

// Filling moves the start of each row to its end, which is the start of the next one.
void restore_starts(std::vector<std::int32_t>& first) {
  std::rotate(first.rbegin(), first.rbegin() + 1, first.rend());
  first.front() = 0;
}

}  // namespace

void find_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                   const ClusterParams& params, ClusterWorkspace& workspace, Clusters& result) {
  find_runs(grid, ground, workspace.runs);
  connect_runs(grid.geometry.stride(), workspace.runs);
  count_cells(workspace);
  number_clusters(params, workspace, result);

  result.cluster_of.assign(grid.observed(), kNoCluster);
  for (const CellRun& run : workspace.runs) {
    const std::int32_t cluster = workspace.cluster_of_root[static_cast<std::size_t>(run.parent)];
    if (cluster == kNoCluster) continue;
    std::int32_t& next = result.slots.first[static_cast<std::size_t>(cluster)];
    for (Slot slot = run.first_slot; slot < run.first_slot + length_of(run); ++slot) {
      result.cluster_of[static_cast<std::size_t>(slot)] = cluster;
      result.slots.items[static_cast<std::size_t>(next++)] = slot;
    }
  }
  restore_starts(result.slots.first);
}

void gather_points(const PointSlots& point_slots, const Clusters& clusters,
                   const std::vector<std::int32_t>& points_wanted, IndexRows& rows) {
  assert(points_wanted.size() == clusters.size());
  rows.first.resize(clusters.size() + 1);
  rows.first[0] = 0;
  std::partial_sum(points_wanted.begin(), points_wanted.end(), rows.first.begin() + 1);
  rows.items.resize(static_cast<std::size_t>(rows.first.back()));
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (point_slots[i] < 0) continue;
    const std::int32_t cluster = clusters.cluster_of[static_cast<std::size_t>(point_slots[i])];
    if (cluster == kNoCluster || points_wanted[static_cast<std::size_t>(cluster)] == 0) continue;
    std::int32_t& next = rows.first[static_cast<std::size_t>(cluster)];
    rows.items[static_cast<std::size_t>(next++)] = static_cast<std::int32_t>(i);
  }
  restore_starts(rows.first);
}

void gather_points_by_slot(const PointSlots& point_slots,
                           const std::vector<std::uint8_t>& slot_wanted, IndexRows& rows) {
  const auto is_wanted = [&](std::int32_t slot) {
    return slot >= 0 && slot_wanted[static_cast<std::size_t>(slot)] != 0;
  };
  rows.first.assign(slot_wanted.size() + 1, 0);
  for (const std::int32_t slot : point_slots) {
    if (is_wanted(slot)) ++rows.first[static_cast<std::size_t>(slot) + 1];
  }
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.items.resize(static_cast<std::size_t>(rows.first.back()));
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (!is_wanted(point_slots[i])) continue;
    std::int32_t& next = rows.first[static_cast<std::size_t>(point_slots[i])];
    rows.items[static_cast<std::size_t>(next++)] = static_cast<std::int32_t>(i);
  }
  restore_starts(rows.first);
}

}  // namespace mrpt_terrain
