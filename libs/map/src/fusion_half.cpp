// SPDX-License-Identifier: BSD-3-Clause
#include "fusion_half.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "mrpt_terrain/core/tile_state.h"

namespace mrpt_terrain {
namespace {

// Layers below and above a cell's bins that tell where a free span begins and ends.
constexpr std::int32_t kMoreLayers = 2;

ColumnRequest column_of(const CellLayers& layers) {
  return {layers.cell, {layers.span.low - kMoreLayers, layers.span.high + kMoreLayers}};
}

// Adds the cells over the voxels that the OctoMap has freed; some of them more than once.
void add_freed_columns(const OctreeHalf& octree, const FusedSnapshot& map,
                       std::vector<ColumnRequest>& columns) {
  const double voxels = std::round(map.lattice.cell_size() / map.lattice.layer_height());
  for (const octree::FreedCube& cube : octree.freed()) {
    const auto cell_of = [&](std::size_t axis, int offset) {
      return floor_to_int((cube.key[axis] - 0x8000 + offset) / voxels);
    };
    for (std::int32_t i = cell_of(0, 0); i <= cell_of(0, cube.cells - 1); ++i) {
      for (std::int32_t j = cell_of(1, 0); j <= cell_of(1, cube.cells - 1); ++j) {
        const Tile* tile = map.tiles.find(tile_of({i, j}));
        if (tile == nullptr) continue;
        const CellLayers layers = layers_of(*tile, {i, j});
        if (!layers.span.empty()) columns.push_back(column_of(layers));
      }
    }
  }
}

// Sorts by one of the coordinates; those that are equal keep their order.
void sort_by(std::int32_t MapCell::*coordinate, const std::vector<ColumnRequest>& columns,
             std::vector<std::size_t>& begin, std::vector<ColumnRequest>& sorted) {
  sorted.resize(columns.size());
  if (columns.empty()) return;
  const auto before = [coordinate](const ColumnRequest& a, const ColumnRequest& b) {
    return a.cell.*coordinate < b.cell.*coordinate;
  };
  const auto [first, last] = std::minmax_element(columns.begin(), columns.end(), before);
  const std::int32_t low = first->cell.*coordinate;
  begin.assign(static_cast<std::size_t>(last->cell.*coordinate - low) + 2, 0);
  const auto number_of = [&](const ColumnRequest& column) {
    return static_cast<std::size_t>(column.cell.*coordinate - low);
  };
  for (const ColumnRequest& column : columns) ++begin[number_of(column) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (const ColumnRequest& column : columns) sorted[begin[number_of(column)]++] = column;
}

/// Cells that the OctoMap has something to say about: those hit by the scan that hold more than one
/// layer, and those over voxels that it freed. The same number of cells is looked at however large
/// the map is.
void find_columns(const OctreeHalf& octree, FusionHalf& fusion) {
  std::vector<ColumnRequest>& columns = fusion.columns;
  columns.clear();
  for (const CellLayers& layers : fusion.fusing.hit) {
    if (layers.several) columns.push_back(column_of(layers));
  }
  add_freed_columns(octree, fusion.grid.now(), columns);
  // By whole numbers within reach of a scan: in less time than by comparing.
  sort_by(&MapCell::j, columns, fusion.sort_begin, fusion.sorted_columns);
  sort_by(&MapCell::i, fusion.sorted_columns, fusion.sort_begin, columns);
  const auto same = [](const ColumnRequest& a, const ColumnRequest& b) { return a.cell == b.cell; };
  columns.erase(std::unique(columns.begin(), columns.end(), same), columns.end());
}

/// Tells the OctoMap which voxels hold ground. The scan is in the grid by then.
void guard_ground(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot, FusionHalf& fusion,
                  OctreeHalf& octree) {
  if (!octree.protects_ground()) return;
  const FusedSnapshot& map = fusion.grid.now();
  find_guarded_ground(map, octree.reach_of(scan, T_map_robot, map), fusion.params, fusion.guarded);
  octree.guard(map.lattice, fusion.guarded);
}

}  // namespace

void fuse(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot, double time,
          FusionHalf& fusion, OctreeHalf* octree) {
  fuse_scan({scan.points.view(), T_map_robot, time}, fusion.params, fusion.fusing, fusion.grid);
  if (octree == nullptr) return;
  guard_ground(scan, T_map_robot, fusion, *octree);
  octree->insert(scan, T_map_robot);
  const MapLattice& lattice = fusion.grid.now().lattice;
  find_columns(*octree, fusion);
  octree->find_free_space(lattice, fusion.columns, time, fusion.free);
  apply_free_space(fusion.free, fusion.params, fusion.grid);
  if (fusion.params.extent == FusionExtent::kRolling) {
    octree->trim(lattice, fusion.grid.now().window);
  }
}

void copy_tiles(const FusedSnapshot& from, FusedGrid& grid) {
  TileState state;
  from.tiles.for_each([&](TileIndex index, const Tile& tile) {
    save_tile(index, tile, state);
    const RestoreStatus status = restore_tile(state, grid);
    assert(status == RestoreStatus::kOk);
    (void)status;
  });
  restore_progress(from.window, from.time, from.scans, grid);
}

}  // namespace mrpt_terrain
