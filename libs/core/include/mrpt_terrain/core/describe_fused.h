// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/fused_window.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Description of the window around the robot from fused cells.
struct FusedDescription {
  WindowFrame frame;
  Description description;  ///< in the frame of the window; `labels` are of the current scan
  WindowCells cells;
};

/// Points of the current scan in a cell; heights in the frame of the window, metres.
struct CellHits {
  std::int32_t points = 0;
  float low = 0.0F, high = 0.0F;
};

/// Cells of a square that the current scan has hit: those that tell where the ground was before,
/// and those of them where it was elsewhere.
struct ShiftCounts {
  std::int32_t told = 0, shifted = 0;
};

/// Scratch memory of field mode: what the cells of the window remember, whatever its height.
struct RememberedWorkspace {
  ElevationGrid grid;
  WindowCells cells;
  std::vector<CellHits> hits;       ///< per cell of the window
  std::vector<ShiftCounts> shifts;  ///< per square of cells
};

/// Scratch memory of `describe_fused`.
struct FusedDescriptionWorkspace {
  DescriptionWorkspace stages;
  RememberedWorkspace remembered;
  Points points;  ///< of the current scan, in the frame of the window; then remembered ones
  std::vector<std::array<float, 3>> origins;  ///< of its beams, likewise
};

/// The current scan as `describe_fused` takes it.
struct CurrentScan {
  PosedScan scan;                ///< one that has been fused
  BeamOrigins origins;           ///< robot frame; needed by `slope.method = beam` only
  std::size_t origin_count = 0;  ///< length of `origins.origins`
};

/// Parameters of `describe_fused`, borrowed.
struct FusedDescriptionParams {
  const DescriptionParams& description;
  const FusionParams& fusion;
};

/// Describes the window around the robot by the same stages as `describe`, from fused cells instead
/// of the points of one scan.
///
/// Heights, roughness and extent of clusters come from all points that their cells hold. Slopes
/// come from the current scan's points in the cluster if these lie in at least `points_cover` of
/// its cells, and from the moments of the cells otherwise: `Slope::source` says which. The labels
/// are those of the current scan's points; a point whose cell the map does not hold counts as
/// outside the map.
/// \param map a snapshot, or `FusedGrid::now()`
/// \param[in,out] result overwritten; keeps its memory
void describe_fused(const FusedSnapshot& map, const CurrentScan& current,
                    const FusedDescriptionParams& params, FusedDescriptionWorkspace& workspace,
                    FusedDescription& result, StageListener* listener = nullptr);

}  // namespace mrpt_terrain
