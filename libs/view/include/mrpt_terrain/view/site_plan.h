// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/view/raster.h"

namespace mrpt_terrain::view {

/// Rectangle of the map, metres: x east, y north.
struct PlanExtent {
  double x_min = 0.0, x_max = 0.0;
  double y_min = 0.0, y_max = 0.0;
};

/// A thing on a plan.
struct PlanThing {
  int id = 0;
  std::string type;
  TerrainClass terrain_class = TerrainClass::kNone;
  double height = 0.0;  ///< metres; negative: depth
  Position2 place;      ///< metres; where its number goes
};

/// What a plan of a site shows.
struct SitePlan {
  std::string title;
  std::string subtitle;
  PlanExtent extent;
  /// Heights and things of the extent as seen from above, one value per pixel of the panel, north
  /// up: metres (NaN: nothing there), and index into `things` (-1: ground). Of the same size, see
  /// `plan_panel_size`.
  Raster<float> heights{0, 0};
  Raster<std::int32_t> thing{0, 0};
  std::vector<PlanThing> things;
  std::vector<Position2> path;  ///< of the robot, metres; one point: it stands
  double yaw = 0.0;             ///< of the robot at the start of its path, radians from x to y
};

struct PanelSize {
  int width = 0, height = 0;  ///< pixels
};
/// Size of the panel that shows an extent as large as fits, one scale for both axes.
[[nodiscard]] PanelSize plan_panel_size(const PlanExtent& extent, int max_width = 1100,
                                        int max_height = 820);

/// Writes a PNG of the site from above: heights in colours with shaded relief, things tinted by
/// their class, with their numbers and a table of what they are, the path, the robot at its start,
/// grid, scale bar and legend.
///
/// The file appears as a whole or not at all. Throws std::runtime_error "FILE: cannot be written:
/// reason".
void write_site_plan(const std::string& file, const SitePlan& plan);

}  // namespace mrpt_terrain::view
