// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mrpt_terrain/sim/scene.h"
#include "mrpt_terrain/sim/vehicle.h"

namespace mrpt_terrain::sim {

/// A scene file: the scene, and how it is driven through and by what it is seen. doc/scenes.md
/// describes the format.
///
///     name: pothole road
///     ground: {form: plane, length: 60, width: 20, material: asphalt}
///     solids:
///       - {type: pothole, x: 4, y: 0.2, length: 0.5, width: 0.4, depth: 0.09}
///       - {type: box, id: 7, x: 6, y: 2, yaw_deg: 30, height: 0.15, class: obstacle}
///     sensor: hdl32e            # file in params/sensors, or a path ending in .yaml
///     vehicle: {sensor_z: 0.81}
///     path: {speed: 0.5, waypoints: [[0, 0], [20, 0]]}
struct SceneFile {
  Scene scene;
  std::string sensor;  ///< empty if the file names none
  VehicleParams vehicle;
  DrivePath path;  ///< without waypoints: the vehicle stands at the origin
};

/// Reads a scene file. Throws SceneError with one line per problem, each "file:line: key = value:
/// rule": unknown keys and types (with the one that was probably meant), keys given twice, values
/// out of range, ids given twice, missing files, syntax errors.
[[nodiscard]] SceneFile load_scene(const std::string& file);

}  // namespace mrpt_terrain::sim
