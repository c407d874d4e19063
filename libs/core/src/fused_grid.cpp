// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fused_access.h"

namespace mrpt_terrain {
namespace {

using Access = FusedGridAccess;

constexpr MapCellRect kEverything{{-MapLattice::kMost, -MapLattice::kMost},
                                  {MapLattice::kMost, MapLattice::kMost}};

// ---- the window ----

// First cell of a window of n cells about a position along one axis.
std::int32_t window_start(double position, std::int32_t n, double cell_size) {
  return floor_to_int(position / cell_size - 0.5 * n + 0.5);
}

bool is_off_centre(double position, std::int32_t low, std::int32_t high, const MapLattice& lattice,
                   double limit) {
  const double centre =
      0.5 * (static_cast<double>(low) + static_cast<double>(high)) * lattice.cell_size();
  // Half a cell is what rounding to whole cells leaves.
  return std::abs(position - centre) > std::max(limit, 0.5001 * lattice.cell_size());
}

void follow(const Eigen::Vector3d& robot, const FusionParams& params, FusedGrid& grid) {
  const FusedSnapshot& now = grid.now();
  if (params.extent == FusionExtent::kGrowing) {
    Access::now(grid).window = kEverything;
    return;
  }
  const double c = now.lattice.cell_size();
  const auto n_i = static_cast<std::int32_t>(std::lround(params.length / c));
  const auto n_j = static_cast<std::int32_t>(std::lround(params.width / c));
  const MapCellRect& old = now.window;
  const bool same_size = old.high.i - old.low.i == n_i && old.high.j - old.low.j == n_j;
  if (same_size &&
      !is_off_centre(robot.x(), old.low.i, old.high.i, now.lattice, params.roll_step) &&
      !is_off_centre(robot.y(), old.low.j, old.high.j, now.lattice, params.roll_step)) {
    return;
  }
  const MapCell low{window_start(robot.x(), n_i, c), window_start(robot.y(), n_j, c)};
  move_window({low, {low.i + n_i, low.j + n_j}}, grid);
}

// Forgets the cells of a tile outside `window`.
void cut_tile(TileIndex index, const MapCellRect& window, FusedGrid& grid) {
  const Tile* tile = grid.now().tiles.find(index);
  if (tile == nullptr) return;
  const MapCell corner = cell_of(index, 0);
  const MapCellRect own{corner, {corner.i + kTileSide, corner.j + kTileSide}};
  if (intersection(own, window).empty()) {
    Access::drop(grid, index);
    return;
  }
  Tile* writable = nullptr;
  for (std::size_t place = 0; place < kTileCells; ++place) {
    if (tile->cells[place].first == kNoBin || window.contains(cell_of(index, place))) continue;
    if (writable == nullptr) tile = writable = &Access::writable(grid, index);
    clear_cell(*writable, place);
  }
}

void cut_tiles_of(const MapCellRect& cells, const MapCellRect& window, FusedGrid& grid) {
  if (cells.empty()) return;
  const TileIndex low = tile_of(cells.low);
  const TileIndex high = tile_of({cells.high.i - 1, cells.high.j - 1});
  for (std::int32_t i = low.i; i <= high.i; ++i) {
    for (std::int32_t j = low.j; j <= high.j; ++j) cut_tile({i, j}, window, grid);
  }
}

// ---- points to bins of one scan ----

/// Rotation and translation as plain numbers, which the compiler keeps in registers.
struct Motion {
  std::array<double, 9> r{};
  std::array<double, 3> t{};

  explicit Motion(const Eigen::Isometry3d& pose) {
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        r[static_cast<std::size_t>(3 * row + col)] = pose.linear()(row, col);
      }
      t[static_cast<std::size_t>(row)] = pose.translation()[row];
    }
  }
  [[nodiscard]] double x(double px, double py, double pz) const {
    return r[0] * px + r[1] * py + r[2] * pz + t[0];
  }
  [[nodiscard]] double y(double px, double py, double pz) const {
    return r[3] * px + r[4] * py + r[5] * pz + t[1];
  }
  [[nodiscard]] double z(double px, double py, double pz) const {
    return r[6] * px + r[7] * py + r[8] * pz + t[2];
  }
};

// Nearest multiple of 2^-16: adding this number leaves no room for finer digits.
double rounded(double offset) {
  constexpr double kShift = 1.5 * (1ULL << 36U);
  return (offset + kShift) - kShift;
}

/// What the loop over the points needs.
struct Sorter {
  const MapLattice lattice;
  const Motion motion;
  const MapCellRect reach;
  const double top, bottom;  // heights of the map
  FusionWorkspace& workspace;

  [[nodiscard]] std::size_t head_of(MapCell cell) const {
    const auto stride = static_cast<std::size_t>(reach.high.j - reach.low.j);
    return static_cast<std::size_t>(cell.i - reach.low.i) * stride +
           static_cast<std::size_t>(cell.j - reach.low.j);
  }
};

// The bin of this scan for a layer of a cell; those of a cell are linked by layer.
ScanBin& scan_bin(const Sorter& self, MapCell cell, std::int32_t layer) {
  std::vector<ScanBin>& bins = self.workspace.bins;
  std::int32_t* link = &self.workspace.head[self.head_of(cell)];
  while (*link >= 0 && bins[static_cast<std::size_t>(*link)].layer < layer) {
    link = &bins[static_cast<std::size_t>(*link)].next;
  }
  if (*link >= 0 && bins[static_cast<std::size_t>(*link)].layer == layer) {
    return bins[static_cast<std::size_t>(*link)];
  }
  ScanBin bin;
  bin.cell = cell;
  bin.layer = layer;
  bin.next = *link;
  bin.z_min = std::numeric_limits<float>::max();
  bin.z_max = std::numeric_limits<float>::lowest();
  *link = static_cast<std::int32_t>(bins.size());
  bins.push_back(bin);
  return bins.back();
}

void count_left_out(double x, double y, double z, const Sorter& self, FusionCounts& counts) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
    ++counts.not_finite;
  } else if (z >= self.top) {
    ++counts.too_high;
  } else if (z < self.bottom) {
    ++counts.too_low;
  } else {
    ++counts.outside;
  }
}

/// A point in its cell and layer.
struct PlacedPoint {
  MapCell cell;
  std::int32_t layer;
  double x, y, z;  // from the centre of the cell and the bottom of the layer, metres
};

bool place_point(double x, double y, double z, const Sorter& self, PlacedPoint& point) {
  const MapLattice lattice = self.lattice;
  if (!(z < self.top && z >= self.bottom) || !lattice.cell_at(x, y, point.cell) ||
      !self.reach.contains(point.cell) || !lattice.layer_at(z, point.layer)) {
    return false;
  }
  const Position2 centre = lattice.centre_of(point.cell);
  point.x = rounded(x - centre.x);
  point.y = rounded(y - centre.y);
  point.z = rounded(z - lattice.bottom_of(point.layer));
  return true;
}

void add_point(const PlacedPoint& point, const Sorter& self) {
  ScanBin& bin = scan_bin(self, point.cell, point.layer);
  bin.z_min = std::min(bin.z_min, static_cast<float>(point.z));
  bin.z_max = std::max(bin.z_max, static_cast<float>(point.z));
  bin.sums.add(point.x, point.y, point.z);
}

void prefetch(const void* place) {
#if defined(__GNUC__)
  __builtin_prefetch(place);
#else
  (void)place;
#endif
}

// So many points at a time: the list of each one's cell is on its way while the others are placed.
void sort_points(const PointsView points, const Sorter& self, FusionCounts& counts) {
  constexpr std::size_t kTogether = 32;
  std::array<PlacedPoint, kTogether> placed;
  for (std::size_t begin = 0; begin < points.size; begin += kTogether) {
    const std::size_t end = std::min(begin + kTogether, points.size);
    std::size_t size = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double px = points.x[i], py = points.y[i], pz = points.z[i];
      const double x = self.motion.x(px, py, pz);
      const double y = self.motion.y(px, py, pz);
      const double z = self.motion.z(px, py, pz);
      if (place_point(x, y, z, self, placed[size])) {
        prefetch(&self.workspace.head[self.head_of(placed[size++].cell)]);
      } else {
        count_left_out(x, y, z, self, counts);
      }
    }
    for (std::size_t k = 0; k < size; ++k) add_point(placed[k], self);
  }
}

MapCellRect reach_of(const Eigen::Vector3d& robot, const FusionParams& params,
                     const FusedSnapshot& now) {
  MapCell low, high;
  const double range = params.max_range;
  if (!now.lattice.cell_at(robot.x() - range, robot.y() - range, low) ||
      !now.lattice.cell_at(robot.x() + range, robot.y() + range, high)) {
    return {};
  }
  return intersection({low, {high.i + 1, high.j + 1}}, now.window);
}

// ---- bins of one scan into the grid ----

// Adds the points of a scan to those of a bin (Chan, Golub and LeVeque 1979).
void add(const ScanBin& hit, double time, HeightBin& bin) {
  const Moments m = moments_from(hit.sums);
  const double before = bin.count;
  const double n = before + m.n;
  const double share = m.n / n;
  const double weight = before * share;
  const double dx = m.mean_x - double{bin.mean_x};
  const double dy = m.mean_y - double{bin.mean_y};
  const double dz = m.mean_z - double{bin.mean_z};
  bin.z_min = bin.count == 0 ? hit.z_min : std::min(bin.z_min, hit.z_min);
  bin.z_max = bin.count == 0 ? hit.z_max : std::max(bin.z_max, hit.z_max);
  bin.mean_x = static_cast<float>(bin.mean_x + share * dx);
  bin.mean_y = static_cast<float>(bin.mean_y + share * dy);
  bin.mean_z = static_cast<float>(bin.mean_z + share * dz);
  bin.m_xx = static_cast<float>(bin.m_xx + m.m_xx + weight * dx * dx);
  bin.m_xy = static_cast<float>(bin.m_xy + m.m_xy + weight * dx * dy);
  bin.m_xz = static_cast<float>(bin.m_xz + m.m_xz + weight * dx * dz);
  bin.m_yy = static_cast<float>(bin.m_yy + m.m_yy + weight * dy * dy);
  bin.m_yz = static_cast<float>(bin.m_yz + m.m_yz + weight * dy * dz);
  bin.m_zz = static_cast<float>(bin.m_zz + m.m_zz + weight * dz * dz);
  bin.count += static_cast<std::uint32_t>(m.n);
  bin.last_seen = time;
  bin.scans = static_cast<std::uint8_t>(std::min(255, bin.scans + 1));
  bin.freed = 0;
}

// Puts a new bin where `link` points; false if the tile is full.
bool insert_bin(Tile& tile, BinLink link, std::int32_t layer, TileStore& store) {
  const BinIndex fresh = store.new_bin(tile);
  if (fresh == kNoBin) return false;
  tile.bin(fresh).layer = layer;
  tile.bin(fresh).next = *link;
  *link = fresh;
  return true;
}

bool leads_to(const Tile& tile, BinIndex bin, std::int32_t layer) {
  return bin != kNoBin && tile.bin(bin).layer == layer;
}

// Adds the points to the layer's newer bin, which replaces the older one when it has seen enough
// scans; false if there was no room.
bool merge(const ScanBin& hit, double time, int renew_scans, Tile& tile, TileStore& store) {
  BinLink older = &tile.cells[place_in_tile(hit.cell)].first;
  while (*older != kNoBin && tile.bin(*older).layer < hit.layer) older = &tile.bin(*older).next;
  if (!leads_to(tile, *older, hit.layer)) {
    if (!insert_bin(tile, older, hit.layer, store)) return false;
    add(hit, time, tile.bin(*older));
    return true;
  }
  tile.bin(*older).freed = 0;
  BinLink newer = &tile.bin(*older).next;
  bool has_two = leads_to(tile, *newer, hit.layer);
  if (!has_two && renew_scans > 0 && tile.bin(*older).scans >= renew_scans) {
    has_two = insert_bin(tile, newer, hit.layer, store);
  }
  HeightBin& bin = tile.bin(has_two ? *newer : *older);
  add(hit, time, bin);
  if (has_two && renew_scans > 0 && bin.scans >= renew_scans) remove_bin(tile, older);
  return true;
}

// A hit in space known to be free: the longer part of it remains.
void trim(std::int32_t layer, LayerSpan& free) {
  if (!free.contains(layer)) return;
  if (layer - free.low > free.high - layer - 1) {
    free.high = layer;
  } else {
    free.low = layer + 1;
  }
  if (free.empty()) free = {};
}

void forget_old(double before, std::size_t place, Tile& tile) {
  BinLink link = &tile.cells[place].first;
  while (*link != kNoBin) {
    if (tile.bin(*link).last_seen < before) {
      remove_bin(tile, link);
    } else {
      link = &tile.bin(*link).next;
    }
  }
  if (tile.cells[place].first == kNoBin) tile.cells[place].free = {};
}

/// What is the same for all cells of a scan.
struct Merger {
  const PosedScan& scan;
  const FusionParams& params;
  const std::vector<ScanBin>& bins;
  TileStore& store;
};

// All that a scan says about one cell, from its first bin up.
void merge_cell(const Merger& self, std::int32_t first, Tile& tile, FusionCounts& counts) {
  const auto& [scan, params, bins, store] = self;
  const std::size_t place = place_in_tile(bins[static_cast<std::size_t>(first)].cell);
  if (params.max_age > 0.0) forget_old(scan.time - params.max_age, place, tile);
  for (std::int32_t k = first; k >= 0; k = bins[static_cast<std::size_t>(k)].next) {
    const ScanBin& hit = bins[static_cast<std::size_t>(k)];
    trim(hit.layer, tile.cells[place].free);
    const bool done = merge(hit, scan.time, params.renew_scans, tile, store);
    (done ? counts.fused : counts.no_room) += static_cast<std::size_t>(hit.sums.n);
  }
  ++counts.cells;
}

/// The tiles in reach, numbered row by row.
struct TileRange {
  TileIndex low;
  std::int32_t rows, columns;

  explicit TileRange(const MapCellRect& cells) : low(tile_of(cells.low)) {
    const TileIndex high = tile_of({cells.high.i - 1, cells.high.j - 1});
    rows = high.i - low.i + 1;
    columns = high.j - low.j + 1;
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  [[nodiscard]] std::size_t number_of(MapCell cell) const {
    const TileIndex tile = tile_of(cell);
    return static_cast<std::size_t>((tile.i - low.i) * columns + tile.j - low.j);
  }
  [[nodiscard]] TileIndex tile(std::size_t number) const {
    const auto n = static_cast<std::int32_t>(number);
    return {low.i + n / columns, low.j + n % columns};
  }
};

// Lists the cells that were hit by their first bins, tile by tile, so that a tile is copied and
// written to while it is in the caches. Leaves `head` empty.
void sort_cells_by_tile(const Sorter& sorter, const TileRange& tiles) {
  FusionWorkspace& workspace = sorter.workspace;
  const std::vector<ScanBin>& bins = workspace.bins;
  std::vector<std::int32_t>& begin = workspace.tile_begin;
  begin.assign(tiles.size() + 1, 0);
  workspace.cells.clear();
  // There are at most as many cells as bins: memory for them grows with that for the bins only.
  for (auto* list : {&workspace.cells, &workspace.by_tile}) list->reserve(bins.capacity());
  workspace.hit.reserve(bins.capacity());
  for (const ScanBin& hit : bins) {
    const std::int32_t first =
        std::exchange(workspace.head[sorter.head_of(hit.cell)], std::int32_t{-1});
    if (first < 0) continue;  // came with another bin of the same cell
    workspace.cells.push_back(first);
    ++begin[tiles.number_of(hit.cell) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  workspace.by_tile.resize(workspace.cells.size());
  for (const std::int32_t first : workspace.cells) {
    std::int32_t& next = begin[tiles.number_of(bins[static_cast<std::size_t>(first)].cell)];
    workspace.by_tile[static_cast<std::size_t>(next++)] = first;
  }
  // Each beginning has become the next one.
  std::rotate(begin.rbegin(), begin.rbegin() + 1, begin.rend());
  begin.front() = 0;
}

void merge_all(const PosedScan& scan, const FusionParams& params, const Sorter& sorter,
               FusedGrid& grid, FusionCounts& counts) {
  FusionWorkspace& workspace = sorter.workspace;
  const TileRange tiles(sorter.reach);
  sort_cells_by_tile(sorter, tiles);
  const Merger merger{scan, params, workspace.bins, Access::store(grid)};
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const auto begin = static_cast<std::size_t>(workspace.tile_begin[k]);
    const auto end = static_cast<std::size_t>(workspace.tile_begin[k + 1]);
    if (begin == end) continue;
    Tile& tile = Access::writable(grid, tiles.tile(k));
    for (std::size_t n = begin; n < end; ++n) {
      const std::int32_t first = workspace.by_tile[n];
      merge_cell(merger, first, tile, counts);
      const MapCell cell = workspace.bins[static_cast<std::size_t>(first)].cell;
      workspace.hit.push_back(layers_of(tile, cell));
    }
  }
}

}  // namespace

CellLayers layers_of(const Tile& tile, MapCell cell) {
  CellLayers layers{cell, {}, false};
  for_each_bin(tile, place_in_tile(cell), [&](const HeightBin& bin) {
    if (layers.span.empty()) layers.span.low = bin.layer;
    layers.several |= bin.layer != layers.span.low;
    layers.span.high = bin.layer + 1;
  });
  return layers;
}

void FusedGrid::clear() {
  const MapLattice lattice = now_.lattice;
  now_ = {};
  now_.lattice = lattice;
}

void move_window(const MapCellRect& window, FusedGrid& grid) {
  const MapCellRect old = grid.now().window;
  if (old == window) return;
  Access::now(grid).window = window;
  if (old == kEverything) {
    std::vector<TileIndex> all;
    grid.now().tiles.for_each([&](TileIndex index, const Tile&) { all.push_back(index); });
    for (const TileIndex index : all) cut_tile(index, window, grid);
    return;
  }
  const MapCellRect kept = intersection(old, window);
  if (kept.empty()) {
    cut_tiles_of(old, window, grid);
    return;
  }
  cut_tiles_of({old.low, {kept.low.i, old.high.j}}, window, grid);
  cut_tiles_of({{kept.high.i, old.low.j}, old.high}, window, grid);
  cut_tiles_of({{kept.low.i, old.low.j}, {kept.high.i, kept.low.j}}, window, grid);
  cut_tiles_of({{kept.low.i, kept.high.j}, {kept.high.i, old.high.j}}, window, grid);
}

FusionCounts fuse_scan(const PosedScan& scan, const FusionParams& params,
                       FusionWorkspace& workspace, FusedGrid& grid) {
  const Eigen::Vector3d robot = scan.T_map_robot.translation();
  assert(scan.T_map_robot.matrix().allFinite());
  Access::store(grid).collect();
  follow(robot, params, grid);
  const FusedSnapshot& now = grid.now();
  const MapCellRect reach = reach_of(robot, params, now);
  const Sorter sorter{now.lattice,
                      Motion(scan.T_map_robot),
                      reach,
                      robot.z() + params.max_height,
                      robot.z() + params.min_height,
                      workspace};
  const std::size_t cells = reach.empty()
                                ? 0
                                : static_cast<std::size_t>(reach.high.i - reach.low.i) *
                                      static_cast<std::size_t>(reach.high.j - reach.low.j);
  if (workspace.head.size() < cells) workspace.head.resize(cells, -1);
  workspace.bins.clear();
  workspace.hit.clear();
  FusionCounts counts;
  sort_points(scan.points, sorter, counts);
  if (!workspace.bins.empty()) merge_all(scan, params, sorter, grid, counts);
  Access::now(grid).time = scan.time;
  ++Access::now(grid).scans;
  return counts;
}

void forget_before(double time, FusedGrid& grid) {
  std::vector<TileIndex> stale;
  grid.now().tiles.for_each([&](TileIndex index, const Tile& tile) {
    for (std::size_t place = 0; place < kTileCells; ++place) {
      bool found = false;
      for_each_bin(tile, place, [&](const HeightBin& bin) { found |= bin.last_seen < time; });
      if (!found) continue;
      stale.push_back(index);
      return;
    }
  });
  for (const TileIndex index : stale) {
    Tile& tile = Access::writable(grid, index);
    for (std::size_t place = 0; place < kTileCells; ++place) forget_old(time, place, tile);
    if (tile.bins == 0) Access::drop(grid, index);
  }
}

FusedMemory memory_of(const FusedGrid& grid) {
  FusedMemory memory;
  grid.now().tiles.for_each([&](TileIndex, const Tile& tile) {
    memory.tiles += sizeof(Tile) + tile.blocks.size() * sizeof(BinBlock);
    memory.bins += tile.bins;
    for (const TileCell& cell : tile.cells) memory.cells += cell.first != kNoBin ? 1U : 0U;
  });
  memory.spare = Access::store(grid).spare_bytes();
  return memory;
}

}  // namespace mrpt_terrain
