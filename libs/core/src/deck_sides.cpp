// SPDX-License-Identifier: BSD-3-Clause
#include "deck_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "mrpt_terrain/core/random.h"
#include "sort_in_buckets.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

// Lines through two random points each that are tried for every side...
constexpr int kHypotheses = 48;
// ...so far apart, metres: nearer ones give no direction, farther ones are hardly of one side.
constexpr float kNearest = 0.15F, kFarthest = 2.5F;
// Sides have no longer gaps, metres: rings are apart where a side runs along the beams.
constexpr float kGap = 1.0F;
// Fewer points are no side, nor are shorter stretches, metres.
constexpr std::size_t kFewest = 5;
constexpr float kShortest = 0.2F;
// A strip so many times as wide as the line has at least this share of its points on the line.
constexpr float kStrip = 3.0F, kSharp = 0.6F;
// A side goes on beyond its last points, metres, as far as the line is known: where two of its
// standard deviations are the reach.
constexpr float kLeastBeyond = 0.2F, kMostBeyond = 3.0F;
constexpr float kDeviations = 2.0F;
// No line is better known than as one of points that scatter by this, metres.
constexpr float kLeastSigma = 0.005F;
// So many sides of a deck are looked for, in about so many of its points at most.
constexpr int kMostSides = 8;
constexpr std::size_t kMostPoints = 1024;
// The same for rings that run along a side.
constexpr int kMostRings = 4;
constexpr std::size_t kMostRingPoints = 256;
// Rings on sides have so many points at least, and are lower at both ends than in between by this,
// metres...
constexpr std::size_t kFewestOfRing = 12;
constexpr float kLeastFall = 0.01F;
// ...and by more than they bend seen from above, by this factor: faces are steeper than 63 deg...
constexpr float kSteepFace = 2.0F;
// ...and this share of the surface up to so far beside, metres, is theirs: rings that cross a ridge
// are straight and fall to both ends, too, but one behind the other.
constexpr float kStripOfRing = 0.6F, kAlone = 0.8F;

struct PointRange {
  std::vector<DeckSidePoint>::iterator first, last;  // the last one is behind
  [[nodiscard]] auto begin() const { return first; }
  [[nodiscard]] auto end() const { return last; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

bool line_through(const DeckSidePoint& a, const DeckSidePoint& b, DeckSide& line) {
  const float x = b.x - a.x, y = b.y - a.y, length = std::sqrt(x * x + y * y);
  if (!(length >= kNearest && length <= kFarthest)) return false;
  line = {a.deck, a.x, a.y, x / length, y / length, 0.0F};
  return true;
}

/// Where the points are, for loops over many of them at once.
struct Places {
  std::array<float, kMostPoints> x, y;
  std::size_t size = 0;

  explicit Places(PointRange points) {
    for (const DeckSidePoint& p : points) {
      x[size] = p.x;
      y[size++] = p.y;
    }
  }
};

MRPT_TERRAIN_WIDE_REGISTERS
std::int32_t count_on(const DeckSide line, const Places& places, float reach) {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < places.size; ++i)
    count += std::abs(line.across(places.x[i], places.y[i])) <= reach ? 1 : 0;
  return count;
}

// The best of random lines by the number of points on it (RANSAC, Fischler and Bolles 1981).
bool find_line(PointRange points, float reach, RandomGenerator& random, DeckSide& best) {
  const Places places(points);
  constexpr auto kLeast = static_cast<std::int32_t>(kFewest);
  std::int32_t most = kLeast - 1;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (int k = 0; k < kHypotheses; ++k) {
    DeckSide line;
    const DeckSidePoint& a = *(points.begin() + random.below(n));
    const DeckSidePoint& b = *(points.begin() + random.below(n));
    if (!line_through(a, b, line)) continue;
    const std::int32_t count = count_on(line, places, reach);
    if (count <= most) continue;
    most = count;
    best = line;
  }
  return most >= kLeast;
}

// Brings the points on a line, along the stretch without gap that has most of them, to the front.
PointRange take_stretch(const DeckSide& line, PointRange points, float reach) {
  const auto off = std::partition(
      points.begin(), points.end(),
      [&line, reach](const DeckSidePoint& p) { return std::abs(line.across(p.x, p.y)) <= reach; });
  std::sort(points.begin(), off, [&line](const DeckSidePoint& a, const DeckSidePoint& b) {
    return line.along(a.x, a.y) < line.along(b.x, b.y);
  });
  const auto is_gap = [&line](const DeckSidePoint& a, const DeckSidePoint& b) {
    return line.along(b.x, b.y) - line.along(a.x, a.y) > kGap;
  };
  PointRange best{points.begin(), points.begin()};
  for (PointRange stretch = best; stretch.first != off; stretch.first = stretch.last) {
    const auto gap = std::adjacent_find(stretch.first, off, is_gap);
    stretch.last = gap == off ? off : gap + 1;
    if (stretch.size() > best.size()) best = stretch;
  }
  const auto size = best.last - best.first;
  std::rotate(points.begin(), best.first, best.last);
  return {points.begin(), points.begin() + size};
}

// The line through points with the least sum of squared distances from it, about their middle.
DeckSide fit_line(PointRange points) {
  const DeckSidePoint& origin = *points.begin();
  const auto n = static_cast<float>(points.size());
  float x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F;
  for (const DeckSidePoint& p : points) {
    const float u = p.x - origin.x, v = p.y - origin.y;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
    yy += v * v;
  }
  const float turn = 0.5F * std::atan2(2.0F * (xy - x * y / n), xx - x * x / n - (yy - y * y / n));
  return {origin.deck, origin.x + x / n, origin.y + y / n, std::cos(turn), std::sin(turn), 0.0F};
}

/// How points lie along a fitted line, metres.
struct Spread {
  float low = 0.0F, high = 0.0F;  // along it
  float known = 0.0F;             // how far from the middle on both sides the line is known
};

Spread spread_of(const DeckSide& line, PointRange points, float reach) {
  Spread spread;
  float across_squares = 0.0F, along_squares = 0.0F;
  for (const DeckSidePoint& p : points) {
    const float along = line.along(p.x, p.y), across = line.across(p.x, p.y);
    spread.low = std::min(spread.low, along);
    spread.high = std::max(spread.high, along);
    along_squares += along * along;
    across_squares += across * across;
  }
  // Its variance at a distance s from the middle is v (1 / n + s^2 / sum of squared s).
  const auto n = static_cast<float>(points.size());
  const float v = std::max(across_squares / (n - 2.0F), kLeastSigma * kLeastSigma);
  const float sigma = reach / kDeviations;
  spread.known = std::sqrt(along_squares * std::max(sigma * sigma / v - 1.0F / n, 0.0F));
  return spread;
}

// Moves the middle of a line to that of its points, and gives it their length.
void lay_along(const Spread& spread, DeckSide& side) {
  const float middle = 0.5F * (spread.low + spread.high);
  side.x += middle * side.along_x;
  side.y += middle * side.along_y;
  side.half_length = 0.5F * (spread.high - spread.low);
}

// Whether a share of what lies in the strip along a side, up to `strip` metres off, is on its line.
bool has_most_of_strip(const DeckSide& side, PointRange points, float reach, float strip,
                       float share) {
  std::size_t on = 0, all = 0;
  for (const DeckSidePoint& p : points) {
    if (std::abs(side.along(p.x, p.y)) > side.half_length) continue;
    const float across = std::abs(side.across(p.x, p.y));
    on += across <= reach ? 1U : 0U;
    all += across <= strip ? 1U : 0U;
  }
  return static_cast<float>(on) >= share * static_cast<float>(all);
}

// Makes a side of the points of a stretch, if it is one.
// \param points that are in no stretch yet
bool settle_side(PointRange stretch, PointRange points, float reach, DeckSide& side) {
  if (stretch.size() < kFewest) return false;
  side = fit_line(stretch);
  const Spread spread = spread_of(side, stretch, reach);
  lay_along(spread, side);
  if (side.half_length < 0.5F * kShortest) return false;
  if (!has_most_of_strip(side, points, reach, kStrip * reach, kSharp)) return false;
  side.half_length =
      std::clamp(spread.known, side.half_length + kLeastBeyond, side.half_length + kMostBeyond);
  return true;
}

// Bend of the parabola through values over the points of a line, about the middle of which places
// along it are taken: what its middle is above the ends of the line.
template <class ValueOf>
float bend_of(const DeckSide& line, PointRange points, float length, ValueOf&& value_of) {
  float n = 0.0F, squares = 0.0F, cubes = 0.0F;
  for (const DeckSidePoint& p : points) {
    const float t = line.along(p.x, p.y);
    n += 1.0F;
    squares += t * t;
    cubes += t * t * t;
  }
  float product = 0.0F, norm = 0.0F;
  for (const DeckSidePoint& p : points) {
    const float t = line.along(p.x, p.y);
    // t^2 without what a straight line explains of it.
    const float bent = t * t - squares / n - t * cubes / squares;
    product += bent * value_of(p);
    norm += bent * bent;
  }
  return -0.25F * length * length * product / norm;
}

// Makes a side of a stretch of the surface, if it is a ring alone that runs along an upright face.
// \param points of the whole surface
bool settle_ring(PointRange stretch, PointRange points, float reach, DeckSide& side) {
  if (stretch.size() < kFewestOfRing) return false;
  side = fit_line(stretch);
  const Spread spread = spread_of(side, stretch, reach);
  const float length = spread.high - spread.low;
  const float z = stretch.begin()->z;
  const float fall =
      bend_of(side, stretch, length, [z](const DeckSidePoint& p) { return p.z - z; });
  const float bend = bend_of(side, stretch, length,
                             [&side](const DeckSidePoint& p) { return side.across(p.x, p.y); });
  if (!(fall >= kLeastFall && fall >= kSteepFace * std::abs(bend))) return false;
  lay_along(spread, side);
  return has_most_of_strip(side, points, reach, kStripOfRing, kAlone);
}

// Keeps every n-th point, so that no deck takes long.
PointRange thin_out(PointRange points, std::size_t most) {
  const std::size_t step = (points.size() + most - 1) / most;
  if (step < 2) return points;
  auto kept = points.begin();
  for (std::size_t i = 0; i < points.size(); i += step)
    *kept++ = points.begin()[static_cast<std::ptrdiff_t>(i)];
  return {points.begin(), kept};
}

// Seeks up to `most` sides of at least `fewest` points each in those of one deck; `settle` tells
// which stretches are some.
template <class Settle>
void find_sides_of_deck(PointRange points, int most, std::size_t fewest, float reach,
                        Settle&& settle, std::vector<DeckSide>& sides) {
  RandomGenerator random(1);
  for (int k = 0; k < most && points.size() >= fewest; ++k) {
    DeckSide side;
    if (!find_line(points, reach, random, side)) return;
    PointRange stretch = take_stretch(side, points, reach);
    stretch = take_stretch(fit_line(stretch), points, reach);
    if (settle(stretch, points, reach, side)) sides.push_back(side);
    points.first = stretch.last;
  }
}

// Most of them come cell by cell. Their numbers are spread over those of the scan, so that few fall
// into one bucket.
void put_in_scan_order(std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets) {
  const auto less = [](const DeckSidePoint& a, const DeckSidePoint& b) {
    return a.point < b.point;
  };
  if (std::is_sorted(points.begin(), points.end(), less)) return;
  const auto ends = std::minmax_element(points.begin(), points.end(), less);
  const std::int32_t first = ends.first->point, last = ends.second->point;
  const double share = static_cast<double>(points.size()) / (1.0 + last - first);
  sort_in_buckets(
      points.size(),
      [first, share](const DeckSidePoint& p) {
        return static_cast<std::size_t>(share * (p.point - first));
      },
      less, points, buckets.points, buckets.end);
}

// Calls `visit` with the points of every deck that has at least `fewest`, in their order in the
// scan.
template <class Visitor>
void for_each_deck(std::size_t fewest, std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets,
                   Visitor&& visit) {
  put_in_scan_order(points, buckets);
  std::int32_t decks = 0;
  for (const DeckSidePoint& p : points) decks = std::max(decks, p.deck + 1);
  put_into_buckets(
      static_cast<std::size_t>(decks),
      [](const DeckSidePoint& p) { return static_cast<std::size_t>(p.deck); }, points,
      buckets.points, buckets.end);
  PointRange of_deck{points.begin(), points.begin()};
  for (std::size_t deck = 0; deck < static_cast<std::size_t>(decks); ++deck) {
    of_deck = {of_deck.last, points.begin() + buckets.end[deck]};
    if (of_deck.size() >= fewest) visit(of_deck);
  }
}

}  // namespace

void find_deck_sides(float reach, std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets,
                     std::vector<DeckSide>& sides) {
  sides.clear();
  for_each_deck(kFewest, points, buckets, [&](PointRange of_deck) {
    find_sides_of_deck(thin_out(of_deck, kMostPoints), kMostSides, kFewest, reach, settle_side,
                       sides);
  });
}

void find_side_rings(float reach, std::vector<DeckSidePoint>& points, DeckSideBuckets& buckets,
                     std::vector<DeckSide>& sides) {
  for_each_deck(kFewestOfRing, points, buckets, [&](PointRange of_deck) {
    const PointRange all = thin_out(of_deck, kMostRingPoints);
    const auto settle = [all](PointRange stretch, PointRange, float off, DeckSide& side) {
      return settle_ring(stretch, all, off, side);
    };
    find_sides_of_deck(all, kMostRings, kFewestOfRing, reach, settle, sides);
  });
  std::sort(sides.begin(), sides.end(),
            [](const DeckSide& a, const DeckSide& b) { return a.deck < b.deck; });
}

bool is_on_side(const std::vector<DeckSide>& sides, std::int32_t deck, float x, float y,
                float reach) {
  const auto first = std::lower_bound(
      sides.begin(), sides.end(), deck,
      [](const DeckSide& side, std::int32_t number) { return side.deck < number; });
  for (auto side = first; side != sides.end() && side->deck == deck; ++side) {
    if (std::abs(side->along(x, y)) <= side->half_length && std::abs(side->across(x, y)) <= reach)
      return true;
  }
  return false;
}

}  // namespace mrpt_terrain
