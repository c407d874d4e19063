// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/sim/ray_caster.h"
#include "mrpt_terrain/sim/sweep.h"

/// \file
/// What a perfect description of a scene would say. It comes from the scene alone; no stage of the
/// description has a part in it. doc/truth-files.md has the rules with examples.
///
/// Support of a place on a surface:
/// * a drivable surface is kGround;
/// * a flank, the steep wall of a hole, is kUnknown;
/// * rubble and grass up to `kGroundCover` above the drivable ground are kGround;
/// * objects, rubble, vegetation and persons more than `kLeastObstacle` above it are kAbove;
/// * what lies between, and the low parts of objects, is kUnknown.
/// kUnknown is reported and not counted. kBelow does not occur: there is nothing below the terrain.
namespace mrpt_terrain::sim {

/// Up to this height above the drivable ground, rubble and grass are ground, metres.
inline constexpr double kGroundCover = 0.05;
/// Above this height over the drivable ground, things are above the ground, metres.
inline constexpr double kLeastObstacle = 0.10;

/// Truth of the returns of one sweep, in their order. It is that of the surface that the return
/// comes from, whatever noise did to the measured point.
struct PointTruth {
  std::vector<std::int32_t> solid;          ///< id of the solid as in the scene; 0: ground
  std::vector<Support> support;             ///< kUnknown: between ground and object, not counted
  std::vector<TerrainClass> terrain_class;  ///< of the solid; kNone: ground without a thing
  std::vector<float> true_range;            ///< metres
  /// Above the drivable ground, metres: 0 on the terrain itself, flanks included. Under tables and
  /// bridges the ground below counts; beside a step of the terrain (the side of a ramp or curb)
  /// the lower ground within 1 cm. NaN where there is no ground.
  std::vector<float> height;
};
[[nodiscard]] PointTruth truth_of(const RayCaster& caster, const Sweep& sweep);

/// Truth of every cell of a grid, whether anything was seen there or not. Arrays are indexed by
/// cell l * cells_w + w. NaN: outside the scene.
///
/// Each cell is looked at in `kSamplesPerSide` x `kSamplesPerSide` places, evenly spread, from
/// above. What hangs at least an overhang above the terrain (a vehicle passes under it) is left
/// out, vegetation counts as its outer form, persons do not count because they do not stay.
struct CellTruth {
  GridGeometry geometry;
  std::vector<float> min, mean, max;   ///< heights of the uppermost surface in the cell, metres
  std::vector<float> ground_height;    ///< of the drivable surface at the centre, metres
  std::vector<float> slope;            ///< of the drivable surface at the centre, radians
  std::vector<float> slope_direction;  ///< where it rises, from the grid's x towards y, radians
  /// kAbove where at least one place is above; else kGround where at least half of the places are
  /// ground; else kUnknown.
  std::vector<Support> support;
  /// Of the places that have the cell's support the most frequent class, the lowest at a tie;
  /// places on flanks count where the cell is not above.
  std::vector<TerrainClass> terrain_class;
};
inline constexpr int kSamplesPerSide = 5;
/// \param T_map_grid pose of the grid; only x, y and yaw move the cells, heights are relative to
/// its z
/// \param overhang metres of free space over the terrain that are enough to pass
[[nodiscard]] CellTruth truth_of_cells(const RayCaster& caster, const Eigen::Isometry3d& T_map_grid,
                                       const GridGeometry& geometry, double overhang = 2.0);

/// Truth of one solid of the scene.
struct ObjectTruth {
  int id = 0;
  std::string type;  ///< as in scene files: "box", "pothole", ...
  TerrainClass terrain_class = TerrainClass::kNone;
  Support support = Support::kUnknown;  ///< of its top, or of the floor of a hole
  double height = 0.0;  ///< metres above the ground it stands on; negative: depth of a hole
  double length = 0.0;  ///< extent along its own x axis, metres
  double width = 0.0;   ///< extent along its own y axis, metres
  double slope = 0.0;   ///< inclination of its drivable surface from horizontal, radians
  Eigen::Isometry3d T_map_object = Eigen::Isometry3d::Identity();  ///< at time 0
};
/// All solids but the ground, in the order of the scene.
[[nodiscard]] std::vector<ObjectTruth> truth_of_objects(const World& world);

}  // namespace mrpt_terrain::sim
