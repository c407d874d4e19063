// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/io/file_cloud.h"
#include "mrpt_terrain/io/observation_reader.h"

/// \file
/// Scans of KITTI and SemanticKITTI: float32 x, y, z, intensity per point slot, little-endian.
namespace mrpt_terrain::io {

/// The scans of a folder, sorted by name: the `.bin` files in its `velodyne/` or, without that, in
/// the folder itself. Throws ReadError if it is no folder or there are none.
[[nodiscard]] std::vector<std::string> find_kitti_scans(const std::string& folder);

/// Reads one scan, every slot in its place. Throws ReadError when the file is missing, a folder,
/// empty, or no whole number of points.
[[nodiscard]] FileCloud read_kitti_scan(const std::string& file);

/// One scan as an input of one observation: a CObservationPointCloud without time stamp, labelled
/// as importers do by default, with the sensor at the robot's origin. Reads the file at once and
/// throws as `read_kitti_scan`.
[[nodiscard]] std::unique_ptr<ObservationReader> open_kitti_scan(const std::string& file);

}  // namespace mrpt_terrain::io
