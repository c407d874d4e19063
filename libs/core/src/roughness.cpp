// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/roughness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace mrpt_terrain {
namespace {

// Below this variance, m^2, all points are on one spot: what is left is the rounding of MomentSums.
constexpr double kLeastSpread = 1e-8;

}  // namespace

Roughness roughness(const Moments& moments, const RoughnessParams& params) {
  Roughness result;
  if (moments.n < 3.0) {
    result.status = FeatureStatus::kTooFewPoints;
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.covariance(),
                                                              Eigen::EigenvaluesOnly);
  // A covariance has no negative eigenvalues; rounding makes them.
  for (std::size_t k = 0; k < 3; ++k) {
    result.lambda[k] = std::max(0.0, solver.eigenvalues()[static_cast<Eigen::Index>(k)]);
  }
  if (result.lambda[2] <= kLeastSpread) {
    result.status = FeatureStatus::kDegenerate;
    return result;
  }
  result.status = FeatureStatus::kOk;
  const auto& [l0, l1, l2] = result.lambda;
  const bool printed_exception = params.perfect_plane_is_rough && l0 == 0.0;
  const bool flat = l1 >= params.t_ratio * l0 && l1 >= params.t_l && l0 <= params.t_s;
  result.rough = !flat || printed_exception;
  return result;
}

}  // namespace mrpt_terrain
