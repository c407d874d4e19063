// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "mrpt_terrain/files/whole_file.h"
#include "mrpt_terrain/sim/motion.h"

/// Writes true poses of the robot as a TUM file: a hundred a second during every sweep, from its
/// first to its last firing, so that `terrain-rawlog process --poses` can undo the motion.
class PosesFile {
 public:
  /// The file appears with `commit`. Throws std::runtime_error if it cannot be written.
  explicit PosesFile(const std::string& file);

  /// Adds the poses of a sweep; call in the order of time.
  /// \param begin, end of the sweep, seconds of the run
  void add(const mrpt_terrain::sim::Motion& motion, double begin, double end);
  void commit() { file_.commit(); }
  [[nodiscard]] const std::string& name() const { return file_.file(); }

 private:
  void write(double time, const Eigen::Isometry3d& T_map_robot);

  mrpt_terrain::files::WholeFile file_;
  double last_;  ///< time of the last line
};
