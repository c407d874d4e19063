// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/local_planes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>
#include <vector>

#include "grids.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

struct Scan {
  Points points;
  ElevationGrid grid;
  PointSlots slots;
};
Scan scan_of(Points points, const GridParams& params) {
  Scan scan{std::move(points), {}, {}};
  ElevationGridWorkspace workspace;
  build_elevation_grid(scan.points.view(), params, workspace, scan.grid, scan.slots);
  return scan;
}

/// Points of hilly ground at random places, so that some cells are empty.
Points hills(std::size_t n, double half, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = half * (2.0 * random.uniform() - 1.0);
    const double y = half * (2.0 * random.uniform() - 1.0);
    const double z = 0.5 * std::sin(x) + 0.3 * y + sigma * worlds::normal_deviate(random);
    worlds::add_point(points, x, y, z);
  }
  return points;
}

/// The points of a window, found one by one.
std::vector<Eigen::Vector3d> points_of_window(const Scan& scan, CellIndex centre, int reach) {
  std::vector<Eigen::Vector3d> found;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.slots[i] < 0) continue;
    const CellId id = scan.grid.cell[static_cast<std::size_t>(scan.slots[i])];
    const CellIndex cell = scan.grid.geometry.index_of(id);
    if (std::abs(cell.l - centre.l) > reach || std::abs(cell.w - centre.w) > reach) continue;
    found.emplace_back(scan.points.x[i], scan.points.y[i], scan.points.z[i]);
  }
  return found;
}

struct Fit {
  Eigen::Vector3d mean, eigenvalues, normal;
};
/// Total least squares in two passes, with Eigen's iterative solver.
Fit brute_force(const std::vector<Eigen::Vector3d>& points) {
  Fit fit;
  fit.mean.setZero();
  for (const auto& p : points) fit.mean += p;
  fit.mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - fit.mean) * (p - fit.mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter /
                                                              static_cast<double>(points.size()));
  fit.eigenvalues = solver.eigenvalues();
  fit.normal = solver.eigenvectors().col(0);
  return fit;
}

TEST(LocalPlanes, OracleBruteForceOverThePointsOfEachWindow) {
  for (int reach = 1; reach <= kMaxReach; ++reach) {
    for (const double sigma : {0.0, 0.02, 0.2}) {
      const Scan scan = scan_of(hills(600, 2.5, sigma, 40 + static_cast<std::uint64_t>(reach)),
                                {4.0, 5.0, 0.25, 10.0});
      std::vector<LocalPlane> planes;
      fit_local_planes(scan.grid, reach, planes);
      ASSERT_EQ(planes.size(), scan.grid.observed());
      std::size_t compared = 0;
      for (std::size_t k = 0; k < planes.size(); ++k) {
        const LocalPlane& plane = planes[k];
        const CellIndex cell = scan.grid.geometry.index_of(scan.grid.cell[k]);
        const Fit fit = brute_force(points_of_window(scan, cell, reach));
        const double full = reach * (reach + 1) / 3.0 * 0.25 * 0.25;
        if (plane.cells < 2 * reach + 1) {
          EXPECT_EQ(plane.status, FeatureStatus::kTooFewPoints);
          continue;
        }
        EXPECT_EQ(plane.status == FeatureStatus::kOk, fit.eigenvalues[1] >= 0.25 * full);
        if (plane.status != FeatureStatus::kOk) continue;
        ++compared;
        // Newton leaves 1e-6 of the eigenvalue, storing as float 6e-8 of everything.
        EXPECT_NEAR(plane.roughness, std::sqrt(std::max(0.0, fit.eigenvalues[0])), 1e-6);
        EXPECT_NEAR(plane.x, fit.mean.x(), 1e-12);
        EXPECT_NEAR(plane.y, fit.mean.y(), 1e-12);
        EXPECT_NEAR(plane.z, fit.mean.z(), 1e-12);
        // The least eigenvalue is known to 1e-6, which turns the normal by that over the gap to the
        // next; windows of mere noise may stand upright, and their gradients end at the steepest.
        const double level = std::hypot(fit.normal.x(), fit.normal.y());
        const double upright = std::max(std::abs(fit.normal.z()), level / kSteepestGradient);
        const double sign = fit.normal.z() < 0.0 ? -1.0 : 1.0;
        const double tolerance = fit.eigenvalues[1] > 2.0 * fit.eigenvalues[0] ? 1e-4 : 1e-2;
        const double steepness = 1.0 + level * level / (upright * upright);
        EXPECT_NEAR(plane.gradient_x, -sign * fit.normal.x() / upright, tolerance * steepness);
        EXPECT_NEAR(plane.gradient_y, -sign * fit.normal.y() / upright, tolerance * steepness);
      }
      EXPECT_GT(compared, planes.size() / 2);
    }
  }
}

TEST(LocalPlanes, CountsTheObservedCellsOfAWindow) {
  const ElevationGrid grid =
      grids::flat_cells({{0, 0, grids::kNone, 0}, {0, 0, 0, grids::kNone}, {0, 0, 0, 0}});
  std::vector<LocalPlane> planes;
  fit_local_planes(grid, 1, planes);
  const std::vector<int> expected = {4, 5, 2, 6, 8, 7, 4, 6, 5, 3};
  ASSERT_EQ(planes.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(planes[k].cells, expected[k]) << k;
}

TEST(LocalPlanes, HeightAtFollowsTheGradient) {
  LocalPlane plane;
  plane.x = 1.0;
  plane.y = 2.0;
  plane.z = 3.0;
  plane.gradient_x = 0.5F;
  plane.gradient_y = -0.25F;
  EXPECT_EQ(plane.height_at(3.0, 4.0), 3.0 + 1.0 - 0.5);
}

TEST(LocalPlanes, UprightPlanesAreAsSteepAsToldSteepest) {
  Points points;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) worlds::add_point(points, 0.02, 0.025 * i - 0.5, 0.025 * k);
  }
  const Scan scan = scan_of(std::move(points), {2.0, 2.0, 0.1, 10.0});
  std::vector<LocalPlane> planes;
  fit_local_planes(scan.grid, 2, planes);
  ASSERT_GT(planes.size(), 5U);
  for (const LocalPlane& plane : planes) {
    if (plane.status != FeatureStatus::kOk) continue;
    EXPECT_NEAR(std::hypot(double{plane.gradient_x}, double{plane.gradient_y}), kSteepestGradient,
                1e-4);
  }
}

// 400 m from the origin, where the sums are largest.
TEST(LocalPlanes, FarFromTheOriginPlanesAreAsGood) {
  RandomGenerator random(50);
  Points points;
  for (int i = 0; i < 4000; ++i) {
    const double x = 399.0 - random.uniform();
    const double y = -399.0 + random.uniform();
    worlds::add_point(points, x, y, 0.2 * (x - 398.0));
  }
  const Scan scan = scan_of(std::move(points), {800.0, 800.0, 0.2, 10.0});
  std::vector<LocalPlane> planes;
  fit_local_planes(scan.grid, 1, planes);
  for (const LocalPlane& plane : planes) {
    ASSERT_EQ(plane.status, FeatureStatus::kOk);
    // Coordinates at 400 m are floats of 3e-5 m.
    EXPECT_NEAR(plane.gradient_x, 0.2, 1e-3);
    EXPECT_NEAR(plane.gradient_y, 0.0, 1e-3);
    EXPECT_LT(plane.roughness, 1e-4);
  }
}

}  // namespace
}  // namespace mrpt_terrain
