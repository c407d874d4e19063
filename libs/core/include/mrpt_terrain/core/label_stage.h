// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Labels every observed cell. C_G is ground; of C_N, cells that eq. (1) took out for lying at or
/// below T_low are below, all others above.
/// \param class_of per cluster: its class
void label_cells(const GroundSegmentation& ground, const Clusters& clusters,
                 const std::vector<TerrainClass>& class_of, CellLabels& result);

/// Labels every point by its cell: in C_G it is ground; in C_N it is below if its own height is at
/// or below T_low, and above otherwise. Points without a cell are unknown, with the reason.
void label_points(const PointsView& points, const PointSlots& point_slots, const CellLabels& cells,
                  const Clusters& clusters, const GroundParams& params, PointLabels& result);

}  // namespace mrpt_terrain
