// SPDX-License-Identifier: BSD-3-Clause
#include "face_errors.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "ring_errors.h"

namespace mrpt_terrain {
namespace {

// Points beside each other on a ring are wrong in the same way to a part: they count like one of
// so many, as those of the ground do (ring_errors.cpp).
constexpr double kTogether = 4.0;

Eigen::Vector3d place_of(const BeamPoints& points, std::size_t i) {
  return Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>();
}

/// The plane of a face for small changes: height, and slopes along u and v, about its mean.
struct FaceRows {
  BeamPlane plane;
  Eigen::Vector3d u, v, mean;

  /// What a point says of the plane.
  struct Row {
    double along;         ///< cosine of beam and normal
    double distance;      ///< of the point from the plane, metres
    double weight;        ///< that of noise along the beam
    Eigen::Vector3d row;  ///< (1, u . p, v . p) where the beam meets the plane
  };
  [[nodiscard]] Row of(const BeamPoints& points, std::size_t i) const {
    const Eigen::Vector3d beam =
        Eigen::Vector3f(points.dx[i], points.dy[i], points.dz[i]).cast<double>();
    const Eigen::Vector3d at = place_of(points, i);
    Row result;
    result.along = plane.normal.dot(beam);
    result.distance = plane.normal.dot(at) + plane.offset;
    result.weight = 1.0 / (result.along * result.along + kAcrossBeam * kAcrossBeam);
    const Eigen::Vector3d met = at - beam * (result.along * result.distance * result.weight) - mean;
    result.row = {1.0, u.dot(met), v.dot(met)};
    return result;
  }
};

/// Generalised least squares for the plane and the errors of the rings on it, which are eliminated.
struct FaceEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

// Adds up what the points say. Rings have the errors that the ground tells.
// \param noise variance of ranges, m^2
// \param[in,out] workspace of its rings `pull`, `information` and `sum` are overwritten
FaceEquations add_rows(const FaceRows& rows, double noise, FaceSlopeWorkspace& workspace) {
  FaceEquations equations;
  for (FaceRing& ring : workspace.rings) {
    ring.pull.setZero();
    ring.information = ring.sum = 0.0;
  }
  for (const FaceBeam& beam : workspace.beams) {
    if (beam.ground) continue;
    const FaceRows::Row p = rows.of(workspace.points, static_cast<std::size_t>(beam.point));
    FaceRing& ring = workspace.rings[static_cast<std::size_t>(beam.ring)];
    const double e = p.distance - p.along * ring.error;
    equations.matrix += p.weight * p.row * p.row.transpose();
    equations.right -= p.weight * e * p.row;
    ring.pull += p.weight * p.along * p.row;
    ring.information += p.weight * p.along * p.along;
    ring.sum += p.weight * p.along * e;
  }
  for (FaceRing& ring : workspace.rings) {
    if (!ring.on_face || !(ring.variance > 0.0)) continue;
    const double share = 1.0 / (ring.information + noise / ring.variance);
    equations.matrix -= share * ring.pull * ring.pull.transpose();
    equations.right += share * ring.sum * ring.pull;
  }
  return equations;
}

// What noise pulls at the plane. Neighbours on a ring may be wrong together, at edges above all, so
// that it is added up over parts of rings: the covariance of estimates with dependent errors in
// groups (Liang and Zeger 1986).
// \param change of the plane, in terms of the rows
Eigen::Matrix3d scatter_of_parts(const FaceRows& rows, const Eigen::Vector3d& change, double noise,
                                 FaceSlopeWorkspace& workspace) {
  PartsOfRings parts(workspace);
  for (const FaceBeam& beam : workspace.beams) {
    if (beam.ground) continue;
    const FaceRows::Row p = rows.of(workspace.points, static_cast<std::size_t>(beam.point));
    const FaceRing& ring = workspace.rings[static_cast<std::size_t>(beam.ring)];
    const double share =
        ring.variance > 0.0 ? 1.0 / (ring.information + noise / ring.variance) : 0.0;
    const double error = ring.error + share * (ring.sum + ring.pull.dot(change));
    const double e = p.distance + p.row.dot(change) - p.along * error;
    parts.of(beam).row += p.weight * e * (p.row - p.along * share * ring.pull);
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const RingPart& part : workspace.parts) scatter += part.row * part.row.transpose();
  const auto n = static_cast<double>(workspace.parts.size());
  double estimated = 3.0;  // numbers: the plane's, and of each ring's error as far as it is unknown
  for (const FaceRing& ring : workspace.rings) {
    if (!ring.on_face || !(ring.variance > 0.0)) continue;
    estimated += ring.information / (ring.information + noise / ring.variance);
  }
  return scatter * (n / std::max(n - estimated, 1.0));
}

}  // namespace

void fit_with_errors_of_rings(const Moments& face, const Eigen::Matrix3d& shared,
                              FaceSlopeWorkspace& workspace, BeamPlaneFit& fit) {
  const Eigen::Vector3d u = fit.plane.normal.unitOrthogonal();
  const FaceRows rows{fit.plane, u, fit.plane.normal.cross(u), face.mean()};
  const double noise = kTogether * fit.range_sigma * fit.range_sigma;
  const FaceEquations equations = add_rows(rows, noise, workspace);
  const Eigen::Matrix3d inverse = equations.matrix.inverse();
  const Eigen::Vector3d change = inverse * equations.right;
  Eigen::Matrix3d pulls = Eigen::Matrix3d::Zero(), of_ground = Eigen::Matrix3d::Zero();
  for (const FaceRing& ring : workspace.rings) {
    if (!ring.on_face || !(ring.variance > 0.0)) continue;
    // The fit makes up for a part of the error by itself.
    const double left = noise / ring.variance / (ring.information + noise / ring.variance);
    pulls += left * left * ring.variance * ring.pull * ring.pull.transpose();
    of_ground += left * ring.pull * ring.shared.transpose();
  }
  pulls += of_ground * shared * of_ground.transpose();
  pulls += scatter_of_parts(rows, change, noise, workspace);
  Eigen::Matrix<double, 3, 2> axes;
  axes << rows.u, rows.v;
  fit.normal_covariance =
      axes * (inverse * pulls * inverse).bottomRightCorner<2, 2>() * axes.transpose();
  const Eigen::Vector3d normal = fit.plane.normal + axes * change.tail<2>();
  const double offset = fit.plane.offset + change.x() - (axes * change.tail<2>()).dot(face.mean());
  fit.plane = {normal / normal.norm(), offset / normal.norm()};
}

}  // namespace mrpt_terrain
