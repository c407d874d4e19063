// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/fused_grid.h"

namespace mrpt_terrain {

/// The inside of a grid, for the functions that write to it.
struct FusedGridAccess {
  static FusedSnapshot& now(FusedGrid& grid) { return grid.now_; }
  static TileStore& store(FusedGrid& grid) { return grid.store_; }
  static const TileStore& store(const FusedGrid& grid) { return grid.store_; }
  static Tile& writable(FusedGrid& grid, TileIndex index) {
    return grid.store_.writable(grid.now_.tiles, index);
  }
  static void drop(FusedGrid& grid, TileIndex index) { grid.store_.drop(grid.now_.tiles, index); }
};

/// Link that leads to a bin: of its cell, or of the bin below.
using BinLink = BinIndex*;

/// Takes the bin that a link leads to out of its list, and gives it back.
inline void remove_bin(Tile& tile, BinLink link) {
  const BinIndex gone = *link;
  *link = tile.bin(gone).next;
  TileStore::free_bin(tile, gone);
}

/// Forgets all that a cell knows.
inline void clear_cell(Tile& tile, std::size_t place) {
  TileCell& cell = tile.cells[place];
  while (cell.first != kNoBin) remove_bin(tile, &cell.first);
  cell.free = {};
}

}  // namespace mrpt_terrain
