// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"

namespace mrpt_terrain {

/// Height index of a cluster (paper, eq. 3), metres.
struct HeightIndex {
  double h_d = 0.0;  ///< H_d: greatest h_max minus smallest h_min of its cells
  double h_m = 0.0;  ///< H_m: mean of its cells' mean heights
  double h_f = 0.0;  ///< H_f: max(H_d, H_m) if H_m >= 0, min(-H_d, H_m) otherwise
};

/// Height index of the cells `slots` (at least one).
[[nodiscard]] HeightIndex height_index(const ElevationGrid& grid, const GroundSegmentation& ground,
                                       IndexRange slots);

}  // namespace mrpt_terrain
