// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace mrpt_terrain::sim {

/// Pose of the robot over time, sampled densely; times in seconds from the start of the run.
class Motion {
 public:
  /// A robot that stands still.
  explicit Motion(const Eigen::Isometry3d& T_map_robot = Eigen::Isometry3d::Identity());
  /// \param times ascending, at least one
  /// \param T_map_robot one per time
  Motion(std::vector<double> times, std::vector<Eigen::Isometry3d> T_map_robot);

  /// T_map_robot; between samples position linear and attitude by spherical interpolation, before
  /// the first and after the last sample the end pose.
  [[nodiscard]] Eigen::Isometry3d at(double time) const;
  [[nodiscard]] double start() const { return times_.front(); }
  [[nodiscard]] double end() const { return times_.back(); }
  [[nodiscard]] bool stands_still() const { return times_.size() == 1; }

 private:
  std::vector<double> times_;
  std::vector<Eigen::Isometry3d> poses_;
};

}  // namespace mrpt_terrain::sim
