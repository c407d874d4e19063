// SPDX-License-Identifier: BSD-3-Clause
#include "octree_half.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "mrpt_terrain/core/move_points.h"
#include "mrpt_terrain/octree/trim_tree.h"

namespace mrpt_terrain {
namespace {

int voxels_per_cell(const MapLattice& lattice) {
  return static_cast<int>(std::lround(lattice.cell_size() / lattice.layer_height()));
}

/// OctoMap counts voxels from the middle of its range.
std::uint16_t key_of(std::int32_t voxel) {
  return static_cast<std::uint16_t>(std::clamp(voxel + 0x8000, 0, 0xFFFF));
}

/// Up to 64 layers of a cell, a bit each: whether all of their voxels are known to be free.
std::uint64_t free_layers(const octree::FreeCells& free, MapCell cell, LayerSpan span, int voxels) {
  std::uint64_t layers = ~std::uint64_t{0};
  for (int x = 0; x < voxels; ++x) {
    for (int y = 0; y < voxels; ++y) {
      layers &= free.column(key_of(cell.i * voxels + x), key_of(cell.j * voxels + y),
                            key_of(span.low), span.layers());
    }
  }
  return layers;
}

}  // namespace

OctreeHalf::OctreeHalf(const MapCreationParams& creation, const OctreeInsertParams& insert)
    : params_(insert), tree_(creation.octree_resolution) {
  tree_.setProbHit(insert.prob_hit);
  tree_.setProbMiss(insert.prob_miss);
  tree_.setClampingThresMin(insert.clamping_min);
  tree_.setClampingThresMax(insert.clamping_max);
}

OctreeHalf::OctreeHalf(const OctreeHalf& other) : params_(other.params_), tree_(*other.copy()) {
  free_.assign(tree_);
}

MapCellRect OctreeHalf::reach_of(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot,
                                 const FusedSnapshot& map) const {
  if (params_.max_range <= 0.0 || scan.ray_origins.empty()) return map.window;
  Eigen::AlignedBox2d box;
  for (const auto& origin : scan.ray_origins) {
    const Eigen::Vector3d p =
        T_map_robot * Eigen::Vector3f(origin[0], origin[1], origin[2]).cast<double>();
    box.extend(p.head<2>());
  }
  MapCell low, high;
  const double r = params_.max_range;
  if (!map.lattice.cell_at(box.min().x() - r, box.min().y() - r, low) ||
      !map.lattice.cell_at(box.max().x() + r, box.max().y() + r, high)) {
    return map.window;
  }
  return intersection({low, {high.i + 1, high.j + 1}}, map.window);
}

void OctreeHalf::guard(const MapLattice& lattice, const std::vector<GuardedGround>& ground) {
  const int voxels = voxels_per_cell(lattice);
  guarded_.clear();
  for (const GuardedGround& at : ground) {
    for (int x = 0; x < voxels; ++x) {
      for (int y = 0; y < voxels; ++y) {
        guarded_.push_back({key_of(at.cell.i * voxels + x), key_of(at.cell.j * voxels + y),
                            key_of(at.layers.low), key_of(at.layers.high - 1), key_of(at.below)});
      }
    }
  }
}

void OctreeHalf::insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot) {
  move_points(scan.points.view(), T_map_robot, ends_);
  origins_.clear();
  for (const auto& origin : scan.ray_origins) {
    origins_.push_back(move_point(origin, T_map_robot));
  }
  if (origins_.empty()) return;
  const octree::RayOrigins origins{origins_.data(), origins_.size(),
                                   scan.origin_of.empty() ? nullptr : scan.origin_of.data()};
  const octree::InsertionOptions options{params_.max_range > 0.0 ? params_.max_range : -1.0,
                                         params_.discretize,
                                         params_.protect_ground ? &guarded_ : nullptr};
  const std::lock_guard lock(mutex_);
  copy_.reset();
  const PointsView ends = ends_.view();
  octree::insert_scan({ends.x, ends.y, ends.z, ends.size}, origins, options, workspace_, tree_,
                      &freed_, &free_);
}

void OctreeHalf::find_free_space(const MapLattice& lattice,
                                 const std::vector<ColumnRequest>& columns, double time,
                                 FreeSpaceGrid& grid) const {
  const int voxels = voxels_per_cell(lattice);
  grid.clear();
  grid.lattice = lattice;
  grid.time = time;
  for (const ColumnRequest& column : columns) {
    bool named = false;
    for (std::int32_t low = column.layers.low; low < column.layers.high; low += 64) {
      const LayerSpan span{low, std::min(low + 64, column.layers.high)};
      std::uint64_t layers = free_layers(free_, column.cell, span, voxels);
      if (layers != 0 && !named) grid.begin_cell(column.cell);
      named = named || layers != 0;
      for (; layers != 0; layers &= layers - 1) {
        const std::int32_t layer = low + static_cast<std::int32_t>(__builtin_ctzll(layers));
        grid.add_span({layer, layer + 1});
      }
    }
  }
}

void OctreeHalf::find_free_space_in(const MapLattice& lattice, const MapCellRect& cells,
                                    LayerSpan layers, double time, FreeSpaceGrid& grid) const {
  std::vector<ColumnRequest> columns;
  for (std::int32_t i = cells.low.i; i < cells.high.i; ++i) {
    for (std::int32_t j = cells.low.j; j < cells.high.j; ++j) columns.push_back({{i, j}, layers});
  }
  const std::lock_guard lock(mutex_);
  find_free_space(lattice, columns, time, grid);
}

void OctreeHalf::trim(const MapLattice& lattice, const MapCellRect& window) {
  const int voxels = voxels_per_cell(lattice);
  const octree::CellWindow keys{
      {key_of(window.low.i * voxels), key_of(window.low.j * voxels), 0},
      {key_of(window.high.i * voxels - 1), key_of(window.high.j * voxels - 1), 0xFFFF}};
  const std::lock_guard lock(mutex_);
  if (octree::trim_tree(keys, tree_).removed == 0) return;
  copy_.reset();
  free_.trim(keys);
}

std::shared_ptr<const octomap::OcTree> OctreeHalf::copy() const {
  const std::lock_guard lock(mutex_);
  if (!copy_) copy_ = std::make_shared<octomap::OcTree>(tree_);
  return copy_;
}

void OctreeHalf::clear() {
  const std::lock_guard lock(mutex_);
  copy_.reset();
  tree_.clear();
  free_.clear();
}

std::string OctreeHalf::bytes_of(const octomap::OcTree& tree) {
  std::ostringstream out;
  tree.writeData(out);
  return out.str();
}

void OctreeHalf::restore(const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  copy_.reset();
  tree_.clear();
  free_.clear();
  if (bytes.empty()) return;
  std::istringstream in(bytes);
  tree_.readData(in);
  if (!in) {
    tree_.clear();
    throw std::runtime_error("the OctoMap in it is cut off");
  }
  free_.assign(tree_);
}

}  // namespace mrpt_terrain
