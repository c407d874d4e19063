// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "mrpt_terrain/core/feature_status.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Thresholds of the roughness test (paper, eq. 4 and Algorithm 1).
struct RoughnessParams {
  double t_ratio = 20.0;  ///< T_ratio: lambda_1 >= T_ratio * lambda_0 means lambda_1 >> lambda_0
  double t_l = 0.01;      ///< T_L, m^2
  double t_s = 4e-4;      ///< T_S, m^2
  bool perfect_plane_is_rough = false;  ///< the printed form of Algorithm 1 (lambda_0 = 0 is rough)

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_ratio,
          ParamInfo{"t_ratio", "T_ratio", "", 1.0, 1e6,
                    "middle eigenvalue over the smallest from which a cluster is flat"});
    visit(self.t_l,
          ParamInfo{"t_l", "T_L", "m^2", 0.0, 100.0, "least middle eigenvalue of a flat cluster"});
    visit(self.t_s, ParamInfo{"t_s", "T_S", "m^2", 0.0, 100.0,
                              "greatest smallest eigenvalue of a flat cluster"});
    visit(self.perfect_plane_is_rough, ParamInfo{"perfect_plane_is_rough", "", "", 0, 0,
                                                 "calls a cluster with a smallest eigenvalue of "
                                                 "exactly 0 rough, as the paper prints it"});
  }
};

/// Roughness of a cluster (paper, eq. 4).
struct Roughness {
  FeatureStatus status = FeatureStatus::kNotNeeded;
  bool rough = true;                           ///< R_n = 1
  std::array<double, 3> lambda = {{0, 0, 0}};  ///< eigenvalues of the covariance, ascending, m^2
};

/// Roughness from the eigenvalues of the covariance (divided by n) of a cluster's points.
[[nodiscard]] Roughness roughness(const Moments& moments, const RoughnessParams& params);

}  // namespace mrpt_terrain
