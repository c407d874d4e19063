// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "meshes.h"
#include "mrpt_terrain/eval/paper_experiments.h"
#include "worlds.h"

namespace mrpt_terrain::worlds {

/// Triangles of a ramp whose low edge is at x0, seen from the front.
inline void add_ramp_solid(sim::World& world, int id, const Rect& rect, double angle) {
  const double height = (rect.x1 - rect.x0) * std::tan(angle);
  const auto solid = static_cast<std::int32_t>(world.solids.size());
  add_patch(world.mesh, {rect.x0, rect.y0, 0.0}, {rect.x1 - rect.x0, 0.0, height},
            {0.0, rect.y1 - rect.y0, 0.0}, solid, sim::SurfaceKind::kDrivable);
  sim::WorldSolid entry;
  entry.id = id;
  entry.height = height;
  entry.slope = angle;
  world.solids.push_back(entry);
}

/// Level ground with ramp 7 (1 m wide, 1.25 to 2.45 m ahead) and box 8 behind the robot, 0.3 m
/// high, before a level sensor of 32 beams at 0.81 m. Targets: the ramp, the box.
[[nodiscard]] inline eval::PaperScene ramp_and_box(double ramp_angle) {
  eval::PaperScene scene;
  scene.name = "ramp_and_box";
  scene.world = std::make_unique<sim::World>();
  scene.world->solids.emplace_back();
  add_ground(*scene.world, 0.0, 0.0, 0.0, 20.0);
  add_ramp_solid(*scene.world, 7, {1.25, 2.45, -0.5, 0.5}, ramp_angle);
  const auto solid = static_cast<std::int32_t>(scene.world->solids.size());
  add_box(scene.world->mesh, {-2.0, -0.3, 0.0}, {-1.6, 0.3, 0.3}, solid);
  sim::WorldSolid box;
  box.id = 8;
  box.height = 0.3;
  scene.world->solids.push_back(box);
  scene.caster = std::make_unique<sim::RayCaster>(*scene.world);

  sensors::SensorModel& model = scene.sensor.model;
  for (int ring = 0; ring < 32; ++ring) {
    model.elevation.push_back(radians(-30.67 + ring * 41.34 / 31.0));
  }
  model.max_range = 100.0;
  model.rate = 10.0;
  model.columns = 1000;
  scene.sensor.T_robot_sensor.translation().z() = 0.81;
  scene.targets = {{"ramp", {7}, 0.0, ramp_angle}, {"box", {8}, 0.3, 0.0}};
  return scene;
}

}  // namespace mrpt_terrain::worlds
