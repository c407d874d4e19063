// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/sim/motion.h"
#include "mrpt_terrain/sim/ray_caster.h"

namespace mrpt_terrain::sim {

/// Wheels and sensor mounting of a vehicle. The robot frame lies on the ground below the middle of
/// the axles.
struct VehicleParams {
  double wheelbase = 0.6;     ///< metres between the axles
  double track = 0.5;         ///< metres between left and right wheels
  double sensor_x = 0.0;      ///< of the sensor in the robot frame, metres
  double sensor_z = 0.81;     ///< metres
  double sensor_roll = 0.0;   ///< radians
  double sensor_pitch = 0.0;  ///< radians, nose down > 0

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.wheelbase, ParamInfo{"wheelbase", "", "m", 0.05, 10.0, "distance of the axles"});
    visit(self.track, ParamInfo{"track", "", "m", 0.05, 10.0, "distance of left and right wheels"});
    visit(self.sensor_x,
          ParamInfo{"sensor_x", "", "m", -10.0, 10.0, "of the sensor in the robot frame"});
    visit(self.sensor_z, ParamInfo{"sensor_z", "", "m", 0.05, 10.0,
                                   "height of the sensor above the wheels' feet"});
    visit(self.sensor_roll,
          ParamInfo{"sensor_roll_deg", "", "deg", -90.0, 90.0, "mounting of the sensor"});
    visit(self.sensor_pitch, ParamInfo{"sensor_pitch_deg", "", "deg", -90.0, 90.0,
                                       "mounting of the sensor, nose down is positive"});
  }
  [[nodiscard]] Eigen::Isometry3d T_robot_sensor() const;
};

/// Waypoints in the horizontal plane and a speed.
struct DrivePath {
  std::vector<Eigen::Vector2d> waypoints;  ///< metres, map frame; at least one
  double yaw = 0.0;                        ///< of a vehicle with one waypoint, radians
  double speed = 0.5;                      ///< metres per second
};

/// Length on which a wheel touches the ground, metres: its foot is at the mean height of the
/// terrain over that length along the heading. Steps are therefore climbed as ramps of that length;
/// on planes the mean is exact.
inline constexpr double kContactLength = 0.2;

/// Drives along the path with four wheels on the terrain: height, roll and pitch are those of the
/// plane of least squares through the feet of the wheels. Wheelbase and track are taken
/// horizontally. Flanks of holes carry wheels as well.
///
/// Corners are arcs of 0.5 m radius, of less where an arc would take more than half of a leg.
/// Corners sharper than 120 degrees are turned on the spot, at the waypoint. The speed is constant
/// but for turns, where the heading changes by at most 1 rad/s. Equal waypoints in a row count
/// once. Samples are at most 1 cm and 1 degree of heading apart.
///
/// A vehicle with one place to be (none: the origin) stands there with `DrivePath::yaw`, and the
/// motion is one pose.
/// \param source of the path, beginning of messages
/// Throws SceneError "SOURCE: leaves the terrain at (x, y) ..." where a wheel has no ground,
/// and where a waypoint is not finite or the speed not above 0.
[[nodiscard]] Motion drive(const RayCaster& caster, const VehicleParams& vehicle,
                           const DrivePath& path, const std::string& source);

}  // namespace mrpt_terrain::sim
