// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

#include "mrpt_terrain/core/grid_geometry.h"

namespace mrpt_terrain {

/// Whole-number address of a cell of a map, the same for all time: the cell [i c, (i + 1) c) along
/// the map's x and [j c, (j + 1) c) along its y.
struct MapCell {
  std::int32_t i = 0;
  std::int32_t j = 0;

  friend bool operator==(MapCell a, MapCell b) { return a.i == b.i && a.j == b.j; }
  friend bool operator!=(MapCell a, MapCell b) { return !(a == b); }
  /// Row by row: by i, then by j.
  friend bool operator<(MapCell a, MapCell b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }
};

/// Rectangle of cells of a map: i in [low.i, high.i), j in [low.j, high.j).
struct MapCellRect {
  MapCell low, high;

  [[nodiscard]] bool contains(MapCell cell) const {
    return cell.i >= low.i && cell.i < high.i && cell.j >= low.j && cell.j < high.j;
  }
  [[nodiscard]] bool empty() const { return low.i >= high.i || low.j >= high.j; }
  friend bool operator==(const MapCellRect& a, const MapCellRect& b) {
    return a.low == b.low && a.high == b.high;
  }
  friend bool operator!=(const MapCellRect& a, const MapCellRect& b) { return !(a == b); }
};

/// Cells that lie in both of two rectangles; may be empty.
[[nodiscard]] inline MapCellRect intersection(const MapCellRect& a, const MapCellRect& b) {
  return {{std::max(a.low.i, b.low.i), std::max(a.low.j, b.low.j)},
          {std::min(a.high.i, b.high.i), std::min(a.high.j, b.high.j)}};
}

/// Greatest integer that is not above `value`. Requires |value| < 2^31.
[[nodiscard]] inline std::int32_t floor_to_int(double value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < truncated ? 1 : 0);
}

/// Where the cells and height layers of a map lie: the only place that converts between metres and
/// either. Anchored to the map's origin like the voxels of an OctoMap: layer k is
/// [k h, (k + 1) h) along z, so that with h the resolution of the octree layers are its voxels.
class MapLattice {
 public:
  /// Cells and layers are numbered within (-kMost, kMost): more than 3000 km of 0.2 m.
  static constexpr std::int32_t kMost = 1 << 24;

  MapLattice() = default;
  /// \param cell_size side of a cell, metres, > 0
  /// \param layer_height height of a layer, metres, > 0
  MapLattice(double cell_size, double layer_height)
      : cell_size_(cell_size),
        layer_height_(layer_height),
        cells_per_metre_(1.0 / cell_size),
        layers_per_metre_(1.0 / layer_height) {}

  [[nodiscard]] double cell_size() const { return cell_size_; }
  [[nodiscard]] double layer_height() const { return layer_height_; }

  /// Cell that holds (x, y), map frame, metres. Returns false, also for NaN, beyond `kMost` cells.
  [[nodiscard]] bool cell_at(double x, double y, MapCell& cell) const {
    const double i = x * cells_per_metre_;
    const double j = y * cells_per_metre_;
    constexpr double kEnd = kMost;
    if (!(i > -kEnd && i < kEnd && j > -kEnd && j < kEnd)) return false;
    cell = {floor_to_int(i), floor_to_int(j)};
    return true;
  }
  /// Layer that holds height z, map frame, metres. Returns false, also for NaN, beyond `kMost`.
  [[nodiscard]] bool layer_at(double z, std::int32_t& layer) const {
    const double k = z * layers_per_metre_;
    constexpr double kEnd = kMost;
    if (!(k > -kEnd && k < kEnd)) return false;
    layer = floor_to_int(k);
    return true;
  }
  /// Centre of a cell, map frame, metres.
  [[nodiscard]] Position2 centre_of(MapCell cell) const {
    return {(cell.i + 0.5) * cell_size_, (cell.j + 0.5) * cell_size_};
  }
  /// Height of the lower face of a layer, map frame, metres.
  [[nodiscard]] double bottom_of(std::int32_t layer) const { return layer * layer_height_; }

  friend bool operator==(const MapLattice& a, const MapLattice& b) {
    return a.cell_size_ == b.cell_size_ && a.layer_height_ == b.layer_height_;
  }
  friend bool operator!=(const MapLattice& a, const MapLattice& b) { return !(a == b); }

 private:
  double cell_size_ = 0.2;
  double layer_height_ = 0.2;
  double cells_per_metre_ = 5.0;
  double layers_per_metre_ = 5.0;
};

}  // namespace mrpt_terrain
