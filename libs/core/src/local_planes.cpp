// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/local_planes.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "mrpt_terrain/core/moments.h"

namespace mrpt_terrain {
namespace {

// Sums over the observed ones of some cells.
struct CellSums {
  MomentSums sums;
  std::int32_t cells = 0;
};

// Windows of the cells of one row after the other. A window is the sum of its columns; neighbours
// in a row share all but one of them, so the columns are kept.
class Windows {
 public:
  Windows(const ElevationGrid& grid, int reach) : grid_(grid), reach_(reach) {}

  CellSums about(CellIndex centre) {
    if (centre.l != row_) start_row(centre.l);
    const int first = std::max(0, centre.w - reach_);
    const int last = std::min(grid_.geometry.cells_w() - 1, centre.w + reach_);
    CellSums window;
    for (int w = first; w <= last; ++w) {
      const CellSums& column = column_at(w);
      if (column.cells == 0) continue;
      window.sums.add(column.sums);
      window.cells += column.cells;
    }
    return window;
  }

 private:
  static constexpr std::size_t kKept = 8;  // a power of two, at least 2 kMaxReach + 1
  static_assert(kKept >= 2 * kMaxReach + 1);

  void start_row(int l) {
    row_ = l;
    column_of_.fill(-1);
  }

  const CellSums& column_at(int w) {
    const std::size_t place = static_cast<std::size_t>(w) % kKept;
    CellSums& column = columns_[place];
    if (column_of_[place] == w) return column;
    column_of_[place] = w;
    column = CellSums{};
    const int last = std::min(grid_.geometry.cells_l() - 1, row_ + reach_);
    for (int l = std::max(0, row_ - reach_); l <= last; ++l) {
      const Slot slot =
          grid_.slot_of[static_cast<std::size_t>(value_of(grid_.geometry.id_of({l, w})))];
      if (slot == kUnobserved) continue;
      column.sums.add(grid_.sums[static_cast<std::size_t>(slot)]);
      ++column.cells;
    }
    return column;
  }

  const ElevationGrid& grid_;
  int reach_;
  int row_ = -1;
  std::array<int, kKept> column_of_{};
  std::array<CellSums, kKept> columns_{};
};

// The two smaller eigenvalues of a covariance, m^2.
struct Spread {
  double across_plane;  // smallest
  double across_line;   // middle
};

// Newton's method on the characteristic polynomial. From 0, which is left of all roots, it climbs
// to the smallest one without overshooting. No sines as in the closed form: those of the C library
// differ between processors.
Spread smaller_eigenvalues(const Eigen::Matrix3d& a) {
  const double trace = a.trace();
  const double minors = a(0, 0) * a(1, 1) - a(0, 1) * a(0, 1) + a(0, 0) * a(2, 2) -
                        a(0, 2) * a(0, 2) + a(1, 1) * a(2, 2) - a(1, 2) * a(1, 2);
  const double determinant = a.determinant();
  constexpr int kMaxSteps = 30;
  double root = 0.0;
  for (int k = 0; k < kMaxSteps; ++k) {
    const double value = ((root - trace) * root + minors) * root - determinant;
    const double slope = (3.0 * root - 2.0 * trace) * root + minors;
    if (!(value < 0.0 && slope > 0.0)) break;
    const double step = -value / slope;
    root += step;
    if (step <= 1e-6 * root) break;
  }
  const double sum = trace - root;
  const double product = std::max(0.0, minors - root * sum);
  const double half = 0.5 * sum;
  const double largest = half + std::sqrt(std::max(0.0, half * half - product));
  return {root, largest > 0.0 ? product / largest : 0.0};
}

// Eigenvector, of any length and with z >= 0; zero where it is not unique.
Eigen::Vector3d eigenvector(const Eigen::Matrix3d& a, double eigenvalue) {
  const Eigen::Matrix3d b = a - eigenvalue * Eigen::Matrix3d::Identity();
  Eigen::Vector3d best = b.col(0).cross(b.col(1));
  for (const Eigen::Vector3d& other :
       {Eigen::Vector3d(b.col(0).cross(b.col(2))), Eigen::Vector3d(b.col(1).cross(b.col(2)))}) {
    if (other.squaredNorm() > best.squaredNorm()) best = other;
  }
  return best.z() < 0.0 ? Eigen::Vector3d(-best) : best;
}

void set_gradient(const Eigen::Vector3d& normal, LocalPlane& plane) {
  const double level = std::sqrt(normal.x() * normal.x() + normal.y() * normal.y());
  const double divisor = std::max(normal.z(), level / kSteepestGradient);
  plane.gradient_x = static_cast<float>(-normal.x() / divisor);
  plane.gradient_y = static_cast<float>(-normal.y() / divisor);
}

LocalPlane plane_through(const CellSums& window, std::int32_t least_cells, double least_spread) {
  LocalPlane plane;
  plane.cells = window.cells;
  if (window.cells < least_cells) return plane;
  const Moments moments = moments_from(window.sums);
  const Eigen::Matrix3d covariance = moments.covariance();
  const Spread spread = smaller_eigenvalues(covariance);
  const Eigen::Vector3d normal = eigenvector(covariance, spread.across_plane);
  if (spread.across_line < least_spread || normal.squaredNorm() == 0.0) {
    plane.status = FeatureStatus::kDegenerate;
    return plane;
  }
  plane.status = FeatureStatus::kOk;
  plane.x = moments.mean_x;
  plane.y = moments.mean_y;
  plane.z = moments.mean_z;
  plane.roughness = static_cast<float>(std::sqrt(spread.across_plane));
  set_gradient(normal, plane);
  return plane;
}

}  // namespace

void fit_local_planes(const ElevationGrid& grid, int reach, std::vector<LocalPlane>& planes) {
  assert(reach >= 1 && reach <= kMaxReach);
  const double cell_size = grid.geometry.cell_size();
  // Variance of the centres of 2 r + 1 rows: r (r + 1) / 3 squared cells.
  const double least_spread = 0.1 * reach * (reach + 1) / 3.0 * cell_size * cell_size;
  planes.resize(grid.observed());
  Windows windows(grid, reach);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const CellSums window = windows.about(grid.geometry.index_of(grid.cell[slot]));
    planes[slot] = plane_through(window, 2 * reach + 1, least_spread);
  }
}

}  // namespace mrpt_terrain
