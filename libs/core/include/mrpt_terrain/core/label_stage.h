// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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

/// What all points of one cell share; two supports because a point's own height decides in C_N.
struct SharedLabel {
  std::int32_t cluster;
  TerrainClass terrain_class;
  UnknownReason reason;
  std::array<Support, 2> support;  ///< of points above T_low, of points at or below it
};

/// Scratch memory of `label_points`.
struct LabelWorkspace {
  std::vector<SharedLabel> shared;  ///< one per reason to be unknown, then one per slot
};

/// Labels every point by its cell: in C_G it is ground; in C_N it is below if its own height is at
/// or below T_low, and above otherwise. Points without a cell are unknown, with the reason.
void label_points(const PointsView& points, const PointSlots& point_slots, const CellLabels& cells,
                  const Clusters& clusters, const GroundParams& params, LabelWorkspace& workspace,
                  PointLabels& result);

}  // namespace mrpt_terrain
