// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/face_slope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "plane_inliers.h"
#include "ring_errors.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kConsensusSize = 256;
constexpr std::size_t kLeastPoints = 8;
// Rounds in which the points of a face are chosen, and steps of the fit in each.
constexpr int kRounds = 3, kSteps = 2;
// Least sine of the angle between the face and the beams.
constexpr double kLeastGrazing = 0.02;
// Least width of a face: a standard deviation in metres, and in those of the range noise.
constexpr double kLeastWidth = 0.05;
constexpr double kWidthSigmas = 3.0;
// Points may be so far from the first plane, along their beams, metres: three standard deviations
// of range noise and errors of rings.
constexpr float kAlongBeam = 0.06F;
// Least share of a thing's points on its face.
constexpr double kLeastShare = 0.2;
// A face is at least this share of what is seen between its ends.
constexpr double kClosed = 0.9;
// A smaller part than params.least_share is a face if it has so many points, is wider than a curb
// (standard deviation in metres: 0.7 m), and begins at most this high, metres: as decks that are
// ramps do.
constexpr double kFewestOnFace = 24.0, kSmallWidth = 0.2;
constexpr float kFoot = 0.25F;
// Points this many standard deviations from the plane are on the face.
constexpr float kOnFace = 3.0F;
// A single ring shows no slope, nor do two one behind the other.
constexpr std::ptrdiff_t kFewestRings = 2;
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

// Distance from a plane up to which points may be on it: noise lies along the beams.
float seed_distance(const Eigen::Vector3f& normal, const Eigen::Vector3f& beam,
                    const BeamSlopeParams& params) {
  const float across = std::abs(normal.dot(beam)) + static_cast<float>(kAcrossBeam);
  return std::min(static_cast<float>(params.seed_distance), kAlongBeam * across);
}

// The best of random planes that are not too steep, by truncated squared distances (MSAC).
// \param beam mean direction of the beams
std::optional<BeamPlane> consensus_plane(const FaceSlopeWorkspace& workspace,
                                         const Eigen::Vector3f& beam, const BeamSlopeParams& params,
                                         RandomGenerator& random) {
  const PointsView cloud{workspace.x.data(), workspace.y.data(), workspace.z.data(),
                         workspace.x.size()};
  const auto least_upright = static_cast<float>(std::cos(kSteepestFace));
  float best_cost = std::numeric_limits<float>::max();
  std::optional<BeamPlane> best;
  for (int k = 0; k < params.hypotheses; ++k) {
    const std::optional<Plane> plane = random_plane(cloud, random);
    if (!plane || std::abs(plane->c) < least_upright) continue;
    const float limit = seed_distance({plane->a, plane->b, plane->c}, beam, params);
    const float per_square = 1.0F / (limit * limit);
    float cost = 0.0F;
    for (std::size_t i = 0; i < cloud.size && cost < best_cost; ++i) {
      const float e =
          plane->a * cloud.x[i] + plane->b * cloud.y[i] + plane->c * cloud.z[i] + plane->d;
      cost += std::min(e * e * per_square, 1.0F);
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
                  const Eigen::Vector3f& beam, const BeamSlopeParams& params) {
  const Eigen::Vector3f n = plane.normal.cast<float>();
  const float limit = seed_distance(n, beam, params);
  const auto d = static_cast<float>(plane.offset);
  std::size_t near = 0;
  for (std::size_t i = 0; i < workspace.x.size(); ++i) {
    const float e = n.x() * workspace.x[i] + n.y() * workspace.y[i] + n.z() * workspace.z[i] + d;
    near += std::abs(e) <= limit ? 1U : 0U;
  }
  return static_cast<double>(near) >= kLeastShare * static_cast<double>(workspace.x.size());
}

// Lets the points count that are near a plane, along their beams.
void select_points(const BeamPlane& plane, float limit, BeamPoints& points) {
  const Eigen::Vector3f n = plane.normal.cast<float>();
  const auto d = static_cast<float>(plane.offset);
  for (std::size_t i = 0; i < points.size; ++i) {
    const float e = n.x() * points.x[i] + n.y() * points.y[i] + n.z() * points.z[i] + d;
    const float along = n.x() * points.dx[i] + n.y() * points.dy[i] + n.z() * points.dz[i];
    const float across = std::hypot(along, static_cast<float>(kAcrossBeam));
    points.count[i] = std::abs(e) <= limit * across ? 1.0F : 0.0F;
  }
}

// RMS distance along the beams of the points that count.
double sigma_along_beams(const BeamPlane& plane, const BeamSlopeParams& params,
                         const BeamPoints& points) {
  const Eigen::Vector3f n = plane.normal.cast<float>();
  const auto d = static_cast<float>(plane.offset);
  double squares = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (points.count[i] == 0.0F) continue;
    const float e = n.x() * points.x[i] + n.y() * points.y[i] + n.z() * points.z[i] + d;
    const float along = n.x() * points.dx[i] + n.y() * points.dy[i] + n.z() * points.dz[i];
    squares += double{e} * e;
    weights += double{along} * along + kAcrossBeam * kAcrossBeam;
  }
  return weights > 0.0 ? std::max(params.least_sigma, std::sqrt(squares / weights))
                       : params.least_sigma;
}

// The likely plane of the face alone: what is off it, along the beams, by more than noise is left
// out, so that a face beside it does not turn it. The less noise there is, the less may be off.
BeamPlaneFit fit_face(const BeamPlane& first, const BeamSlopeParams& params, BeamPoints& points) {
  BeamPlaneFit fit;
  fit.plane = first;
  float limit = kAlongBeam;
  for (int round = 0; round < kRounds; ++round) {
    select_points(fit.plane, limit, points);
    const double sigma = sigma_along_beams(fit.plane, params, points);
    fit = fit_beam_plane(points, fit.plane, sigma, params.least_sigma, kSteps);
    if (!fit.ok) return fit;
    limit = std::min(kAlongBeam, kOnFace * static_cast<float>(fit.range_sigma));
  }
  return fit;
}

std::int32_t column_of(float dx, float dy) {
  return static_cast<std::int32_t>(std::floor(std::atan2(dy, dx) / kColumn));
}
float elevation_of(float dz) { return std::asin(std::clamp(dz, -1.0F, 1.0F)); }

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
    FaceBeam beam;
    beam.column = column_of(points.dx[i], points.dy[i]);
    beam.elevation = elevation_of(points.dz[i]);
    beam.point = static_cast<std::int32_t>(i);
    workspace.beams.push_back(beam);
  }
  sort_beams(workspace.beams);
  return moments_from(sums);
}

// Share of the face in what is seen between its lowest and highest point of every column: a face is
// in sight as a whole, while planes through bushes are not.
// \param beams of the face, sorted
double closed_share(const BeamPoints& points, const std::vector<FaceBeam>& beams) {
  std::size_t between = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t column = column_of(points.dx[i], points.dy[i]);
    const auto first = std::lower_bound(
        beams.begin(), beams.end(), column,
        [](const FaceBeam& beam, std::int32_t wanted) { return beam.column < wanted; });
    const auto end = std::upper_bound(
        first, beams.end(), column,
        [](std::int32_t wanted, const FaceBeam& beam) { return wanted < beam.column; });
    if (first == end) continue;
    const float elevation = elevation_of(points.dz[i]);
    between += elevation >= first->elevation && elevation <= (end - 1)->elevation ? 1U : 0U;
  }
  return static_cast<double>(beams.size()) / static_cast<double>(std::max<std::size_t>(between, 1));
}

// Whether the face begins near the ground: a ramp does, what lies on top of a thing does not.
bool begins_at_ground(const BeamPoints& points, const std::vector<FaceBeam>& beams,
                      const Eigen::Vector3d& centre, const FaceSurroundings& around,
                      std::vector<float>& heights) {
  heights.clear();
  for (const FaceBeam& beam : beams) {
    const auto i = static_cast<std::size_t>(beam.point);
    const Eigen::Vector3d at(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                             static_cast<double>(points.z[i]));
    heights.push_back(
        static_cast<float>(around.ground.normal.dot(at + centre) + around.ground.offset));
  }
  const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
  std::nth_element(heights.begin(), low, heights.end());
  return *low <= kFoot;
}

// Standard deviation of the points in the horizontal direction of least spread, metres.
double width_of(const Moments& m) {
  const double half = 0.5 * (m.m_xx - m.m_yy);
  const double least = 0.5 * (m.m_xx + m.m_yy) - std::hypot(half, m.m_xy);
  return std::sqrt(std::max(0.0, least / std::max(m.n, 1.0)));
}

// Whether a small part of a thing is a face all the same.
bool is_clear(const Moments& face, const Eigen::Vector3d& centre, const FaceSurroundings& around,
              FaceSlopeWorkspace& workspace) {
  return face.n >= kFewestOnFace && width_of(face) >= kSmallWidth &&
         begins_at_ground(workspace.points, workspace.beams, centre, around, workspace.x);
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

/// The normal equations of a face: rows (1, u . p, v . p) about its mean, with the weights of noise
/// along the beams.
struct FaceRows {
  Eigen::Vector3d normal, u, v, mean;

  [[nodiscard]] Eigen::Vector3d row(const Eigen::Vector3d& at) const {
    return {1.0, u.dot(at - mean), v.dot(at - mean)};
  }
  [[nodiscard]] double along(const BeamPoints& points, std::size_t i) const {
    return normal.dot(Eigen::Vector3f(points.dx[i], points.dy[i], points.dz[i]).cast<double>());
  }
  [[nodiscard]] static double weight(double along) {
    return 1.0 / (along * along + kAcrossBeam * kAcrossBeam);
  }
};

Eigen::Vector3d place_of(const BeamPoints& points, std::size_t i) {
  return Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>();
}

// What an error of every ring does to the plane: it pulls at all points of the ring at once.
// \return the normal equations
Eigen::Matrix3d add_pulls(const FaceRows& rows, FaceSlopeWorkspace& workspace) {
  const BeamPoints& points = workspace.points;
  Eigen::Matrix3d normal_equations = Eigen::Matrix3d::Zero();
  for (FaceRing& ring : workspace.rings) ring.pull.setZero();
  for (const FaceBeam& beam : workspace.beams) {
    if (beam.ground) continue;
    const auto i = static_cast<std::size_t>(beam.point);
    const double along = rows.along(points, i);
    const Eigen::Vector3d row = rows.row(place_of(points, i));
    const double weight = FaceRows::weight(along);
    normal_equations += weight * row * row.transpose();
    workspace.rings[static_cast<std::size_t>(beam.ring)].pull += weight * along * row;
  }
  return normal_equations;
}

// What is left of the errors of points when those of their rings are taken off pulls at the plane
// too. Neighbours on a ring may be wrong together, at edges above all, so that it is added up over
// parts of rings: the covariance of estimates with dependent errors in groups (Liang and Zeger
// 1986). Where nothing is known of a ring, its mean error is that which `add_pulls` has.
// \param change of the plane, in terms of the rows
Eigen::Matrix3d scatter_of_parts(const FaceRows& rows, double offset, const Eigen::Vector3d& change,
                                 double ring_sigma, FaceSlopeWorkspace& workspace) {
  const BeamPoints& points = workspace.points;
  const auto visit = [&](auto&& visitor) {
    for (const FaceBeam& beam : workspace.beams) {
      if (beam.ground) continue;
      const auto i = static_cast<std::size_t>(beam.point);
      const Eigen::Vector3d at = place_of(points, i);
      const Eigen::Vector3d row = rows.row(at);
      const double along = rows.along(points, i);
      FaceRing& ring = workspace.rings[static_cast<std::size_t>(beam.ring)];
      const double e = rows.normal.dot(at) + offset + row.dot(change) - along * ring.error;
      visitor(beam, ring, e, along, row);
    }
  };
  for (FaceRing& ring : workspace.rings) ring.sum = ring.information = 0.0;
  visit([](const FaceBeam&, FaceRing& ring, double e, double along, const Eigen::Vector3d&) {
    ring.sum += FaceRows::weight(along) * along * e;
    ring.information += FaceRows::weight(along) * along * along;
  });
  for (FaceRing& ring : workspace.rings) {
    const double unknown = ring_sigma > 0.0 ? ring.variance / (ring_sigma * ring_sigma) : 0.0;
    ring.sum = ring.information > 0.0 ? unknown * unknown * ring.sum / ring.information : 0.0;
  }
  PartsOfRings parts(workspace);
  visit([&](const FaceBeam& beam, const FaceRing& ring, double e, double along,
            const Eigen::Vector3d& row) {
    parts.of(beam).row += FaceRows::weight(along) * (e - along * ring.sum) * row;
  });
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const RingPart& part : workspace.parts) scatter += part.row * part.row.transpose();
  const auto n = static_cast<double>(workspace.parts.size());
  return scatter * (n / std::max(n - 3.0, 1.0));
}

// Takes what is known of the errors of the rings off, and states how uncertain the plane is.
// \param shared covariance of the ground's plane, which the errors share
void take_off_errors_of_rings(const Moments& face, const Eigen::Matrix3d& shared, double ring_sigma,
                              FaceSlopeWorkspace& workspace, BeamPlaneFit& fit) {
  const Eigen::Vector3d u = fit.plane.normal.unitOrthogonal();
  const FaceRows rows{fit.plane.normal, u, fit.plane.normal.cross(u), face.mean()};
  const Eigen::Matrix3d inverse = add_pulls(rows, workspace).inverse();
  Eigen::Matrix3d pulls = Eigen::Matrix3d::Zero(), of_ground = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (const FaceRing& ring : workspace.rings) {
    pulls += ring.variance * ring.pull * ring.pull.transpose();
    of_ground += ring.pull * ring.shared.transpose();
    pull += ring.error * ring.pull;
  }
  pulls += of_ground * shared * of_ground.transpose();
  const Eigen::Vector3d change = inverse * pull;
  pulls += scatter_of_parts(rows, fit.plane.offset, change, ring_sigma, workspace);
  Eigen::Matrix<double, 3, 2> axes;
  axes << rows.u, rows.v;
  fit.normal_covariance =
      axes * (inverse * pulls * inverse).bottomRightCorner<2, 2>() * axes.transpose();
  const Eigen::Vector3d normal = rows.normal + axes * change.tail<2>();
  const double offset = fit.plane.offset + change.x() - (axes * change.tail<2>()).dot(face.mean());
  fit.plane = {normal / normal.norm(), offset / normal.norm()};
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

// Whether the beams meet the upper side of the face, and its points scatter by no more than those
// of a surface. A ring lies in a plane through the sensor whatever it meets.
bool is_seen_from_above(const BeamPlaneFit& fit, const Eigen::Vector3d& beam,
                        const BeamSlopeParams& params) {
  const double upright = fit.plane.normal.z() < 0.0 ? -1.0 : 1.0;
  const double grazing = -upright * fit.plane.normal.dot(beam);
  return grazing >= kLeastGrazing &&
         fit.range_sigma * std::hypot(grazing, kAcrossBeam) <= params.max_scatter;
}

}  // namespace

Slope estimate_face_slope(const PointsView& points, const BeamOrigins& origins, IndexRange members,
                          const BeamSlopeParams& params, std::uint64_t seed, std::uint64_t stream,
                          FaceSlopeWorkspace& workspace, const FaceSurroundings* around) {
  Slope slope;
  slope.points = static_cast<std::int32_t>(members.size());
  slope.iterations = params.hypotheses;
  if (!origins.known() || members.size() < kLeastPoints) {
    slope.status = origins.known() ? FeatureStatus::kTooFewPoints : FeatureStatus::kNoOrigin;
    return slope;
  }
  const Eigen::Vector3f centre = centre_of(points, members);
  draw_sample(points, members, centre, workspace);
  RandomGenerator random(seed, stream);
  const std::array<float, 3>& origin = origins.of(static_cast<std::size_t>(*members.begin()));
  const Eigen::Vector3f middle_beam =
      (centre - Eigen::Vector3f(origin[0], origin[1], origin[2])).normalized();
  const std::optional<BeamPlane> first = consensus_plane(workspace, middle_beam, params, random);
  if (!first || !is_promising(workspace, *first, middle_beam, params)) {
    slope.status = FeatureStatus::kNotPlanar;
    return slope;
  }
  load(points, origins, members, centre, workspace.points);
  BeamPlaneFit fit = fit_face(*first, params, workspace.points);
  if (!fit.ok) {
    slope.status = FeatureStatus::kDegenerate;
    return slope;
  }
  const Eigen::Vector3d beam = middle_beam.cast<double>();
  const Moments face = find_face(fit, workspace);
  const double width = width_of(face);
  if (face.n < 3.0 || width < std::max(kLeastWidth, kWidthSigmas * fit.range_sigma) ||
      rings_per_column(workspace.beams) < kLeastRingsPerColumn) {
    slope.status = FeatureStatus::kUncertain;
    return slope;
  }
  const double least = params.least_share * static_cast<double>(members.size());
  if (!is_seen_from_above(fit, beam, params) ||
      closed_share(workspace.points, workspace.beams) < kClosed ||
      (fit.inliers < least &&
       (around == nullptr || !is_clear(face, centre.cast<double>(), *around, workspace)))) {
    report(fit, centre.cast<double>(), slope);
    slope.status = FeatureStatus::kNotPlanar;
    return slope;
  }
  if (around != nullptr) add_beams_beside(origins, *around, origin, workspace);
  follow_beams(workspace.beams, workspace.rings);
  const auto on_face = std::count_if(workspace.rings.begin(), workspace.rings.end(),
                                     [](const FaceRing& ring) { return ring.on_face; });
  if (on_face < kFewestRings) {
    slope.status = FeatureStatus::kUncertain;
    return slope;
  }
  const Eigen::Matrix3d shared =
      estimate_ring_errors(points, origins, around, params.ring_sigma, workspace);
  take_off_errors_of_rings(face, shared, params.ring_sigma, workspace, fit);
  report(fit, centre.cast<double>(), slope);
  const bool certain = fit.converged && slope.angle_sigma <= params.max_angle_sigma;
  const bool planar = slope.angle <= kSteepestFace;
  slope.status = !planar   ? FeatureStatus::kNotPlanar
                 : certain ? FeatureStatus::kOk
                           : FeatureStatus::kUncertain;
  return slope;
}

}  // namespace mrpt_terrain
