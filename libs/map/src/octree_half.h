// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mrpt_terrain/core/apply_free_space.h"
#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/map_lattice.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/octree/free_cells.h"
#include "mrpt_terrain/octree/insert_scan.h"

namespace mrpt_terrain {

/// Layers of a cell that somebody wants to know about.
struct ColumnRequest {
  MapCell cell;
  LayerSpan layers;
};

/// The OctoMap of a terrain map. One thread writes; others get copies, which are made once per
/// change.
class OctreeHalf {
 public:
  OctreeHalf(const MapCreationParams& creation, const OctreeInsertParams& insert);
  OctreeHalf(const OctreeHalf& other);
  OctreeHalf& operator=(const OctreeHalf&) = delete;

  void clear();

  /// Whether ground is to be guarded; if not, `guard` need not be called.
  [[nodiscard]] bool protects_ground() const { return params_.protect_ground; }
  /// Cells that the rays of a scan may free voxels of.
  [[nodiscard]] MapCellRect reach_of(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot,
                                     const FusedSnapshot& map) const;
  /// Says what rays that graze the ground must not free in the next insertion.
  void guard(const MapLattice& lattice, const std::vector<GuardedGround>& ground);
  /// Inserts the rays of a scan.
  /// \param T_map_robot pose of the frame of the scan's points
  void insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot);
  /// Voxels that the last insertion freed: those that had been occupied before.
  [[nodiscard]] const std::vector<octree::FreedCube>& freed() const { return freed_; }

  /// Says which of the layers are free.
  /// \param columns sorted by cell, each cell once
  /// \param[in,out] grid overwritten
  void find_free_space(const MapLattice& lattice, const std::vector<ColumnRequest>& columns,
                       double time, FreeSpaceGrid& grid) const;

  /// The same for all cells of a rectangle, in any thread.
  void find_free_space_in(const MapLattice& lattice, const MapCellRect& cells, LayerSpan layers,
                          double time, FreeSpaceGrid& grid) const;

  /// Removes all voxels over cells outside a window.
  void trim(const MapLattice& lattice, const MapCellRect& window);

  [[nodiscard]] std::shared_ptr<const octomap::OcTree> copy() const;

  /// All nodes with their log-odds, as octomap's `writeData` has them.
  [[nodiscard]] static std::string bytes_of(const octomap::OcTree& tree);
  /// Replaces all nodes by those of `bytes`. Throws std::runtime_error if they are none.
  void restore(const std::string& bytes);

 private:
  OctreeInsertParams params_;
  Points ends_;                                ///< of a scan's rays, map frame
  std::vector<std::array<float, 3>> origins_;  ///< and their origins
  std::vector<octree::GuardedCells> guarded_;
  octree::InsertionWorkspace workspace_;
  std::vector<octree::FreedCube> freed_;
  mutable std::mutex mutex_;
  octomap::OcTree tree_;
  octree::FreeCells free_;                               ///< of `tree_`
  mutable std::shared_ptr<const octomap::OcTree> copy_;  ///< of `tree_` as it is; else null
};

}  // namespace mrpt_terrain
