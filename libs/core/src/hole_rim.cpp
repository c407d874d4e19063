// SPDX-License-Identifier: BSD-3-Clause
#include "hole_rim.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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
// Weight of "no bending", in points times m^4: within half a metre, a hundred points outweigh it.
constexpr double kHold = 30.0;

bool is_around(const HolePoint& p) { return p.zone == HoleZone::kRim || p.zone == HoleZone::kNear; }

// Whether a point counts in a fit: in the first round those that are in cells away from the hole.
struct Selection {
  const RimSurface& rim;
  double band;
  bool first, away_only;
  [[nodiscard]] bool takes(const HolePoint& p) const {
    if (!is_around(p)) return false;
    if (first) return !away_only || p.zone == HoleZone::kRim;
    const double low = rim.height_at(p.x, p.y) - p.z;
    return low <= band && low >= -kUpperBand * band;
  }
};

// One round: the surface through the points that the one before selects.
template <int kTerms>
bool fit_round(const std::vector<HolePoint>& points, const Selection& selection, RimSurface& rim) {
  using Matrix = Eigen::Matrix<double, kTerms, kTerms>;
  using Vector = Eigen::Matrix<double, kTerms, 1>;
  Matrix a = Matrix::Zero();  // its lower triangle, which is all that the decomposition reads
  Vector b = Vector::Zero();
  int n = 0;
  for (const HolePoint& p : points) {
    if (!selection.takes(p)) continue;
    const double u = p.x - rim.x, v = p.y - rim.y, z = p.z - rim.z;
    const std::array<double, 6> terms{1.0, u, v, u * u, u * v, v * v};
    for (int j = 0; j < kTerms; ++j) {
      const double weighted = p.weight * terms[static_cast<std::size_t>(j)];
      b(j) += weighted * z;
      for (int i = j; i < kTerms; ++i) a(i, j) += weighted * terms[static_cast<std::size_t>(i)];
    }
    ++n;
  }
  if (n < kFewestRimPoints) return false;
  for (int k = 3; k < kTerms; ++k) a(k, k) += kHold;
  const Eigen::LDLT<Matrix> ldlt(a);
  const Vector d = ldlt.vectorD();
  if (!(d.minCoeff() > 1e-9 * d.maxCoeff())) return false;
  const Vector x = ldlt.solve(b);
  rim.z += x(0);
  rim.gradient_x = x(1);
  rim.gradient_y = x(2);
  if constexpr (kTerms == 6) {
    rim.bend_xx = x(3);
    rim.bend_xy = x(4);
    rim.bend_yy = x(5);
  }
  return true;
}

double spread_of(const std::vector<HolePoint>& points, const Selection& selection, int terms) {
  double squares = 0.0, weights = 0.0;
  int n = 0;
  for (const HolePoint& p : points) {
    if (!selection.takes(p)) continue;
    const double low = selection.rim.height_at(p.x, p.y) - p.z;
    squares += p.weight * low * low;
    weights += p.weight;
    ++n;
  }
  if (n <= terms) return 0.0;
  return std::sqrt(squares / (weights * (1.0 - static_cast<double>(terms) / n)));
}

// Puts the origin of the surface into the mean of the points; returns how many are in cells away
// from the hole.
int start(const std::vector<HolePoint>& points, RimSurface& rim) {
  const auto away = std::count_if(points.begin(), points.end(),
                                  [](const HolePoint& p) { return p.zone == HoleZone::kRim; });
  const bool enough = away >= kFewestRimPoints;
  double n = 0.0;
  rim = {};
  for (const HolePoint& p : points) {
    if (!is_around(p) || (enough && p.zone != HoleZone::kRim)) continue;
    rim.x += p.x;
    rim.y += p.y;
    rim.z += p.z;
    n += 1.0;
  }
  const double share = 1.0 / std::max(n, 1.0);
  rim.x *= share;
  rim.y *= share;
  rim.z *= share;
  return static_cast<int>(away);
}

}  // namespace

bool fit_rim(const std::vector<HolePoint>& points, double low, RimSurface& rim) {
  const bool away_only = start(points, rim) >= kFewestRimPoints;
  double band = low;
  for (int round = 0; round < kRounds; ++round) {
    const bool plane = round < kPlaneRounds;
    const RimSurface before = rim;
    const Selection selection{before, band, round == 0, away_only};
    if (!(plane ? fit_round<3>(points, selection, rim) : fit_round<6>(points, selection, rim)))
      return false;
    rim.sigma = spread_of(points, {rim, band, false, away_only}, plane ? 3 : 6);
    band = std::clamp(kOutlier * rim.sigma, std::min(kLeastBand, low), low);
  }
  return true;
}

}  // namespace mrpt_terrain
