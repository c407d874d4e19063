// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/face_slope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "plane_inliers.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kConsensusSize = 256;
constexpr std::size_t kLeastPoints = 8;
constexpr int kSteps = 6;
// Least sine of the angle between the face and the beams.
constexpr double kLeastGrazing = 0.02;
// Least width of a face: a standard deviation in metres, and in those of the range noise.
constexpr double kLeastWidth = 0.05;
constexpr double kWidthSigmas = 3.0;
// Points this many standard deviations from the plane are on the face.
constexpr float kOnFace = 3.0F;
// Width of a column, and by how much the elevation of a ring may change from one to the next if the
// sensor is tilted, radians: 0.5 deg, and less than half of the narrowest usual beam spacing.
constexpr float kColumn = 0.0087F;
constexpr float kRingGap = 0.0026F;
// A single ring shows no slope, nor do two one behind the other.
constexpr std::size_t kFewestRings = 2;
constexpr double kLeastRingsPerColumn = 1.5;

Eigen::Vector3f centre_of(const PointsView& points, IndexRange members) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    sum += Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>();
  }
  return (sum / static_cast<double>(members.size())).cast<float>();
}

void load(const PointsView& points, const BeamOrigins& origins, IndexRange members,
          const Eigen::Vector3f& centre, BeamPoints& result) {
  result.resize(members.size());
  std::size_t k = 0;
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    result.set(k++, {points.x[i], points.y[i], points.z[i]}, origins.of(i), centre);
  }
  result.normalise_beams();
}

void draw_sample(const PointsView& points, IndexRange members, const Eigen::Vector3f& centre,
                 FaceSlopeWorkspace& workspace) {
  const std::size_t stride = (members.size() + kConsensusSize - 1) / kConsensusSize;
  workspace.x.clear();
  workspace.y.clear();
  workspace.z.clear();
  for (std::size_t k = 0; k < members.size(); k += stride) {
    const auto i = static_cast<std::size_t>(members.begin()[k]);
    workspace.x.push_back(points.x[i] - centre.x());
    workspace.y.push_back(points.y[i] - centre.y());
    workspace.z.push_back(points.z[i] - centre.z());
  }
}

// The best of random planes that are not too steep, by truncated squared distances (MSAC).
std::optional<BeamPlane> consensus_plane(const FaceSlopeWorkspace& workspace,
                                         const BeamSlopeParams& params, RandomGenerator& random) {
  const PointsView cloud{workspace.x.data(), workspace.y.data(), workspace.z.data(),
                         workspace.x.size()};
  const auto limit = static_cast<float>(params.seed_distance * params.seed_distance);
  const auto least_upright = static_cast<float>(std::cos(kSteepestFace));
  float best_cost = std::numeric_limits<float>::max();
  std::optional<BeamPlane> best;
  for (int k = 0; k < params.hypotheses; ++k) {
    const std::optional<Plane> plane = random_plane(cloud, random);
    if (!plane || std::abs(plane->c) < least_upright) continue;
    float cost = 0.0F;
    for (std::size_t i = 0; i < cloud.size && cost < best_cost; ++i) {
      const float e =
          plane->a * cloud.x[i] + plane->b * cloud.y[i] + plane->c * cloud.z[i] + plane->d;
      cost += std::min(e * e, limit);
    }
    if (!(cost < best_cost)) continue;
    best_cost = cost;
    best = BeamPlane{Eigen::Vector3f(plane->a, plane->b, plane->c).cast<double>().normalized(),
                     static_cast<double>(plane->d)};
  }
  return best;
}

// Whether the sample has enough points near the plane.
bool is_promising(const FaceSlopeWorkspace& workspace, const BeamPlane& plane,
                  const BeamSlopeParams& params) {
  const Eigen::Vector3f n = plane.normal.cast<float>();
  const auto d = static_cast<float>(plane.offset);
  std::size_t near = 0;
  for (std::size_t i = 0; i < workspace.x.size(); ++i) {
    const float e = n.x() * workspace.x[i] + n.y() * workspace.y[i] + n.z() * workspace.z[i] + d;
    near += std::abs(e) <= static_cast<float>(params.seed_distance) ? 1U : 0U;
  }
  return static_cast<double>(near) >= params.least_share * static_cast<double>(workspace.x.size());
}

// Only points near the first plane say how large the noise is.
double first_sigma(const BeamPlane& plane, const BeamSlopeParams& params,
                   FaceSlopeWorkspace& workspace) {
  const Eigen::Vector3f n = plane.normal.cast<float>();
  const auto d = static_cast<float>(plane.offset);
  const BeamPoints& points = workspace.points;
  double squares = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float e = n.x() * points.x[i] + n.y() * points.y[i] + n.z() * points.z[i] + d;
    if (std::abs(e) > static_cast<float>(params.seed_distance)) continue;
    const float along = n.x() * points.dx[i] + n.y() * points.dy[i] + n.z() * points.dz[i];
    squares += double{e} * e;
    weights += double{along} * along + kAcrossBeam * kAcrossBeam;
  }
  return weights > 0.0 ? std::max(params.least_sigma, std::sqrt(squares / weights))
                       : params.least_sigma;
}

// The points within a few standard deviations of the plane, by column and elevation.
Moments find_face(const BeamPlaneFit& fit, FaceSlopeWorkspace& workspace) {
  const Eigen::Vector3f n = fit.plane.normal.cast<float>();
  const auto d = static_cast<float>(fit.plane.offset);
  const BeamPoints& points = workspace.points;
  MomentSums sums;
  workspace.beams.clear();
  for (std::size_t i = 0; i < points.size; ++i) {
    const float e = n.x() * points.x[i] + n.y() * points.y[i] + n.z() * points.z[i] + d;
    const float along = n.x() * points.dx[i] + n.y() * points.dy[i] + n.z() * points.dz[i];
    const float sigma =
        static_cast<float>(fit.range_sigma) * std::hypot(along, static_cast<float>(kAcrossBeam));
    if (std::abs(e) > kOnFace * sigma) continue;
    sums.add(points.x[i], points.y[i], points.z[i]);
    const float turn = std::atan2(points.dy[i], points.dx[i]);
    workspace.beams.push_back({static_cast<std::int32_t>(std::floor(turn / kColumn)),
                               std::asin(std::clamp(points.dz[i], -1.0F, 1.0F)),
                               static_cast<std::int32_t>(i)});
  }
  std::sort(workspace.beams.begin(), workspace.beams.end(),
            [](const FaceBeam& a, const FaceBeam& b) {
              if (a.column != b.column) return a.column < b.column;
              return a.elevation != b.elevation ? a.elevation < b.elevation : a.point < b.point;
            });
  return moments_from(sums);
}

// Standard deviation of the points in the horizontal direction of least spread, metres.
double width_of(const Moments& m) {
  const double half = 0.5 * (m.m_xx - m.m_yy);
  const double least = 0.5 * (m.m_xx + m.m_yy) - std::hypot(half, m.m_xy);
  return std::sqrt(std::max(0.0, least / std::max(m.n, 1.0)));
}

// Rings per column, mean over the columns in which the face was seen.
double rings_per_column(const std::vector<FaceBeam>& beams) {
  std::size_t rings = 0, columns = 0;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const bool next = k == 0 || beams[k].column != beams[k - 1].column;
    columns += next ? 1U : 0U;
    rings += next || beams[k].elevation - beams[k - 1].elevation > kRingGap ? 1U : 0U;
  }
  return columns == 0 ? 0.0 : static_cast<double>(rings) / static_cast<double>(columns);
}

// The ring that a beam belongs to: that whose elevation was nearest in the columns before.
FaceRing& ring_of(const FaceBeam& beam, std::vector<FaceRing>& rings) {
  FaceRing* nearest = nullptr;
  for (FaceRing& ring : rings) {
    const float gap = std::abs(ring.elevation - beam.elevation);
    if (gap > kRingGap) continue;
    if (nearest == nullptr || gap < std::abs(nearest->elevation - beam.elevation)) nearest = &ring;
  }
  if (nearest == nullptr) nearest = &rings.emplace_back();
  nearest->elevation = beam.elevation;
  return *nearest;
}

// Every ring has an error of its own, which all its points share: what it does to the plane is that
// of least squares on all points of the ring at once.
void add_errors_of_rings(const Moments& face, double ring_sigma, FaceSlopeWorkspace& workspace,
                         BeamPlaneFit& fit) {
  const Eigen::Vector3d& n = fit.plane.normal;
  const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
  const BeamPoints& points = workspace.points;
  Eigen::Matrix3d normal_equations = Eigen::Matrix3d::Zero();
  workspace.rings.clear();
  for (const FaceBeam& beam : workspace.beams) {
    const auto i = static_cast<std::size_t>(beam.point);
    const Eigen::Vector3d about =
        Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>() - face.mean();
    const double along =
        n.dot(Eigen::Vector3f(points.dx[i], points.dy[i], points.dz[i]).cast<double>());
    const Eigen::Vector3d row(1.0, u.dot(about), v.dot(about));
    const double weight = 1.0 / (along * along + kAcrossBeam * kAcrossBeam);
    normal_equations += weight * row * row.transpose();
    ring_of(beam, workspace.rings).pull += weight * along * row;
  }
  Eigen::Matrix3d pulls = Eigen::Matrix3d::Zero();
  for (const FaceRing& ring : workspace.rings) pulls += ring.pull * ring.pull.transpose();
  const Eigen::Matrix3d inverse = normal_equations.inverse();
  const Eigen::Matrix2d turns =
      ring_sigma * ring_sigma * (inverse * pulls * inverse).bottomRightCorner<2, 2>();
  Eigen::Matrix<double, 3, 2> axes;
  axes << u, v;
  fit.normal_covariance += axes * turns * axes.transpose();
}

void report(const BeamPlaneFit& fit, const Eigen::Vector3d& centre, Slope& slope) {
  const Eigen::Vector3d n =
      fit.plane.normal.z() < 0.0 ? Eigen::Vector3d(-fit.plane.normal) : fit.plane.normal;
  const double offset = fit.plane.normal.z() < 0.0 ? -fit.plane.offset : fit.plane.offset;
  slope.normal = n;
  slope.offset = offset - n.dot(centre);
  slope.angle = std::atan2(n.head<2>().norm(), n.z());
  slope.direction = direction_of(n);
  const double horizontal = n.head<2>().norm();
  const Eigen::Vector3d up =
      horizontal > 1e-9
          ? Eigen::Vector3d(n.x() * n.z() / horizontal, n.y() * n.z() / horizontal, -horizontal)
          : n.unitOrthogonal();
  const double variance = std::max(0.0, up.dot(fit.normal_covariance * up));
  slope.angle_sigma = std::sqrt(variance);
  slope.direction_sigma = kPi;
  if (horizontal > 1e-9) {
    const Eigen::Vector3d aside(-n.y() / horizontal, n.x() / horizontal, 0.0);
    const double across = std::max(0.0, aside.dot(fit.normal_covariance * aside));
    slope.direction_sigma = std::min(kPi, std::sqrt(across) / horizontal);
  }
  slope.range_sigma = fit.range_sigma;
  slope.inliers = fit.inliers;
}

}  // namespace

Slope estimate_face_slope(const PointsView& points, const BeamOrigins& origins, IndexRange members,
                          const BeamSlopeParams& params, std::uint64_t seed, std::uint64_t stream,
                          FaceSlopeWorkspace& workspace) {
  Slope slope;
  slope.points = static_cast<std::int32_t>(members.size());
  slope.iterations = params.hypotheses;
  if (!origins.known()) {
    slope.status = FeatureStatus::kNoOrigin;
    return slope;
  }
  if (members.size() < kLeastPoints) {
    slope.status = FeatureStatus::kTooFewPoints;
    return slope;
  }
  const Eigen::Vector3f centre = centre_of(points, members);
  draw_sample(points, members, centre, workspace);
  RandomGenerator random(seed, stream);
  const std::optional<BeamPlane> first = consensus_plane(workspace, params, random);
  if (!first || !is_promising(workspace, *first, params)) {
    slope.status = FeatureStatus::kNotPlanar;
    return slope;
  }
  load(points, origins, members, centre, workspace.points);
  BeamPlaneFit fit = fit_beam_plane(
      workspace.points, *first, first_sigma(*first, params, workspace), params.least_sigma, kSteps);
  if (!fit.ok) {
    slope.status = FeatureStatus::kDegenerate;
    return slope;
  }
  const std::array<float, 3>& origin = origins.of(static_cast<std::size_t>(*members.begin()));
  const Eigen::Vector3d beam =
      (centre - Eigen::Vector3f(origin[0], origin[1], origin[2])).cast<double>().normalized();
  const Moments face = find_face(fit, workspace);
  const double width = width_of(face);
  if (face.n < 3.0 || width < std::max(kLeastWidth, kWidthSigmas * fit.range_sigma)) {
    slope.status = FeatureStatus::kUncertain;
    return slope;
  }
  add_errors_of_rings(face, params.ring_sigma, workspace, fit);
  if (workspace.rings.size() < kFewestRings ||
      rings_per_column(workspace.beams) < kLeastRingsPerColumn) {
    slope.status = FeatureStatus::kUncertain;
    return slope;
  }
  report(fit, centre.cast<double>(), slope);
  const double grazing = -slope.normal.dot(beam);
  const double across = fit.range_sigma * std::hypot(grazing, kAcrossBeam);
  // A ring lies in a plane through the sensor whatever it meets.
  const bool seen_from_above = grazing >= kLeastGrazing;
  const bool planar = seen_from_above &&
                      fit.inliers >= params.least_share * static_cast<double>(members.size()) &&
                      across <= params.max_scatter && slope.angle <= kSteepestFace;
  const bool certain = fit.converged && slope.angle_sigma <= params.max_angle_sigma;
  slope.status = !planar   ? FeatureStatus::kNotPlanar
                 : certain ? FeatureStatus::kOk
                           : FeatureStatus::kUncertain;
  return slope;
}

}  // namespace mrpt_terrain
