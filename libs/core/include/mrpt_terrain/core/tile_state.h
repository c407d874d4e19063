// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/fused_tile.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// A tile as plain numbers, to be stored and restored without a changed bit.
struct TileState {
  struct Cell {
    std::uint8_t place = 0;  ///< number of the cell within the tile
    std::uint16_t bins = 0;  ///< its bins follow each other in `bins`, lowest first
    LayerSpan free;
  };
  TileIndex tile;
  std::vector<Cell> cells;      ///< cells that hold anything, by number
  std::vector<HeightBin> bins;  ///< `next` is kNoBin
};

/// Writes down a tile; depends on what it holds alone, not on how it came to be.
void save_tile(TileIndex index, const Tile& tile, TileState& state);

/// What is wrong with a stored tile.
enum class RestoreStatus : std::uint8_t {
  kOk = 0,
  kBadIndex,   ///< tile outside the lattice
  kBadCells,   ///< cells not ascending, or numbers of bins that do not add up
  kBadBins,    ///< bins not sorted by layer, more than two in a layer, or impossible
  kNotFinite,  ///< a number that is not finite
  kTooMany,    ///< more bins than a tile can hold
};
constexpr EnumNames<RestoreStatus, 6> enum_names(RestoreStatus) {
  return {{{RestoreStatus::kOk, "ok"},
           {RestoreStatus::kBadIndex, "bad_index"},
           {RestoreStatus::kBadCells, "bad_cells"},
           {RestoreStatus::kBadBins, "bad_bins"},
           {RestoreStatus::kNotFinite, "not_finite"},
           {RestoreStatus::kTooMany, "too_many"}}};
}

/// Puts a stored tile into the grid in place of what is there; a state that is not `kOk` changes
/// nothing.
[[nodiscard]] RestoreStatus restore_tile(const TileState& state, FusedGrid& grid);
/// Sets what a grid knows besides its tiles: `window`, `time` and `scans` of a stored snapshot.
void restore_progress(const MapCellRect& window, double time, std::uint64_t scans, FusedGrid& grid);

}  // namespace mrpt_terrain
