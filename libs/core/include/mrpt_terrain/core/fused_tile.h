// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/map_lattice.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/shared_node.h"

namespace mrpt_terrain {

/// Number of a bin within its tile.
using BinIndex = std::uint16_t;
inline constexpr BinIndex kNoBin = 0xFFFF;

/// All that a cell knows of the points of one height layer. To forget a bin is to forget them all:
/// nothing else in the map depends on them.
///
/// A layer has one bin, or an older and a newer one in this order (see `FusionParams`).
struct HeightBin {
  double last_seen = 0.0;   ///< stamp of the last scan that hit it, seconds
  std::int32_t layer = 0;   ///< `MapLattice` number
  std::uint32_t count = 0;  ///< points
  float z_min = 0.0F;       ///< lowest point, metres above the bottom of the layer
  float z_max = 0.0F;       ///< highest point, likewise
  float mean_x = 0.0F;      ///< metres from the centre of the cell
  float mean_y = 0.0F;      ///< likewise
  float mean_z = 0.0F;      ///< metres above the bottom of the layer
  float m_xx = 0.0F, m_xy = 0.0F, m_xz = 0.0F;  ///< sums of products of deviations, m^2
  float m_yy = 0.0F, m_yz = 0.0F, m_zz = 0.0F;
  BinIndex next = kNoBin;  ///< link within the tile; not part of what is known
  std::uint8_t scans = 0;  ///< scans that hit it, up to 255
  std::uint8_t freed = 0;  ///< scans since the last hit that saw the cell and freed the layer
};
static_assert(sizeof(HeightBin) == 64, "one cache line");

/// Address of a tile: that of its cells divided by `kTileSide`, rounded down.
struct TileIndex {
  std::int32_t i = 0;
  std::int32_t j = 0;

  friend bool operator==(TileIndex a, TileIndex b) { return a.i == b.i && a.j == b.j; }
  friend bool operator!=(TileIndex a, TileIndex b) { return !(a == b); }
  friend bool operator<(TileIndex a, TileIndex b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }
};

inline constexpr int kTileShift = 4;
/// Cells along the side of a tile.
inline constexpr int kTileSide = 1 << kTileShift;
inline constexpr int kTileCells = kTileSide * kTileSide;

[[nodiscard]] inline TileIndex tile_of(MapCell cell) {
  return {cell.i >> kTileShift, cell.j >> kTileShift};
}
/// Number of a cell within its tile, row by row: 0 to `kTileCells` - 1.
[[nodiscard]] inline std::size_t place_in_tile(MapCell cell) {
  constexpr std::int32_t kMask = kTileSide - 1;
  return static_cast<std::size_t>((cell.i & kMask) * kTileSide + (cell.j & kMask));
}
[[nodiscard]] inline MapCell cell_of(TileIndex tile, std::size_t place) {
  const auto p = static_cast<std::int32_t>(place);
  return {tile.i * kTileSide + p / kTileSide, tile.j * kTileSide + p % kTileSide};
}

/// One cell of a tile: a list of bins, lowest first, and the free space known above its ground.
struct TileCell {
  BinIndex first = kNoBin;
  LayerSpan free;  ///< layers that rays have found empty; empty if none is known
};

/// Block of memory for bins.
inline constexpr std::size_t kBinsPerBlock = 32;
using BinBlock = std::array<HeightBin, kBinsPerBlock>;
/// Bins that a tile can hold: 255 per cell on average.
inline constexpr std::size_t kMostBins = kNoBin / kBinsPerBlock * kBinsPerBlock;

/// Square of cells with their bins: the unit that snapshots share and that is copied when written
/// to. `cells` and `blocks` are read through the functions below.
struct Tile : SharedNode {
  std::array<TileCell, kTileCells> cells;
  std::vector<std::unique_ptr<BinBlock>> blocks;
  BinIndex first_unused = kNoBin;  ///< list of places in the blocks that no cell uses
  std::uint32_t bins = 0;          ///< bins in use
  std::uint32_t disorder = 0;  ///< bins that were added since they lay in the order of the cells

  [[nodiscard]] const HeightBin& bin(BinIndex k) const {
    return (*blocks[k / kBinsPerBlock])[k % kBinsPerBlock];
  }
  [[nodiscard]] HeightBin& bin(BinIndex k) {
    return (*blocks[k / kBinsPerBlock])[k % kBinsPerBlock];
  }
};

/// Calls `visit(const HeightBin&)` for the bins of a cell, lowest first.
template <class Visit>
void for_each_bin(const Tile& tile, std::size_t place, Visit&& visit) {
  for (BinIndex k = tile.cells[place].first; k != kNoBin; k = tile.bin(k).next) visit(tile.bin(k));
}

/// Number, mean and scatter of a bin's points about the centre of its cell and height 0 of the map.
[[nodiscard]] inline Moments moments_of(const HeightBin& bin, const MapLattice& lattice) {
  Moments m;
  m.n = bin.count;
  m.mean_x = bin.mean_x;
  m.mean_y = bin.mean_y;
  m.mean_z = lattice.bottom_of(bin.layer) + double{bin.mean_z};
  m.m_xx = bin.m_xx;
  m.m_xy = bin.m_xy;
  m.m_xz = bin.m_xz;
  m.m_yy = bin.m_yy;
  m.m_yz = bin.m_yz;
  m.m_zz = bin.m_zz;
  return m;
}

}  // namespace mrpt_terrain
