// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/oriented_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lane_parts.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;

double cross(const Position2& o, const Position2& a, const Position2& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

// Points are left out in so many rounds at most, while there are more than so many.
constexpr int kRounds = 4;
constexpr std::size_t kFew = 48;

using EightPlaces = std::array<Position2, kCellLanes>;

// The first of the farthest points in each of eight directions.
template <class Lanes>
[[gnu::always_inline]] inline void find_extremes_in(const EightPlaces& direction, const double* x,
                                                    const double* y, std::size_t n,
                                                    EightPlaces& result) {
  std::array<double, kCellLanes> to_x, to_y;
  for (std::size_t k = 0; k < kCellLanes; ++k) {
    to_x[k] = direction[k].x;
    to_y[k] = direction[k].y;
  }
  const Lanes direction_x = Lanes::from(to_x.data()), direction_y = Lanes::from(to_y.data());
  Lanes best = Lanes::of(std::numeric_limits<double>::lowest()), best_x{}, best_y{};
  for (std::size_t i = 0; i < n; ++i) {
    const Lanes along = x[i] * direction_x + y[i] * direction_y;
    best_x.take_where_less(best, along, Lanes::of(x[i]));
    best_y.take_where_less(best, along, Lanes::of(y[i]));
    best.take_where_less(best, along, along);
  }
  best_x.copy_to(to_x.data());
  best_y.copy_to(to_y.data());
  for (std::size_t k = 0; k < kCellLanes; ++k) result[k] = {to_x[k], to_y[k]};
}
MRPT_TERRAIN_LANE_FUNCTION(find_extremes,
                           (const EightPlaces& direction, const double* x, const double* y,
                            std::size_t n, EightPlaces& result),
                           (direction, x, y, n, result))

// Extreme points in eight directions, counter-clockwise.
void find_octagon(const OrientedBoxWorkspace& workspace, std::vector<Position2>& polygon) {
  constexpr EightPlaces kDirections{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  EightPlaces corners;
  find_extremes(kDirections, workspace.x.data(), workspace.y.data(), workspace.x.size(), corners);
  polygon.assign(corners.begin(), corners.end());
}

// Puts the point farthest outside of every edge of a convex polygon between the edge's ends.
void add_corners(const OrientedBoxWorkspace& workspace, std::vector<Position2>& polygon,
                 std::vector<Position2>& finer) {
  finer.clear();
  const std::size_t n = polygon.size();
  for (std::size_t first = 0; first < n; first += kCellLanes) {
    const std::size_t edges = std::min(kCellLanes, n - first);
    EightPlaces outward{}, farthest;
    for (std::size_t k = 0; k < edges; ++k) {
      const Position2 &o = polygon[first + k], &a = polygon[(first + k + 1) % n];
      outward[k] = {a.y - o.y, o.x - a.x};
    }
    find_extremes(outward, workspace.x.data(), workspace.y.data(), workspace.x.size(), farthest);
    for (std::size_t k = 0; k < edges; ++k) {
      const Position2 &o = polygon[first + k], &a = polygon[(first + k + 1) % n];
      finer.push_back(o);
      if (cross(o, a, farthest[k]) < 0.0) finer.push_back(farthest[k]);
    }
  }
  polygon.swap(finer);
}

// Least cross product of the edges of a polygon and the places: positive inside.
MRPT_TERRAIN_WIDE_REGISTERS
void find_inside(const std::vector<Position2>& polygon, const double* x, const double* y,
                 std::size_t n, double* inside) {
  std::fill_n(inside, n, std::numeric_limits<double>::max());
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Position2 o = polygon[k], a = polygon[(k + 1) % polygon.size()];
    if (o.x == a.x && o.y == a.y) continue;
    const double dx = a.x - o.x, dy = a.y - o.y;
    for (std::size_t i = 0; i < n; ++i) {
      const double cross = dx * (y[i] - o.y) - dy * (x[i] - o.x);
      inside[i] = cross < inside[i] ? cross : inside[i];
    }
  }
}

// Leaves out the points inside of a polygon.
void keep_outside(const std::vector<Position2>& polygon, OrientedBoxWorkspace& workspace) {
  std::vector<double>&x = workspace.x, &y = workspace.y;
  workspace.inside.resize(x.size());
  find_inside(polygon, x.data(), y.data(), x.size(), workspace.inside.data());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[kept] = x[i];
    y[kept] = y[i];
    kept += workspace.inside[i] <= 0.0 ? 1U : 0U;
  }
  x.resize(kept);
  y.resize(kept);
}

// Points that may be corners of the convex hull, all that are among them: the octagon of extreme
// points, and finer polygons made of it, leave out what lies inside.
void find_candidates(OrientedBoxWorkspace& workspace) {
  std::vector<Position2>& polygon = workspace.candidates;
  find_octagon(workspace, polygon);
  keep_outside(polygon, workspace);
  for (int round = 1; round < kRounds && workspace.x.size() > kFew; ++round) {
    add_corners(workspace, polygon, workspace.hull);
    keep_outside(polygon, workspace);
  }
  for (std::size_t i = 0; i < workspace.x.size(); ++i)
    polygon.push_back({workspace.x[i], workspace.y[i]});
}

// Andrew's monotone chain, counter-clockwise; no three points in a row on a line.
void find_hull(std::vector<Position2>& points, std::vector<Position2>& hull) {
  std::sort(points.begin(), points.end(), [](const Position2& a, const Position2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  hull.clear();
  const auto add = [&hull](const Position2& p, std::size_t least) {
    while (hull.size() >= least + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Position2& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p < points.rend(); ++p) add(*p, lower);
  if (hull.size() > 1) hull.pop_back();
}

// The rectangle with a side along (c, s).
OrientedBox rectangle_along(const std::vector<Position2>& hull, double c, double s) {
  constexpr double kMost = std::numeric_limits<double>::max();
  double low_u = kMost, high_u = -kMost, low_v = kMost, high_v = -kMost;
  for (const Position2& p : hull) {
    const double u = c * p.x + s * p.y, v = c * p.y - s * p.x;
    low_u = std::min(low_u, u);
    high_u = std::max(high_u, u);
    low_v = std::min(low_v, v);
    high_v = std::max(high_v, v);
  }
  const double u = 0.5 * (low_u + high_u), v = 0.5 * (low_v + high_v);
  OrientedBox box;
  box.centre = {c * u - s * v, s * u + c * v};
  box.yaw = std::atan2(s, c);
  box.length = high_u - low_u;
  box.width = high_v - low_v;
  return box;
}

// Area of the rectangle with a side along an edge, times the squared length of the edge.
double scaled_area_along(const std::vector<Position2>& hull, const Position2& edge) {
  constexpr double kMost = std::numeric_limits<double>::max();
  double low_u = kMost, high_u = -kMost, low_v = kMost, high_v = -kMost;
  for (const Position2& p : hull) {
    const double u = edge.x * p.x + edge.y * p.y, v = edge.x * p.y - edge.y * p.x;
    low_u = std::min(low_u, u);
    high_u = std::max(high_u, u);
    low_v = std::min(low_v, v);
    high_v = std::max(high_v, v);
  }
  return (high_u - low_u) * (high_v - low_v);
}

// The smallest rectangle with a side along an edge of the hull; of several, the first.
OrientedBox smallest_rectangle(const std::vector<Position2>& hull) {
  // More than rounding makes of an area, m^2. Most edges are told by it to have no smaller
  // rectangle, without roots, quotients and angles.
  constexpr double kRounding = 1e-6;
  OrientedBox best = rectangle_along(hull, 1.0, 0.0);
  double least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < hull.size() && hull.size() > 1; ++k) {
    const Position2& p = hull[k];
    const Position2& q = hull[(k + 1) % hull.size()];
    const Position2 edge{q.x - p.x, q.y - p.y};
    const double squared_length = edge.x * edge.x + edge.y * edge.y;
    if (scaled_area_along(hull, edge) > (least + kRounding) * squared_length) continue;
    const double length = std::hypot(edge.x, edge.y);
    if (!(length > 0.0)) continue;
    const OrientedBox box = rectangle_along(hull, edge.x / length, edge.y / length);
    if (box.length * box.width >= least) continue;
    least = box.length * box.width;
    best = box;
  }
  return best;
}

void turn_to_longer_side(OrientedBox& box) {
  if (box.width > box.length) {
    std::swap(box.width, box.length);
    box.yaw += 0.5 * kPi;
  }
  while (box.yaw > 0.5 * kPi) box.yaw -= kPi;
  while (box.yaw <= -0.5 * kPi) box.yaw += kPi;
}

}  // namespace

OrientedBox box_around(const PointsView& points, IndexRange members,
                       OrientedBoxWorkspace& workspace) {
  OrientedBox best;
  if (members.size() == 0) return best;
  const std::size_t n = members.size();
  for (auto* values : {&workspace.x, &workspace.y}) values->resize(n);
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  std::size_t next = 0;
  for (const std::int32_t item : members) {
    const auto i = static_cast<std::size_t>(item);
    workspace.x[next] = static_cast<double>(points.x[i]);
    workspace.y[next++] = static_cast<double>(points.y[i]);
    low = std::min(low, points.z[i]);
    high = std::max(high, points.z[i]);
  }
  find_candidates(workspace);
  find_hull(workspace.candidates, workspace.hull);
  best = smallest_rectangle(workspace.hull);
  turn_to_longer_side(best);
  best.low = low;
  best.high = high;
  return best;
}

}  // namespace mrpt_terrain
