// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain::bench {

/// The scan that all benchmarks describe, with z = 0 on the ground below its sensor.
struct BenchmarkScan {
  Points points;
  std::string source;  ///< where it came from, for the context of the results
};

/// The first scan of `kitti_raw_0001` in the folder of real data (TERRAIN_DATA_DIR, or
/// ../shared/data beside the project); where that is missing, a made-up street of the same size
/// seen by 64 beams.
[[nodiscard]] const BenchmarkScan& benchmark_scan();

}  // namespace mrpt_terrain::bench
