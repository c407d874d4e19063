// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "mrpt_terrain/core/labels.h"

/// \file
/// What is true of one scan, in the form in which the metrics of this library take it. It comes
/// from simulated worlds (world_scans.h) or from labelled data (labelled_scans.h); tests write it
/// by hand. doc/terrain-eval.md defines every number that is made of it.
namespace mrpt_terrain::eval {

/// `ScanTruth::thing` of points on ground without a thing.
inline constexpr std::int32_t kNoThing = 0;

/// A hole in the ground seen from above.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< map frame, metres
  double yaw = 0.0;                                  ///< of its x axis, radians
  double length = 0.0, width = 0.0;                  ///< along its x and y axes, metres
  bool ellipse = false;                              ///< otherwise a rectangle

  /// Whether a place of the map lies in it after it has grown by `grown` metres on all sides.
  [[nodiscard]] bool contains(const Eigen::Vector2d& place, double grown = 0.0) const;
};

/// A thing that a description may find: a solid of a simulated world.
struct TrueThing {
  int id = 0;                                        ///< as in the scene
  std::string type;                                  ///< as in scene files: "box", "pothole", ...
  TerrainClass terrain_class = TerrainClass::kNone;  ///< kNone: nothing to be found
  double slope = 0.0;   ///< of its drivable surface, map frame, radians
  double depth = 0.0;   ///< of a hole, metres; 0: no hole
  Footprint footprint;  ///< of a hole
};

/// One plane of a drivable thing.
struct TrueFace {
  std::int32_t thing = kNoThing;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, upwards, robot's undisturbed frame
  double inclination = 0.0;                           ///< in the map frame, radians
};
/// `ScanTruth::face` of points that lie on none.
inline constexpr std::int32_t kNoFace = -1;

/// Truth of one scan; the arrays have one entry per point, or none where nothing is known.
struct ScanTruth {
  std::vector<Support> support;     ///< kUnknown: not counted
  std::vector<float> height;        ///< above the drivable ground, metres; may be empty
  std::vector<std::int32_t> thing;  ///< index into `things`, or kNoThing; may be empty
  /// Ground cover (low grass, rubble), which is ground and part of a thing: neither right nor wrong
  /// in a cluster. May be empty.
  std::vector<std::uint8_t> cover;
  std::vector<std::int32_t> ring;  ///< of the sensor; may be empty
  std::vector<float> below_rim;    ///< metres below the rim of the hole that it lies in; else 0
  std::vector<std::int32_t> face;  ///< index into `faces`, or kNoFace; may be empty
  std::vector<TrueThing> things;   ///< 0 is the ground itself
  std::vector<TrueFace> faces;
  /// Frame in which the description was told the points; it differs from the robot's if a test
  /// disturbs the pose.
  Eigen::Isometry3d T_map_given = Eigen::Isometry3d::Identity();
  /// Corners of the ground, map frame, metres: beyond, there is nothing.
  Eigen::Vector2d ground_low = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector2d ground_high = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  double range_sigma = 0.0;   ///< standard deviation of a range at 0 m, metres
  double range_growth = 0.0;  ///< its growth per metre of range

  /// Empties the arrays of points and faces and keeps their memory.
  void clear_points();
};

}  // namespace mrpt_terrain::eval
