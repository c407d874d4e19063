// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/random.h"

/// How the wheels of the simulated robot count.
struct OdometryParams {
  double rate = 20.0;          ///< readings per second
  double scale_sigma = 0.005;  ///< relative error of the wheels' size, one number per run
  double slip = 0.05;          ///< uphill the wheels turn farther by this share of the climb
  double way_sigma = 0.005;    ///< metres after one metre; grows with the root of the way
  double turn_sigma =
      0.008726646259971648;  ///< radians after one metre; grows with the root of the way

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    using mrpt_terrain::ParamInfo;
    visit(self.rate, ParamInfo{"rate", "", "Hz", 0.1, 1000.0, "readings per second"});
    visit(self.scale_sigma, ParamInfo{"scale_sigma", "", "", 0.0, 0.5,
                                      "relative error of the wheels' size, one number per run"});
    visit(self.slip, ParamInfo{"slip", "", "", 0.0, 1.0,
                               "uphill the wheels turn farther by this share of the climb"});
    visit(self.way_sigma,
          ParamInfo{"way_sigma", "", "m", 0.0, 1.0,
                    "standard deviation after one metre; grows with the root of the way"});
    visit(self.turn_sigma,
          ParamInfo{"turn_sigma_deg", "", "deg", 0.0, 45.0,
                    "standard deviation after one metre; grows with the root of the way"});
  }
};

/// A pose in the plane, metres and radians.
struct PlanarPose {
  double x = 0.0, y = 0.0, yaw = 0.0;
};

/// Dead reckoning by the wheels, which starts at the origin of the odometry's own frame. It knows
/// neither height nor tilt: its way is the one along the terrain, not the horizontal one.
class Odometry {
 public:
  Odometry(const OdometryParams& params, std::uint64_t seed,
           const Eigen::Isometry3d& T_map_robot_at_start);

  /// Reading after the robot has gone on to a pose; call in the order of time.
  [[nodiscard]] PlanarPose move_to(const Eigen::Isometry3d& T_map_robot);

 private:
  OdometryParams params_;
  mrpt_terrain::RandomGenerator random_;
  double scale_;
  Eigen::Isometry3d T_map_last_;
  PlanarPose pose_;
};
