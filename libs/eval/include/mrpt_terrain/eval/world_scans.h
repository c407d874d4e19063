// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/eval/scan_truth.h"
#include "mrpt_terrain/sim/families.h"
#include "mrpt_terrain/sim/ground_surface.h"
#include "mrpt_terrain/sim/motion.h"
#include "mrpt_terrain/sim/ray_caster.h"
#include "mrpt_terrain/sim/sweep.h"
#include "mrpt_terrain/sim/world.h"

/// \file
/// Scans of simulated worlds as a description gets them, with their truth.
namespace mrpt_terrain::eval {

/// How worlds are scanned, and by how much the pose is wrong that the description is told.
struct ScanOptions {
  std::string sensor_folder;     ///< where the sensors are that worlds name
  std::string sensor;            ///< instead of the world's; empty: the world's
  double sensor_z = 0.0;         ///< metres, instead of the world's; 0: the world's
  double speed = 0.0;            ///< metres per second, instead of the world's; 0: the world's
  std::uint64_t noise_seed = 1;  ///< of all sweeps, as `terrain-sim --seed`
  bool skewed = false;           ///< leave the robot's motion during a sweep in the points
  bool level = false;            ///< z of the frame is vertical instead of the vehicle's
  double pitch = 0.0;            ///< disturbance: radians about y, forwards down > 0
  double raise = 0.0;            ///< disturbance: metres along z
  double min_range = 0.3;        ///< metres from the sensor; other points are left out
  double max_range = 200.0;
  double radius =
      0.0;  ///< metres: beyond it in x or y, support and clusters do not count; 0: all do
};

/// A world of a family with a robot that drives through it. Stays where it is: the caster refers to
/// the world.
struct DrivenWorld {
  std::string family;
  std::uint64_t seed = 0;
  sim::SceneFile file;
  sim::MountedSensor sensor;
  sim::World world;
  std::unique_ptr<sim::RayCaster> caster;
  std::unique_ptr<sim::GroundSurface> ground;  ///< without holes
  sim::Motion motion;
  std::vector<TrueThing> things;  ///< one per solid of `world`
  std::size_t sweeps = 0;         ///< whole sweeps of the drive, at least one

  [[nodiscard]] double sweep_time() const { return 1.0 / sensor.model.rate; }
  /// Of the n-th sweep, seconds; those of `terrain-sim`.
  [[nodiscard]] double start_of(std::size_t sweep) const;
};
/// Throws what `make_world`, `build_world`, `drive` and `resolve_sensor` throw.
[[nodiscard]] std::unique_ptr<DrivenWorld> make_driven_world(const sim::Family& family,
                                                             std::uint64_t seed,
                                                             const ScanOptions& options);

/// `count` sweeps spread evenly over a drive of `sweeps`, or all.
[[nodiscard]] std::vector<std::size_t> spread_sweeps(std::size_t sweeps, std::size_t count);

/// One scan, ready to be described.
struct TestScan {
  Points points;  ///< robot frame as the description is told it, metres
  std::vector<std::array<float, 3>> ray_origins;  ///< in that frame, one per column or one for all
  std::vector<std::uint32_t> origin_of;           ///< per point; empty: all the first
  ScanTruth truth;
  [[nodiscard]] ScanView view() const;
};

struct ScanWorkspace {
  sim::SweepWorkspace sweep_workspace;
  sim::Sweep sweep;
};

/// Simulates a sweep of the drive and puts it into the robot's frame at its start.
void take_scan(const DrivenWorld& world, std::size_t sweep, const ScanOptions& options,
               ScanWorkspace& workspace, TestScan& scan);

/// A hole on the path of the robot.
struct HoleAhead {
  std::int32_t thing = kNoThing;
  std::vector<std::size_t> sweeps;  ///< that end in time, the last one first
};
/// How an approach is looked at.
struct ApproachRules {
  double in_time = 1.0;     ///< metres of way before the front wheels reach the hole
  double farthest = 6.0;    ///< metres of way; earlier sweeps are not looked at
  std::size_t sweeps = 10;  ///< at most, evenly spread
};
/// Holes over which the line between the front wheels passes, with the sweeps that see them before.
/// Those that the robot starts too close to are left out.
[[nodiscard]] std::vector<HoleAhead> holes_ahead(const DrivenWorld& world,
                                                 const ApproachRules& rules);

}  // namespace mrpt_terrain::eval
