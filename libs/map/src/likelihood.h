// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/map/snapshot.h"

namespace mrpt_terrain {

/// What a cell looks like to a point near it; window frame, metres.
///
/// A *surface* is a plane through the cell's points. It has no edges: how far its points happen to
/// reach says more about where the rays fell than about the terrain. Everything else *stands*: an
/// upright prism over a rectangle that is as long as its points along their main direction, and has
/// a middle, but no width, across it.
struct CellShape {
  bool surface = false;
  double x = 0.0, y = 0.0, z = 0.0;  ///< mean of its points
  double slope_x = 0.0, slope_y = 0.0;
  double cosine = 1.0;                  ///< of a surface's inclination
  double along_x = 1.0, along_y = 0.0;  ///< unit vector of the main direction of what stands
  double half_length = 0.0;             ///< along it
  double variance_across = 0.0;
  double low = 0.0, high = 0.0;
};

/// \param sums of the cell's points
/// \param low, high of the cell's points
[[nodiscard]] CellShape shape_of(const MomentSums& sums, double low, double high);

/// A snapshot, made ready for many likelihoods.
struct LikelihoodField {
  TerrainSnapshotPtr snapshot;
  std::vector<CellShape> shapes;  ///< per slot
};

/// The field of the snapshot that was judged by last. Any number of threads may ask.
class LikelihoodFields {
 public:
  [[nodiscard]] std::shared_ptr<const LikelihoodField> of(const TerrainSnapshotPtr& snapshot) const;

 private:
  mutable std::mutex mutex_;  ///< held for the time of copying a pointer
  mutable std::shared_ptr<const LikelihoodField> last_;
};

/// log-likelihood of points, robot frame, at a pose.
[[nodiscard]] double log_likelihood(const LikelihoodField& field, const PointsView& points,
                                    const Eigen::Isometry3d& T_map_robot,
                                    const MapLikelihoodParams& params);

}  // namespace mrpt_terrain
