// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/tile_state.h"

namespace mrpt_terrain::test {

template <class T>
void append_bytes(const T& value, std::string& bytes) {
  static_assert(std::is_arithmetic_v<T>, "no padding");
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

inline void append_bytes(const HeightBin& bin, std::string& bytes) {
  append_bytes(bin.last_seen, bytes);
  append_bytes(bin.layer, bytes);
  append_bytes(bin.count, bytes);
  for (const float number : {bin.z_min, bin.z_max, bin.mean_x, bin.mean_y, bin.mean_z, bin.m_xx,
                             bin.m_xy, bin.m_xz, bin.m_yy, bin.m_yz, bin.m_zz}) {
    append_bytes(number, bytes);
  }
  append_bytes(bin.scans, bytes);
  append_bytes(bin.freed, bytes);
}

/// All that the cells of a map know, byte by byte, for comparisons that tolerate nothing.
/// \param shift added to all addresses of cells
inline std::string bytes_of(const FusedSnapshot& map, MapCell shift = {}) {
  std::string bytes;
  TileState state;
  std::vector<std::pair<MapCell, std::string>> cells;
  map.tiles.for_each([&](TileIndex index, const Tile& tile) {
    save_tile(index, tile, state);
    std::size_t next = 0;
    for (const TileState::Cell& cell : state.cells) {
      const MapCell where = cell_of(index, cell.place);
      std::string own;
      append_bytes(cell.free.low, own);
      append_bytes(cell.free.high, own);
      for (std::size_t k = 0; k < cell.bins; ++k) append_bytes(state.bins[next++], own);
      cells.push_back({{where.i + shift.i, where.j + shift.j}, own});
    }
  });
  std::sort(cells.begin(), cells.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [where, own] : cells) {
    append_bytes(where.i, bytes);
    append_bytes(where.j, bytes);
    bytes += own;
  }
  return bytes;
}

}  // namespace mrpt_terrain::test
