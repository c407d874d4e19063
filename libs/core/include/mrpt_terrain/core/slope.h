// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/feature_status.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// How slopes are estimated.
enum class SlopeMethod : std::uint8_t {
  kPaper = 0,  ///< RANSAC and least squares (this file)
  kBeam,       ///< maximum likelihood with noise along the beams (beam_slope.h)
};
constexpr EnumNames<SlopeMethod, 2> enum_names(SlopeMethod) {
  return {{{SlopeMethod::kPaper, "paper"}, {SlopeMethod::kBeam, "beam"}}};
}

/// Parameters of the slope estimate (paper, eqs. 5 and 6, Algorithm 2).
struct SlopeParams {
  SlopeMethod method = SlopeMethod::kPaper;
  double inlier_distance = 0.01;  ///< T_q (T_Segment in Algorithm 2), metres
  double inlier_share = 0.95;     ///< T_Inlier: RANSAC stops when the share of inliers exceeds it
  int max_iterations = 1000;      ///< MaxIterations
  /// Inclination of the RANSAC plane, radians, from which the final fit minimises distances along
  /// the normal instead of along z, because z = A x + B y + D has no solution for a wall.
  double vertical_from = 1.2217304763960306;
  std::uint64_t seed = 1;  ///< of the random triples; each cluster draws its own sequence

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.method, ParamInfo{"method", "", "", 0, 0,
                                 "paper: RANSAC and least squares; beam: noise along the beams, "
                                 "section beam_slope"});
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

/// Slope of a cluster against the ground around it; method `beam` only.
struct SlopeToGround {
  FeatureStatus status = FeatureStatus::kNotNeeded;  ///< kTooFewPoints: too little ground seen
  double angle = 0.0;                                ///< radians, between the two planes
  double angle_sigma = 0.0;                          ///< its standard deviation, radians
  Eigen::Vector3d ground_normal = Eigen::Vector3d::UnitZ();  ///< unit, z >= 0
  double ground_offset = 0.0;  ///< metres: ground_normal . p + ground_offset = 0 on the ground
};

/// What a plane was fitted to.
enum class PlaneSource : std::uint8_t {
  kPoints = 0,  ///< the points of the scan
  kMoments,     ///< the moments of fused cells, for want of points
};
constexpr EnumNames<PlaneSource, 2> enum_names(PlaneSource) {
  return {{{PlaneSource::kPoints, "points"}, {PlaneSource::kMoments, "moments"}}};
}

/// Slope of a cluster (paper, eqs. 5 and 6). The standard deviations are those of method `beam`;
/// method `paper` has none and leaves them 0.
struct Slope {
  FeatureStatus status = FeatureStatus::kNotNeeded;
  PlaneSource source = PlaneSource::kPoints;         ///< kMoments in fused descriptions only
  double angle = 0.0;                                ///< alpha_s, radians, 0 to pi/2
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, z >= 0
  double offset = 0.0;           ///< metres: normal . p + offset = 0 on the plane
  double direction = 0.0;        ///< where it rises, from x towards y, radians, (-pi, pi]
  double angle_sigma = 0.0;      ///< standard deviation of the angle, radians
  double direction_sigma = 0.0;  ///< standard deviation of the direction, radians, at most pi
  double range_sigma = 0.0;      ///< noise along the beams that the points show, metres
  SlopeToGround to_ground;
  std::int32_t inliers = 0;     ///< points within T_q of the best hypothesis, or that counted
  std::int32_t points = 0;      ///< points of the cluster
  std::int32_t iterations = 0;  ///< hypotheses drawn
};

/// Where a plane rises, from x towards y, radians; 0 for a level one.
/// \param normal unit, z >= 0
[[nodiscard]] double direction_of(const Eigen::Vector3d& normal);

/// Scratch memory of `estimate_slope`.
struct SlopeWorkspace {
  std::vector<float> x, y, z;  ///< points of the cluster about their centre
};

/// RANSAC plane through the points, then least squares on its inliers and the plane's inclination.
/// \param points all points of the scan
/// \param members indices of the cluster's points
/// \param stream distinguishes the random sequences of clusters (the cluster's number)
[[nodiscard]] Slope estimate_slope(const PointsView& points, IndexRange members,
                                   const SlopeParams& params, std::uint64_t stream,
                                   SlopeWorkspace& workspace);

/// Plane by least squares through all points of a set, of which only the moments are left: eq. (5),
/// or along the normal if it is steeper than `vertical_from`. Outliers cannot be told apart.
[[nodiscard]] Slope slope_from_moments(const Moments& moments, const SlopeParams& params);

}  // namespace mrpt_terrain
