// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/sensors/sensor_model.h"
#include "mrpt_terrain/sim/motion.h"
#include "mrpt_terrain/sim/ray_caster.h"

namespace mrpt_terrain::sim {

/// A sensor on a robot.
struct MountedSensor {
  sensors::SensorModel model;  ///< beams, rate, range limits, noise
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
};

/// One turn of a sensor. Slot of a ray: column * rings + ring.
struct Sweep {
  std::size_t rings = 0;
  std::size_t columns = 0;
  double start_time = 0.0;  ///< of column 0, seconds from the start of the run

  // Per slot.
  std::vector<float> range;       ///< measured, metres; 0: no return
  std::vector<float> true_range;  ///< of the same beam without noise, metres; 0: nothing there
  std::vector<std::uint8_t> intensity;
  std::vector<std::int32_t> solid;  ///< index into World::solids, or kNoSolid
  std::vector<SurfaceKind> kind;
  std::vector<float> time;  ///< of the firing, seconds after start_time

  // Per return, in slot order.
  std::vector<std::uint32_t> slot;  ///< which slot it is
  Points points;                    ///< sensor frame at the time of its own firing, metres
  Points true_points;               ///< true position in the map frame, metres
};

/// Scratch memory of `simulate_sweep`.
struct SweepWorkspace {
  Rays rays;
  Hits hits;
};

/// Casts one turn of the sensor from a moving robot and adds the noise that the model describes.
/// The same arguments give the same bytes.
/// \param start_time of the turn, seconds from the start of the run
/// \param seed of the noise; sweeps of one run use their number as `stream`
void simulate_sweep(const RayCaster& caster, const MountedSensor& sensor, const Motion& motion,
                    double start_time, std::uint64_t seed, std::uint64_t stream,
                    SweepWorkspace& workspace, Sweep& sweep);

}  // namespace mrpt_terrain::sim
