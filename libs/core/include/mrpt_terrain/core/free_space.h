// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/map_lattice.h"

namespace mrpt_terrain {

/// Layers [low, high) of one cell, `MapLattice` numbers.
struct LayerSpan {
  std::int32_t low = 0;
  std::int32_t high = 0;

  [[nodiscard]] bool empty() const { return low >= high; }
  [[nodiscard]] std::int32_t layers() const { return empty() ? 0 : high - low; }
  [[nodiscard]] bool contains(std::int32_t layer) const { return layer >= low && layer < high; }
  friend bool operator==(LayerSpan a, LayerSpan b) { return a.low == b.low && a.high == b.high; }
  friend bool operator!=(LayerSpan a, LayerSpan b) { return !(a == b); }
};

/// What rays say about empty space, as plain numbers: for each cell that they say something about
/// the layers that are free over the whole cell. Made from an octree, or by hand.
///
/// Cells are sorted row by row and named once; the spans of a cell are sorted and do not touch.
struct FreeSpaceGrid {
  MapLattice lattice;
  double time = 0.0;                   ///< stamp of the scan whose rays these are, seconds
  std::vector<MapCell> cell;           ///< the cells that something is known of
  std::vector<std::int32_t> first{0};  ///< per cell: its first span; one more at the end
  std::vector<LayerSpan> spans;

  [[nodiscard]] std::size_t size() const { return cell.size(); }
  [[nodiscard]] const LayerSpan* begin_of(std::size_t k) const { return spans.data() + first[k]; }
  [[nodiscard]] const LayerSpan* end_of(std::size_t k) const { return spans.data() + first[k + 1]; }

  /// Number of a cell in the arrays, or `size()` if nothing is known of it.
  [[nodiscard]] std::size_t find(MapCell wanted) const;
  /// Lower face of the lowest free layer of entry k, map frame, metres.
  [[nodiscard]] double lowest_free(std::size_t k) const {
    return lattice.bottom_of(begin_of(k)->low);
  }
  /// Upper face of the highest free layer of entry k, map frame, metres.
  [[nodiscard]] double highest_free(std::size_t k) const {
    return lattice.bottom_of((end_of(k) - 1)->high);
  }
  /// Number of gaps between the free spans of entry k: layers there are occupied or unknown.
  [[nodiscard]] std::size_t gaps(std::size_t k) const {
    return static_cast<std::size_t>(first[k + 1] - first[k] - 1);
  }
  /// Layers of the n-th gap of entry k.
  [[nodiscard]] LayerSpan gap(std::size_t k, std::size_t n) const {
    return {begin_of(k)[n].high, begin_of(k)[n + 1].low};
  }
  /// Whether all heights of [low, high) metres are known to be free in a cell.
  [[nodiscard]] bool is_free(MapCell wanted, double low, double high) const;

  /// Removes all cells and keeps the memory.
  void clear();
  /// Appends a cell, which has to come after all cells before (row by row). Its spans follow by
  /// `add_span`; a cell without spans must not stay the last.
  void begin_cell(MapCell next);
  /// Appends a span to the last cell; it has to lie above the cell's spans before. A span that
  /// touches the one before extends it.
  void add_span(LayerSpan span);
};

/// A voxel by its whole-number address, [x r, (x + 1) r) and so on, r the resolution: the key of an
/// OctoMap less 32768.
struct VoxelIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
};

/// Makes a `FreeSpaceGrid` of a list of free voxels in any order, named once or more often. A layer
/// of a cell is free if all of its voxels are.
/// \param voxels_per_cell side of a cell in voxels, 1 to 64: cell_size / layer_height of `lattice`
/// \param[in,out] voxels sorted in place: scratch afterwards
/// \param[in,out] grid overwritten; keeps its memory
void collect_free_space(const MapLattice& lattice, int voxels_per_cell, double time,
                        std::vector<VoxelIndex>& voxels, FreeSpaceGrid& grid);

}  // namespace mrpt_terrain
