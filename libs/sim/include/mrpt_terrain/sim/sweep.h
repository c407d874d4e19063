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

/// Share of light near 900 nm that a dry surface sends back diffusely, typical values, 0 to 1.
[[nodiscard]] double reflectivity(Material material);

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
  std::vector<std::int32_t> solid;  ///< index into World::solids, or kNoSolid; also of lost returns
  std::vector<SurfaceKind> kind;
  std::vector<float> time;  ///< of the firing, seconds after start_time

  // Per return, in slot order.
  std::vector<std::uint32_t> slot;  ///< which slot it is
  Points points;                    ///< sensor frame at the time of its own firing, metres
  Points true_points;               ///< true position in the map frame, metres
};

/// Scratch memory of `simulate_sweep`: the rays of some columns at a time.
struct SweepWorkspace {
  Rays rays;
  Hits hits;
};

/// Casts one turn of the sensor from a moving robot and adds the noise that the model describes.
/// The same arguments give the same bytes.
///
/// Ring r of column c looks at `SensorModel::azimuth(c, r)`, which counts from x forward towards y
/// left, and fires at `SensorModel::firing_time(c, r)`; Velodyne's own angle, as its packets carry
/// it, is the negative of that azimuth. Robot and movers are where they are at the time of the
/// column.
///
/// Of a beam with sub-rays, those whose ranges lie within a pulse length of each other make one
/// echo; the strongest echo is the return. Its range is their mean, weighted by strength; truth is
/// that of the central ray if it belongs to the echo, else of the first one that does.
///
/// A model with a perfect `noise` returns exact ranges. Each slot has its own share of the random
/// numbers, so that a change in the scene changes only the slots that see it.
/// \param start_time of the turn, seconds from the start of the run
/// \param seed of the noise; sweeps of one run use their number as `stream`
/// Throws std::invalid_argument if the model gives no rate or no columns.
void simulate_sweep(const RayCaster& caster, const MountedSensor& sensor, const Motion& motion,
                    double start_time, std::uint64_t seed, std::uint64_t stream,
                    SweepWorkspace& workspace, Sweep& sweep);

}  // namespace mrpt_terrain::sim
