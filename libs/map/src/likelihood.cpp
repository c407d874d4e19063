// SPDX-License-Identifier: BSD-3-Clause
#include "likelihood.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace mrpt_terrain {
namespace {

// A surface's points keep this close to its plane (standard deviation, metres) ...
constexpr double kFlat = 0.04;
// ... which rises less than this.
constexpr double kSteepest = 1.0;
// What `unknown_share` says counts as much as this share of a scan's points.
constexpr double kPriorWeight = 0.02;
// Points that are not spread farther than this, metres, say nothing about a slope.
constexpr double kLeastSpread = 0.02;

struct Covariance {
  double xx, xy, yy, xz, yz, zz;
};

Covariance covariance_of(const MomentSums& sums) {
  const Moments m = moments_from(sums);
  return {m.m_xx / m.n, m.m_xy / m.n, m.m_yy / m.n, m.m_xz / m.n, m.m_yz / m.n, m.m_zz / m.n};
}

/// Slopes of z over x and y by least squares. The term of regularisation keeps them from running
/// away where the points lie in a line.
void fit_slopes(const Covariance& c, CellShape& shape) {
  constexpr double kRegular = kLeastSpread * kLeastSpread;
  const double xx = c.xx + kRegular, yy = c.yy + kRegular;
  const double determinant = xx * yy - c.xy * c.xy;
  shape.slope_x = (yy * c.xz - c.xy * c.yz) / determinant;
  shape.slope_y = (xx * c.yz - c.xy * c.xz) / determinant;
}

/// Main direction of the points as seen from above.
void fit_prism(const Covariance& c, CellShape& shape) {
  const double turn = 0.5 * std::atan2(2.0 * c.xy, c.xx - c.yy);
  shape.along_x = std::cos(turn);
  shape.along_y = std::sin(turn);
  const double middle = 0.5 * (c.xx + c.yy);
  const double radius = std::hypot(0.5 * (c.xx - c.yy), c.xy);
  // Spread evenly over a length l they have the variance l^2 / 12.
  shape.half_length = std::sqrt(3.0 * (middle + radius));
  shape.variance_across = std::max(0.0, middle - radius);
}

/// Square of the distance between a point and the nearest of the shapes around it. Negative:
/// nothing is known around it.
class CellDistance {
 public:
  CellDistance(const LikelihoodField& field, const MapLikelihoodParams& params)
      : grid_(field.snapshot->description.grid),
        shapes_(field.shapes),
        variance_(params.sigma * params.sigma),
        reach_(static_cast<int>(std::ceil(params.max_distance / grid_.geometry.cell_size()))) {}

  [[nodiscard]] double square(const Eigen::Vector3d& p) const {
    CellIndex middle;
    if (!grid_.geometry.cell_at(p.x(), p.y(), middle)) return -1.0;
    // Ring by ring: of the surfaces only the nearest ones count, as they have no edges.
    double least = -1.0;
    bool on_surface = false;
    for (int ring = 0; ring <= reach_; ++ring) {
      if (on_surface && least <= nearest_in(ring)) break;
      bool found = false;
      for_each_in_ring(middle, ring, [&](const CellShape& shape) {
        if (shape.surface && on_surface) return;
        found |= shape.surface;
        const double square = shape.surface ? to_surface(shape, p) : to_prism(shape, p);
        if (least < 0.0 || square < least) least = square;
      });
      on_surface |= found;
    }
    return least;
  }

 private:
  /// Square of a distance that nothing in a ring is worth looking for below: no cell of it is
  /// nearer, or it would change a point's share by less than a two-hundredth.
  [[nodiscard]] double nearest_in(int ring) const {
    const double cells = std::max(0, ring - 1) * grid_.geometry.cell_size();
    return std::max(cells * cells, 0.01 * variance_);
  }

  template <class Visit>
  void for_each_in_ring(CellIndex middle, int ring, Visit&& visit) const {
    for (int dl = -ring; dl <= ring; ++dl) {
      const int step = std::abs(dl) == ring || ring == 0 ? 1 : 2 * ring;
      for (int dw = -ring; dw <= ring; dw += step) {
        const Slot slot = grid_.slot_at({middle.l + dl, middle.w + dw});
        if (slot != kUnobserved) visit(shapes_[static_cast<std::size_t>(slot)]);
      }
    }
  }

  static double to_surface(const CellShape& shape, const Eigen::Vector3d& p) {
    const double plane =
        shape.z + shape.slope_x * (p.x() - shape.x) + shape.slope_y * (p.y() - shape.y);
    const double distance = (p.z() - plane) * shape.cosine;
    return distance * distance;
  }

  // Across what is thick a distance says less.
  [[nodiscard]] double to_prism(const CellShape& shape, const Eigen::Vector3d& p) const {
    const double dx = p.x() - shape.x, dy = p.y() - shape.y;
    const double along = std::abs(dx * shape.along_x + dy * shape.along_y) - shape.half_length;
    const double beside = std::max(0.0, along);
    const double across = dy * shape.along_x - dx * shape.along_y;
    const double over = std::max({0.0, p.z() - shape.high, shape.low - p.z()});
    return beside * beside + across * across * variance_ / (variance_ + shape.variance_across) +
           over * over;
  }

  const ElevationGrid& grid_;
  const std::vector<CellShape>& shapes_;
  double variance_;
  int reach_;
};

}  // namespace

CellShape shape_of(const MomentSums& sums, double low, double high) {
  const Covariance c = covariance_of(sums);
  CellShape shape;
  shape.x = sums.x / sums.n;
  shape.y = sums.y / sums.n;
  shape.z = sums.z / sums.n;
  shape.low = low;
  shape.high = high;
  fit_slopes(c, shape);
  const double rest = c.zz - shape.slope_x * c.xz - shape.slope_y * c.yz;
  const double rise = std::hypot(shape.slope_x, shape.slope_y);
  shape.surface = rest < kFlat * kFlat && rise < kSteepest;
  shape.cosine = 1.0 / std::hypot(1.0, rise);
  if (!shape.surface) fit_prism(c, shape);
  return shape;
}

std::shared_ptr<const LikelihoodField> LikelihoodFields::of(
    const TerrainSnapshotPtr& snapshot) const {
  {
    const std::lock_guard lock(mutex_);
    if (last_ && last_->snapshot == snapshot) return last_;
  }
  auto field = std::make_shared<LikelihoodField>();
  field->snapshot = snapshot;
  const ElevationGrid& grid = snapshot->description.grid;
  field->shapes.reserve(grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    field->shapes.push_back(shape_of(grid.sums[slot], static_cast<double>(grid.h_min[slot]),
                                     static_cast<double>(grid.h_max[slot])));
  }
  std::shared_ptr<const LikelihoodField> result = std::move(field);
  const std::lock_guard lock(mutex_);
  last_ = result;
  return result;
}

double log_likelihood(const LikelihoodField& field, const PointsView& points,
                      const Eigen::Isometry3d& T_map_robot, const MapLikelihoodParams& params) {
  if (field.snapshot->revision == 0) return 0.0;
  const Eigen::Isometry3d T_window_robot = field.snapshot->T_map_window.inverse() * T_map_robot;
  const CellDistance distance(field, params);
  const double worst = params.max_distance * params.max_distance;
  double known = 0.0;  // sum of squares where something is known
  int judged = 0, unknown = 0;
  for (std::size_t k = 0; k < points.size; ++k) {
    const Eigen::Vector3f point(points.x[k], points.y[k], points.z[k]);
    const Eigen::Vector3d p = T_window_robot * point.cast<double>();
    if (!p.allFinite()) continue;
    const double square = distance.square(p);
    ++judged;
    if (square < 0.0) {
      ++unknown;
    } else {
      known += std::min(square, worst);
    }
  }
  if (judged == 0) return 0.0;
  // Which points fall where nothing is known says how the rings of the two scans lie, not how the
  // terrain does. Such a point costs what the others cost on average, so that it is neither worth
  // while nor harmful to move one there. Where hardly anything is known the prior takes over.
  const double prior = kPriorWeight * judged;
  const double average =
      (known + prior * params.unknown_share * worst) / (judged - unknown + prior);
  return -0.5 * (known + unknown * average) / (params.sigma * params.sigma);
}

}  // namespace mrpt_terrain
