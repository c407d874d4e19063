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

#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/octree/insert_scan.h"

namespace mrpt_terrain {

/// The OctoMap of a terrain map. One thread writes; others get copies, which are made once per
/// change.
class OctreeHalf {
 public:
  OctreeHalf(const MapCreationParams& creation, const OctreeInsertParams& insert);
  OctreeHalf(const OctreeHalf& other);
  OctreeHalf& operator=(const OctreeHalf&) = delete;

  /// Inserts the rays of a scan.
  /// \param T_map_robot pose of the frame of the scan's points
  void insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot);

  [[nodiscard]] std::shared_ptr<const octomap::OcTree> copy() const;

  /// All nodes with their log-odds, as octomap's `writeData` has them.
  [[nodiscard]] std::string bytes() const;
  /// Replaces all nodes by those of `bytes`. Throws std::runtime_error if they are none.
  void restore(const std::string& bytes);

 private:
  OctreeInsertParams params_;
  std::vector<float> x_, y_, z_;               ///< ends of a scan's rays, map frame
  std::vector<std::array<float, 3>> origins_;  ///< and their origins
  octree::InsertionWorkspace workspace_;
  mutable std::mutex mutex_;
  octomap::OcTree tree_;
  mutable std::shared_ptr<const octomap::OcTree> copy_;  ///< of `tree_` as it is; else null
};

}  // namespace mrpt_terrain
