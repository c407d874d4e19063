// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/tile_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "fused_access.h"

namespace mrpt_terrain {
namespace {

bool is_finite(const HeightBin& bin) {
  const std::array<float, 11> numbers = {bin.z_min,  bin.z_max, bin.mean_x, bin.mean_y,
                                         bin.mean_z, bin.m_xx,  bin.m_xy,   bin.m_xz,
                                         bin.m_yy,   bin.m_yz,  bin.m_zz};
  return std::isfinite(bin.last_seen) &&
         std::all_of(numbers.begin(), numbers.end(), [](float v) { return std::isfinite(v); });
}

bool is_within(std::int32_t value) {
  return value > -MapLattice::kMost && value < MapLattice::kMost;
}

bool is_possible(const HeightBin& bin) {
  return bin.count > 0 && is_within(bin.layer) && bin.z_min <= bin.z_max && bin.m_xx >= 0.0F &&
         bin.m_yy >= 0.0F && bin.m_zz >= 0.0F;
}

// Bins [first, last) of one cell: sorted by layer, at most two in each, none empty.
bool are_in_order(const HeightBin* first, const HeightBin* last) {
  for (const HeightBin* bin = first; bin != last; ++bin) {
    if (!is_possible(*bin)) return false;
    if (bin != first && bin->layer < bin[-1].layer) return false;
    if (bin - first >= 2 && bin->layer == bin[-2].layer) return false;
  }
  return true;
}

RestoreStatus check(const TileState& state) {
  constexpr std::int32_t kEnd = MapLattice::kMost / kTileSide;
  const TileIndex tile = state.tile;
  if (tile.i < -kEnd || tile.i >= kEnd || tile.j < -kEnd || tile.j >= kEnd) {
    return RestoreStatus::kBadIndex;
  }
  if (state.bins.size() > kMostBins) return RestoreStatus::kTooMany;
  if (!std::all_of(state.bins.begin(), state.bins.end(), is_finite)) {
    return RestoreStatus::kNotFinite;
  }
  std::size_t first = 0;
  int last_place = -1;
  for (const TileState::Cell& cell : state.cells) {
    const std::size_t end = first + cell.bins;
    if (int{cell.place} <= last_place || cell.bins == 0 || end > state.bins.size()) {
      return RestoreStatus::kBadCells;
    }
    const LayerSpan free = cell.free;
    const bool free_is_good =
        free == LayerSpan{} || (!free.empty() && is_within(free.low) && is_within(free.high));
    if (!free_is_good) return RestoreStatus::kBadCells;
    if (!are_in_order(state.bins.data() + first, state.bins.data() + end)) {
      return RestoreStatus::kBadBins;
    }
    last_place = cell.place;
    first = end;
  }
  if (first != state.bins.size()) return RestoreStatus::kBadCells;
  return RestoreStatus::kOk;
}

}  // namespace

void save_tile(TileIndex index, const Tile& tile, TileState& state) {
  state.tile = index;
  state.cells.clear();
  state.bins.clear();
  for (std::size_t place = 0; place < kTileCells; ++place) {
    const std::size_t before = state.bins.size();
    for_each_bin(tile, place, [&](const HeightBin& bin) {
      state.bins.push_back(bin);
      state.bins.back().next = kNoBin;
    });
    const std::size_t bins = state.bins.size() - before;
    if (bins == 0) continue;
    state.cells.push_back({static_cast<std::uint8_t>(place), static_cast<std::uint16_t>(bins),
                           tile.cells[place].free});
  }
}

RestoreStatus restore_tile(const TileState& state, FusedGrid& grid) {
  const RestoreStatus status = check(state);
  if (status != RestoreStatus::kOk) return status;
  FusedGridAccess::drop(grid, state.tile);
  if (state.cells.empty()) return status;
  Tile& tile = FusedGridAccess::writable(grid, state.tile);
  std::size_t next = 0;
  for (const TileState::Cell& cell : state.cells) {
    BinLink link = &tile.cells[cell.place].first;
    for (std::size_t k = 0; k < cell.bins; ++k) {
      *link = FusedGridAccess::store(grid).new_bin(tile);
      HeightBin& bin = tile.bin(*link);
      bin = state.bins[next++];
      bin.next = kNoBin;
      link = &bin.next;
    }
    tile.cells[cell.place].free = cell.free;
  }
  return status;
}

void restore_progress(const MapCellRect& window, double time, std::uint64_t scans,
                      FusedGrid& grid) {
  FusedSnapshot& now = FusedGridAccess::now(grid);
  now.window = window;
  now.time = time;
  now.scans = scans;
}

}  // namespace mrpt_terrain
