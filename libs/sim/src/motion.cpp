// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/motion.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace mrpt_terrain::sim {

Motion::Motion(const Eigen::Isometry3d& T_map_robot) : times_{0.0}, poses_{T_map_robot} {}

Motion::Motion(std::vector<double> times, std::vector<Eigen::Isometry3d> T_map_robot)
    : times_(std::move(times)), poses_(std::move(T_map_robot)) {
  assert(!times_.empty() && times_.size() == poses_.size());
  assert(std::is_sorted(times_.begin(), times_.end()));
}

Eigen::Isometry3d Motion::at(double time) const {
  const auto next = std::upper_bound(times_.begin(), times_.end(), time);
  if (next == times_.begin()) return poses_.front();
  if (next == times_.end()) return poses_.back();
  const auto k = static_cast<std::size_t>(next - times_.begin());
  const double share = (time - times_[k - 1]) / (times_[k] - times_[k - 1]);
  const Eigen::Isometry3d &a = poses_[k - 1], &b = poses_[k];
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (1.0 - share) * a.translation() + share * b.translation();
  pose.linear() = Eigen::Quaterniond(a.linear())
                      .slerp(share, Eigen::Quaterniond(b.linear()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace mrpt_terrain::sim
