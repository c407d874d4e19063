// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/local_planes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "lanes.h"
#include "mrpt_terrain/core/moments.h"
#include "wide_registers.h"

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
  Windows(const ElevationGrid& grid, const std::vector<MomentSums>& sums, int reach)
      : grid_(grid), sums_(sums), reach_(reach) {}

  MRPT_TERRAIN_LANES CellSums about(CellIndex centre) {
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

  MRPT_TERRAIN_LANES const CellSums& column_at(int w) {
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
      const MomentSums& cell = observed ? sums_[static_cast<std::size_t>(slot)] : kNothing;
      column.sums.add(cell);
      column.cells += cell.n > 0.0 ? 1 : 0;
    }
    return column;
  }

  const ElevationGrid& grid_;
  const std::vector<MomentSums>& sums_;
  int reach_;
  int row_ = -1;
  std::array<int, kKept> column_of_{};
  std::array<CellSums, kKept> columns_{};
};

// Sums of a window per lane, and what becomes of them.
struct WindowLanes {
  LaneArray n, x, y, z, xx, xy, xz, yy, yz, zz;
  LaneArray mean_x, mean_y, mean_z, roughness, gradient_x, gradient_y;
  std::int64_t on_a_line[kCellLanes] = {};  // not 0: the points are
  std::int32_t cells[kCellLanes] = {};
};

void set_lane(const CellSums& window, std::size_t lane, WindowLanes& lanes) {
  const MomentSums& s = window.sums;
  lanes.n.value[lane] = s.n;
  lanes.x.value[lane] = s.x;
  lanes.y.value[lane] = s.y;
  lanes.z.value[lane] = s.z;
  lanes.xx.value[lane] = s.xx;
  lanes.xy.value[lane] = s.xy;
  lanes.xz.value[lane] = s.xz;
  lanes.yy.value[lane] = s.yy;
  lanes.yz.value[lane] = s.yz;
  lanes.zz.value[lane] = s.zz;
  lanes.cells[lane] = window.cells;
}

// Symmetric matrices, and vectors, of lanes.
struct SymmetricLanes {
  DoubleLanes xx, xy, xz, yy, yz, zz;
};
struct VectorLanes {
  DoubleLanes x, y, z;
};

// As Moments::covariance of moments_from, with one division.
MRPT_TERRAIN_LANES void find_covariance(WindowLanes& window, SymmetricLanes& c) {
  DoubleLanes n, x, y, z;
  load(window.n, n);
  load(window.x, x);
  load(window.y, y);
  load(window.z, z);
  load(window.xx, c.xx);
  load(window.xy, c.xy);
  load(window.xz, c.xz);
  load(window.yy, c.yy);
  load(window.yz, c.yz);
  load(window.zz, c.zz);
  const DoubleLanes zero{};
  const DoubleLanes share = 1.0 / n;
  const DoubleLanes mean_x = x * share;
  const DoubleLanes mean_y = y * share;
  const DoubleLanes mean_z = z * share;
  c.xx = c.xx - mean_x * x;
  c.yy = c.yy - mean_y * y;
  c.zz = c.zz - mean_z * z;
  // Rounding may leave a sum of squares a hair below zero.
  c.xx = (c.xx > zero ? c.xx : zero) * share;
  c.yy = (c.yy > zero ? c.yy : zero) * share;
  c.zz = (c.zz > zero ? c.zz : zero) * share;
  c.xy = (c.xy - mean_x * y) * share;
  c.xz = (c.xz - mean_x * z) * share;
  c.yz = (c.yz - mean_y * z) * share;
  store(mean_x, window.mean_x);
  store(mean_y, window.mean_y);
  store(mean_z, window.mean_z);
}

// Coefficients of the characteristic polynomial of a covariance: x^3 - trace x^2 + minors x -
// determinant.
struct Invariants {
  DoubleLanes trace, minors, determinant;
};
MRPT_TERRAIN_LANES void find_invariants(const SymmetricLanes& a, Invariants& of) {
  const DoubleLanes minor_x = a.yy * a.zz - a.yz * a.yz;
  const DoubleLanes minor_y = a.xx * a.zz - a.xz * a.xz;
  const DoubleLanes minor_z = a.xx * a.yy - a.xy * a.xy;
  of.trace = a.xx + (a.yy + a.zz);
  of.minors = minor_x + minor_y + minor_z;
  of.determinant =
      a.xx * minor_x + a.xy * (a.xz * a.yz - a.xy * a.zz) + a.xz * (a.xy * a.yz - a.xz * a.yy);
}

// Newton's method on the characteristic polynomial. From 0, which is left of all roots, it climbs
// to the smallest one without overshooting. No sines as in the closed form: those of the C library
// differ between processors.
MRPT_TERRAIN_LANES void find_smallest_eigenvalue(const Invariants& of, DoubleLanes& root) {
  constexpr int kMaxSteps = 30;
  const DoubleLanes zero{};
  root = zero;
  DoubleLanes climbs;
  set_flags(climbs);
  for (int k = 0; k < kMaxSteps; ++k) {
    const DoubleLanes value = ((root - of.trace) * root + of.minors) * root - of.determinant;
    const DoubleLanes slope = (3.0 * root - 2.0 * of.trace) * root + of.minors;
    keep_less(value, zero, climbs);
    keep_less(zero, slope, climbs);
    const DoubleLanes step = -value / slope;
    root = climbs > zero ? root + step : root;
    keep_less(1e-3 * root, step, climbs);  // convergence is quadratic: 1e-6 is left
    if (!any_flag(climbs)) break;
  }
}

// Whether the middle eigenvalue is at least `least`, from sum and product of the upper two.
MRPT_TERRAIN_LANES void middle_eigenvalue_reaches(double least, const Invariants& of,
                                                  const DoubleLanes& smallest,
                                                  DoubleLanes& reaches) {
  const DoubleLanes zero{};
  const DoubleLanes sum = of.trace - smallest;
  const DoubleLanes product = of.minors - smallest * sum;
  set_flags(reaches);
  keep_up_to(zero + 2.0 * least, sum, reaches);
  keep_up_to(zero, product - least * sum + least * least, reaches);
}

MRPT_TERRAIN_LANES void cross(const VectorLanes& a, const VectorLanes& b, VectorLanes& c) {
  c.x = a.y * b.z - a.z * b.y;
  c.y = a.z * b.x - a.x * b.z;
  c.z = a.x * b.y - a.y * b.x;
}

MRPT_TERRAIN_LANES void take_longer(const VectorLanes& other, VectorLanes& best,
                                    DoubleLanes& square) {
  const DoubleLanes other_square = other.x * other.x + (other.y * other.y + other.z * other.z);
  best.x = other_square > square ? other.x : best.x;
  best.y = other_square > square ? other.y : best.y;
  best.z = other_square > square ? other.z : best.z;
  square = other_square > square ? other_square : square;
}

// Eigenvector, of any length and with z >= 0; zero where it is not unique.
MRPT_TERRAIN_LANES void find_eigenvector(const SymmetricLanes& a, const DoubleLanes& eigenvalue,
                                         VectorLanes& best, DoubleLanes& square) {
  const VectorLanes first{a.xx - eigenvalue, a.xy, a.xz};
  const VectorLanes second{a.xy, a.yy - eigenvalue, a.yz};
  const VectorLanes third{a.xz, a.yz, a.zz - eigenvalue};
  VectorLanes other;
  cross(first, second, best);
  square = best.x * best.x + (best.y * best.y + best.z * best.z);
  cross(first, third, other);
  take_longer(other, best, square);
  cross(second, third, other);
  take_longer(other, best, square);
  const DoubleLanes zero{};
  best.x = best.z < zero ? -best.x : best.x;
  best.y = best.z < zero ? -best.y : best.y;
  best.z = best.z < zero ? -best.z : best.z;
}

MRPT_TERRAIN_LANES void store_gradient(const VectorLanes& normal, WindowLanes& window) {
  const DoubleLanes level2 = normal.x * normal.x + normal.y * normal.y;
  const DoubleLanes upright = kSteepestGradient * normal.z;
  DoubleLanes level = level2;
  take_roots(level);
  const DoubleLanes divisor = level2 > upright * upright ? level / kSteepestGradient : normal.z;
  const DoubleLanes scale = -1.0 / divisor;
  store(normal.x * scale, window.gradient_x);
  store(normal.y * scale, window.gradient_y);
}

MRPT_TERRAIN_WIDE_REGISTERS
void fit_planes(double least_spread, WindowLanes& window) {
  SymmetricLanes covariance;
  find_covariance(window, covariance);
  Invariants invariants;
  find_invariants(covariance, invariants);
  DoubleLanes across_plane;
  find_smallest_eigenvalue(invariants, across_plane);
  DoubleLanes spread;
  middle_eigenvalue_reaches(least_spread, invariants, across_plane, spread);
  VectorLanes normal;
  DoubleLanes square;
  find_eigenvector(covariance, across_plane, normal, square);
  store_gradient(normal, window);
  take_roots(across_plane);
  store(across_plane, window.roughness);
  const DoubleLanes zero{};
  keep_less(zero, square, spread);
  const MaskLanes on_a_line = spread == zero;
  std::memcpy(window.on_a_line, &on_a_line, sizeof(on_a_line));
}

LocalPlane plane_of(const WindowLanes& window, std::size_t lane, std::int32_t least_cells) {
  LocalPlane plane;
  plane.cells = window.cells[lane];
  if (plane.cells < least_cells) return plane;
  if (window.on_a_line[lane] != 0) {
    plane.status = FeatureStatus::kDegenerate;
    return plane;
  }
  plane.status = FeatureStatus::kOk;
  plane.x = window.mean_x.value[lane];
  plane.y = window.mean_y.value[lane];
  plane.z = window.mean_z.value[lane];
  plane.roughness = static_cast<float>(window.roughness.value[lane]);
  plane.gradient_x = static_cast<float>(window.gradient_x.value[lane]);
  plane.gradient_y = static_cast<float>(window.gradient_y.value[lane]);
  return plane;
}

MRPT_TERRAIN_WIDE_REGISTERS
void fit_all(const ElevationGrid& grid, const CellSelection& cells, int reach, double least_spread,
             std::vector<LocalPlane>& planes) {
  Windows windows(grid, cells.sums, reach);
  WindowLanes lanes;
  std::size_t slots[kCellLanes];
  for (std::size_t next = 0; next < grid.observed();) {
    std::size_t count = 0;
    for (; count < kCellLanes && next < grid.observed(); ++next) {
      if (cells.is_skipped(next)) {
        planes[next] = LocalPlane{};
        continue;
      }
      set_lane(windows.about(grid.geometry.index_of(grid.cell[next])), count, lanes);
      slots[count++] = next;
    }
    fit_planes(least_spread, lanes);
    for (std::size_t lane = 0; lane < count; ++lane) {
      planes[slots[lane]] = plane_of(lanes, lane, 2 * reach + 1);
    }
  }
}

}  // namespace

void fit_local_planes(const ElevationGrid& grid, int reach, std::vector<LocalPlane>& planes) {
  fit_local_planes(grid, CellSelection{grid.sums, nullptr}, reach, planes);
}

void fit_local_planes(const ElevationGrid& grid, const CellSelection& cells, int reach,
                      std::vector<LocalPlane>& planes) {
  assert(reach >= 1 && reach <= kMaxReach);
  const double cell_size = grid.geometry.cell_size();
  // A quarter of the variance of the centres of 2 r + 1 rows, r (r + 1) / 3 squared cells.
  const double least_spread = 0.25 * reach * (reach + 1) / 3.0 * cell_size * cell_size;
  planes.resize(grid.observed());
  fit_all(grid, cells, reach, least_spread, planes);
}

}  // namespace mrpt_terrain
