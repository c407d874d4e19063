// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/slope.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/random.h"
#include "plane_inliers.h"

namespace mrpt_terrain {
namespace {

// Singular values below this share of the greatest count as zero.
constexpr double kRankTolerance = 1e-9;

Eigen::Vector3d centre_of(const PointsView& points, IndexRange members) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    sum += Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
  }
  return sum / static_cast<double>(members.size());
}

// Copies the cluster's points relative to their centre, where floats have digits to spare.
void load(const PointsView& points, IndexRange members, const Eigen::Vector3d& centre,
          SlopeWorkspace& workspace) {
  workspace.x.resize(members.size());
  workspace.y.resize(members.size());
  workspace.z.resize(members.size());
  std::size_t k = 0;
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    workspace.x[k] = static_cast<float>(points.x[i] - centre.x());
    workspace.y[k] = static_cast<float>(points.y[i] - centre.y());
    workspace.z[k] = static_cast<float>(points.z[i] - centre.z());
    ++k;
  }
}

struct Consensus {
  std::optional<Plane> plane;
  std::int32_t inliers = 0;
  std::int32_t iterations = 0;
};

// Algorithm 2, lines 1 to 22.
Consensus ransac(const PointsView& cloud, const SlopeParams& params, std::uint64_t stream) {
  RandomGenerator random(params.seed, stream);
  Consensus best;
  const auto tolerance = static_cast<float>(params.inlier_distance);
  while (best.iterations < params.max_iterations) {
    ++best.iterations;
    const std::optional<Plane> plane = random_plane(cloud, random);
    if (!plane) continue;
    const std::int32_t inliers = count_inliers(cloud, *plane, tolerance, best.inliers);
    if (inliers > best.inliers) {
      best.inliers = inliers;
      best.plane = plane;
    }
    if (best.inliers > params.inlier_share * static_cast<double>(cloud.size)) break;
  }
  return best;
}

Moments moments_of_inliers(const PointsView& cloud, const Plane& plane, float tolerance) {
  MomentSums sums;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (is_inlier(cloud, i, plane, tolerance)) sums.add(cloud.x[i], cloud.y[i], cloud.z[i]);
  }
  return moments_from(sums);
}

// Eq. (5): z = A x + B y + D by least squares. About the mean of the inliers the third row and
// column of the matrix decouple (D = 0 there), which leaves the two by two part to the SVD.
std::optional<Eigen::Vector3d> fit_along_z(const Moments& inliers) {
  Eigen::Matrix2d matrix;
  matrix << inliers.m_xx, inliers.m_xy, inliers.m_xy, inliers.m_yy;
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] <= kRankTolerance * svd.singularValues()[0]) return std::nullopt;
  const Eigen::Vector2d slope = svd.solve(Eigen::Vector2d(inliers.m_xz, inliers.m_yz));
  return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

// Total least squares: the direction of least scatter.
std::optional<Eigen::Vector3d> fit_along_normal(const Moments& inliers) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inliers.covariance());
  if (solver.eigenvalues()[1] <= kRankTolerance * solver.eigenvalues()[2]) return std::nullopt;
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

double inclination(double normal_z) { return std::acos(std::min(1.0, std::abs(normal_z))); }

// Writes down the plane of that normal through a point, or that there is none.
void report_plane(const std::optional<Eigen::Vector3d>& normal, const Eigen::Vector3d& through,
                  Slope& result) {
  if (!normal) {
    result.status = FeatureStatus::kDegenerate;
    return;
  }
  result.status = FeatureStatus::kOk;
  result.normal = *normal;
  result.offset = -normal->dot(through);
  result.angle = inclination(normal->z());
  result.direction = direction_of(*normal);
}

}  // namespace

double direction_of(const Eigen::Vector3d& normal) {
  if (normal.x() == 0.0 && normal.y() == 0.0) return 0.0;
  return std::atan2(-normal.y(), -normal.x());
}

Slope estimate_slope(const PointsView& points, IndexRange members, const SlopeParams& params,
                     std::uint64_t stream, SlopeWorkspace& workspace) {
  Slope result;
  result.points = static_cast<std::int32_t>(members.size());
  if (members.size() < 3) {
    result.status = FeatureStatus::kTooFewPoints;
    return result;
  }
  const Eigen::Vector3d centre = centre_of(points, members);
  load(points, members, centre, workspace);
  const PointsView cloud{workspace.x.data(), workspace.y.data(), workspace.z.data(),
                         members.size()};

  const Consensus best = ransac(cloud, params, stream);
  result.iterations = best.iterations;
  result.inliers = best.inliers;
  if (!best.plane) {
    result.status = FeatureStatus::kDegenerate;
    return result;
  }
  if (best.inliers <= 3 && members.size() > 3) {
    result.status = FeatureStatus::kNoConsensus;
    return result;
  }
  const Moments inliers =
      moments_of_inliers(cloud, *best.plane, static_cast<float>(params.inlier_distance));
  const bool steep = inclination(best.plane->c) >= params.vertical_from;
  report_plane(steep ? fit_along_normal(inliers) : fit_along_z(inliers), inliers.mean() + centre,
               result);
  return result;
}

Slope slope_from_moments(const Moments& moments, const SlopeParams& params) {
  Slope result;
  result.source = PlaneSource::kMoments;
  result.points = static_cast<std::int32_t>(moments.n);
  if (moments.n < 3.0) {
    result.status = FeatureStatus::kTooFewPoints;
    return result;
  }
  result.inliers = result.points;
  // Which fit is right shows in the direction of least scatter; without one there is no plane.
  const std::optional<Eigen::Vector3d> upright = fit_along_normal(moments);
  const bool steep = upright && inclination(upright->z()) >= params.vertical_from;
  report_plane(upright && !steep ? fit_along_z(moments) : upright, moments.mean(), result);
  return result;
}

}  // namespace mrpt_terrain
