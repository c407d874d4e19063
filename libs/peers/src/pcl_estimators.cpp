// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/peers/pcl_estimators.h"

#include <pcl/console/print.h>
#include <pcl/pcl_config.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/lmeds.h>
#include <pcl/sample_consensus/mlesac.h>
#include <pcl/sample_consensus/msac.h>
#include <pcl/sample_consensus/prosac.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/rransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mrpt_terrain::peers {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using PlaneModel = pcl::SampleConsensusModelPlane<pcl::PointXYZ>;

/// PCL's plane model, which draws its samples from a generator with our seed.
class SeededPlaneModel : public PlaneModel {
 public:
  SeededPlaneModel(const Cloud::ConstPtr& cloud, std::uint64_t seed) : PlaneModel(cloud) {
    rng_alg_.seed(static_cast<unsigned>(seed ^ (seed >> 32U)));
  }
};

/// One of PCL's methods; RRANSAC has a generator of its own for the points it tests.
template <template <class> class Method>
class Seeded : public Method<pcl::PointXYZ> {
 public:
  Seeded(const PlaneModel::Ptr& model, double threshold, std::uint64_t seed)
      : Method<pcl::PointXYZ>(model, threshold) {
    this->rng_->base().seed(static_cast<unsigned>((seed >> 32U) + 2654435769U * seed));
  }
};

Cloud::Ptr cloud_of(const PointsView& points, IndexRange members) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(members.size());
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    cloud->push_back({points.x[i], points.y[i], points.z[i]});
  }
  return cloud;
}

Cloud::Ptr sorted_by_distance(const Cloud& cloud, const Eigen::Vector3d& normal) {
  const auto height = [&normal](const pcl::PointXYZ& p) {
    return normal.dot(p.getVector3fMap().cast<double>());
  };
  const double sum = std::accumulate(
      cloud.begin(), cloud.end(), 0.0,
      [&height](double so_far, const pcl::PointXYZ& p) { return so_far + height(p); });
  const double mean = sum / static_cast<double>(cloud.size());
  auto sorted = pcl::make_shared<Cloud>(cloud);
  std::stable_sort(sorted->begin(), sorted->end(),
                   [&](const pcl::PointXYZ& a, const pcl::PointXYZ& b) {
                     return std::abs(height(a) - mean) < std::abs(height(b) - mean);
                   });
  return sorted;
}

eval::PlaneEstimate failed(FeatureStatus status) {
  eval::PlaneEstimate result;
  result.status = status;
  return result;
}

template <template <class> class Method>
void prepare(Seeded<Method>& /*method*/, std::size_t /*points*/) {}

void prepare(Seeded<pcl::RandomizedRandomSampleConsensus>& method, std::size_t points) {
  method.setFractionNrPretest(100.0 / static_cast<double>(points));
}

template <template <class> class Method>
class PclEstimator : public eval::PlaneEstimator {
 public:
  PclEstimator(std::string name, const PclOptions& options)
      : name_(std::move(name)), options_(options) {}

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] eval::PlaneEstimate estimate(const PointsView& points, IndexRange members,
                                             double threshold, std::uint64_t seed) const override {
    // PCL looks for samples that span a plane again and again; on a line there are none.
    const eval::PlaneEstimate components =
        eval::pca_estimator()->estimate(points, members, threshold, seed);
    if (components.status != FeatureStatus::kOk) return components;
    Cloud::Ptr cloud = cloud_of(points, members);
    if (sorts_points()) cloud = sorted_by_distance(*cloud, components.normal);

    const auto model = pcl::make_shared<SeededPlaneModel>(cloud, seed);
    Seeded<Method> method(model, threshold, seed);
    prepare(method, cloud->size());
    if (!method.computeModel()) return failed(FeatureStatus::kNoConsensus);
    Eigen::VectorXf plane;
    method.getModelCoefficients(plane);
    if (options_.refine) {
      pcl::Indices inliers;
      method.getInliers(inliers);
      const Eigen::VectorXf sampled = plane;
      model->optimizeModelCoefficients(inliers, sampled, plane);
    }
    return eval::plane_of_normal(plane.head<3>().cast<double>());
  }

 private:
  static constexpr bool sorts_points() {
    return std::is_same_v<Method<pcl::PointXYZ>, pcl::ProgressiveSampleConsensus<pcl::PointXYZ>>;
  }

  std::string name_;
  PclOptions options_;
};

template <template <class> class Method>
void add(eval::PlaneEstimators& list, const char* name, const PclOptions& options) {
  list.push_back(std::make_unique<PclEstimator<Method>>(name, options));
}

}  // namespace

eval::PlaneEstimators pcl_estimators(const PclOptions& options) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  eval::PlaneEstimators list;
  add<pcl::RandomSampleConsensus>(list, "ransac", options);
  add<pcl::LeastMedianSquares>(list, "lmeds", options);
  add<pcl::MEstimatorSampleConsensus>(list, "msac", options);
  add<pcl::RandomizedRandomSampleConsensus>(list, "rransac", options);
  add<pcl::MaximumLikelihoodSampleConsensus>(list, "mlesac", options);
  add<pcl::ProgressiveSampleConsensus>(list, "prosac", options);
  return list;
}

const char* pcl_version() { return PCL_VERSION_PRETTY; }

}  // namespace mrpt_terrain::peers
