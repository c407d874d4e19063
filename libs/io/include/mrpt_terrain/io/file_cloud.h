// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain::io {

/// A point cloud as a file holds it: every slot in its place, also NaN and zero returns.
struct FileCloud {
  Points points;                      ///< metres, in the frame of the file
  std::vector<float> intensity;       ///< per point, or empty
  std::vector<std::uint32_t> labels;  ///< per point as in label_file.h, or empty
};

}  // namespace mrpt_terrain::io
