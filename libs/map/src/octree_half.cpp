// SPDX-License-Identifier: BSD-3-Clause
#include "octree_half.h"

#include <sstream>
#include <stdexcept>

namespace mrpt_terrain {

OctreeHalf::OctreeHalf(const MapCreationParams& creation, const OctreeInsertParams& insert)
    : params_(insert), tree_(creation.octree_resolution) {
  tree_.setProbHit(insert.prob_hit);
  tree_.setProbMiss(insert.prob_miss);
  tree_.setClampingThresMin(insert.clamping_min);
  tree_.setClampingThresMax(insert.clamping_max);
}

OctreeHalf::OctreeHalf(const OctreeHalf& other) : params_(other.params_), tree_(*other.copy()) {}

void OctreeHalf::insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot) {
  const auto in_map = [&T_map_robot](float x, float y, float z) -> Eigen::Vector3f {
    return (T_map_robot * Eigen::Vector3f(x, y, z).cast<double>()).cast<float>();
  };
  const std::size_t n = scan.points.size();
  for (auto* axis : {&x_, &y_, &z_}) axis->resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3f p = in_map(scan.points.x[k], scan.points.y[k], scan.points.z[k]);
    x_[k] = p.x();
    y_[k] = p.y();
    z_[k] = p.z();
  }
  origins_.clear();
  for (const auto& origin : scan.ray_origins) {
    const Eigen::Vector3f p = in_map(origin[0], origin[1], origin[2]);
    origins_.push_back({p.x(), p.y(), p.z()});
  }
  if (origins_.empty()) return;
  const octree::RayOrigins origins{origins_.data(), origins_.size(),
                                   scan.origin_of.empty() ? nullptr : scan.origin_of.data()};
  const octree::InsertionOptions options{params_.max_range > 0.0 ? params_.max_range : -1.0,
                                         params_.discretize};
  const std::lock_guard lock(mutex_);
  copy_.reset();
  octree::insert_scan({x_.data(), y_.data(), z_.data(), n}, origins, options, workspace_, tree_);
}

std::shared_ptr<const octomap::OcTree> OctreeHalf::copy() const {
  const std::lock_guard lock(mutex_);
  if (!copy_) copy_ = std::make_shared<octomap::OcTree>(tree_);
  return copy_;
}

std::string OctreeHalf::bytes() const {
  std::ostringstream out;
  copy()->writeData(out);
  return out.str();
}

void OctreeHalf::restore(const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  copy_.reset();
  tree_.clear();
  if (bytes.empty()) return;
  std::istringstream in(bytes);
  tree_.readData(in);
  if (!in) {
    tree_.clear();
    throw std::runtime_error("the OctoMap in it is cut off");
  }
}

}  // namespace mrpt_terrain
