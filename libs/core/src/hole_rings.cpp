// SPDX-License-Identifier: BSD-3-Clause
#include "hole_rings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hole_shares.h"
#include "sort_in_buckets.h"

namespace mrpt_terrain {
namespace {

enum RingState : std::uint8_t { kOnRim, kBetween, kOnFloor, kLowElsewhere };

constexpr double kDegree = M_PI / 180.0;
// Neighbours on a ring: within this azimuth, so that single beams may be missing...
constexpr double kLongestStep = 1.2 * kDegree;
// ...but not two points of the same column...
constexpr double kShortestStep = 0.02 * kDegree;
// ...and with elevations that differ by less than rings do, plus what a tilt of the sensor of 9 deg
// changes with the azimuth.
constexpr double kSameRing = 0.1 * kDegree, kTiltedRing = 0.15;
// The nearer end of a trace is at a wall if it is no wider than this many steps, or than the depth.
constexpr double kWallSteps = 2.6;
// The other end may be oblique to the wall, metres.
constexpr double kWidestWall = 0.3;
// The floor begins behind the wall, which is as wide as deep: from there on, over an eighth of a
// trace at both its ends, it lies this deep at least, over its mean depth. Few points do not tell.
constexpr double kDeepAtEnds = 0.8;
constexpr int kEighth = 8;
// Walls are told from noise if rim and floor differ by so many of its standard deviations.
constexpr double kTold = 1.8;
// Low ground on which no part of the hole was found, over the depth.
constexpr float kFarLow = 0.5F;

RingState state_of(const HolePoint& p, double depth) {
  const double share = p.depth / depth;
  if (p.zone == HoleZone::kFar) return share < kFarLow ? kOnRim : kLowElsewhere;
  if (share < kRimShare) return kOnRim;
  if (share < kFloorShare) return kBetween;
  return p.zone == HoleZone::kRim ? kLowElsewhere : kOnFloor;
}

// Points of one azimuth are told apart by their elevations, so that the order is always the same.
void sort_by_azimuth(HoleWorkspace& workspace) {
  std::vector<RingPoint>& rings = workspace.rings;
  if (rings.empty()) return;
  const auto less = [](const RingPoint& a, const RingPoint& b) {
    return a.azimuth != b.azimuth ? a.azimuth < b.azimuth : a.elevation < b.elevation;
  };
  const auto ends = std::minmax_element(
      rings.begin(), rings.end(),
      [](const RingPoint& a, const RingPoint& b) { return a.azimuth < b.azimuth; });
  const double low = ends.first->azimuth, extent = ends.second->azimuth - low;
  const double per_radian = static_cast<double>(rings.size()) / std::max(extent, kShortestStep);
  const auto bucket_of = [low, per_radian](const RingPoint& p) {
    return static_cast<std::size_t>((p.azimuth - low) * per_radian);
  };
  // One more for the end of the last one.
  sort_in_buckets(rings.size() + 1, bucket_of, less, rings, workspace.sorted_rings,
                  workspace.first_ring);
}

void put_in_order(const std::vector<HolePoint>& points, const BeamOrigins& origins, double depth,
                  HoleWorkspace& workspace) {
  std::vector<RingPoint>& rings = workspace.rings;
  double x = 0.0, y = 0.0;
  rings.clear();
  for (const HolePoint& p : points) {
    if (!origins.is_measured(static_cast<std::size_t>(p.index))) continue;
    const auto& origin = origins.of(static_cast<std::size_t>(p.index));
    const double dx = p.x - origin[0], dy = p.y - origin[1], dz = p.z - origin[2];
    const double range = std::sqrt(dx * dx + dy * dy);
    rings.push_back({std::atan2(dy, dx), std::atan2(dz, range), static_cast<float>(range), p.depth,
                     -1, state_of(p, depth), false});
    if (p.zone != HoleZone::kFloor) continue;
    x += dx;
    y += dy;
  }
  const double middle = std::atan2(y, x);
  for (RingPoint& p : rings) {
    p.azimuth -= middle;
    if (std::abs(p.azimuth) > M_PI) p.azimuth = std::remainder(p.azimuth, 2.0 * M_PI);
  }
  sort_by_azimuth(workspace);
}

// Leads from each point to the next one on its ring. Returns the median step, radians.
double link(std::vector<RingPoint>& rings, std::vector<float>& steps) {
  steps.clear();
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = i + 1; j < rings.size(); ++j) {
      const double step = rings[j].azimuth - rings[i].azimuth;
      if (step >= kLongestStep) break;
      const double rise = std::abs(rings[j].elevation - rings[i].elevation);
      if (step <= kShortestStep || rise > kSameRing + kTiltedRing * step) continue;
      rings[i].next = static_cast<std::int32_t>(j);
      rings[j].has_before = true;
      steps.push_back(static_cast<float>(step));
      break;
    }
  }
  if (steps.empty()) return kShortestStep;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

// From the median difference between neighbours on the rim; 0 if there are only a few.
double noise_on_rim(const std::vector<RingPoint>& rings, double step,
                    std::vector<float>& differences) {
  constexpr std::size_t kFewest = 7;
  constexpr double kMedianOfNormal = 0.6745;
  constexpr double kNeighbours = 2.5;  // steps
  differences.clear();
  for (const RingPoint& p : rings) {
    if (p.next < 0 || p.state != kOnRim) continue;
    const RingPoint& q = rings[static_cast<std::size_t>(p.next)];
    if (q.state != kOnRim || q.azimuth - p.azimuth >= kNeighbours * step) continue;
    differences.push_back(std::abs(p.depth - q.depth));
  }
  if (differences.size() < kFewest) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / (kMedianOfNormal * std::sqrt(2.0));
}

/// The part of a ring that lies on the floor, while it is followed.
struct Trace {
  const RingPoint* first = nullptr;
  const RingPoint* last = nullptr;
  const RingPoint* rim_before = nullptr;
  bool low_before = false;  // the ring comes from low ground outside of the hole
  int points = 0;
};

// Whether the floor is as deep at the ends of a trace as in its middle. Dips deepen gradually.
// \param wall points on a wall
bool is_deep_at_ends(const std::vector<float>& depths, std::ptrdiff_t wall) {
  const auto n = static_cast<std::ptrdiff_t>(depths.size()) - 2 * wall;
  const std::ptrdiff_t part = n / kEighth;
  if (part <= 0) return true;
  const auto first = depths.begin() + wall, last = depths.end() - wall;
  const double all = std::accumulate(first, last, 0.0);
  const double ends =
      std::accumulate(first, first + part, 0.0) + std::accumulate(last - part, last, 0.0);
  return ends * static_cast<double>(n) >= kDeepAtEnds * all * static_cast<double>(2 * part);
}

double width_between(const RingPoint& a, const RingPoint& b) {
  return (b.azimuth - a.azimuth) * static_cast<double>(std::min(a.range, b.range));
}

// A trace has ended on the rim, on low ground, or with the points (both null and false).
void end_trace(const RingPoint* rim_after, bool low_after, double step, double depth, Trace& trace,
               const std::vector<float>& depths, RingEvidence& ring) {
  if (trace.first == nullptr) return;
  constexpr double kNone = 1e9;
  const double before =
      trace.rim_before != nullptr ? width_between(*trace.rim_before, *trace.first) : kNone;
  const double after = rim_after != nullptr ? width_between(*trace.last, *rim_after) : kNone;
  const double nearer = std::min(before, after), farther = std::max(before, after);
  const double narrow =
      std::max(kWallSteps * step * static_cast<double>(trace.first->range), depth);
  const bool both = farther <= std::max(narrow, kWidestWall);
  // Rings may leave the part that is looked at while they are on the floor.
  const bool open_before = trace.rim_before == nullptr && !trace.low_before;
  const bool open_after = rim_after == nullptr && !low_after;
  const bool one = farther == kNone && open_before != open_after;
  const auto wall =
      1 + static_cast<std::ptrdiff_t>(depth / (step * static_cast<double>(trace.first->range)));
  const bool walled = nearer <= narrow && (both || one);
  if ((walled || both) && is_deep_at_ends(depths, wall)) {
    if (walled) {
      ++ring.traces;
      ring.walled += trace.points;
      ring.strictly += both ? trace.points : 0;
    } else {
      ++ring.oblique_traces;
      ring.oblique += trace.points;
    }
  }
  trace.first = nullptr;
  trace.points = 0;
}

void follow(const std::vector<RingPoint>& rings, std::size_t start, double step, double depth,
            std::vector<float>& depths, RingEvidence& evidence) {
  RingEvidence ring;
  Trace trace;
  for (auto k = static_cast<std::int32_t>(start); k >= 0;
       k = rings[static_cast<std::size_t>(k)].next) {
    const RingPoint& p = rings[static_cast<std::size_t>(k)];
    if (p.state == kOnFloor) {
      if (trace.first == nullptr) {
        trace.first = &p;
        depths.clear();
      }
      depths.push_back(p.depth);
      trace.last = &p;
      ++trace.points;
    } else if (p.state == kOnRim) {
      end_trace(&p, false, step, depth, trace, depths, ring);
      trace.rim_before = &p;
      trace.low_before = false;
    } else if (p.state == kLowElsewhere) {
      end_trace(nullptr, true, step, depth, trace, depths, ring);
      trace.rim_before = nullptr;
      trace.low_before = true;
    }
  }
  end_trace(nullptr, false, step, depth, trace, depths, ring);
  evidence.traces += ring.traces;
  evidence.walled += ring.walled;
  evidence.strictly += ring.strictly;
  evidence.rings += ring.walled >= 2 ? 1 : 0;
  evidence.oblique_traces += ring.oblique_traces;
  evidence.oblique += ring.oblique;
  evidence.oblique_rings += ring.walled < 2 && ring.walled + ring.oblique >= 2 ? 1 : 0;
}

}  // namespace

RingEvidence follow_rings(const std::vector<HolePoint>& points, const BeamOrigins& origins,
                          double depth, HoleWorkspace& workspace) {
  put_in_order(points, origins, depth, workspace);
  const double step = link(workspace.rings, workspace.values);
  RingEvidence evidence;
  evidence.noise = noise_on_rim(workspace.rings, step, workspace.values);
  if ((kFloorShare - kRimShare) * depth < kTold * evidence.noise) return evidence;
  for (std::size_t i = 0; i < workspace.rings.size(); ++i) {
    if (!workspace.rings[i].has_before)
      follow(workspace.rings, i, step, depth, workspace.values, evidence);
  }
  return evidence;
}

void count_oblique(RingEvidence& rings) {
  rings.traces += rings.oblique_traces;
  rings.walled += rings.oblique;
  rings.strictly += rings.oblique;
  rings.rings += rings.oblique_rings;
}

}  // namespace mrpt_terrain
