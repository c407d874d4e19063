// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/random.h"
#include "plane_inliers.h"

namespace mrpt_terrain {
namespace {

// A plane that only a handful of cells agree on is no ground.
constexpr std::size_t kFewestCandidates = 20;

// The lowest point of every cell: what stands on the ground hides, the ground itself remains.
void collect_lowest(const PointsView& points, const GroundPlaneParams& params,
                    GroundPlaneWorkspace& workspace) {
  const GridGeometry geometry(2 * params.range, 2 * params.range, params.cell_size);
  workspace.lowest.assign(static_cast<std::size_t>(geometry.array_size()), -1);
  for (std::size_t i = 0; i < points.size; ++i) {
    CellIndex cell;
    if (!std::isfinite(points.z[i]) || !geometry.cell_at(points.x[i], points.y[i], cell)) continue;
    std::int32_t& lowest =
        workspace.lowest[static_cast<std::size_t>(value_of(geometry.id_of(cell)))];
    if (lowest < 0 || points.z[i] < points.z[lowest]) lowest = static_cast<std::int32_t>(i);
  }
  workspace.candidates.clear();
  for (const std::int32_t i : workspace.lowest) {
    if (i >= 0) workspace.candidates.push_back(points.x[i], points.y[i], points.z[i]);
  }
}

struct Votes {
  std::int32_t on = 0;
  std::int32_t below = 0;
};

Votes count_votes(const PointsView& candidates, const Plane& up, float tolerance) {
  Votes votes;
  for (std::size_t i = 0; i < candidates.size; ++i) {
    const float height =
        up.a * candidates.x[i] + up.b * candidates.y[i] + up.c * candidates.z[i] + up.d;
    votes.on += std::abs(height) <= tolerance ? 1 : 0;
    votes.below += height < -tolerance ? 1 : 0;
  }
  return votes;
}

struct BestPlane {
  std::optional<Plane> plane;
  Votes votes;
};

BestPlane best_plane(const PointsView& candidates, const GroundPlaneParams& params) {
  RandomGenerator random(params.seed);
  const auto least_z = static_cast<float>(std::cos(params.max_tilt));
  BestPlane best;
  for (int k = 0; k < params.iterations; ++k) {
    std::optional<Plane> plane = random_plane(candidates, random);
    if (!plane || std::abs(plane->c) < least_z) continue;
    if (plane->c < 0) plane = Plane{-plane->a, -plane->b, -plane->c, -plane->d};
    const Votes votes = count_votes(candidates, *plane, static_cast<float>(params.tolerance));
    // Table tops and roofs have something below them, the ground has next to nothing.
    if (best.plane && votes.on - votes.below <= best.votes.on - best.votes.below) continue;
    best = {plane, votes};
  }
  return best;
}

// Total least squares over all points near the plane: the lowest points alone lie too low.
void refine(const PointsView& points, const Plane& plane, const GroundPlaneParams& params,
            GroundPlane& result) {
  MomentSums sums;
  for (std::size_t i = 0; i < points.size; ++i) {
    const bool near = std::abs(points.x[i]) < params.range && std::abs(points.y[i]) < params.range;
    if (near && is_inlier(points, i, plane, static_cast<float>(params.tolerance))) {
      sums.add(points.x[i], points.y[i], points.z[i]);
    }
  }
  const Moments moments = moments_from(sums);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.covariance());
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  result.normal = normal.z() < 0 ? Eigen::Vector3d(-normal) : normal;
  result.height = result.normal.dot(moments.mean()) / result.normal.z();
  result.tilt = std::acos(std::min(1.0, result.normal.z()));
}

}  // namespace

GroundPlane find_ground_plane(const PointsView& points, const GroundPlaneParams& params,
                              GroundPlaneWorkspace& workspace) {
  GroundPlane result;
  collect_lowest(points, params, workspace);
  const PointsView candidates = workspace.candidates.view();
  if (candidates.size < kFewestCandidates) return result;
  const BestPlane best = best_plane(candidates, params);
  if (!best.plane) return result;
  result.share = best.votes.on / static_cast<double>(candidates.size);
  if (result.share < params.min_share || best.votes.below > best.votes.on) return result;
  GroundPlane fitted = result;
  refine(points, *best.plane, params, fitted);
  // Points in a strip that is narrower than it is thick have their least scatter sideways.
  if (!(fitted.tilt <= params.max_tilt)) return result;
  fitted.found = true;
  return fitted;
}

}  // namespace mrpt_terrain
