// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/moments.h"

namespace mrpt_terrain {

/// What is known of one cell. Heights in the map frame, metres.
struct FusedCell {
  double height = 0.0;    ///< of the ground: the mean of its lowest layer that is no outlier
  double variance = 0.0;  ///< of the points about that height, m^2
  LayerSpan ground;       ///< the layer of the ground, and the next one if its surface lies on the
                          ///< border of both
  double h_min = 0.0;     ///< lowest point, outliers below the ground left out
  double h_max = 0.0;     ///< highest point that does not hang over
  double low = 0.0;       ///< h_min and h_max, cut at `spread_limit` standard deviations
  double high = 0.0;
  Moments moments;         ///< of the same points; about the map's origin, centred
  double last_seen = 0.0;  ///< stamp of the last scan that hit the cell, seconds
  std::int32_t bins = 0;   ///< bins counted in
  std::int32_t below = 0;  ///< points left out as outliers below the ground
  bool overhung = false;   ///< something hangs over the cell with `clearance` or more below it
  double overhang = 0.0;   ///< lowest point of it
  LayerSpan free;          ///< layers known to be free above the ground; may be empty
};

/// Which bins of a cell count, borrowed.
struct CellReader {
  const FusedSnapshot& map;
  const FusionParams& params;
  double ceiling;  ///< metres, map frame: layers whose lowest point is there or above are not read
};

/// Reads one cell. Returns false, and leaves `cell` as it was, if nothing is known of it: never
/// observed, forgotten, or outside the window.
[[nodiscard]] bool read_cell(const FusedSnapshot& map, MapCell where, const FusionParams& params,
                             FusedCell& cell);
/// The same for a cell of a tile at hand.
/// \param index of the tile
/// \param place number of the cell in the tile
[[nodiscard]] bool read_cell(const CellReader& reader, TileIndex index, const Tile& tile,
                             std::size_t place, FusedCell& cell);

}  // namespace mrpt_terrain
