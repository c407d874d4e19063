// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain::bench {

/// One KITTI scan (`kitti_raw_0001/velodyne/NNNNNN.bin` of the folder of real data) with z = 0 on
/// the ground below its sensor, which is 1.73 m high. Nothing when the data are not there.
[[nodiscard]] std::optional<Points> kitti_scan(int number);

/// Where `kitti_scan` looks: TERRAIN_DATA_DIR, or ../shared/data beside the project.
[[nodiscard]] std::string data_folder();

}  // namespace mrpt_terrain::bench
