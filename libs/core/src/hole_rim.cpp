// SPDX-License-Identifier: BSD-3-Clause
#include "hole_rim.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "lane_parts.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr int kFewestRimPoints = 8;
constexpr int kRounds = 6;        // of leaving out what lies low
constexpr int kPlaneRounds = 2;   // of these, the first ones fit a plane
constexpr double kOutlier = 2.5;  // standard deviations
// Points at least this far below the rim are left out: smooth roads scatter less.
constexpr double kLeastBand = 0.015;  // metres
// A few things that stand there are part of the rim up to this many times the band.
constexpr double kUpperBand = 3.0;
// Points count half at this distance from the hole, metres.
constexpr double kHalfWeight = 0.2;
// Weight of "no bending", in points times m^4: within half a metre, a hundred points outweigh it.
constexpr double kHold = 30.0;

bool is_around(const HolePoint& p) { return p.zone == HoleZone::kRim || p.zone == HoleZone::kNear; }

/// Weighted sums of u^p v^q, p + q <= 4, and of z times those of p + q <= 2, in the order of
/// `at`.
struct PowerSums {
  static constexpr std::size_t kMoments = 15, kHeights = 6;
  std::array<double, kMoments> moment{};
  std::array<double, kHeights> height{};
  double points = 0.0;

  static constexpr std::size_t at(int p, int q) {
    return static_cast<std::size_t>((p + q) * (p + q + 1) / 2 + q);
  }
};

/// Points of a rim side by side.
template <class Lanes>
struct RimLanes {
  Lanes u, v, z;

  [[gnu::always_inline]] RimLanes(const RimPoints& points, std::size_t i)
      : u(Lanes::from(points.u.data() + i)),
        v(Lanes::from(points.v.data() + i)),
        z(Lanes::from(points.z.data() + i)) {}
};

// How many points have a weight.
template <class Lanes>
[[gnu::always_inline]] inline void count_weights(const Lanes& w, Lanes& count) {
  const Lanes zero{};
  Lanes counts{};
  counts.take_where_less(zero, w, Lanes::of(1.0));
  count += counts;
}

// The weights of the points within the band about the surface, 0 for the others.
template <class Lanes>
[[gnu::always_inline]] inline Lanes weights_within(const RimPoints& points, std::size_t i,
                                                   double band, const Lanes& low) {
  Lanes w = Lanes::from(points.weight.data() + i);
  w.drop_where_less(Lanes::of(band), low);
  w.drop_where_less(low, Lanes::of(-kUpperBand * band));
  return w;
}

// Lets the points within the band count.
// \param[out] changed whether they are others than before
template <class Lanes>
[[gnu::always_inline]] inline void choose_points_in(double band, RimPoints& points, bool& changed) {
  Lanes differences{};
  for (std::size_t i = 0; i < points.size; i += kCellLanes) {
    const Lanes w = weights_within(points, i, band, Lanes::from(points.low.data() + i));
    const Lanes off = w - Lanes::from(points.counted.data() + i);
    differences += off * off;
    w.copy_to(points.counted.data() + i);
  }
  changed = differences.total() > 0.0;
}
MRPT_TERRAIN_LANE_FUNCTION(choose_points, (double band, RimPoints& points, bool& changed),
                           (band, points, changed))

// Sums over the points that count, as far as a plane needs them.
template <class Lanes>
[[gnu::always_inline]] inline void sum_for_plane_in(const RimPoints& points, PowerSums& sums) {
  Lanes moment[6] = {}, heights[3] = {}, count = {};
  for (std::size_t i = 0; i < points.size; i += kCellLanes) {
    const RimLanes<Lanes> p(points, i);
    const Lanes w = Lanes::from(points.counted.data() + i);
    count_weights(w, count);
    const Lanes wu = w * p.u, wv = w * p.v;
    moment[0] += w;
    moment[1] += wu;
    moment[2] += wv;
    moment[3] += wu * p.u;
    moment[4] += wu * p.v;
    moment[5] += wv * p.v;
    heights[0] += w * p.z;
    heights[1] += wu * p.z;
    heights[2] += wv * p.z;
  }
  for (std::size_t k = 0; k < 6; ++k) sums.moment[k] = moment[k].total();
  for (std::size_t k = 0; k < 3; ++k) sums.height[k] = heights[k].total();
  sums.points = count.total();
}
MRPT_TERRAIN_LANE_FUNCTION(sum_for_plane, (const RimPoints& points, PowerSums& sums),
                           (points, sums))

// All sums over the points that count.
template <class Lanes>
[[gnu::always_inline]] inline void sum_for_bend_in(const RimPoints& points, PowerSums& sums) {
  Lanes moment[PowerSums::kMoments] = {}, heights[PowerSums::kHeights] = {}, count = {};
  for (std::size_t i = 0; i < points.size; i += kCellLanes) {
    const RimLanes<Lanes> p(points, i);
    const Lanes w = Lanes::from(points.counted.data() + i);
    count_weights(w, count);
    const Lanes wu = w * p.u, wv = w * p.v;
    const Lanes wuu = wu * p.u, wuv = wu * p.v, wvv = wv * p.v;
    const Lanes wuuu = wuu * p.u, wuuv = wuu * p.v, wuvv = wuv * p.v, wvvv = wvv * p.v;
    moment[0] += w;
    moment[1] += wu;
    moment[2] += wv;
    moment[3] += wuu;
    moment[4] += wuv;
    moment[5] += wvv;
    moment[6] += wuuu;
    moment[7] += wuuv;
    moment[8] += wuvv;
    moment[9] += wvvv;
    moment[10] += wuuu * p.u;
    moment[11] += wuuu * p.v;
    moment[12] += wuuv * p.v;
    moment[13] += wuvv * p.v;
    moment[14] += wvvv * p.v;
    heights[0] += w * p.z;
    heights[1] += wu * p.z;
    heights[2] += wv * p.z;
    heights[3] += wuu * p.z;
    heights[4] += wuv * p.z;
    heights[5] += wvv * p.z;
  }
  for (std::size_t k = 0; k < PowerSums::kMoments; ++k) sums.moment[k] = moment[k].total();
  for (std::size_t k = 0; k < PowerSums::kHeights; ++k) sums.height[k] = heights[k].total();
  sums.points = count.total();
}
MRPT_TERRAIN_LANE_FUNCTION(sum_for_bend, (const RimPoints& points, PowerSums& sums), (points, sums))

/// Sums over points about a surface.
struct SpreadSums {
  double squares = 0.0, weights = 0.0;  ///< weighted squares of depths, and the weights
  double count = 0.0;
  double squares_above = 0.0, weights_above = 0.0;  ///< of the points that are not below it
};

// Measures how far all points lie below the surface, which is about the same origin as they are and
// has z = 0 there but for `height`, and sums up those within the band.
template <class Lanes>
[[gnu::always_inline]] inline void sum_squares_in(const RimSurface& surface, double height,
                                                  double band, RimPoints& points,
                                                  SpreadSums& sums) {
  const RimSurface rim = surface;
  const Lanes zero{};
  Lanes squares = {}, weights = {}, count = {}, squares_above = {}, weights_above = {};
  for (std::size_t i = 0; i < points.size; i += kCellLanes) {
    const RimLanes<Lanes> p(points, i);
    Lanes low = rim.gradient_x * p.u + rim.gradient_y * p.v + rim.bend_xx * p.u * p.u +
                rim.bend_xy * p.u * p.v + rim.bend_yy * p.v * p.v - p.z;
    low += Lanes::of(height);
    low.copy_to(points.low.data() + i);
    Lanes w = weights_within(points, i, band, low);
    squares += w * low * low;
    weights += w;
    count_weights(w, count);
    w.drop_where_less(zero, low);
    squares_above += w * low * low;
    weights_above += w;
  }
  sums.squares = squares.total();
  sums.weights = weights.total();
  sums.count = count.total();
  sums.squares_above = squares_above.total();
  sums.weights_above = weights_above.total();
}
MRPT_TERRAIN_LANE_FUNCTION(sum_squares,
                           (const RimSurface& surface, double height, double band,
                            RimPoints& points, SpreadSums& sums),
                           (surface, height, band, points, sums))

// The surface of least squares through the points of the sums.
// \param[out] height of the surface at the origin
template <int kTerms>
bool solve(const PowerSums& sums, RimSurface& rim, double& height) {
  using Matrix = Eigen::Matrix<double, kTerms, kTerms>;
  using Vector = Eigen::Matrix<double, kTerms, 1>;
  constexpr int kPowers[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  if (sums.points < kFewestRimPoints) return false;
  Matrix a;
  Vector b;
  for (int i = 0; i < kTerms; ++i) {
    b(i) = sums.height[PowerSums::at(kPowers[i][0], kPowers[i][1])];
    for (int j = 0; j < kTerms; ++j) {
      a(i, j) =
          sums.moment[PowerSums::at(kPowers[i][0] + kPowers[j][0], kPowers[i][1] + kPowers[j][1])];
    }
  }
  for (int k = 3; k < kTerms; ++k) a(k, k) += kHold;
  const Eigen::LDLT<Matrix> ldlt(a);
  const Vector d = ldlt.vectorD();
  if (!(d.minCoeff() > 1e-9 * d.maxCoeff())) return false;
  const Vector x = ldlt.solve(b);
  height = x(0);
  rim.gradient_x = x(1);
  rim.gradient_y = x(2);
  if constexpr (kTerms == 6) {
    rim.bend_xx = x(3);
    rim.bend_xy = x(4);
    rim.bend_yy = x(5);
  }
  return true;
}

bool fit_plane(const RimPoints& points, RimSurface& rim, double& height) {
  PowerSums sums;
  sum_for_plane(points, sums);
  return solve<3>(sums, rim, height);
}

bool fit_bend(const RimPoints& points, RimSurface& rim, double& height) {
  PowerSums sums;
  sum_for_bend(points, sums);
  return solve<6>(sums, rim, height);
}

/// Standard deviation of the points from the surface, metres.
struct RimSpread {
  double all = 0.0, above = 0.0;
};

RimSpread spread_of(const RimSurface& rim, double height, double band, int terms,
                    RimPoints& points) {
  SpreadSums sums;
  sum_squares(rim, height, band, points, sums);
  if (sums.count <= terms) return {};
  const double free = 1.0 - terms / sums.count;
  const double above = std::max(sums.weights_above, std::numeric_limits<double>::min());
  return {std::sqrt(sums.squares / (sums.weights * free)),
          std::sqrt(sums.squares_above / (above * free))};
}

/// Sums of places.
struct PlaceSums {
  double x = 0.0, y = 0.0, z = 0.0, n = 0.0;

  void add(double px, double py, double pz) {
    x += px;
    y += py;
    z += pz;
    n += 1.0;
  }
};

// Takes the points around in the frame of the scan. Those in cells away from the hole count.
// \return sums over these
PlaceSums take_around(const std::vector<HolePoint>& points, RimPoints& around) {
  around.reserve((points.size() + kCellLanes - 1) / kCellLanes * kCellLanes);
  around.size = 0;
  PlaceSums away;
  for (const HolePoint& p : points) {
    if (!is_around(p)) continue;
    const bool is_away = p.zone == HoleZone::kRim;
    around.add(p.x, p.y, p.z, is_away ? 1.0 : 0.0);
    if (is_away) away.add(p.x, p.y, p.z);
  }
  return away;
}

PlaceSums sum_all(const RimPoints& points) {
  PlaceSums sums;
  for (std::size_t i = 0; i < points.size; ++i) sums.add(points.u[i], points.v[i], points.z[i]);
  return sums;
}

// The nearer to the hole, the more a point counts.
MRPT_TERRAIN_WIDE_REGISTERS
void weigh_points(const RimArea& area, RimPoints& points) {
  const Position2 low = area.low, high = area.high;
  const double margin = area.margin;
  const double *u = points.u.data(), *v = points.v.data();
  double *weight = points.weight.data(), *counted = points.counted.data();
  for (std::size_t i = 0; i < points.size; ++i) {
    const double dx = std::max(std::max(low.x - margin - u[i], u[i] - high.x - margin), 0.0);
    const double dy = std::max(std::max(low.y - margin - v[i], v[i] - high.y - margin), 0.0);
    const auto w =
        static_cast<float>(1.0 / (1.0 + (dx * dx + dy * dy) / (kHalfWeight * kHalfWeight)));
    weight[i] = static_cast<double>(w);
    counted[i] *= weight[i];
  }
}

// Moves the points into the frame of the surface.
MRPT_TERRAIN_WIDE_REGISTERS
void move_to_origin(const RimSurface& rim, RimPoints& points) {
  const double x = rim.x, y = rim.y, z = rim.z;
  double *u = points.u.data(), *v = points.v.data(), *w = points.z.data();
  for (std::size_t i = 0; i < points.size; ++i) {
    u[i] -= x;
    v[i] -= y;
    w[i] -= z;
  }
}

// Takes the points around, about their mean, which becomes the origin of the surface, and some of
// no weight for the lanes that are left over. In the first round those in cells away from the hole
// count, or all if there are few.
void start(const std::vector<HolePoint>& points, const RimArea& area, RimPoints& around,
           RimSurface& rim) {
  const PlaceSums away = take_around(points, around);
  weigh_points(area, around);
  const bool enough = away.n >= kFewestRimPoints;
  const PlaceSums mean = enough ? away : sum_all(around);
  const double share = 1.0 / std::max(mean.n, 1.0);
  rim = {};
  rim.x = mean.x * share;
  rim.y = mean.y * share;
  rim.z = mean.z * share;
  if (!enough) around.counted = around.weight;
  move_to_origin(rim, around);
  while (around.size % kCellLanes != 0) {
    around.weight[around.size] = 0.0;
    around.add(0.0, 0.0, 0.0, 0.0);
  }
}

bool same(const RimSurface& a, const RimSurface& b) {
  return a.gradient_x == b.gradient_x && a.gradient_y == b.gradient_y && a.bend_xx == b.bend_xx &&
         a.bend_xy == b.bend_xy && a.bend_yy == b.bend_yy && a.sigma == b.sigma;
}

}  // namespace

bool fit_rim(const std::vector<HolePoint>& points, const RimArea& area, double low, bool from_above,
             RimPoints& scratch, RimSurface& rim) {
  start(points, area, scratch, rim);
  double band = low, height = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const bool plane = round < kPlaneRounds;
    const RimSurface before = rim;
    const double height_before = height, band_before = band;
    // Where the same points count, the same surface goes through them.
    bool changed = true;
    if (round > 0) choose_points(band, scratch, changed);
    if (changed || round == kPlaneRounds) {
      if (!(plane ? fit_plane(scratch, rim, height) : fit_bend(scratch, rim, height))) return false;
    }
    const RimSpread spread = spread_of(rim, height, band, plane ? 3 : 6, scratch);
    rim.sigma = spread.all;
    // Walls of the hole that count would hold the band open to themselves.
    const double sigma = from_above ? std::min(spread.all, spread.above) : spread.all;
    band = std::clamp(kOutlier * sigma, std::min(kLeastBand, low), low);
    // The same points again: the other rounds would change nothing.
    if (!plane && same(rim, before) && height == height_before && band == band_before) break;
  }
  rim.z += height;
  return true;
}

}  // namespace mrpt_terrain
