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

constexpr MomentSums kNothing;

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
      // Without a branch: which cells are observed is hard to predict, and adding zeros is cheap.
      const bool observed = slot != kUnobserved;
      column.sums.add(observed ? grid_.sums[static_cast<std::size_t>(slot)] : kNothing);
      column.cells += observed ? 1 : 0;
    }
    return column;
  }

  const ElevationGrid& grid_;
  int reach_;
  int row_ = -1;
  std::array<int, kKept> column_of_{};
  std::array<CellSums, kKept> columns_{};
};

// Coefficients of the characteristic polynomial of a covariance: x^3 - trace x^2 + minors x -
// determinant.
struct Invariants {
  double trace, minors, determinant;
};
Invariants invariants_of(const Eigen::Matrix3d& a) {
  const double minor_x = a(1, 1) * a(2, 2) - a(1, 2) * a(1, 2);
  const double minor_y = a(0, 0) * a(2, 2) - a(0, 2) * a(0, 2);
  const double minor_z = a(0, 0) * a(1, 1) - a(0, 1) * a(0, 1);
  const double determinant = a(0, 0) * minor_x + a(0, 1) * (a(0, 2) * a(1, 2) - a(0, 1) * a(2, 2)) +
                             a(0, 2) * (a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1));
  return {a.trace(), minor_x + minor_y + minor_z, determinant};
}

// Newton's method on the characteristic polynomial. From 0, which is left of all roots, it climbs
// to the smallest one without overshooting. No sines as in the closed form: those of the C library
// differ between processors.
double smallest_eigenvalue(const Invariants& of) {
  constexpr int kMaxSteps = 30;
  double root = 0.0;
  for (int k = 0; k < kMaxSteps; ++k) {
    const double value = ((root - of.trace) * root + of.minors) * root - of.determinant;
    const double slope = (3.0 * root - 2.0 * of.trace) * root + of.minors;
    if (!(value < 0.0 && slope > 0.0)) break;
    const double step = -value / slope;
    root += step;
    if (step <= 1e-3 * root) break;  // convergence is quadratic: 1e-6 is left
  }
  return root;
}

// Whether the middle eigenvalue is at least `least`, from sum and product of the upper two.
bool middle_eigenvalue_reaches(double least, const Invariants& of, double smallest) {
  const double sum = of.trace - smallest;
  const double product = of.minors - smallest * sum;
  return sum >= 2.0 * least && product - least * sum + least * least >= 0.0;
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
  const double level2 = normal.x() * normal.x() + normal.y() * normal.y();
  const double upright = kSteepestGradient * normal.z();
  const bool steep = level2 > upright * upright;
  const double divisor = steep ? std::sqrt(level2) / kSteepestGradient : normal.z();
  const double scale = -1.0 / divisor;
  plane.gradient_x = static_cast<float>(normal.x() * scale);
  plane.gradient_y = static_cast<float>(normal.y() * scale);
}

// As Moments::covariance, with one division.
Eigen::Matrix3d covariance_of(const Moments& m) {
  const double share = 1.0 / m.n;
  Eigen::Matrix3d c;
  c << m.m_xx, m.m_xy, m.m_xz,  //
      m.m_xy, m.m_yy, m.m_yz,   //
      m.m_xz, m.m_yz, m.m_zz;
  return c * share;
}

LocalPlane plane_through(const CellSums& window, std::int32_t least_cells, double least_spread) {
  LocalPlane plane;
  plane.cells = window.cells;
  if (window.cells < least_cells) return plane;
  const Moments moments = moments_from(window.sums);
  const Eigen::Matrix3d covariance = covariance_of(moments);
  const Invariants invariants = invariants_of(covariance);
  const double across_plane = smallest_eigenvalue(invariants);
  const Eigen::Vector3d normal = eigenvector(covariance, across_plane);
  if (!middle_eigenvalue_reaches(least_spread, invariants, across_plane) ||
      normal.squaredNorm() == 0.0) {
    plane.status = FeatureStatus::kDegenerate;
    return plane;
  }
  plane.status = FeatureStatus::kOk;
  plane.x = moments.mean_x;
  plane.y = moments.mean_y;
  plane.z = moments.mean_z;
  plane.roughness = static_cast<float>(std::sqrt(across_plane));
  set_gradient(normal, plane);
  return plane;
}

}  // namespace

void fit_local_planes(const ElevationGrid& grid, int reach, std::vector<LocalPlane>& planes) {
  assert(reach >= 1 && reach <= kMaxReach);
  const double cell_size = grid.geometry.cell_size();
  // A quarter of the variance of the centres of 2 r + 1 rows, r (r + 1) / 3 squared cells.
  const double least_spread = 0.25 * reach * (reach + 1) / 3.0 * cell_size * cell_size;
  planes.resize(grid.observed());
  Windows windows(grid, reach);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const CellSums window = windows.about(grid.geometry.index_of(grid.cell[slot]));
    planes[slot] = plane_through(window, 2 * reach + 1, least_spread);
  }
}

}  // namespace mrpt_terrain
