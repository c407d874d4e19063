// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grids.h"
#include "lidar.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/field_cells.h"
#include "worlds.h"

/// \file
/// Worlds on ground that is neither level nor at z = 0, and the field stages run on them. Metres,
/// radians.
namespace mrpt_terrain::worlds {

/// Turned about y so that the plane z = 0 falls along +x by `angle`, and raised by `offset`. The
/// plane becomes z = offset - tan(angle) x; what stands on it stands on it still.
[[nodiscard]] inline Points tilted(const Points& points, double angle, double offset = 0.0) {
  Points result;
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = double{points.x[i]}, z = double{points.z[i]};
    add_point(result, c * x + s * z, double{points.y[i]}, c * z - s * x + offset);
  }
  return result;
}

inline void append(Points& to, const Points& from) {
  for (std::size_t i = 0; i < from.size(); ++i) to.push_back(from.x[i], from.y[i], from.z[i]);
}

/// Sixteen or so beams on all sides, one column per half degree.
[[nodiscard]] inline LidarModel coarse_rings(int beams) {
  LidarModel model;
  model.beams = beams;
  model.azimuth_step_deg = 0.5;
  return model;
}

/// Where the beams of a level sensor above (0, 0, z0) meet the ground z = height(x, y): the first
/// crossing, looked for in steps of 0.1 m and then halved down to less than 0.1 mm.
template <class Height>
[[nodiscard]] Points ring_scan(const LidarModel& model, double z0, Height&& height) {
  Points result;
  const auto columns = static_cast<int>(360.0 / model.azimuth_step_deg);
  const double beam_step = (model.highest_deg - model.lowest_deg) / (model.beams - 1);
  for (int column = 0; column < columns; ++column) {
    const double azimuth = radians(column * model.azimuth_step_deg);
    for (int beam = 0; beam < model.beams; ++beam) {
      const double elevation = radians(model.lowest_deg + beam * beam_step);
      const Vec3 d{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation)};
      const auto above = [&](double t) { return z0 + t * d.z - height(t * d.x, t * d.y); };
      constexpr double kStep = 0.1;
      for (double t = kStep; t < model.max_range; t += kStep) {
        if (above(t) > 0.0) continue;
        double low = t - kStep, high = t;
        for (int k = 0; k < 11; ++k) {
          const double middle = 0.5 * (low + high);
          (above(middle) > 0.0 ? low : high) = middle;
        }
        add_point(result, high * d.x, high * d.y, height(high * d.x, high * d.y));
        break;
      }
    }
  }
  return result;
}

/// A square patch of ground with a rectangular hole in it, whose four walls are seen, too.
[[nodiscard]] inline Points patch_with_hole(const Rect& patch, const Rect& hole, double depth,
                                            double spacing = 0.05) {
  Points points;
  add_surface(points, patch, spacing,
              [&](double x, double y) { return inside(hole, x, y) ? -depth : 0.0; });
  Points walls;
  add_box(walls, hole, depth, 0.5 * spacing);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double z = double{walls.z[i]} - depth;
    if (z < -1e-6) add_point(points, double{walls.x[i]}, double{walls.y[i]}, z);
  }
  return points;
}

/// Field mode with the values of params/field.ini for robots, on a grid of 30 m.
[[nodiscard]] inline DescriptionParams field_params() {
  DescriptionParams params;
  params.description.mode = DescriptionMode::kField;
  params.grid = {30.0, 30.0, 0.2, 3.0};
  params.classes.t_neg = -0.03;
  return params;
}

/// The field stages up to the cells.
struct FieldStages {
  FieldWorkspace field;
  ElevationGrid grid;
  PointSlots point_slots;
  FieldCells cells;
  GroundSegmentation ground;
};
inline void measure(const PointsView& points, const DescriptionParams& params,
                    FieldStages& stages) {
  ElevationGridWorkspace workspace;
  find_field_ground(points, params.ground_surface, params.ground_labels, stages.field);
  build_elevation_grid(points, params.grid, workspace, stages.grid, stages.point_slots,
                       stages.field.points.height.data());
  measure_field_cells(points, stages.field, stages.grid, stages.point_slots, stages.cells,
                      stages.ground);
}
inline void measure(const Points& points, const DescriptionParams& params, FieldStages& stages) {
  measure(points.view(), params, stages);
}

}  // namespace mrpt_terrain::worlds
