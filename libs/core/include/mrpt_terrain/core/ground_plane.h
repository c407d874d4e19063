// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// How the plane of the ground is looked for.
struct GroundPlaneParams {
  double range = 30.0;                   ///< metres: points farther away in x or y do not count
  double cell_size = 0.5;                ///< metres: one candidate, the lowest point, per cell
  double tolerance = 0.15;               ///< metres: distance of candidates on the plane
  double max_tilt = 0.3490658503988659;  ///< radians
  double min_share = 0.2;                ///< share of the candidates that must lie on the plane
  int iterations = 1000;
  std::uint64_t seed = 1;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.range,
          ParamInfo{"range", "", "m", 1.0, 1000.0, "points farther away in x or y do not count"});
    visit(self.cell_size, ParamInfo{"cell_size", "", "m", 0.05, 10.0,
                                    "the lowest point of each cell of this size is a candidate"});
    visit(self.tolerance, ParamInfo{"tolerance", "", "m", 0.001, 1.0,
                                    "distance up to which a candidate lies on the plane"});
    visit(self.max_tilt, ParamInfo{"max_tilt_deg", "", "deg", 0.0, 60.0,
                                   "greatest tilt of the plane in the robot frame"});
    visit(self.min_share, ParamInfo{"min_share", "", "", 0.0, 1.0,
                                    "share of the candidates that must lie on the plane"});
    visit(self.iterations, ParamInfo{"iterations", "", "", 1, 1000000, "planes that are tried"});
    visit(self.seed, ParamInfo{"seed", "", "", 0, 9e15, "seed of the random numbers"});
  }
};

/// The ground as one plane in the frame of the points.
struct GroundPlane {
  bool found = false;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, upwards
  double height = 0.0;                                ///< of the plane at x = y = 0, metres
  double tilt = 0.0;                                  ///< angle between normal and z, radians
  double share = 0.0;                                 ///< of the candidates on the plane
};

/// Scratch memory of `find_ground_plane`.
struct GroundPlaneWorkspace {
  std::vector<std::int32_t> lowest;
  Points candidates;
};

/// Looks for the plane that most of the low points share and few points lie below. Meant for data
/// whose sensor pose does not put z = 0 on the ground; one plane, so only as good as the ground is
/// flat. Deterministic for equal points, parameters and seed.
[[nodiscard]] GroundPlane find_ground_plane(const PointsView& points,
                                            const GroundPlaneParams& params,
                                            GroundPlaneWorkspace& workspace);

}  // namespace mrpt_terrain
