// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Whether a feature could be computed. Its numbers mean something only when it is `kOk`.
enum class FeatureStatus : std::uint8_t {
  kOk = 0,
  kNotNeeded,      ///< the class was known without it (the paper computes features in sequence)
  kTooFewPoints,   ///< fewer than three points
  kDegenerate,     ///< the points are on one spot or one line: no plane
  kNoConsensus,    ///< RANSAC found no plane that holds more than its own three points
};
constexpr EnumNames<FeatureStatus, 5> enum_names(FeatureStatus) {
  return {{{FeatureStatus::kOk, "ok"},
           {FeatureStatus::kNotNeeded, "not_needed"},
           {FeatureStatus::kTooFewPoints, "too_few_points"},
           {FeatureStatus::kDegenerate, "degenerate"},
           {FeatureStatus::kNoConsensus, "no_consensus"}}};
}

/// Height index of a cluster (paper, eq. 3), metres.
struct HeightIndex {
  double h_d = 0.0;  ///< H_d: greatest h_max minus smallest h_min of its cells
  double h_m = 0.0;  ///< H_m: mean of its cells' mean heights
  double h_f = 0.0;  ///< H_f: max(H_d, H_m) if H_m >= 0, min(-H_d, H_m) otherwise
};

/// Height index of the cells `slots` (at least one).
[[nodiscard]] HeightIndex height_index(const ElevationGrid& grid, const GroundSegmentation& ground,
                                       IndexRange slots);

/// Thresholds of the roughness test (paper, eq. 4 and Algorithm 1).
struct RoughnessParams {
  double t_ratio = 20.0;        ///< T_ratio: lambda_1 >= T_ratio * lambda_0 means lambda_1 >> lambda_0
  double t_l = 0.01;            ///< T_L, m^2
  double t_s = 4e-4;            ///< T_S, m^2
  bool perfect_plane_is_rough = false;  ///< the printed form of Algorithm 1 (lambda_0 = 0 is rough)

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_ratio, ParamInfo{"t_ratio", "T_ratio", "", 1.0, 1e6,
                                  "middle eigenvalue over the smallest from which a cluster is flat"});
    visit(self.t_l, ParamInfo{"t_l", "T_L", "m^2", 0.0, 100.0,
                              "least middle eigenvalue of a flat cluster"});
    visit(self.t_s, ParamInfo{"t_s", "T_S", "m^2", 0.0, 100.0,
                              "greatest smallest eigenvalue of a flat cluster"});
    visit(self.perfect_plane_is_rough,
          ParamInfo{"perfect_plane_is_rough", "", "", 0, 0,
                    "calls a cluster with a smallest eigenvalue of exactly 0 rough, as the paper prints it"});
  }
};

/// Roughness of a cluster (paper, eq. 4).
struct Roughness {
  FeatureStatus status = FeatureStatus::kNotNeeded;
  bool rough = true;                            ///< R_n = 1
  std::array<double, 3> lambda = {{0, 0, 0}};   ///< eigenvalues of the covariance, ascending, m^2
};

/// Roughness from the eigenvalues of the covariance (divided by n) of a cluster's points.
[[nodiscard]] Roughness roughness(const Moments& moments, const RoughnessParams& params);

/// Parameters of the slope estimate (paper, eqs. 5 and 6, Algorithm 2).
struct SlopeParams {
  double inlier_distance = 0.02;   ///< T_q (T_Segment in Algorithm 2), metres
  double inlier_share = 0.95;      ///< T_Inlier: RANSAC stops when the share of inliers exceeds it
  int max_iterations = 1000;       ///< MaxIterations
  /// Inclination of the RANSAC plane, radians, from which the final fit minimises distances along
  /// the normal instead of along z, because z = A x + B y + D has no solution for a wall.
  double vertical_from = 1.2217304763960306;
  std::uint64_t seed = 1;          ///< of the random triples; each cluster draws its own sequence

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.inlier_distance, ParamInfo{"inlier_distance", "T_q", "m", 0.0001, 1.0,
                                          "point-to-plane distance of an inlier"});
    visit(self.inlier_share, ParamInfo{"inlier_share", "T_Inlier", "", 0.0, 1.0,
                                       "share of inliers above which RANSAC stops"});
    visit(self.max_iterations, ParamInfo{"max_iterations", "MaxIterations", "", 1, 1000000,
                                         "most RANSAC hypotheses of a cluster"});
    visit(self.vertical_from,
          ParamInfo{"vertical_from_deg", "", "deg", 0.0, 90.0,
                    "inclination from which the plane is fitted by total least squares; 90 is the "
                    "paper to the letter"});
    visit(self.seed, ParamInfo{"seed", "", "", 0, 9e15, "seed of the random numbers"});
  }
};

/// Slope of a cluster (paper, eqs. 5 and 6).
struct Slope {
  FeatureStatus status = FeatureStatus::kNotNeeded;
  double angle = 0.0;                               ///< alpha_s, radians, 0 to pi/2
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< unit, z >= 0
  double offset = 0.0;                              ///< metres: normal . p + offset = 0 on the plane
  std::int32_t inliers = 0;                         ///< points within T_q of the best hypothesis
  std::int32_t points = 0;                          ///< points of the cluster
  std::int32_t iterations = 0;                      ///< hypotheses drawn
};

/// Scratch memory of `estimate_slope`.
struct SlopeWorkspace {
  std::vector<float> x, y, z;   ///< points of the cluster about their centre
};

/// RANSAC plane through the points, then least squares on its inliers and the plane's inclination.
/// \param points all points of the scan
/// \param members indices of the cluster's points
/// \param stream distinguishes the random sequences of clusters (the cluster's number)
[[nodiscard]] Slope estimate_slope(const PointsView& points, IndexRange members,
                                   const SlopeParams& params, std::uint64_t stream,
                                   SlopeWorkspace& workspace);

}  // namespace mrpt_terrain
