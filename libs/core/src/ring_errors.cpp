// SPDX-License-Identifier: BSD-3-Clause
#include "ring_errors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sort_in_buckets.h"

namespace mrpt_terrain {
namespace {

// Ground is looked for so far beside a face: radians of azimuth on both sides, radians of elevation
// above and below the beams to it, metres behind and before it.
constexpr float kAside = 0.4F;
constexpr float kAboveAndBelow = 0.06F;
constexpr float kFarther = 5.0F;
// Wider faces surround the sensor, radians to both sides.
constexpr float kWidestFace = 1.2F;
// A ring ends where it was not seen for more columns than this.
constexpr std::int32_t kMissingColumns = 3;
// A part of a ring on the ground: so many columns.
constexpr std::int32_t kPartColumns = 4;
// The ground around is no smoother than this, and taken to be as uneven as that at first, metres...
constexpr double kLeastUneven = 0.002, kFirstUneven = 0.01;
// ...and parts of rings that are near each other are uneven in the same way: they count like one of
// so many.
constexpr double kAlike = 4.0;
constexpr int kRounds = 4;
// Parts further from the plane than so many standard deviations do not count.
constexpr double kOutlier = 3.0;
// Standard deviation that the slope of the ground has before it is seen: 1 is 45 deg.
constexpr double kSlopeBefore = 1.0;
// Fewer parts tell nothing.
constexpr std::size_t kFewestParts = 6;

/// The face as it is seen from where its beams start.
struct Sector {
  float middle = 0.0F;                ///< azimuth, radians
  float before = 0.0F, after = 0.0F;  ///< azimuth about the middle, radians
  float low = 0.0F, high = 0.0F;      ///< elevation, radians
  float farthest = 0.0F;              ///< horizontal distance, metres
};

// From one azimuth to another, -pi to pi; both have to be that, too. Differences of more than half
// a turn and a whole turn are exact, as `std::remainder` is.
float turn_from(float from, float to) {
  constexpr auto kTurn = static_cast<float>(2.0 * M_PI);
  const float turn = to - from;
  if (turn > 0.5F * kTurn) return turn - kTurn;
  return turn < -0.5F * kTurn ? turn + kTurn : turn;
}

bool sector_of(FaceSlopeWorkspace& workspace, Sector& sector) {
  if (workspace.beams.empty()) return false;
  const BeamPoints& points = workspace.points;
  double dx = 0.0, dy = 0.0;
  for (const FaceBeam& beam : workspace.beams) {
    const auto i = static_cast<std::size_t>(beam.point);
    dx += static_cast<double>(points.dx[i]);
    dy += static_cast<double>(points.dy[i]);
  }
  sector.middle = static_cast<float>(std::atan2(dy, dx));
  sector.low = std::numeric_limits<float>::max();
  sector.high = std::numeric_limits<float>::lowest();
  for (const FaceBeam& beam : workspace.beams) {
    const float azimuth = azimuth_of(static_cast<std::size_t>(beam.point), workspace);
    const float turn = turn_from(sector.middle, azimuth);
    sector.before = std::min(sector.before, turn);
    sector.after = std::max(sector.after, turn);
    sector.low = std::min(sector.low, beam.elevation);
    sector.high = std::max(sector.high, beam.elevation);
  }
  return sector.after < kWidestFace && sector.before > -kWidestFace;
}

/// Finds the points of the ground in a sector.
class GroundSearch {
 public:
  GroundSearch(const BeamOrigins& origins, const FaceSurroundings& around,
               const std::array<float, 3>& origin, const Sector& sector)
      : origins_(origins),
        around_(around),
        origin_(origin),
        sector_(sector),
        tan_low_(std::tan(sector.low - kAboveAndBelow)),
        tan_high_(std::tan(std::min(sector.high + kAboveAndBelow, -0.005F))) {}

  template <class Visitor>
  void visit(Visitor&& visitor) const {
    const GroundSurface& surface = around_.field.surface;
    const SquareLattice& lattice = surface.lattice();
    const float reach = sector_.farthest;
    const int half = lattice.side / 2;
    const auto index = [&](float metres) {
      return std::clamp(static_cast<int>(std::floor(metres / lattice.cell_size)) + half, 0,
                        lattice.side - 1);
    };
    // The box of the sector: its apex, the ends of its arc and what the arc reaches between.
    float low_x = origin_[0], high_x = origin_[0], low_y = origin_[1], high_y = origin_[1];
    for (int k = 0; k <= 4; ++k) {
      const float share = 0.25F * static_cast<float>(k);
      const float turn = sector_.middle + (sector_.before - kAside) * (1.0F - share) +
                         (sector_.after + kAside) * share;
      const float x = origin_[0] + reach * std::cos(turn), y = origin_[1] + reach * std::sin(turn);
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
    }
    for (int row = index(low_x); row <= index(high_x); ++row) {
      for (int column = index(low_y); column <= index(high_y); ++column) {
        const std::int32_t slot = surface.cells.slot_of[surface.cells.number_of({row, column})];
        if (slot >= 0) visit_cell(static_cast<std::size_t>(slot), visitor);
      }
    }
  }

 private:
  template <class Visitor>
  void visit_cell(std::size_t slot, Visitor&& visitor) const {
    const CellPoints& cells = around_.field.surface.cells;
    for (auto k = static_cast<std::size_t>(cells.first[slot]);
         k < static_cast<std::size_t>(cells.first[slot + 1]); ++k) {
      const CellPoint& p = cells.points[k];
      if (around_.field.support[k] != Support::kGround) continue;
      const auto i = static_cast<std::size_t>(p.index);
      if (around_.raised[i] > 0.0F || !origins_.is_measured(i)) continue;
      const std::array<float, 3>& from = origins_.of(i);
      const float dx = p.x - from[0], dy = p.y - from[1], dz = p.z - from[2];
      const float flat = dx * dx + dy * dy;
      if (flat > sector_.farthest * sector_.farthest || dz >= 0.0F) continue;
      // Both tangents are negative.
      if (dz * dz > tan_low_ * tan_low_ * flat || dz * dz < tan_high_ * tan_high_ * flat) continue;
      const float turn = turn_from(sector_.middle, std::atan2(dy, dx));
      if (turn < sector_.before - kAside || turn > sector_.after + kAside) continue;
      visitor(p.index, turn, std::atan2(dz, std::sqrt(flat)));
    }
  }

  const BeamOrigins& origins_;
  const FaceSurroundings& around_;
  const std::array<float, 3>& origin_;
  const Sector& sector_;
  float tan_low_, tan_high_;
};

std::int32_t column_of(float turn) { return static_cast<std::int32_t>(std::floor(turn / kColumn)); }

// Adds up the points of the ground in parts of rings. Distances are those from the plane that is
// known of the ground, places are about its centre.
void collect_parts(const PointsView& points, const BeamOrigins& origins,
                   const FaceSurroundings& around, FaceSlopeWorkspace& workspace) {
  PartsOfRings parts(workspace);
  for (const FaceBeam& beam : workspace.beams) {
    if (!beam.ground) continue;
    const auto i = static_cast<std::size_t>(beam.point);
    const std::array<float, 3>& from = origins.of(i);
    const Eigen::Vector3d at =
        Eigen::Vector3f(points.x[i], points.y[i], points.z[i]).cast<double>();
    const Eigen::Vector3d way = at - Eigen::Vector3f(from[0], from[1], from[2]).cast<double>();
    RingPart& part = parts.of(beam);
    part.row += Eigen::Vector3d(1.0, at.x() - around.place.x(), at.y() - around.place.y());
    part.distance += around.ground.normal.dot(at) + around.ground.offset;
    part.along += around.ground.normal.dot(way) / way.norm();
  }
  for (RingPart& part : workspace.parts) {
    const double n = part.row.x();
    part.row /= n;
    part.distance /= n;
    part.along /= n;
  }
}

// The plane of the ground and the errors of the rings; nothing is known of them yet.
void forget(double ring_sigma, std::vector<FaceRing>& rings) {
  for (FaceRing& ring : rings) {
    ring.error = 0.0;
    ring.variance = ring_sigma * ring_sigma;
    ring.shared.setZero();
  }
}

/// Least squares for the plane of the ground and the errors of the rings that meet it; the errors
/// are eliminated ring by ring.
struct GroundFit {
  FaceSlopeWorkspace& workspace;
  double prior;  ///< 1 / ring_sigma^2
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  [[nodiscard]] double residual(const RingPart& part) const {
    const FaceRing& ring = workspace.rings[static_cast<std::size_t>(part.ring)];
    return part.distance - part.row.dot(plane) - part.along * ring.error;
  }

  /// \param variance of a part's distance
  /// \param limit squared residual of the last step from which parts do not count
  void step(double variance, double limit) {
    const double weight = 1.0 / (kAlike * variance);
    for (FaceRing& ring : workspace.rings) {
      ring.information = prior;
      ring.sum = 0.0;
      ring.row.setZero();
    }
    Eigen::Matrix3d normal_equations = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    normal_equations(1, 1) = normal_equations(2, 2) = 1.0 / (kSlopeBefore * kSlopeBefore);
    for (const RingPart& part : workspace.parts) {
      const double e = residual(part);
      if (e * e > limit) continue;
      FaceRing& ring = workspace.rings[static_cast<std::size_t>(part.ring)];
      normal_equations += weight * part.row * part.row.transpose();
      right += weight * part.distance * part.row;
      ring.information += weight * part.along * part.along;
      ring.sum += weight * part.along * part.distance;
      ring.row += weight * part.along * part.row;
    }
    for (const FaceRing& ring : workspace.rings) {
      normal_equations -= ring.row * ring.row.transpose() / ring.information;
      right -= ring.row * (ring.sum / ring.information);
    }
    covariance = normal_equations.inverse();
    plane = covariance * right;
    for (FaceRing& ring : workspace.rings) {
      ring.error = (ring.sum - ring.row.dot(plane)) / ring.information;
      ring.variance = 1.0 / ring.information;
      ring.shared = ring.row / ring.information;
    }
  }

  /// Mean squared residual of the parts that count; negative if they are too few.
  [[nodiscard]] double variance(double limit) const {
    double squares = 0.0, n = 0.0;
    for (const RingPart& part : workspace.parts) {
      const double e = residual(part);
      if (e * e > limit) continue;
      squares += e * e;
      n += 1.0;
    }
    return n < static_cast<double>(kFewestParts) ? -1.0 : squares / (n - 3.0);
  }
};

}  // namespace

float azimuth_of(std::size_t point, FaceSlopeWorkspace& workspace) {
  float& azimuth = workspace.azimuth[point];
  if (azimuth == kUnknownAzimuth)
    azimuth = std::atan2(workspace.points.dy[point], workspace.points.dx[point]);
  return azimuth;
}

// Columns are few.
void sort_beams(FaceSlopeWorkspace& workspace) {
  const std::vector<FaceBeam>& beams = workspace.beams;
  if (beams.empty()) return;
  std::int32_t low = beams.front().column, high = low;
  for (const FaceBeam& beam : beams) {
    low = std::min(low, beam.column);
    high = std::max(high, beam.column);
  }
  const auto less = [](const FaceBeam& a, const FaceBeam& b) {
    if (a.elevation != b.elevation) return a.elevation < b.elevation;
    return a.ground != b.ground ? b.ground : a.point < b.point;
  };
  sort_in_buckets(
      static_cast<std::size_t>(high - low) + 1,
      [low](const FaceBeam& beam) { return static_cast<std::size_t>(beam.column - low); }, less,
      workspace.beams, workspace.beams_by_column, workspace.first_beam);
}

void add_beams_beside(const BeamOrigins& origins, const FaceSurroundings& around,
                      const std::array<float, 3>& origin, FaceSlopeWorkspace& workspace) {
  Sector sector;
  if (!sector_of(workspace, sector)) return;
  // Columns are those of azimuths about the middle of the face, so that none is at their end.
  for (FaceBeam& beam : workspace.beams) {
    const float azimuth = azimuth_of(static_cast<std::size_t>(beam.point), workspace);
    beam.column = column_of(turn_from(sector.middle, azimuth));
  }
  sector.farthest = static_cast<float>(std::hypot(around.place.x() - double{origin[0]},
                                                  around.place.y() - double{origin[1]})) +
                    kFarther;
  const GroundSearch search(origins, around, origin, sector);
  search.visit([&](std::int32_t point, float turn, float elevation) {
    FaceBeam& beam = workspace.beams.emplace_back();
    beam.column = column_of(turn);
    beam.elevation = elevation;
    beam.point = point;
    beam.ground = true;
  });
  sort_beams(workspace);
}

void follow_beams(std::vector<FaceBeam>& beams, std::vector<FaceRing>& rings) {
  rings.clear();
  // Rings that are still seen are few: those that have ended are passed over from the front.
  std::vector<FaceRing>::size_type first = 0;
  for (FaceBeam& beam : beams) {
    while (first < rings.size() && beam.column - rings[first].column > kMissingColumns) ++first;
    FaceRing* nearest = nullptr;
    for (auto k = first; k < rings.size(); ++k) {
      FaceRing& ring = rings[k];
      const float gap = std::abs(ring.elevation - beam.elevation);
      if (gap > kRingGap || beam.column - ring.column > kMissingColumns) continue;
      if (nearest == nullptr || gap < std::abs(nearest->elevation - beam.elevation))
        nearest = &ring;
    }
    if (nearest == nullptr) nearest = &rings.emplace_back();
    nearest->elevation = beam.elevation;
    nearest->column = beam.column;
    nearest->on_face = nearest->on_face || !beam.ground;
    beam.ring = static_cast<std::int32_t>(nearest - rings.data());
  }
}

RingPart& PartsOfRings::of(const FaceBeam& beam) {
  const auto ring = static_cast<std::size_t>(beam.ring);
  const std::int32_t number =
      beam.column >= 0 ? beam.column / kPartColumns : (beam.column + 1) / kPartColumns - 1;
  std::int32_t& last = workspace_.open_parts[ring];
  if (last < 0 || workspace_.parts[static_cast<std::size_t>(last)].number != number) {
    last = static_cast<std::int32_t>(workspace_.parts.size());
    RingPart& part = workspace_.parts.emplace_back();
    part.ring = beam.ring;
    part.number = number;
  }
  return workspace_.parts[static_cast<std::size_t>(last)];
}

Eigen::Matrix3d estimate_ring_errors(const PointsView& points, const BeamOrigins& origins,
                                     const FaceSurroundings* around, double ring_sigma,
                                     FaceSlopeWorkspace& workspace) {
  forget(ring_sigma, workspace.rings);
  if (around == nullptr || !(ring_sigma > 0.0)) return Eigen::Matrix3d::Zero();
  collect_parts(points, origins, *around, workspace);
  if (workspace.parts.size() < kFewestParts) return Eigen::Matrix3d::Zero();
  GroundFit fit{workspace, 1.0 / (ring_sigma * ring_sigma)};
  double variance = kFirstUneven * kFirstUneven;
  for (int round = 0; round < kRounds; ++round) {
    const double limit =
        round == 0 ? std::numeric_limits<double>::max() : kOutlier * kOutlier * variance;
    fit.step(variance, limit);
    const double next = fit.variance(limit);
    if (next < 0.0 || !fit.covariance.allFinite()) {
      forget(ring_sigma, workspace.rings);
      return Eigen::Matrix3d::Zero();
    }
    variance = std::max(kLeastUneven * kLeastUneven, next);
  }
  return fit.covariance;
}

}  // namespace mrpt_terrain
