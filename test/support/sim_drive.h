// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/sensors/sensor_model.h"
#include "mrpt_terrain/sim/families.h"
#include "mrpt_terrain/sim/sweep.h"
#include "mrpt_terrain/sim/world.h"

/// \file
/// A robot that drives through a simulated world, and what its sensor sees.
namespace mrpt_terrain::worlds {

struct SimDrive {
  std::unique_ptr<sim::World> world;
  std::unique_ptr<sim::RayCaster> caster;
  sim::MountedSensor sensor;
  sim::Motion motion;
  std::uint64_t seed = 0;  ///< of the sensor's noise
};

/// The world of a family and a seed with its own sensor, vehicle and path.
[[nodiscard]] inline SimDrive drive_in(const std::string& family, std::uint64_t seed) {
  const std::string params = MRPT_TERRAIN_SOURCE_DIR "/params/";
  const sim::SceneFile file =
      sim::make_world(sim::resolve_family(family, params + "families"), seed).file;
  SimDrive drive;
  drive.world = std::make_unique<sim::World>(sim::build_world(file.scene));
  drive.caster = std::make_unique<sim::RayCaster>(*drive.world);
  drive.sensor = {sensors::resolve_sensor(file.sensor, params + "sensors"),
                  file.vehicle.T_robot_sensor()};
  drive.motion = sim::drive(*drive.caster, file.vehicle, file.path, family);
  drive.seed = seed;
  return drive;
}

/// The sweep that begins at `time`, in the robot's frame at that time as if it had stood still.
[[nodiscard]] inline io::Scan scan_at(const SimDrive& drive, double time, std::uint64_t stream) {
  sim::SweepWorkspace workspace;
  sim::Sweep sweep;
  sim::simulate_sweep(*drive.caster, drive.sensor, drive.motion, time, drive.seed, stream,
                      workspace, sweep);
  io::Scan scan;
  scan.stamp = 1000.0 + time;
  const Eigen::Isometry3d T_robot_map = drive.motion.at(time).inverse();
  Eigen::Isometry3d T_robot_sensor = drive.sensor.T_robot_sensor;
  std::size_t column = 0;  // robots stand still during a column
  for (std::size_t k = 0; k < sweep.slot.size(); ++k) {
    if (sweep.slot[k] / sweep.rings != column) {
      column = sweep.slot[k] / sweep.rings;
      const double fired = time + static_cast<double>(sweep.time[column * sweep.rings]);
      T_robot_sensor = T_robot_map * drive.motion.at(fired) * drive.sensor.T_robot_sensor;
    }
    const Eigen::Vector3d p =
        T_robot_sensor *
        Eigen::Vector3f(sweep.points.x[k], sweep.points.y[k], sweep.points.z[k]).cast<double>();
    scan.points.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z()));
  }
  const Eigen::Vector3f origin = drive.sensor.T_robot_sensor.translation().cast<float>();
  scan.ray_origins.push_back({origin.x(), origin.y(), origin.z()});
  return scan;
}

}  // namespace mrpt_terrain::worlds
