// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mrpt_terrain {
namespace {

// A layer that so many scans have hit is no outlier, however few its points are.
constexpr int kPersistent = 3;

/// One layer of a cell, its two bins taken together. Heights in the map frame.
struct Layer {
  std::int32_t number = 0;
  double z_min = 0.0;
  double z_max = 0.0;
  int scans = 0;
  int bins = 0;
  double last_seen = 0.0;
  Moments moments;  // about the centre of the cell
};

// Adds a set to another (Chan, Golub and LeVeque 1979).
void add(const Moments& set, Moments& sum) {
  if (sum.n == 0.0) {
    sum = set;
    return;
  }
  const double n = sum.n + set.n;
  const double share = set.n / n;
  const double weight = sum.n * share;
  const double dx = set.mean_x - sum.mean_x;
  const double dy = set.mean_y - sum.mean_y;
  const double dz = set.mean_z - sum.mean_z;
  sum.n = n;
  sum.mean_x += share * dx;
  sum.mean_y += share * dy;
  sum.mean_z += share * dz;
  sum.m_xx += set.m_xx + weight * dx * dx;
  sum.m_xy += set.m_xy + weight * dx * dy;
  sum.m_xz += set.m_xz + weight * dx * dz;
  sum.m_yy += set.m_yy + weight * dy * dy;
  sum.m_yz += set.m_yz + weight * dy * dz;
  sum.m_zz += set.m_zz + weight * dz * dz;
}

/// Walks the layers of a cell from the bottom up, without bins that are too old or too high.
class LayerWalk {
 public:
  LayerWalk(const CellReader& reader, const Tile& tile, std::size_t place)
      : reader_(reader), tile_(tile), next_(tile.cells[place].first) {
    if (reader.params.max_age > 0.0) oldest_ = reader.map.time - reader.params.max_age;
    skip();
  }

  [[nodiscard]] bool done() const { return next_ == kNoBin; }

  /// Number of points of the next layer, which is passed.
  double skip_layer() {
    const std::int32_t layer = tile_.bin(next_).layer;
    double n = 0.0;
    for (; !done() && tile_.bin(next_).layer == layer; step()) n += tile_.bin(next_).count;
    return n;
  }

  /// The next layer, which is passed.
  Layer take() {
    Layer layer;
    layer.number = tile_.bin(next_).layer;
    layer.last_seen = tile_.bin(next_).last_seen;
    layer.z_min = std::numeric_limits<double>::max();
    layer.z_max = std::numeric_limits<double>::lowest();
    const double bottom = reader_.map.lattice.bottom_of(layer.number);
    for (; !done() && tile_.bin(next_).layer == layer.number; step()) {
      const HeightBin& bin = tile_.bin(next_);
      layer.z_min = std::min(layer.z_min, bottom + double{bin.z_min});
      layer.z_max = std::max(layer.z_max, bottom + double{bin.z_max});
      layer.scans += bin.scans;
      layer.last_seen = std::max(layer.last_seen, bin.last_seen);
      ++layer.bins;
      add(moments_of(bin, reader_.map.lattice), layer.moments);
    }
    return layer;
  }

 private:
  void step() {
    next_ = tile_.bin(next_).next;
    skip();
  }
  void skip() {
    while (!done() && !counts(tile_.bin(next_))) next_ = tile_.bin(next_).next;
  }
  [[nodiscard]] bool counts(const HeightBin& bin) const {
    return bin.last_seen >= oldest_ &&
           reader_.map.lattice.bottom_of(bin.layer) + double{bin.z_min} < reader_.ceiling;
  }

  const CellReader& reader_;
  const Tile& tile_;
  BinIndex next_;
  double oldest_ = std::numeric_limits<double>::lowest();
};

double points_of_fullest_layer(LayerWalk walk) {
  double most = walk.skip_layer();
  while (!walk.done()) most = std::max(most, walk.skip_layer());
  return most;
}

// The lowest layer that is no outlier; those below are counted.
Layer take_ground(LayerWalk& walk, double least_points, FusedCell& cell) {
  for (;;) {
    Layer layer = walk.take();
    if (layer.moments.n >= least_points || layer.scans >= kPersistent || walk.done()) return layer;
    cell.below += static_cast<std::int32_t>(layer.moments.n);
  }
}

void count_in(const Layer& layer, FusedCell& cell) {
  cell.h_max = std::max(cell.h_max, layer.z_max);
  cell.last_seen = std::max(cell.last_seen, layer.last_seen);
  cell.bins += layer.bins;
  add(layer.moments, cell.moments);
}

double sigma_of(const Moments& m) { return std::sqrt(m.m_zz / m.n); }

// Whether a layer hangs over ground: above enough space known to be free, which begins at the
// ground.
bool hangs_over(const Layer& layer, const Layer& ground, LayerSpan free, const CellReader& reader) {
  const MapLattice& lattice = reader.map.lattice;
  return !free.empty() && layer.number >= free.high &&
         free.layers() * lattice.layer_height() >= reader.params.clearance &&
         lattice.bottom_of(free.low) <= ground.z_max + reader.params.guard_height;
}

// Ground that lies on the border of two layers is one surface.
bool continues(const Layer& next, const Layer& ground, const MapLattice& lattice) {
  return next.number == ground.number + 1 && next.z_max - ground.z_min <= lattice.layer_height();
}

}  // namespace

bool read_cell(const CellReader& reader, TileIndex index, const Tile& tile, std::size_t place,
               FusedCell& cell) {
  LayerWalk walk(reader, tile, place);
  if (walk.done() || !reader.map.window.contains(cell_of(index, place))) return false;
  cell = FusedCell{};
  cell.free = tile.cells[place].free;
  const Layer ground =
      take_ground(walk, reader.params.least_share * points_of_fullest_layer(walk), cell);
  cell.h_min = ground.z_min;
  cell.h_max = ground.z_max;
  cell.last_seen = ground.last_seen;
  count_in(ground, cell);
  Moments surface = ground.moments;
  Layer top = ground;
  while (!walk.done()) {
    const Layer layer = walk.take();
    if (hangs_over(layer, ground, cell.free, reader)) {
      cell.overhung = true;
      cell.overhang = layer.z_min;
      break;
    }
    if (continues(layer, ground, reader.map.lattice)) add(layer.moments, surface);
    count_in(layer, cell);
    top = layer;
  }
  cell.height = surface.mean_z;
  cell.variance = surface.m_zz / surface.n;
  const double limit = reader.params.spread_limit;
  cell.low = std::max(cell.h_min, ground.moments.mean_z - limit * sigma_of(ground.moments));
  cell.high = std::min(cell.h_max, top.moments.mean_z + limit * sigma_of(top.moments));
  const Position2 centre = reader.map.lattice.centre_of(cell_of(index, place));
  cell.moments.mean_x += centre.x;
  cell.moments.mean_y += centre.y;
  return true;
}

bool read_cell(const FusedSnapshot& map, MapCell where, const FusionParams& params,
               FusedCell& cell) {
  if (!map.window.contains(where)) return false;
  const TileIndex index = tile_of(where);
  const Tile* tile = map.tiles.find(index);
  const CellReader reader{map, params, std::numeric_limits<double>::infinity()};
  return tile != nullptr && read_cell(reader, index, *tile, place_in_tile(where), cell);
}

}  // namespace mrpt_terrain
