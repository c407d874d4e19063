// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/face_slope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "face_consensus.h"
#include "face_edges.h"
#include "face_errors.h"
#include "length_of.h"
#include "ring_errors.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kLeastPoints = 8;
// Rounds in which the points of a face are chosen, and steps of the fit in each.
constexpr int kRounds = 3, kSteps = 2;
// Steps of the fit without what is beyond the edges of the face.
constexpr int kLastSteps = 5;
// Faces inclined by fewer standard deviations of their angle rise in no direction.
constexpr double kInclined = 3.0;
// Least sine of the angle between the face and the beams.
constexpr double kLeastGrazing = 0.02;
// Least width of a face: a standard deviation in metres, and in those of the range noise.
constexpr double kLeastWidth = 0.05;
constexpr double kWidthSigmas = 3.0;
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
    const float across = length_of(along, static_cast<float>(kAcrossBeam));
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

std::int32_t column_of(std::size_t point, FaceSlopeWorkspace& workspace) {
  return static_cast<std::int32_t>(std::floor(azimuth_of(point, workspace) / kColumn));
}
float elevation_of(float dz) { return std::asin(std::clamp(dz, -1.0F, 1.0F)); }

// The points within a few standard deviations of the plane, by column and elevation, without those
// that are known to be beyond its edges.
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
        static_cast<float>(fit.range_sigma) * length_of(along, static_cast<float>(kAcrossBeam));
    if (workspace.beyond[i] != 0 || std::abs(e) > kOnFace * sigma) continue;
    sums.add(points.x[i], points.y[i], points.z[i]);
    FaceBeam& beam = workspace.beams.emplace_back();
    beam.column = column_of(i, workspace);
    beam.elevation = elevation_of(points.dz[i]);
    beam.point = static_cast<std::int32_t>(i);
  }
  sort_beams(workspace);
  return moments_from(sums);
}

// Share of the face in what is seen between its lowest and highest point of every column: a face is
// in sight as a whole, while planes through bushes are not.
// \param workspace with the sorted beams of the face, one at least
double closed_share(FaceSlopeWorkspace& workspace) {
  const std::vector<FaceBeam>& beams = workspace.beams;
  const BeamPoints& points = workspace.points;
  const std::int32_t first = beams.front().column, last = beams.back().column;
  std::vector<ColumnExtent>& columns = workspace.columns;
  constexpr float kMost = std::numeric_limits<float>::max();
  columns.assign(static_cast<std::size_t>(last - first) + 1, {kMost, -kMost});
  for (const FaceBeam& beam : beams) {
    ColumnExtent& extent = columns[static_cast<std::size_t>(beam.column - first)];
    extent.low = std::min(extent.low, beam.elevation);
    extent.high = std::max(extent.high, beam.elevation);
  }
  std::size_t between = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t column = column_of(i, workspace);
    if (column < first || column > last) continue;
    const ColumnExtent& extent = columns[static_cast<std::size_t>(column - first)];
    if (extent.low > extent.high) continue;
    const float elevation = elevation_of(points.dz[i]);
    between += elevation >= extent.low && elevation <= extent.high ? 1U : 0U;
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
  if (horizontal > std::max(1e-9, kInclined * slope.angle_sigma)) {
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

/// What a face is measured with.
struct FaceInput {
  const PointsView& points;
  const BeamOrigins& origins;
  const FaceSurroundings* around;
  const BeamSlopeParams& params;
  const std::array<float, 3>& origin;  ///< of the beams to the thing
  Eigen::Vector3f centre, beam;        ///< of the thing, and the mean direction of these beams
};

// The slope of a face that has been found, without what is beyond its edges and with the errors of
// its rings.
void measure_face(const FaceInput& input, RandomGenerator& random, FaceSlopeWorkspace& workspace,
                  BeamPlaneFit& fit, Slope& slope) {
  const BeamSlopeParams& params = input.params;
  slope.status = FeatureStatus::kUncertain;
  const bool settled = fit.converged;
  find_edges(fit, input.beam, params, random, workspace);
  fit =
      fit_beam_plane(workspace.points, fit.plane, fit.range_sigma, params.least_sigma, kLastSteps);
  if (!fit.ok) return;
  const Moments face = find_face(fit, workspace);
  if (input.around != nullptr)
    add_beams_beside(input.origins, *input.around, input.origin, workspace);
  follow_beams(workspace.beams, workspace.rings);
  const auto on_face = std::count_if(workspace.rings.begin(), workspace.rings.end(),
                                     [](const FaceRing& ring) { return ring.on_face; });
  if (on_face < kFewestRings) return;
  const Eigen::Matrix3d shared =
      estimate_ring_errors(input.points, input.origins, input.around, params.ring_sigma, workspace);
  fit_with_errors_of_rings(face, shared, workspace, fit);
  report(fit, input.centre.cast<double>(), slope);
  if (slope.angle > kSteepestFace) {
    slope.status = FeatureStatus::kNotPlanar;
  } else if (settled && fit.converged && slope.angle_sigma <= params.max_angle_sigma) {
    slope.status = FeatureStatus::kOk;
  }
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
  const std::optional<BeamPlane> first =
      consensus_plane(workspace, middle_beam, params, kSteepestFace, random);
  if (!first || !is_promising(workspace, *first, middle_beam, params)) {
    slope.status = FeatureStatus::kNotPlanar;
    return slope;
  }
  load(points, origins, members, centre, workspace.points);
  workspace.azimuth.assign(workspace.points.size, kUnknownAzimuth);
  BeamPlaneFit fit = fit_face(*first, params, workspace.points);
  if (!fit.ok) {
    slope.status = FeatureStatus::kDegenerate;
    return slope;
  }
  const Eigen::Vector3d beam = middle_beam.cast<double>();
  workspace.beyond.assign(workspace.points.size, 0);
  const Moments face = find_face(fit, workspace);
  const double width = width_of(face);
  if (face.n < 3.0 || width < std::max(kLeastWidth, kWidthSigmas * fit.range_sigma) ||
      rings_per_column(workspace.beams) < kLeastRingsPerColumn) {
    slope.status = FeatureStatus::kUncertain;
    return slope;
  }
  const double least = params.least_share * static_cast<double>(members.size());
  if (!is_seen_from_above(fit, beam, params) || closed_share(workspace) < kClosed ||
      (fit.inliers < least &&
       (around == nullptr || !is_clear(face, centre.cast<double>(), *around, workspace)))) {
    report(fit, centre.cast<double>(), slope);
    slope.status = FeatureStatus::kNotPlanar;
    return slope;
  }
  measure_face({points, origins, around, params, origin, centre, middle_beam}, random, workspace,
               fit, slope);
  return slope;
}

}  // namespace mrpt_terrain
