// SPDX-License-Identifier: BSD-3-Clause
#include "odometry.h"

#include <cmath>

namespace {

/// Streams of random numbers apart from those of the sweeps, which are counted from 0.
constexpr std::uint64_t kOdometryStream = std::uint64_t{1} << 61U;

/// Mean 0, standard deviation 1 (Box and Muller).
double normal_deviate(mrpt_terrain::RandomGenerator& random) {
  const double u = 1.0 - random.uniform();
  const double v = random.uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
}

}  // namespace

Odometry::Odometry(const OdometryParams& params, std::uint64_t seed,
                   const Eigen::Isometry3d& T_map_robot_at_start)
    : params_(params),
      random_(seed, kOdometryStream),
      scale_(1.0 + params.scale_sigma * normal_deviate(random_)),
      T_map_last_(T_map_robot_at_start) {}

PlanarPose Odometry::move_to(const Eigen::Isometry3d& T_map_robot) {
  const Eigen::Isometry3d T_last_robot = T_map_last_.inverse() * T_map_robot;
  const Eigen::Vector3d step = T_last_robot.translation();
  const double climb = T_map_robot.translation().z() - T_map_last_.translation().z();
  const double turn = std::atan2(T_last_robot(1, 0), T_last_robot(0, 0));
  const double way = step.norm();
  const double root = std::sqrt(way);
  const double way_error = params_.way_sigma * root * normal_deviate(random_);
  const double turn_error = params_.turn_sigma * root * normal_deviate(random_);
  const double measured = scale_ * way + params_.slip * climb + way_error;
  const double level = std::hypot(step.x(), step.y());
  const double direction = level > 0.0 ? std::atan2(step.y(), step.x()) : 0.0;
  pose_.x += measured * std::cos(pose_.yaw + direction);
  pose_.y += measured * std::sin(pose_.yaw + direction);
  pose_.yaw = std::remainder(pose_.yaw + turn + turn_error, 2.0 * M_PI);
  T_map_last_ = T_map_robot;
  return pose_;
}
