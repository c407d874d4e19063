// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {

/// What the stages after the grid look at; the grid itself is in the `Description`, the slots of
/// the points are in the workspace.
struct StageInput {
  const ScanView& scan;  ///< frame of the grid
  const DescriptionParams& params;
  StageListener* listener = nullptr;
  /// Null if the grid is made of the points of `scan`. Otherwise it is a fused one: the share of a
  /// cluster's cells that the scan must hit for a slope from points.
  const double* points_cover = nullptr;

  /// Slots of the points that clusters consist of, where not all points of their cells belong to
  /// them (field mode); null: `DescriptionWorkspace::point_slots`.
  const PointSlots* cluster_slots = nullptr;

  [[nodiscard]] bool is_fused() const { return points_cover != nullptr; }
};

/// The stages after the grid, in the order of the paper: ground, clusters, features, classes,
/// labels.
void describe_cells(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description);

/// Slopes of the clusters whose class depends on them, or of all; (5), (6).
void measure_slopes(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description);

/// Classes of all clusters, also in `class_of`; Table 1.
void classify_all(const ClassParams& params, std::vector<TerrainClass>& class_of,
                  std::vector<ClusterDescription>& things);

/// Number of the cells of a cluster, and the corners of the rectangle around them.
void measure_extent(const ElevationGrid& grid, IndexRange slots, ClusterDescription& thing);

/// Features of one cluster that its class is told from: roughness where it is needed.
void measure_roughness(const DescriptionParams& params, const Moments& moments,
                       ClusterDescription& thing);

}  // namespace mrpt_terrain
