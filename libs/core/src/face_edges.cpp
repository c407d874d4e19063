// SPDX-License-Identifier: BSD-3-Clause
#include "face_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "face_consensus.h"
#include "length_of.h"

namespace mrpt_terrain {
namespace {

constexpr int kMostPlanes = 4;
constexpr std::size_t kLeastPoints = 8;
constexpr int kSteps = 2;
// Any inclination, radians.
constexpr double kUpright = 3.14159265358979323846;
// Points this many standard deviations from a plane are on it.
constexpr float kOnPlane = 3.0F;
// First guess of the noise along the beams, metres.
constexpr double kFirstSigma = 0.02;
// Least sine of the angle between a plane and beams that meet it.
constexpr float kLeastGrazing = 0.02F;
// Planes less inclined towards each other than 4 deg are one: cosine. What is beyond the noise of
// the face is partly its own.
constexpr double kSame = 0.99756;
// Share of the points of the other plane that have to lie on the same side of the face.
constexpr double kOneSide = 0.75;
// An edge leaves more of the face than this; else it is none.
constexpr double kMostBeyond = 0.25;

/// Where a point lies from a plane, and where its beam meets that.
struct Meeting {
  float distance;  ///< of the point, metres
  float along;     ///< cosine of beam and normal

  Meeting(const BeamPlane& plane, const BeamPoints& points, std::size_t i) {
    const Eigen::Vector3f n = plane.normal.cast<float>();
    distance = n.x() * points.x[i] + n.y() * points.y[i] + n.z() * points.z[i] +
               static_cast<float>(plane.offset);
    along = n.x() * points.dx[i] + n.y() * points.dy[i] + n.z() * points.dz[i];
  }
  /// Distance along the beam, metres.
  [[nodiscard]] float noise() const {
    return std::abs(distance) / length_of(along, static_cast<float>(kAcrossBeam));
  }
  /// How far behind the point the beam meets the plane, metres.
  [[nodiscard]] float behind() const { return -distance / along; }
  /// Whether the beam meets the side that the normal points to.
  [[nodiscard]] bool from_outside() const { return along <= -kLeastGrazing; }
};

/// A plane whose normal points to the sensor.
BeamPlane turned_to(const Eigen::Vector3f& beam, const BeamPlane& plane) {
  return plane.normal.dot(beam.cast<double>()) > 0.0 ? BeamPlane{-plane.normal, -plane.offset}
                                                     : plane;
}

struct OtherPlane {
  BeamPlane plane;
  double sigma = 0.0;   ///< of noise along the beams, metres
  double behind = 0.0;  ///< share of its points that lie behind the face
};

// What is not on the face, thinned out.
void sample_rest(FaceSlopeWorkspace& workspace) {
  const BeamPoints& points = workspace.points;
  const std::vector<std::int32_t>& rest = workspace.rest;
  const std::size_t stride = (rest.size() + kConsensusSize - 1) / kConsensusSize;
  workspace.x.clear();
  workspace.y.clear();
  workspace.z.clear();
  for (std::size_t k = 0; k < rest.size(); k += stride) {
    const auto i = static_cast<std::size_t>(rest[k]);
    workspace.x.push_back(points.x[i]);
    workspace.y.push_back(points.y[i]);
    workspace.z.push_back(points.z[i]);
  }
}

void count_none(BeamPoints& points) { std::fill_n(points.count.begin(), points.size, 0.0F); }

// The likely plane of the rest near a first one.
BeamPlaneFit fit_rest(const BeamPlane& first, const BeamSlopeParams& params,
                      FaceSlopeWorkspace& workspace) {
  BeamPoints& points = workspace.points;
  count_none(points);
  for (const std::int32_t item : workspace.rest) {
    const auto i = static_cast<std::size_t>(item);
    points.count[i] = Meeting(first, points, i).noise() <= kAlongBeam ? 1.0F : 0.0F;
  }
  return fit_beam_plane(points, first, kFirstSigma, params.least_sigma, kSteps);
}

// A plane through what is not on the face; its points are taken away from the rest.
std::optional<OtherPlane> next_plane(const BeamPlane& face, const Eigen::Vector3f& beam,
                                     const BeamSlopeParams& params, RandomGenerator& random,
                                     FaceSlopeWorkspace& workspace) {
  std::vector<std::int32_t>& rest = workspace.rest;
  if (rest.size() < kLeastPoints) return std::nullopt;
  sample_rest(workspace);
  const std::optional<BeamPlane> first = consensus_plane(workspace, beam, params, kUpright, random);
  if (!first) return std::nullopt;
  const BeamPlaneFit fit = fit_rest(*first, params, workspace);
  if (!fit.ok) return std::nullopt;
  const BeamPoints& points = workspace.points;
  const float limit = kOnPlane * static_cast<float>(fit.range_sigma);
  std::size_t behind = 0;
  const auto found = std::remove_if(rest.begin(), rest.end(), [&](std::int32_t item) {
    const auto i = static_cast<std::size_t>(item);
    if (Meeting(fit.plane, points, i).noise() > limit) return false;
    behind += Meeting(face, points, i).behind() < 0.0F ? 1U : 0U;
    return true;
  });
  const auto n = static_cast<std::size_t>(rest.end() - found);
  rest.erase(found, rest.end());
  if (n < kLeastPoints) return std::nullopt;
  return OtherPlane{turned_to(beam, fit.plane), fit.range_sigma,
                    static_cast<double>(behind) / static_cast<double>(n)};
}

/// Where a face ends and another surface begins.
struct Edge {
  const BeamPlane& face;
  const OtherPlane& other;
  float within;  ///< metres along the beam from the face: where noise may confuse the two

  [[nodiscard]] bool is_beyond(const BeamPoints& points, std::size_t i) const {
    const Meeting here(face, points, i), there(other.plane, points, i);
    if (!here.from_outside() || !there.from_outside()) return false;
    const float further = there.behind() - here.behind();
    const float beyond = other.behind > 0.5 ? further : -further;
    return beyond > 0.0F && beyond <= within;
  }
};

void mark_beyond(const Edge& edge, FaceSlopeWorkspace& workspace) {
  const BeamPoints& points = workspace.points;
  const auto is_beyond = [&](const FaceBeam& beam) {
    return edge.is_beyond(points, static_cast<std::size_t>(beam.point));
  };
  const std::vector<FaceBeam>& beams = workspace.beams;
  const auto lost = std::count_if(beams.begin(), beams.end(), is_beyond);
  if (static_cast<double>(lost) > kMostBeyond * static_cast<double>(beams.size())) return;
  for (const FaceBeam& beam : beams) {
    if (is_beyond(beam)) workspace.beyond[static_cast<std::size_t>(beam.point)] = 1;
  }
}

}  // namespace

void find_edges(const BeamPlaneFit& fit, const Eigen::Vector3f& beam, const BeamSlopeParams& params,
                RandomGenerator& random, FaceSlopeWorkspace& workspace) {
  BeamPoints& points = workspace.points;
  const BeamPlane face = turned_to(beam, fit.plane);
  const float limit = kOnPlane * static_cast<float>(fit.range_sigma);
  workspace.rest.clear();
  for (std::size_t i = 0; i < points.size; ++i) {
    if (Meeting(face, points, i).noise() > limit)
      workspace.rest.push_back(static_cast<std::int32_t>(i));
  }
  for (int k = 0; k < kMostPlanes; ++k) {
    const std::optional<OtherPlane> other = next_plane(face, beam, params, random, workspace);
    if (!other) break;
    if (std::max(other->behind, 1.0 - other->behind) < kOneSide) continue;
    if (std::abs(face.normal.dot(other->plane.normal)) > kSame) continue;
    const auto sigma = static_cast<float>(std::max(fit.range_sigma, other->sigma));
    mark_beyond({face, *other, 2.0F * kOnPlane * sigma}, workspace);
  }
  count_none(points);
  for (const FaceBeam& on_face : workspace.beams) {
    const auto i = static_cast<std::size_t>(on_face.point);
    points.count[i] = workspace.beyond[i] == 0 ? 1.0F : 0.0F;
  }
}

}  // namespace mrpt_terrain
