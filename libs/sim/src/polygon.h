// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace mrpt_terrain::sim {

/// Corners of a convex polygon, counter-clockwise. Empty: no area.
using Polygon = std::vector<Eigen::Vector2d>;

/// Left side of the line from a to b > 0, metres times the length of the line.
[[nodiscard]] double side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             const Eigen::Vector2d& p);

/// Part of a polygon to the left of the line from a to b (`left` true) or to the right of it.
[[nodiscard]] Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& a,
                              const Eigen::Vector2d& b, bool left);

/// What two convex polygons share.
[[nodiscard]] Polygon intersection(Polygon polygon, const Polygon& by);

/// A convex polygon split by another one.
struct Split {
  std::vector<Polygon> outside;  ///< convex parts without overlap
  Polygon inside;
};
[[nodiscard]] Split split(Polygon polygon, const Polygon& by);

/// All edges moved inwards by a distance; nothing where an edge would vanish.
[[nodiscard]] std::optional<Polygon> inset(const Polygon& polygon, double distance);

/// Whether two convex polygons share area.
[[nodiscard]] bool overlap(const Polygon& a, const Polygon& b);

[[nodiscard]] bool contains(const Polygon& polygon, const Eigen::Vector2d& p);

/// Rectangle about a centre with its length along `yaw`, radians.
[[nodiscard]] Polygon turned_rectangle(const Eigen::Vector2d& centre, double yaw, double length,
                                       double width);
/// Regular polygon with its corners on an ellipse.
[[nodiscard]] Polygon turned_ellipse(const Eigen::Vector2d& centre, double yaw, double length,
                                     double width, int corners);

}  // namespace mrpt_terrain::sim
