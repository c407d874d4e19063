// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/free_space.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace mrpt_terrain {
namespace {

std::int32_t floor_divide(std::int32_t a, std::int32_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace

std::size_t FreeSpaceGrid::find(MapCell wanted) const {
  const auto found = std::lower_bound(cell.begin(), cell.end(), wanted);
  if (found == cell.end() || *found != wanted) return size();
  return static_cast<std::size_t>(found - cell.begin());
}

bool FreeSpaceGrid::is_free(MapCell wanted, double low, double high) const {
  const std::size_t k = find(wanted);
  if (k == size()) return false;
  return std::any_of(begin_of(k), end_of(k), [&](LayerSpan span) {
    return lattice.bottom_of(span.low) <= low && high <= lattice.bottom_of(span.high);
  });
}

void FreeSpaceGrid::clear() {
  cell.clear();
  first.assign(1, 0);
  spans.clear();
}

void FreeSpaceGrid::begin_cell(MapCell next) {
  assert(cell.empty() || (cell.back() < next && first.back() > first[first.size() - 2]));
  cell.push_back(next);
  first.push_back(first.back());
}

void FreeSpaceGrid::add_span(LayerSpan span) {
  assert(!span.empty() && !cell.empty());
  const bool has_one = first.back() > first[first.size() - 2];
  assert(!has_one || spans.back().high <= span.low);
  if (has_one && spans.back().high == span.low) {
    spans.back().high = span.high;
    return;
  }
  spans.push_back(span);
  ++first.back();
}

void collect_free_space(const MapLattice& lattice, int voxels_per_cell, double time,
                        std::vector<VoxelIndex>& voxels, FreeSpaceGrid& grid) {
  assert(voxels_per_cell >= 1 && voxels_per_cell <= 64);
  const auto cell_of_voxel = [&](const VoxelIndex& v) {
    return MapCell{floor_divide(v.x, voxels_per_cell), floor_divide(v.y, voxels_per_cell)};
  };
  const auto key = [&](const VoxelIndex& v) {
    const MapCell cell = cell_of_voxel(v);
    return std::make_tuple(cell.i, cell.j, v.z, v.x, v.y);
  };
  std::sort(voxels.begin(), voxels.end(),
            [&](const VoxelIndex& a, const VoxelIndex& b) { return key(a) < key(b); });
  const auto same = [](const VoxelIndex& a, const VoxelIndex& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  voxels.erase(std::unique(voxels.begin(), voxels.end(), same), voxels.end());

  grid.clear();
  grid.lattice = lattice;
  grid.time = time;
  const auto whole = static_cast<std::size_t>(voxels_per_cell * voxels_per_cell);
  for (std::size_t k = 0, end = 0; k < voxels.size(); k = end) {
    const MapCell cell = cell_of_voxel(voxels[k]);
    const std::int32_t layer = voxels[k].z;
    while (end < voxels.size() && voxels[end].z == layer && cell_of_voxel(voxels[end]) == cell) {
      ++end;
    }
    if (end - k < whole) continue;
    if (grid.cell.empty() || grid.cell.back() != cell) grid.begin_cell(cell);
    grid.add_span({layer, layer + 1});
  }
}

}  // namespace mrpt_terrain
