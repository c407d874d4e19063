// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace mrpt_terrain::io {

struct ImportOptions {
  mrpt::poses::CPose3D T_robot_sensor;  ///< where the sensor sits on the robot
  std::string sensor_label = "lidar";
  double period = 0.1;        ///< seconds between scans that come without time stamps
  std::size_t max_scans = 0;  ///< stops after so many; 0: all
  /// Called before each scan with the number of scans done and of all; false stops the import,
  /// which then leaves no files.
  std::function<bool(std::size_t done, std::size_t total)> progress;
};

struct ImportSummary {
  std::size_t scans = 0;
  std::size_t points = 0;          ///< of all scans, every slot counted
  std::size_t poses = 0;           ///< scans with a pose
  std::size_t labelled_scans = 0;  ///< scans with labels
  bool stopped = false;            ///< by the progress callback; nothing was written
  std::string rawlog;
  std::string poses_file;     ///< empty without poses
  std::string labels_folder;  ///< empty without labels
};

/// What all importers write, for an output `out.rawlog`:
/// * `out.rawlog`: per scan a CObservationRobotPose (where the pose is known) followed by a
///   CObservationPointCloud with all slots of the scan, zero returns and NaN included, in the
///   sensor frame and order of the source;
/// * `out.tum`: the same poses, T_map_robot = T_map_sensor * inverse(T_robot_sensor);
/// * `out_labels/NNNNNN.label`: labels of the NNNNNN-th scan (label_file.h).
/// Scans are read one at a time. All files appear when everything is written. Problems with the
/// source throw ReadError, problems with the output std::runtime_error; then no file is left.

/// Imports a KITTI or SemanticKITTI folder: `velodyne/NNNNNN.bin` (or the .bin files in the folder
/// itself), `labels/NNNNNN.label`, `times.txt`, and poses of the sensor from `poses.tum` or of the
/// camera from `poses.txt` with `Tr` of `calib.txt`. All but the scans are optional. Line k of the
/// lists belongs to the k-th scan if there are as many lines as scans, else to the scan whose file
/// is named k.
ImportSummary import_kitti(const std::string& folder, const ImportOptions& options,
                           const std::string& rawlog);

/// Imports PCD files, one scan each, in the given order.
ImportSummary import_pcd(const std::vector<std::string>& files, const ImportOptions& options,
                         const std::string& rawlog);

/// Imports PLY files, one scan each, in the given order.
ImportSummary import_ply(const std::vector<std::string>& files, const ImportOptions& options,
                         const std::string& rawlog);

}  // namespace mrpt_terrain::io
