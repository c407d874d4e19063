// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "mrpt_terrain/sim/world.h"

namespace mrpt_terrain::sim {

Eigen::Isometry3d Mover::pose_at(double time) const {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  double yaw = length > 0.0 ? std::atan2(way.y(), way.x()) : 0.0;
  double walked = 0.0;
  if (length > 0.0 && speed > 0.0) {
    walked = std::fmod(speed * std::abs(time), 2.0 * length);
    if (walked > length) {
      walked = 2.0 * length - walked;
      yaw += M_PI;
    }
    walked /= length;
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = from + walked * way;
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

}  // namespace mrpt_terrain::sim
