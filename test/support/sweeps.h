// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <utility>

#include "meshes.h"
#include "mrpt_terrain/sim/sweep.h"

/// \file
/// Small sensors and worlds for tests of sweeps.
namespace mrpt_terrain::worlds {

/// A perfect sensor that turns clockwise at 10 Hz, first column backwards.
[[nodiscard]] inline sensors::SensorModel perfect_sensor(std::vector<double> elevation,
                                                         int columns) {
  sensors::SensorModel model;
  model.name = "perfect";
  model.elevation = std::move(elevation);
  model.max_range = 100.0;
  model.rate = 10.0;
  model.columns = columns;
  return model;
}

/// A sensor upright above the robot's origin.
[[nodiscard]] inline sim::MountedSensor mounted(sensors::SensorModel model, double height) {
  sim::MountedSensor sensor;
  sensor.model = std::move(model);
  sensor.T_robot_sensor.translation().z() = height;
  return sensor;
}

/// Level ground of 2 * half_size about the origin, of one material.
[[nodiscard]] inline sim::World level_world(double half_size) {
  sim::World world;
  world.solids.resize(1);
  world.solids[0].material = sim::Material::kConcrete;
  add_ground(world, 0.0, 0.0, 0.0, half_size);
  return world;
}

}  // namespace mrpt_terrain::worlds
