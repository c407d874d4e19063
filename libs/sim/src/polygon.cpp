// SPDX-License-Identifier: BSD-3-Clause
#include "polygon.h"

#include <Eigen/LU>
#include <cmath>

namespace mrpt_terrain::sim {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
// Slivers of less area, square metres, are dropped.
constexpr double kLeastArea = 1e-14;

double area_of(const Polygon& polygon) {
  double area = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += side_of(polygon[0], polygon[i - 1], polygon[i]) / 2;
  }
  return area;
}

Polygon without_slivers(Polygon polygon) {
  if (polygon.size() < 3 || area_of(polygon) < kLeastArea) polygon.clear();
  return polygon;
}

Eigen::Vector2d turned(double yaw, double x, double y) {
  return {std::cos(yaw) * x - std::sin(yaw) * y, std::sin(yaw) * x + std::cos(yaw) * y};
}

}  // namespace

double side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                bool left) {
  Polygon result;
  const double sign = left ? 1.0 : -1.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double side_p = sign * side_of(a, b, p);
    const double side_q = sign * side_of(a, b, q);
    if (side_p >= 0.0) result.push_back(p);
    if ((side_p > 0.0 && side_q < 0.0) || (side_p < 0.0 && side_q > 0.0)) {
      result.push_back(p + (q - p) * (side_p / (side_p - side_q)));
    }
  }
  return without_slivers(std::move(result));
}

Polygon intersection(Polygon polygon, const Polygon& by) {
  for (std::size_t i = 0; i < by.size() && !polygon.empty(); ++i) {
    polygon = clipped(polygon, by[i], by[(i + 1) % by.size()], true);
  }
  return polygon;
}

Split split(Polygon polygon, const Polygon& by) {
  Split result;
  for (std::size_t i = 0; i < by.size() && !polygon.empty(); ++i) {
    const Eigen::Vector2d& a = by[i];
    const Eigen::Vector2d& b = by[(i + 1) % by.size()];
    Polygon beyond = clipped(polygon, a, b, false);
    if (!beyond.empty()) result.outside.push_back(std::move(beyond));
    polygon = clipped(polygon, a, b, true);
  }
  result.inside = std::move(polygon);
  return result;
}

std::optional<Polygon> inset(const Polygon& polygon, double distance) {
  const std::size_t n = polygon.size();
  Polygon result;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d before = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d after = (polygon[(i + 1) % n] - polygon[i]).normalized();
    // The corner has the distance from both of its edges.
    Eigen::Matrix2d normals;
    normals << -before.y(), before.x(), -after.y(), after.x();
    result.push_back(polygon[i] + normals.inverse() * Eigen::Vector2d(distance, distance));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % n] - polygon[i];
    if (edge.dot(result[(i + 1) % n] - result[i]) <= 0.0) return std::nullopt;
  }
  return result;
}

bool overlap(const Polygon& a, const Polygon& b) { return !intersection(a, b).empty(); }

bool contains(const Polygon& polygon, const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (side_of(polygon[i], polygon[(i + 1) % polygon.size()], p) < 0.0) return false;
  }
  return !polygon.empty();
}

Polygon turned_rectangle(const Eigen::Vector2d& centre, double yaw, double length, double width) {
  const double x = length / 2;
  const double y = width / 2;
  return {centre + turned(yaw, -x, -y), centre + turned(yaw, x, -y), centre + turned(yaw, x, y),
          centre + turned(yaw, -x, y)};
}

Polygon turned_ellipse(const Eigen::Vector2d& centre, double yaw, double length, double width,
                       int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = kTwoPi * i / corners;
    polygon.push_back(centre +
                      turned(yaw, length / 2 * std::cos(angle), width / 2 * std::sin(angle)));
  }
  return polygon;
}

}  // namespace mrpt_terrain::sim
