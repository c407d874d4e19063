// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_window.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mrpt_terrain/core/fused_cell.h"

namespace mrpt_terrain {
namespace {

void clear(WindowCells& cells) {
  cells.height.clear();
  cells.variance.clear();
  cells.last_seen.clear();
  cells.clearance.clear();
}

// Sums about the origin of the window. In their place at once, not in a copy.
void set_sums(const Moments& m, const WindowFrame& frame, MomentSums& s) {
  const double x = m.mean_x - frame.x;
  const double y = m.mean_y - frame.y;
  const double z = m.mean_z - frame.z;
  s.n = m.n;
  s.x = m.n * x;
  s.y = m.n * y;
  s.z = m.n * z;
  s.xx = m.m_xx + s.x * x;
  s.xy = m.m_xy + s.x * y;
  s.xz = m.m_xz + s.x * z;
  s.yy = m.m_yy + s.y * y;
  s.yz = m.m_yz + s.y * z;
  s.zz = m.m_zz + s.z * z;
}

void append(const FusedCell& cell, const WindowFrame& frame, CellId id, ElevationGrid& grid,
            WindowCells& cells) {
  grid.slot_of[static_cast<std::size_t>(value_of(id))] = static_cast<Slot>(grid.cell.size());
  grid.cell.push_back(id);
  grid.h_min.push_back(static_cast<float>(cell.low - frame.z));
  grid.h_max.push_back(static_cast<float>(cell.high - frame.z));
  grid.h_mean.push_back(static_cast<float>(cell.moments.mean_z - frame.z));
  set_sums(cell.moments, frame, grid.sums.emplace_back());
  cells.height.push_back(static_cast<float>(cell.height - frame.z));
  cells.variance.push_back(static_cast<float>(cell.variance));
  cells.last_seen.push_back(cell.last_seen);
  cells.clearance.push_back(cell.overhung ? static_cast<float>(cell.overhang - cell.height) : 0.0F);
}

// Fetching a cell's bins this many cells ahead hides most of the way to the outer caches.
constexpr std::size_t kPrefetchAhead = 6;

void prefetch(const Tile& tile, std::size_t place) {
#if defined(__GNUC__)
  const BinIndex first = tile.cells[place].first;
  if (first == kNoBin) return;
  const auto* bin = reinterpret_cast<const char*>(&tile.bin(first));
  __builtin_prefetch(bin);
  __builtin_prefetch(bin + sizeof(HeightBin));
  __builtin_prefetch(bin + 2 * sizeof(HeightBin));
#else
  (void)tile;
  (void)place;
#endif
}

// Calls visit(cell, tile) for the cells of the window that have a tile, row by row.
template <class Visit>
void for_each_tile_cell(const FusedSnapshot& map, const WindowFrame& frame, Visit&& visit) {
  for (int l = 0; l < frame.geometry.cells_l(); ++l) {
    const Tile* tile = nullptr;
    for (int w = 0; w < frame.geometry.cells_w(); ++w) {
      const MapCell where = frame.map_cell_of({l, w});
      if (w == 0 || where.j % kTileSide == 0) tile = map.tiles.find(tile_of(where));
      if (tile != nullptr) visit(CellIndex{l, w}, *tile);
    }
  }
}

void reserve(std::size_t n, ElevationGrid& grid, WindowCells& cells) {
  grid.cell.reserve(n);
  grid.h_min.reserve(n);
  grid.h_max.reserve(n);
  grid.h_mean.reserve(n);
  grid.sums.reserve(n);
  cells.height.reserve(n);
  cells.variance.reserve(n);
  cells.last_seen.reserve(n);
  cells.clearance.reserve(n);
}

}  // namespace

WindowFrame window_around(const MapLattice& lattice, const GridParams& params,
                          const Eigen::Vector3d& robot) {
  WindowFrame frame;
  const double c = lattice.cell_size();
  frame.geometry = GridGeometry(params.length, params.width, c);
  const bool found =
      lattice.cell_at(robot.x() - frame.geometry.half_length() + 0.5 * c,
                      robot.y() - frame.geometry.half_width() + 0.5 * c, frame.first);
  assert(found);
  (void)found;
  frame.x = frame.first.i * c + frame.geometry.half_length();
  frame.y = frame.first.j * c + frame.geometry.half_width();
  frame.z = robot.z();
  frame.max_height = params.max_height;
  return frame;
}

void read_window(const FusedSnapshot& map, const WindowFrame& frame, const FusionParams& params,
                 ElevationGrid& grid, WindowCells& cells) {
  clear_grid(frame.geometry, grid);
  clear(cells);
  // New memory is asked for once: growing step by step would copy all of it again and again.
  std::size_t most = 0;
  for_each_tile_cell(map, frame, [&](CellIndex at, const Tile& tile) {
    most += tile.cells[place_in_tile(frame.map_cell_of(at))].first != kNoBin ? 1U : 0U;
  });
  // With some room to spare, so that the memory serves for windows with a few more cells, too.
  if (grid.cell.capacity() < most) reserve(most + most / 4, grid, cells);
  const CellReader reader{map, params, frame.z + frame.max_height};
  FusedCell cell;
  for_each_tile_cell(map, frame, [&](CellIndex at, const Tile& tile) {
    const MapCell where = frame.map_cell_of(at);
    const std::size_t place = place_in_tile(where);
    if (place + kPrefetchAhead < kTileCells) prefetch(tile, place + kPrefetchAhead);
    if (!read_cell(reader, tile_of(where), tile, place, cell)) return;
    append(cell, frame, frame.geometry.id_of(at), grid, cells);
  });
}

}  // namespace mrpt_terrain
