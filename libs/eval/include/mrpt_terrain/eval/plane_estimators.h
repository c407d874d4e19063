// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/feature_status.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/slope.h"

namespace mrpt_terrain::eval {

/// The plane that an estimator found in a cluster.
struct PlaneEstimate {
  FeatureStatus status = FeatureStatus::kTooFewPoints;
  double angle = 0.0;                                ///< from horizontal, radians, 0 to pi/2
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, z >= 0
};

/// The estimate with this normal, of any length but zero, turned upwards.
[[nodiscard]] PlaneEstimate plane_of_normal(const Eigen::Vector3d& normal);

/// One way to find the plane of a cluster. All are compared through this interface: the same points
/// for each. Estimators keep no state and may be shared between threads.
class PlaneEstimator {
 public:
  virtual ~PlaneEstimator() = default;

  /// Short and unique, as in the header of a table: "ransac".
  [[nodiscard]] virtual std::string name() const = 0;

  /// \param points all points of the scan, metres
  /// \param members indices of the cluster's points
  /// \param threshold distance of an inlier, metres; unused by estimators without outliers
  /// \param seed of the random numbers; the same seed gives the same estimate
  [[nodiscard]] virtual PlaneEstimate estimate(const PointsView& points, IndexRange members,
                                               double threshold, std::uint64_t seed) const = 0;
};

using PlaneEstimators = std::vector<std::unique_ptr<PlaneEstimator>>;

/// Principal components: the normal is the direction of least scatter. "pca".
[[nodiscard]] std::unique_ptr<PlaneEstimator> pca_estimator();

/// z = A x + B y + D by least squares over all points. "least_squares".
[[nodiscard]] std::unique_ptr<PlaneEstimator> least_squares_estimator();

/// Algorithm 2 of Meng, Cao et al. 2018 (core/slope.h). "paper_method".
/// \param params inlier distance and seed are those of each estimate
[[nodiscard]] std::unique_ptr<PlaneEstimator> paper_estimator(const SlopeParams& params);

}  // namespace mrpt_terrain::eval
