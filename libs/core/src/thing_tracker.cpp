// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/thing_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mrpt_terrain {
namespace {

/// Corners of a convex polygon, counter-clockwise; two rectangles have up to eight in common.
struct Polygon {
  std::array<Eigen::Vector2d, 16> corner;
  std::size_t size = 0;
  void add(const Eigen::Vector2d& p) { corner[size++] = p; }
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Polygon corners_of(const OrientedBox& box, double margin) {
  const Eigen::Vector2d along(std::cos(box.yaw), std::sin(box.yaw));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d centre(box.centre.x, box.centre.y);
  const double u = 0.5 * box.length + margin, v = 0.5 * box.width + margin;
  Polygon polygon;
  polygon.add(centre - u * along - v * across);
  polygon.add(centre + u * along - v * across);
  polygon.add(centre + u * along + v * across);
  polygon.add(centre - u * along + v * across);
  return polygon;
}

// What lies left of the line from a to b (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Polygon result;
  const auto side = [&](const Eigen::Vector2d& p) { return cross(b - a, p - a); };
  for (std::size_t k = 0; k < polygon.size; ++k) {
    const Eigen::Vector2d& p = polygon.corner[k];
    const Eigen::Vector2d& q = polygon.corner[(k + 1) % polygon.size];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0.0) result.add(p);
    if ((at_p >= 0.0) != (at_q >= 0.0)) result.add(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return result;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size; ++k)
    twice += cross(polygon.corner[k], polygon.corner[(k + 1) % polygon.size]);
  return 0.5 * twice;
}

double area_of(const OrientedBox& box, double margin) {
  return (box.length + 2.0 * margin) * (box.width + 2.0 * margin);
}

}  // namespace

double common_area(const OrientedBox& a, const OrientedBox& b, double margin) {
  const double reach = 0.5 * (std::hypot(a.length, a.width) + std::hypot(b.length, b.width)) +
                       2.0 * std::sqrt(2.0) * margin;
  if (std::hypot(a.centre.x - b.centre.x, a.centre.y - b.centre.y) > reach) return 0.0;
  Polygon polygon = corners_of(a, margin);
  const Polygon by = corners_of(b, margin);
  for (std::size_t k = 0; k < 4 && polygon.size > 0; ++k)
    polygon = cut(polygon, by.corner[k], by.corner[(k + 1) % 4]);
  return std::max(0.0, area_of(polygon));
}

OrientedBox moved(const OrientedBox& box, const Eigen::Isometry3d& T_to_from) {
  OrientedBox result = box;
  const double low = static_cast<double>(box.low), high = static_cast<double>(box.high);
  const Eigen::Vector3d centre =
      T_to_from * Eigen::Vector3d(box.centre.x, box.centre.y, 0.5 * (low + high));
  const Eigen::Vector3d along =
      T_to_from.linear() * Eigen::Vector3d(std::cos(box.yaw), std::sin(box.yaw), 0.0);
  result.centre = {centre.x(), centre.y()};
  result.yaw = std::atan2(along.y(), along.x());
  result.low = static_cast<float>(centre.z() - 0.5 * (high - low));
  result.high = static_cast<float>(centre.z() + 0.5 * (high - low));
  return result;
}

void ThingTracker::find_pairs() {
  pairs_.clear();
  const double margin = params_.margin;
  for (std::size_t t = 0; t < state_.tracks.size(); ++t) {
    const OrientedBox& before = state_.tracks[t].box;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
      const OrientedBox& now = boxes_[k];
      const float gap = std::max(before.low, now.low) - std::min(before.high, now.high);
      if (gap > static_cast<float>(params_.height_gap)) continue;
      const double common = common_area(before, now, margin);
      const double a = area_of(before, margin), b = area_of(now, margin);
      if (!(common > 0.0) || common < params_.least_share * std::min(a, b)) continue;
      pairs_.push_back({common / (a + b - common), t, k});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    if (a.likeness != b.likeness) return a.likeness > b.likeness;
    return a.track != b.track ? a.track < b.track : a.thing < b.thing;
  });
}

void ThingTracker::take_pairs(double stamp) {
  taken_.assign(state_.tracks.size(), 0);
  for (const Pair& pair : pairs_) {
    if (taken_[pair.track] != 0 || identities_[pair.thing] != 0) continue;
    taken_[pair.track] = 1;
    Track& track = state_.tracks[pair.track];
    track.box = boxes_[pair.thing];
    track.seen = stamp;
    identities_[pair.thing] = track.identity;
  }
}

const std::vector<std::uint64_t>& ThingTracker::update(
    const std::vector<ClusterDescription>& things, const Eigen::Isometry3d& T_map_robot,
    double stamp) {
  boxes_.clear();
  for (const ClusterDescription& thing : things) boxes_.push_back(moved(thing.box, T_map_robot));
  identities_.assign(things.size(), 0);
  find_pairs();
  take_pairs(stamp);
  state_.tracks.erase(
      std::remove_if(state_.tracks.begin(), state_.tracks.end(),
                     [&](const Track& track) { return stamp - track.seen > params_.memory; }),
      state_.tracks.end());
  for (std::size_t k = 0; k < things.size(); ++k) {
    if (identities_[k] != 0) continue;
    identities_[k] = state_.next++;
    state_.tracks.push_back({identities_[k], boxes_[k], stamp});
  }
  return identities_;
}

}  // namespace mrpt_terrain
