// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/plane_estimators.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "mrpt_terrain/core/moments.h"

namespace mrpt_terrain::eval {
namespace {

// Second moments below this share of the greatest count as zero.
constexpr double kRankTolerance = 1e-9;

// The first point is the origin of the sums, so that they stay small far from the robot.
Moments moments_of(const PointsView& points, IndexRange members) {
  const auto first = static_cast<std::size_t>(*members.begin());
  const double x0 = points.x[first];
  const double y0 = points.y[first];
  const double z0 = points.z[first];
  MomentSums sums;
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    sums.add(points.x[i] - x0, points.y[i] - y0, points.z[i] - z0);
  }
  return moments_from(sums);
}

PlaneEstimate failed(FeatureStatus status) {
  PlaneEstimate result;
  result.status = status;
  return result;
}

class PcaEstimator : public PlaneEstimator {
 public:
  [[nodiscard]] std::string name() const override { return "pca"; }
  [[nodiscard]] PlaneEstimate estimate(const PointsView& points, IndexRange members,
                                       double /*threshold*/,
                                       std::uint64_t /*seed*/) const override {
    if (members.size() < 3) return failed(FeatureStatus::kTooFewPoints);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        moments_of(points, members).covariance());
    const Eigen::Vector3d& values = solver.eigenvalues();
    if (values[1] <= kRankTolerance * values[2]) return failed(FeatureStatus::kDegenerate);
    return plane_of_normal(solver.eigenvectors().col(0));
  }
};

class LeastSquaresEstimator : public PlaneEstimator {
 public:
  [[nodiscard]] std::string name() const override { return "least_squares"; }
  [[nodiscard]] PlaneEstimate estimate(const PointsView& points, IndexRange members,
                                       double /*threshold*/,
                                       std::uint64_t /*seed*/) const override {
    if (members.size() < 3) return failed(FeatureStatus::kTooFewPoints);
    const Moments m = moments_of(points, members);
    // About the mean D drops out of the normal equations.
    const double determinant = m.m_xx * m.m_yy - m.m_xy * m.m_xy;
    const double scale = m.m_xx + m.m_yy;
    if (determinant <= kRankTolerance * scale * scale) return failed(FeatureStatus::kDegenerate);
    const double a = (m.m_yy * m.m_xz - m.m_xy * m.m_yz) / determinant;
    const double b = (m.m_xx * m.m_yz - m.m_xy * m.m_xz) / determinant;
    return plane_of_normal({-a, -b, 1.0});
  }
};

class PaperEstimator : public PlaneEstimator {
 public:
  explicit PaperEstimator(const SlopeParams& params) : params_(params) {}
  [[nodiscard]] std::string name() const override { return "paper_method"; }
  [[nodiscard]] PlaneEstimate estimate(const PointsView& points, IndexRange members,
                                       double threshold, std::uint64_t seed) const override {
    SlopeParams params = params_;
    params.inlier_distance = threshold;
    params.seed = seed;
    SlopeWorkspace workspace;
    const Slope slope = estimate_slope(points, members, params, 0, workspace);
    if (slope.status != FeatureStatus::kOk) return failed(slope.status);
    return plane_of_normal(slope.normal);
  }

 private:
  SlopeParams params_;
};

}  // namespace

PlaneEstimate plane_of_normal(const Eigen::Vector3d& normal) {
  PlaneEstimate result;
  result.status = FeatureStatus::kOk;
  result.normal = normal.normalized();
  if (result.normal.z() < 0.0) result.normal = -result.normal;
  // The cosine of a gentle slope is too close to one for acos.
  result.angle = std::atan2(result.normal.head<2>().norm(), result.normal.z());
  return result;
}

std::unique_ptr<PlaneEstimator> pca_estimator() { return std::make_unique<PcaEstimator>(); }

std::unique_ptr<PlaneEstimator> least_squares_estimator() {
  return std::make_unique<LeastSquaresEstimator>();
}

std::unique_ptr<PlaneEstimator> paper_estimator(const SlopeParams& params) {
  return std::make_unique<PaperEstimator>(params);
}

}  // namespace mrpt_terrain::eval
