// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mrpt_terrain/sim/vehicle.h"

namespace mrpt_terrain::sim {

/// Where a vehicle is in the horizontal plane, and when.
struct RoutePoint {
  double time = 0.0;  ///< seconds
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double yaw = 0.0;  ///< radians, continuous along the route
};

/// Ends of the rules of `drive`.
inline constexpr double kRouteStep = 0.01;                      ///< metres between samples
inline constexpr double kRouteTurnStep = 0.017453292519943295;  ///< radians between samples
inline constexpr double kCornerRadius = 0.5;                    ///< metres
inline constexpr double kSharpestArc = 2.0943951023931953;      ///< radians
inline constexpr double kTurnRate = 1.0;                        ///< radians per second

/// Samples of a path with rounded corners as `drive` describes it; one sample if it leads nowhere.
[[nodiscard]] std::vector<RoutePoint> route_of(const DrivePath& path);

}  // namespace mrpt_terrain::sim
