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
  double n = 0.0;  // points
};

// Adds a set to another that is not empty (Chan, Golub and LeVeque 1979).
inline void add(const Moments& set, Moments& sum) {
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
      : reader_(reader), tile_(tile) {
    if (reader.params.max_age > 0.0) oldest_ = reader.map.time - reader.params.max_age;
    go_to(tile.cells[place].first);
  }

  [[nodiscard]] bool done() const { return bin_ == nullptr; }

  /// Number of points of the next layer, which is passed.
  double skip_layer() {
    const std::int32_t layer = bin_->layer;
    double n = 0.0;
    for (; !done() && bin_->layer == layer; go_to(bin_->next)) n += bin_->count;
    return n;
  }

  /// The next layer, which is passed, and its points about the centre of the cell. In their places
  /// at once: the processor waits where what was just written is copied.
  void take(Layer& layer, Moments& points) {
    layer.number = bin_->layer;
    const double bottom = reader_.map.lattice.bottom_of(layer.number);
    layer.z_min = bottom + double{bin_->z_min};
    layer.z_max = bottom + double{bin_->z_max};
    layer.scans = bin_->scans;
    layer.bins = 1;
    layer.last_seen = bin_->last_seen;
    points = moments_of(*bin_, reader_.map.lattice);
    for (go_to(bin_->next); !done() && bin_->layer == layer.number; go_to(bin_->next)) {
      layer.z_min = std::min(layer.z_min, bottom + double{bin_->z_min});
      layer.z_max = std::max(layer.z_max, bottom + double{bin_->z_max});
      layer.scans += bin_->scans;
      layer.last_seen = std::max(layer.last_seen, bin_->last_seen);
      ++layer.bins;
      add(moments_of(*bin_, reader_.map.lattice), points);
    }
    layer.n = points.n;
  }

 private:
  // The first bin from `k` on that counts.
  void go_to(BinIndex k) {
    for (; k != kNoBin; k = bin_->next) {
      bin_ = &tile_.bin(k);
      if (counts(*bin_)) return;
    }
    bin_ = nullptr;
  }
  [[nodiscard]] bool counts(const HeightBin& bin) const {
    return bin.last_seen >= oldest_ &&
           reader_.map.lattice.bottom_of(bin.layer) + double{bin.z_min} < reader_.ceiling;
  }

  const CellReader& reader_;
  const Tile& tile_;
  const HeightBin* bin_ = nullptr;
  double oldest_ = std::numeric_limits<double>::lowest();
};

double points_of_fullest_layer(LayerWalk walk) {
  double most = walk.skip_layer();
  while (!walk.done()) most = std::max(most, walk.skip_layer());
  return most;
}

// The lowest layer that is no outlier, with its points in `cell`; those below are counted.
void take_ground(const CellReader& reader, LayerWalk& walk, Layer& ground, FusedCell& cell) {
  const LayerWalk whole = walk;
  double least_points = -1.0;  // not known yet: most cells do without
  for (;;) {
    walk.take(ground, cell.moments);
    if (walk.done() || ground.scans >= kPersistent) return;
    if (least_points < 0.0) {
      least_points = reader.params.least_share * points_of_fullest_layer(whole);
    }
    if (ground.n >= least_points) return;
    cell.below += static_cast<std::int32_t>(ground.n);
  }
}

void count_in(const Layer& layer, const Moments& points, FusedCell& cell) {
  cell.h_max = std::max(cell.h_max, layer.z_max);
  cell.last_seen = std::max(cell.last_seen, layer.last_seen);
  cell.bins += layer.bins;
  add(points, cell.moments);
}

/// The heights of a set of points.
struct Heights {
  double n, mean, m;  // m: sum of squared deviations

  explicit Heights(const Moments& set) : n(set.n), mean(set.mean_z), m(set.m_zz) {}
  [[nodiscard]] double sigma() const { return std::sqrt(m / n); }
};

// As the other `add`.
void add(const Moments& set, Heights& sum) {
  const double n = sum.n + set.n;
  const double share = set.n / n;
  const double weight = sum.n * share;
  const double dz = set.mean_z - sum.mean;
  sum.n = n;
  sum.mean += share * dz;
  sum.m += set.m_zz + weight * dz * dz;
}

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
  cell.below = 0;
  cell.overhung = false;
  cell.overhang = 0.0;
  cell.free = tile.cells[place].free;
  Layer ground;
  take_ground(reader, walk, ground, cell);
  cell.ground = {ground.number, ground.number + 1};
  cell.h_min = ground.z_min;
  cell.h_max = ground.z_max;
  cell.last_seen = ground.last_seen;
  cell.bins = ground.bins;
  Heights surface(cell.moments);
  Heights top = surface;
  const bool is_flat = walk.done();
  const double limit = reader.params.spread_limit;
  const double spread = limit * surface.sigma();
  cell.low = std::max(cell.h_min, surface.mean - spread);
  Layer layer;
  Moments points;
  while (!walk.done()) {
    walk.take(layer, points);
    if (hangs_over(layer, ground, cell.free, reader)) {
      cell.overhung = true;
      cell.overhang = layer.z_min;
      break;
    }
    if (continues(layer, ground, reader.map.lattice)) {
      add(points, surface);
      ++cell.ground.high;
    }
    count_in(layer, points, cell);
    top = Heights(points);
  }
  cell.high = std::min(cell.h_max, top.mean + (is_flat ? spread : limit * top.sigma()));
  cell.height = surface.mean;
  cell.variance = surface.m / surface.n;
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
