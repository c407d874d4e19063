// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "map_state.h"

namespace mrpt_terrain {
namespace {

/// Square of the distance between a point and the nearest of the boxes about the points of the
/// cells around it. Negative: nothing is known around it.
class CellDistance {
 public:
  CellDistance(const ElevationGrid& grid, double max_distance)
      : grid_(grid),
        reach_(static_cast<int>(std::ceil(max_distance / grid.geometry.cell_size()))) {}

  [[nodiscard]] double square(const Eigen::Vector3d& p) const {
    CellIndex middle;
    if (!grid_.geometry.cell_at(p.x(), p.y(), middle)) return -1.0;
    double least = -1.0;
    for (int l = middle.l - reach_; l <= middle.l + reach_; ++l) {
      for (int w = middle.w - reach_; w <= middle.w + reach_; ++w) {
        const Slot slot = grid_.slot_at({l, w});
        if (slot == kUnobserved) continue;
        const double square = square_to(static_cast<std::size_t>(slot), p);
        if (least < 0.0 || square < least) least = square;
      }
    }
    return least;
  }

 private:
  // A cell's points fill a part of it: a wall, say, is thin. Spread evenly over a width w they have
  // the standard deviation w / sqrt(12).
  [[nodiscard]] double square_to(std::size_t slot, const Eigen::Vector3d& p) const {
    const MomentSums& sums = grid_.sums[slot];
    const double share = 1.0 / sums.n;
    const auto beside = [share](double value, double sum, double squares) {
      const double mean = sum * share;
      const double half = std::sqrt(std::max(0.0, 3.0 * (squares * share - mean * mean)));
      return std::max(0.0, std::abs(value - mean) - half);
    };
    const double dx = beside(p.x(), sums.x, sums.xx);
    const double dy = beside(p.y(), sums.y, sums.yy);
    const double above = p.z() - static_cast<double>(grid_.h_max[slot]);
    const double below = static_cast<double>(grid_.h_min[slot]) - p.z();
    const double dz = std::max({0.0, above, below});
    return dx * dx + dy * dy + dz * dz;
  }

  const ElevationGrid& grid_;
  int reach_;
};

}  // namespace

double log_likelihood(const TerrainSnapshot& snapshot, const PointsView& points,
                      const Eigen::Isometry3d& T_map_robot, const MapLikelihoodParams& params) {
  if (snapshot.revision == 0) return 0.0;
  const Eigen::Isometry3d T_window_robot = snapshot.T_map_window.inverse() * T_map_robot;
  const CellDistance distance(snapshot.description.grid, params.max_distance);
  const double worst = params.max_distance * params.max_distance;
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size; k += static_cast<std::size_t>(params.decimation)) {
    const Eigen::Vector3f point(points.x[k], points.y[k], points.z[k]);
    const Eigen::Vector3d p = T_window_robot * point.cast<double>();
    if (!p.allFinite()) continue;
    const double square = distance.square(p);
    sum += square < 0.0 ? params.unknown_share * worst : std::min(square, worst);
  }
  return -0.5 * sum / (params.sigma * params.sigma);
}

}  // namespace mrpt_terrain
