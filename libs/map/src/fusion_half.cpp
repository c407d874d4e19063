// SPDX-License-Identifier: BSD-3-Clause
#include "fusion_half.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mrpt_terrain/core/tile_state.h"

namespace mrpt_terrain {
namespace {

// Layers below and above a cell's bins that tell where a free span begins and ends.
constexpr std::int32_t kMoreLayers = 2;

/// Layers of the bins of a cell.
struct CellLayers {
  LayerSpan span;
  bool several = false;
};

CellLayers layers_of(const FusedSnapshot& map, MapCell cell) {
  CellLayers result;
  const Tile* tile = map.tiles.find(tile_of(cell));
  if (tile == nullptr) return result;
  for_each_bin(*tile, place_in_tile(cell), [&](const HeightBin& bin) {
    if (result.span.empty()) result.span.low = bin.layer;
    result.several |= bin.layer != result.span.low;
    result.span.high = bin.layer + 1;
  });
  return result;
}

/// Cells that the OctoMap has something to say about: those hit by the scan that hold more than one
/// layer, and those over voxels that it freed. The same number of cells is looked at however large
/// the map is.
void find_columns(const OctreeHalf& octree, FusionHalf& fusion) {
  const FusedSnapshot& map = fusion.grid.now();
  const auto add = [&](MapCell cell, bool freed) {
    const CellLayers layers = layers_of(map, cell);
    if (layers.span.empty() || !(layers.several || freed)) return;
    fusion.columns.push_back(
        {cell, {layers.span.low - kMoreLayers, layers.span.high + kMoreLayers}});
  };
  fusion.columns.clear();
  for (const ScanBin& bin : fusion.fusing.bins) add(bin.cell, false);
  const double voxels = std::round(map.lattice.cell_size() / map.lattice.layer_height());
  for (const octree::FreedCube& cube : octree.freed()) {
    const auto cell_of = [&](std::size_t axis, int offset) {
      return floor_to_int((cube.key[axis] - 0x8000 + offset) / voxels);
    };
    for (std::int32_t i = cell_of(0, 0); i <= cell_of(0, cube.cells - 1); ++i) {
      for (std::int32_t j = cell_of(1, 0); j <= cell_of(1, cube.cells - 1); ++j) add({i, j}, true);
    }
  }
  const auto by_cell = [](const ColumnRequest& a, const ColumnRequest& b) {
    return a.cell < b.cell;
  };
  const auto same = [](const ColumnRequest& a, const ColumnRequest& b) { return a.cell == b.cell; };
  std::sort(fusion.columns.begin(), fusion.columns.end(), by_cell);
  fusion.columns.erase(std::unique(fusion.columns.begin(), fusion.columns.end(), same),
                       fusion.columns.end());
}

}  // namespace

void fuse(const PosedScan& scan, FusionHalf& fusion, OctreeHalf* octree) {
  fuse_scan(scan, fusion.params, fusion.fusing, fusion.grid);
  if (octree == nullptr) return;
  const MapLattice& lattice = fusion.grid.now().lattice;
  find_columns(*octree, fusion);
  octree->find_free_space(lattice, fusion.columns, scan.time, fusion.free);
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
