// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/apply_free_space.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "fused_access.h"
#include "mrpt_terrain/core/fused_cell.h"

namespace mrpt_terrain {
namespace {

using Access = FusedGridAccess;

// Fewer known cells around say nothing about the ground there.
constexpr int kLeastAround = 4;

/// What becomes of a bin.
enum class Verdict : std::uint8_t {
  kUntouched,  // nothing says that its layer is free
  kGuarded,    // stays in spite of it
  kDoubted,    // the same, and the scan counts against it
  kRemoved,
};

/// One cell with its free layers.
struct Column {
  const FusedSnapshot& map;
  const MapLattice& lattice;
  const FusionParams& params;
  MapCell cell;
  double time;
  const LayerSpan* begin;
  const LayerSpan* end;

  [[nodiscard]] const LayerSpan* span_at(std::int32_t layer) const {
    const LayerSpan* span =
        std::find_if(begin, end, [layer](LayerSpan s) { return layer < s.high; });
    return span != end && span->contains(layer) ? span : nullptr;
  }
};

/// The lowest bin that stays.
struct Ground {
  bool found = false;
  double z_min = 0.0;
  std::int32_t layer = 0;
};

bool is_hit(const Tile& tile, std::size_t place, double time) {
  bool hit = false;
  for_each_bin(tile, place, [&](const HeightBin& bin) { hit |= bin.last_seen >= time; });
  return hit;
}

// A layer was hit if its older or its newer bin was.
bool is_layer_hit(const Tile& tile, const HeightBin& bin, double time) {
  if (bin.last_seen >= time) return true;
  return bin.next != kNoBin && tile.bin(bin.next).layer == bin.layer &&
         tile.bin(bin.next).last_seen >= time;
}

// Lowest point of the lowest bin of a cell, or nothing.
std::optional<double> lowest_of(const Tile& tile, std::size_t place, const MapLattice& lattice) {
  const BinIndex first = tile.cells[place].first;
  if (first == kNoBin) return std::nullopt;
  return lattice.bottom_of(tile.bin(first).layer) + double{tile.bin(first).z_min};
}

// Whether a height lies clearly above the ground around a cell: two thirds of the cells known there
// have something well below it.
bool stands_out(const FusedSnapshot& map, MapCell cell, double height, const FusionParams& params) {
  const double cells = params.ground_reach / map.lattice.cell_size();
  const auto reach = static_cast<std::int32_t>(std::lround(cells));
  const std::int32_t most = (2 * reach + 1) * (2 * reach + 1) / 3;
  std::int32_t below = 0;
  std::int32_t level = 0;
  const Tile* tile = nullptr;
  TileIndex index{std::numeric_limits<std::int32_t>::max(), 0};
  for (std::int32_t i = cell.i - reach; i <= cell.i + reach; ++i) {
    for (std::int32_t j = cell.j - reach; j <= cell.j + reach; ++j) {
      const TileIndex next = tile_of({i, j});
      if (next != index) tile = map.tiles.find(next);
      index = next;
      if (tile == nullptr) continue;
      const auto lowest = lowest_of(*tile, place_in_tile({i, j}), map.lattice);
      if (!lowest) continue;
      ++(*lowest < height - params.guard_height ? below : level);
      if (level > most) return false;  // whatever the others are
    }
  }
  return below + level >= kLeastAround && below >= 2 * level;
}

Verdict judge(const Column& column, const HeightBin& bin, bool cell_hit, const Ground& ground) {
  const LayerSpan* free = column.span_at(bin.layer);
  if (free == nullptr) return Verdict::kUntouched;
  const double guard = column.params.guard_height;
  const double bottom = column.lattice.bottom_of(bin.layer);
  const double free_from = column.lattice.bottom_of(free->low);
  if (!ground.found) {  // rule 1
    const double lowest = bottom + double{bin.z_min};
    const bool goes =
        free_from <= lowest - guard || stands_out(column.map, column.cell, lowest, column.params);
    return goes ? Verdict::kRemoved : Verdict::kGuarded;
  }
  if (bottom + double{bin.z_max} > ground.z_min + guard) {  // rule 2
    const bool passed = free->low < bin.layer || free_from <= ground.z_min + guard;
    return passed ? Verdict::kRemoved : Verdict::kGuarded;
  }
  const int limit = column.params.guard_scans;  // rule 3
  if (bin.layer == ground.layer || limit == 0 || !cell_hit) return Verdict::kGuarded;
  return bin.freed + 1 >= limit ? Verdict::kRemoved : Verdict::kDoubted;
}

// Calls visit(link, verdict) for the bins of a cell from the bottom up; `visit` says whether it has
// taken the bin that the link leads to out of the list. Returns the ground that stays.
template <class AnyTile, class Visit>
Ground judge_all(const Column& column, AnyTile& tile, std::size_t place, Visit&& visit) {
  const bool cell_hit = is_hit(tile, place, column.time);
  Ground ground;
  auto* link = &tile.cells[place].first;
  while (*link != kNoBin) {
    auto& bin = tile.bin(*link);
    const Verdict verdict = is_layer_hit(tile, bin, column.time)
                                ? Verdict::kUntouched
                                : judge(column, bin, cell_hit, ground);
    if (verdict != Verdict::kRemoved && !ground.found) {
      ground = {true, column.lattice.bottom_of(bin.layer) + double{bin.z_min}, bin.layer};
    }
    if (!visit(link, verdict)) link = &bin.next;
  }
  return ground;
}

// Of two stretches of free space, the lower one if a robot fits in, the longer one otherwise.
LayerSpan better(LayerSpan lower, LayerSpan upper, std::int32_t enough) {
  if (lower.layers() >= enough) return lower;
  return upper.layers() > lower.layers() ? upper : lower;
}

// Free space above the ground: what is known already, and what is new.
LayerSpan free_above(const Column& column, std::int32_t ground, LayerSpan known) {
  const auto enough =
      static_cast<std::int32_t>(column.params.clearance / column.lattice.layer_height());
  LayerSpan best;
  for (const LayerSpan* span = column.begin; span != column.end; ++span) {
    if (span->high <= ground) continue;
    best = best.empty() ? *span : better(best, *span, enough);
  }
  if (known.empty() || known.high <= ground) return best;
  if (best.empty()) return known;
  if (best.low <= known.high && known.low <= best.high) {
    return {std::min(best.low, known.low), std::max(best.high, known.high)};
  }
  return best.low < known.low ? better(best, known, enough) : better(known, best, enough);
}

// Whether the rays would change anything in the cell, so that tiles are copied only then.
bool changes(const Column& column, const Tile& tile, std::size_t place, FreeSpaceCounts& counts) {
  bool any = false;
  std::size_t guarded = 0;
  const Ground ground = judge_all(column, tile, place, [&](const BinIndex*, Verdict verdict) {
    any |= verdict == Verdict::kDoubted || verdict == Verdict::kRemoved;
    guarded += verdict == Verdict::kDoubted || verdict == Verdict::kGuarded ? 1U : 0U;
    return false;
  });
  counts.bins_guarded += guarded;
  const LayerSpan known = tile.cells[place].free;
  return any || (ground.found && free_above(column, ground.layer, known) != known);
}

void apply(const Column& column, Tile& tile, std::size_t place, FreeSpaceCounts& counts) {
  const Ground ground = judge_all(column, tile, place, [&](BinLink link, Verdict verdict) {
    HeightBin& bin = tile.bin(*link);
    if (verdict == Verdict::kDoubted) ++bin.freed;
    if (verdict != Verdict::kRemoved) return false;
    ++counts.bins_removed;
    counts.points_removed += bin.count;
    remove_bin(tile, link);
    return true;
  });
  LayerSpan& known = tile.cells[place].free;
  known = ground.found ? free_above(column, ground.layer, known) : LayerSpan{};
}

// Fetching bins this many cells ahead hides most of the way to the outer caches.
constexpr std::size_t kPrefetchAhead = 8;

// `tile`, at `index`, is at hand: most cells ahead lie in it too.
void prefetch(const FusedSnapshot& map, MapCell cell, TileIndex index, const Tile* tile) {
#if defined(__GNUC__)
  if (tile_of(cell) != index) tile = map.tiles.find(tile_of(cell));
  if (tile == nullptr) return;
  const BinIndex first = tile->cells[place_in_tile(cell)].first;
  if (first == kNoBin) return;
  const auto* bin = reinterpret_cast<const char*>(&tile->bin(first));
  __builtin_prefetch(bin);
  __builtin_prefetch(bin + sizeof(HeightBin));
  __builtin_prefetch(bin + 2 * sizeof(HeightBin));
#else
  (void)map, (void)cell, (void)index, (void)tile;
#endif
}

}  // namespace

void find_guarded_ground(const FusedSnapshot& map, const MapCellRect& where,
                         const FusionParams& params, std::vector<GuardedGround>& found) {
  found.clear();
  const MapCellRect known = intersection(where, map.window);
  if (known.empty()) return;
  const CellReader reader{map, params, std::numeric_limits<double>::infinity()};
  FusedCell read;
  const TileIndex low = tile_of(known.low);
  const TileIndex high = tile_of({known.high.i - 1, known.high.j - 1});
  for (TileIndex at = low; at.i <= high.i; ++at.i) {
    for (at.j = low.j; at.j <= high.j; ++at.j) {
      const Tile* tile = map.tiles.find(at);
      for (std::size_t place = 0; tile != nullptr && place < kTileCells; ++place) {
        const MapCell cell = cell_of(at, place);
        std::int32_t below = 0;
        if (!known.contains(cell) || !read_cell(reader, at, *tile, place, read)) continue;
        if (!map.lattice.layer_at(read.h_min - params.guard_height, below)) continue;
        if (!stands_out(map, cell, read.h_min, params)) found.push_back({cell, read.ground, below});
      }
    }
  }
}

FreeSpaceCounts apply_free_space(const FreeSpaceGrid& free, const FusionParams& params,
                                 FusedGrid& grid) {
  assert(free.lattice == grid.now().lattice);
  FreeSpaceCounts counts;
  const Tile* tile = nullptr;
  TileIndex index;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const TileIndex next = tile_of(free.cell[k]);
    if (k == 0 || next != index) tile = grid.now().tiles.find(next);
    index = next;
    if (k + kPrefetchAhead < free.size()) {
      prefetch(grid.now(), free.cell[k + kPrefetchAhead], index, tile);
    }
    const std::size_t place = place_in_tile(free.cell[k]);
    if (tile == nullptr || tile->cells[place].first == kNoBin) continue;
    const Column column{grid.now(), free.lattice,     params,        free.cell[k],
                        free.time,  free.begin_of(k), free.end_of(k)};
    if (!changes(column, *tile, place, counts)) continue;
    Tile& writable = Access::writable(grid, index);
    apply(column, writable, place, counts);
    tile = &writable;
  }
  return counts;
}

}  // namespace mrpt_terrain
