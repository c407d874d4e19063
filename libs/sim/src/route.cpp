// SPDX-License-Identifier: BSD-3-Clause
#include "route.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::sim {
namespace {

// Waypoints closer together are one: their direction would be rounding.
constexpr double kSamePlace = 1e-6;

std::vector<Eigen::Vector2d> without_doubles(const std::vector<Eigen::Vector2d>& waypoints) {
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector2d& point : waypoints) {
    if (result.empty() || (point - result.back()).norm() > kSamePlace) result.push_back(point);
  }
  return result;
}

/// Appends samples; time runs with the way, or with the turn where that takes longer.
class Sampler {
 public:
  Sampler(const RoutePoint& first, double speed) : speed_(speed), route_{first} {}

  void straight_to(const Eigen::Vector2d& end) {
    const RoutePoint from = route_.back();
    const double length = (end - from.position).norm();
    if (length <= kSamePlace) return;
    const int steps = steps_of(length / kRouteStep);
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      route_.push_back({from.time + share * length / speed_,
                        (1.0 - share) * from.position + share * end, from.yaw});
    }
  }

  /// Goes on along a circle; with radius 0 on the spot.
  /// \param angle of the turn, left > 0
  void turn(double angle, double radius) {
    const RoutePoint from = route_.back();
    const double side = angle < 0.0 ? -radius : radius;
    const Eigen::Vector2d centre =
        from.position + side * Eigen::Vector2d(-std::sin(from.yaw), std::cos(from.yaw));
    const double length = radius * std::abs(angle);
    const double duration = std::max(length / speed_, std::abs(angle) / kTurnRate);
    const int steps = steps_of(std::max(length / kRouteStep, std::abs(angle) / kRouteTurnStep));
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps, yaw = from.yaw + share * angle;
      route_.push_back({from.time + share * duration,
                        centre + side * Eigen::Vector2d(std::sin(yaw), -std::cos(yaw)), yaw});
    }
  }

  [[nodiscard]] std::vector<RoutePoint> take() { return std::move(route_); }

 private:
  static int steps_of(double quotient) {
    return std::max(1, static_cast<int>(std::ceil(quotient)));
  }

  double speed_;
  std::vector<RoutePoint> route_;
};

}  // namespace

std::vector<RoutePoint> route_of(const DrivePath& path) {
  const auto places = without_doubles(path.waypoints);
  if (places.size() < 2) {
    return {{0.0, places.empty() ? Eigen::Vector2d::Zero().eval() : places[0], path.yaw}};
  }
  const Eigen::Vector2d first = places[1] - places[0];
  Sampler sampler({0.0, places[0], std::atan2(first.y(), first.x())}, path.speed);
  for (std::size_t k = 1; k + 1 < places.size(); ++k) {
    const Eigen::Vector2d in = places[k] - places[k - 1], out = places[k + 1] - places[k];
    const double angle = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    const bool on_the_spot = std::abs(angle) > kSharpestArc;
    const double tangent = std::tan(0.5 * std::abs(angle));
    const double cut =
        on_the_spot ? 0.0 : std::min({kCornerRadius * tangent, 0.5 * in.norm(), 0.5 * out.norm()});
    sampler.straight_to(places[k] - cut * in.normalized());
    if (angle != 0.0) sampler.turn(angle, on_the_spot ? 0.0 : cut / tangent);
  }
  sampler.straight_to(places.back());
  return sampler.take();
}

}  // namespace mrpt_terrain::sim
