// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace mrpt_terrain::io {

/// Poses of the robot over time: pairs of a time stamp (seconds since the Unix epoch, or since the
/// start of the data set) and `T_map_robot`, ascending in time.
class Trajectory {
 public:
  /// Adds a pose. Stamps may come in any order; a second pose of the same stamp replaces the first.
  void add(double stamp, const mrpt::poses::CPose3D& T_map_robot);

  [[nodiscard]] bool empty() const { return stamps_.empty(); }
  [[nodiscard]] std::size_t size() const { return stamps_.size(); }
  [[nodiscard]] const std::vector<double>& stamps() const { return stamps_; }
  [[nodiscard]] const mrpt::poses::CPose3D& pose(std::size_t k) const { return poses_[k]; }

  /// Pose at a time: position linear, attitude by spherical interpolation between the neighbours.
  /// Nothing outside [first - tolerance, last + tolerance] (within the tolerance the end pose
  /// itself) and nothing inside a gap between neighbours longer than `max_gap` seconds.
  [[nodiscard]] std::optional<mrpt::poses::CPose3D> at(double stamp) const;

  double tolerance = 0.05;  ///< seconds
  double max_gap = 1.0;     ///< seconds

 private:
  std::vector<double> stamps_;
  std::vector<mrpt::poses::CPose3D> poses_;
};

/// Reads a TUM file: lines `stamp tx ty tz qx qy qz qw`, `#` starts a comment.
/// Throws `std::runtime_error` "file:line: what is wrong" for anything else, also for an empty
/// file. \param T_robot_sensor of the sensor whose poses the file lists; identity for poses of the
/// robot
[[nodiscard]] Trajectory load_tum(const std::string& file,
                                  const mrpt::poses::CPose3D& T_robot_sensor = {});

/// Writes a TUM file with 9 decimals.
void save_tum(const Trajectory& trajectory, const std::string& file);

}  // namespace mrpt_terrain::io
