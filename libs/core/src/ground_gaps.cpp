// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_gaps.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mrpt_terrain {
namespace {

constexpr int kRays = 360;
constexpr double kRayStep = 2.0 * M_PI / kRays;
// Along a ray, cells are looked up at every so many of their sides: no ring slips through.
constexpr float kStride = 0.7F;
// Of the sensor, where its place is not known, metres.
constexpr float kAssumedHeight = 1.0F;
// Rays end here, metres.
constexpr float kFarthest = 40.0F;
// Ground before a place counts 1/e at this distance, metres...
constexpr float kMemory = 2.0F;
// ...and tells how it goes on if there are so many cells over so much.
constexpr int kFewestCells = 4;
constexpr float kShortestGround = 0.8F;
// What is so far from the line may be ground: so much everywhere, metres, and so many times what
// the ground was off before.
constexpr float kUneven = 0.05F, kDeviations = 3.0F;
// Things stand so far above the line, metres.
constexpr float kStanding = 0.12F;
// What begins so far above the sensor hides nothing, metres.
constexpr float kHanging = 0.2F;
// A layer of ground is no thicker, metres.
constexpr float kLayer = 0.15F;
// A drop is so many times as deep as ground may be off.
constexpr float kClear = 2.0F;
// Behind an edge, ground is followed back from so much of it, metres...
constexpr float kFarGround = 2.5F;
// ...if it is seen over so much, metres, and over this share of the gap...
constexpr float kShortestFar = 0.6F, kShareOfGap = 0.25F;
// ...if not, the fall to it must be steeper than ground is.
constexpr float kSteepest = 0.7F;
// Behind a ditch, the ground is back at its level but for so much of the depth.
constexpr float kBackAgain = 0.5F;
// On the way into a ditch, what is seen falls so much at least, metres per metre.
constexpr float kLeastChord = 0.08F;
// Of what the beams behind show lower, the ground must lie so much lower where it is followed back.
constexpr float kApartShare = 0.6F;
// Rays of one hole are at most so many apart, and their edges so far: metres, and per metre.
constexpr int kRaysApart = 3;
constexpr float kEdgesApart = 0.5F, kEdgesGrowth = 0.2F;
// Share of the rays of a hole that show it.
constexpr float kShown = 0.6F;
constexpr int kFewestRays = 4;
// Behind an edge so much is part of the drop, metres.
constexpr float kStrip = 0.4F;
// Where nothing comes back, ground may bend down by so much, and so many times the deviation of the
// slopes around.
constexpr float kLeastBend = 0.03F;
constexpr double kBends = 2.0;
// Rays beside one that must show no thing, where nothing comes back.
constexpr int kShadowRays = 2;
// Confidence where nothing came back: water swallows beams as well.
constexpr float kNothingBack = 0.5F;
// ...and it must be so many times as wide.
constexpr double kUnseenWidth = 2.0;
// Share of the rays that tells how flat beams still come back from the ground.
constexpr double kReachShare = 0.1;

struct Origin {
  float x, y, z;
};

Origin origin_of(const HoleInput& input) {
  // Of the points of many scans, the last one's come first.
  const std::size_t n = std::min(input.field.points.support.size(), input.origins.measured);
  if (!input.origins.known() || n == 0) return {0.0F, 0.0F, kAssumedHeight};
  const auto& origin = input.origins.of(n / 2);
  return {origin[0], origin[1], origin[2]};
}

/// A line through heights over ranges, the last ones counting most.
class GroundLine {
 public:
  void clear() { *this = {}; }
  void add(float range, float height) {
    const float gap = cells_ == 0 ? 0.0F : range - last_;
    if (cells_ == 0) first_ = range;
    if (cells_ >= 2) {
      const float off = std::abs(height - at(range));
      off_ += kShareOfNew * (off - off_);
      gap_ += kShareOfNew * (gap - gap_);
    }
    const float keep = kMemory / (kMemory + gap);
    weight_ = keep * weight_ + 1.0F;
    const float dr = range - range_, share = 1.0F / weight_;
    range_ += share * dr;
    height_ += share * (height - height_);
    rr_ = keep * rr_ + dr * (range - range_);
    rz_ = keep * rz_ + dr * (height - height_);
    last_ = range;
    ++cells_;
  }
  [[nodiscard]] bool tells() const {
    return cells_ >= kFewestCells && last_ - first_ >= kShortestGround;
  }
  [[nodiscard]] int cells() const { return cells_; }
  [[nodiscard]] float first() const { return first_; }
  [[nodiscard]] float last() const { return last_; }
  [[nodiscard]] float slope() const { return rr_ > 1e-6F ? rz_ / rr_ : 0.0F; }
  [[nodiscard]] float at(float range) const { return height_ + slope() * (range - range_); }
  /// How far ground may be off at a range.
  [[nodiscard]] float tolerance(float range) const {
    const float gaps = (range - last_) / std::max(gap_, 0.1F);
    return kUneven + kDeviations * off_ * std::max(1.0F, gaps);
  }

 private:
  static constexpr float kShareOfNew = 0.2F;
  int cells_ = 0;
  float first_ = 0.0F, last_ = 0.0F;
  float weight_ = 0.0F, range_ = 0.0F, height_ = 0.0F, rr_ = 0.0F, rz_ = 0.0F;
  float off_ = 0.01F, gap_ = 0.2F;
};

/// What a ray meets in a cell.
struct Met {
  float range;
  std::int32_t slot;
  float low, mean, high;
  bool ground;  // nothing but that, by the labels
};

/// Falls of the last rings, and how far apart they are.
struct RingSpacing {
  float fall = 0.0F;
  std::array<float, 3> step{};

  void add(float next) {
    if (fall > 0.0F) step = {std::max(fall - next, 0.0F), step[0], step[1]};
    fall = next;
  }
  [[nodiscard]] float greatest() const { return std::max({step[0], step[1], step[2]}); }
};

/// Follows one ray.
class RayWalk {
 public:
  RayWalk(const GapParams& params, std::int32_t ray, float sensor, GapWorkspace& workspace)
      : params_(params), ray_(ray), sensor_(sensor), workspace_(workspace) {}

  void meet(const Met& met) {
    if (met.low > sensor_ + kHanging) return;
    if (!near_.tells()) return start(met);
    const float level = near_.at(met.range);
    const float tolerance = near_.tolerance(met.range);
    if (met.high > level + kStanding + tolerance) {
      meet_thing(met);
    } else if (level - met.mean > std::min(tolerance, low_ > 0 ? kBackAgain * depth_ : tolerance)) {
      meet_low(met, level - met.low, tolerance);
    } else if (met.mean - level > tolerance) {
      meet_thing(met);
      start(met);
    } else {
      meet_ground(met);
    }
  }
  // Where it is not known what beams have met, nothing is missing.
  void meet_stray(float range) { note_thing(range); }
  void end() { close(flattest()); }

 private:
  // Ground begins with layers that follow each other.
  void start(const Met& met) {
    const bool layer = met.ground && met.high - met.low <= kLayer;
    const float rise = near_.cells() == 0 ? 0.0F : std::abs(met.mean - near_.at(near_.last()));
    const bool follows = rise <= kLayer + kSteepest * (met.range - near_.last());
    if (!layer) note_thing(met.range);
    if (!layer || !follows) restart();
    if (layer) add_ground(met);
  }
  void add_ground(const Met& met) {
    near_.add(met.range, met.mean);
    spacing_.add((sensor_ - met.mean) / met.range);
    if (!near_.tells()) return;
    GapRay& ray = workspace_.rays[static_cast<std::size_t>(ray_)];
    ray.flattest = std::min(ray.flattest, spacing_.fall);
    const auto off = static_cast<double>(near_.slope() - ray.slope);
    ray.squares += off * off;
    ray.cells += 1.0;
  }
  void note_thing(float range) {
    float& nearest = workspace_.rays[static_cast<std::size_t>(ray_)].nearest_thing;
    nearest = std::min(nearest, range);
  }

  void meet_thing(const Met& met) {
    close((sensor_ - met.low) / met.range);
    note_thing(met.range);
    restart();
  }

  void meet_ground(const Met& met) {
    if (low_ > 0) {
      if (is_ditch(met.range)) {
        workspace_.events.push_back(event_of(HoleKind::kGap, far_));
        keep_low_slots();
      }
      forget_low();
    }
    add_ground(met);
  }
  [[nodiscard]] bool is_ditch(float behind) const {
    return behind - near_.last() <= static_cast<float>(params_.widest) &&
           depth_ >= static_cast<float>(params_.least_depth) && chord_ >= kLeastChord;
  }

  void meet_low(const Met& met, float depth, float tolerance) {
    const float fall = (sensor_ - met.mean) / met.range;
    if (fall < flattest()) return;
    if (low_ == 0) {
      begin_ = std::clamp(range_of(fall), near_.last(), met.range);
      tolerance_ = tolerance;
      chord_ = depth / std::max(met.range - near_.last(), kShortestStep);
    }
    depth_ = std::max(depth_, depth);
    far_ = met.range;
    if (low_ < kMostLow) slots_[static_cast<std::size_t>(low_)] = met.slot;
    ++low_;
    behind_.add(met.range, met.mean);
    const float seen = met.range - behind_.first();
    if (seen < kFarGround || met.range - near_.last() < static_cast<float>(params_.widest)) return;
    close(spacing_.fall);
    restart();
    start(met);
  }

  // Where a beam meets the line, or far away.
  [[nodiscard]] float range_of(float fall) const {
    constexpr float kFarAway = 1e3F, kParallel = 1e-3F;
    const float closing = fall + near_.slope();
    return closing < kParallel ? kFarAway : (sensor_ - near_.at(0.0F)) / closing;
  }
  // Fall of the flattest beams that are looked at.
  [[nodiscard]] float flattest() const {
    return static_cast<float>(params_.least_fall) - near_.slope();
  }

  [[nodiscard]] GapEvent event_of(HoleKind kind, float far) const {
    return {ray_, kind, near_.last(), begin_, far, depth_, tolerance_, 0.0F, -1};
  }

  // The ground before does not go on, as far as is seen. `fall`: of the next beam that came back.
  void close(float fall) {
    if (near_.tells()) {
      if (low_ > 0 && is_apart())
        workspace_.events.push_back(event_of(HoleKind::kDrop, far_));
      else if (low_ == 0)
        note_missing(fall);
    }
    forget_low();
  }

  // Whether the ground behind, followed back, does not meet the ground before.
  [[nodiscard]] bool is_apart() const {
    const auto least = static_cast<float>(params_.drop_depth);
    if (depth_ < std::max(least, kClear * tolerance_)) return false;
    const float edge = near_.last(), seen = behind_.last() - behind_.first();
    if (seen < kShortestFar || seen < kShareOfGap * (behind_.first() - edge))
      return chord_ >= kSteepest;
    return near_.at(edge) - behind_.at(edge) >= std::max(least, kApartShare * depth_);
  }

  // Rings that should have met the ground behind the last one, and came back from nowhere.
  void note_missing(float fall) {
    const float step = spacing_.greatest();
    if (step <= 0.0F) return;
    const float first = spacing_.fall - step;
    const float last = first - static_cast<float>(params_.missing - 1) * step;
    if (last < std::max(fall + 0.5F * step, flattest())) return;
    begin_ = range_of(first);
    GapEvent event = event_of(HoleKind::kDrop, range_of(last));
    event.fall = last;
    event.tolerance = last + near_.slope();
    workspace_.events.push_back(event);
  }

  void forget_low() {
    low_ = 0;
    depth_ = 0.0F;
    behind_.clear();
  }
  void restart() {
    near_.clear();
    spacing_ = {};
    forget_low();
  }
  void keep_low_slots() {
    const auto event = static_cast<std::int32_t>(workspace_.events.size()) - 1;
    for (int k = 0; k < std::min(low_, kMostLow); ++k)
      workspace_.low.push_back({slots_[static_cast<std::size_t>(k)], event});
  }

  static constexpr int kMostLow = 32;
  static constexpr float kShortestStep = 0.05F;
  const GapParams& params_;
  std::int32_t ray_;
  float sensor_;
  GapWorkspace& workspace_;
  GroundLine near_, behind_;
  RingSpacing spacing_;
  int low_ = 0;
  float begin_ = 0.0F, far_ = 0.0F, depth_ = 0.0F, tolerance_ = 0.0F, chord_ = 0.0F;
  std::array<std::int32_t, kMostLow> slots_{};
};

/// The rays of a scan over its grid.
struct Rays {
  const HoleInput& input;
  const FieldCells& cells;
  const GapParams& params;
  Origin origin;
};

// Cells of reflections hold points below ground that is seen.
bool is_stray(const Rays& rays, const GroundSegmentation& ground, std::size_t slot) {
  return rays.cells.below[slot] > 0 && ground.rule[slot] == GroundRule::kGround;
}

void walk(const Rays& rays, const GroundSegmentation& ground, std::int32_t ray,
          GapWorkspace& workspace) {
  const ElevationGrid& grid = rays.input.grid;
  const auto side = static_cast<float>(grid.geometry.cell_size());
  const float per_metre = 1.0F / side;
  const auto r = static_cast<std::size_t>(ray);
  const float step_l = kStride * workspace.rays[r].x;
  const float step_w = kStride * workspace.rays[r].y;
  float l = (rays.origin.x + static_cast<float>(grid.geometry.half_length())) * per_metre;
  float w = (rays.origin.y + static_cast<float>(grid.geometry.half_width())) * per_metre;
  const auto end_l = static_cast<float>(grid.geometry.cells_l());
  const auto end_w = static_cast<float>(grid.geometry.cells_w());
  const float height =
      rays.origin.z - rays.input.field.surface.height_at(rays.origin.x, rays.origin.y);
  const float farthest = std::min(
      kFarthest, 1.3F * std::max(height, 0.2F) / static_cast<float>(rays.params.least_fall));
  const int steps = static_cast<int>(farthest / (kStride * side));
  RayWalk ray_walk(rays.params, ray, rays.origin.z, workspace);
  Slot before = kUnobserved;
  for (int n = 0; n < steps; ++n, l += step_l, w += step_w) {
    if (!(l >= 0.0F && w >= 0.0F && l < end_l && w < end_w)) break;
    const std::int32_t id = (static_cast<std::int32_t>(l) + 1) * grid.geometry.stride() +
                            static_cast<std::int32_t>(w) + 1;
    const Slot slot = grid.slot_of[static_cast<std::size_t>(id)];
    if (slot == kUnobserved || slot == before) continue;
    before = slot;
    const auto s = static_cast<std::size_t>(slot);
    const float range = (static_cast<float>(n) + 0.5F) * kStride * side;
    if (is_stray(rays, ground, s)) {
      ray_walk.meet_stray(range);
      continue;
    }
    if (workspace.rays[r].steepest == 0.0F)
      workspace.rays[r].steepest = (rays.origin.z - grid.h_mean[s]) / range;
    const bool only_ground = rays.cells.on[s] > 0 && rays.cells.above[s] == 0;
    ray_walk.meet({range, slot, grid.h_min[s], grid.h_mean[s], grid.h_max[s], only_ground});
  }
  ray_walk.end();
}

void start_rays(const GroundSurface& surface, GapWorkspace& workspace) {
  constexpr float kNone = std::numeric_limits<float>::max();
  workspace.rays.resize(kRays);
  for (std::size_t k = 0; k < kRays; ++k) {
    GapRay& ray = workspace.rays[k];
    const double azimuth = static_cast<double>(k) * kRayStep;
    // Directions stay the same from scan to scan.
    if (ray.x == 0.0F && ray.y == 0.0F) {
      ray.x = static_cast<float>(std::cos(azimuth));
      ray.y = static_cast<float>(std::sin(azimuth));
    }
    ray.slope = surface.gradient_x * ray.x + surface.gradient_y * ray.y;
    ray.nearest_thing = ray.flattest = kNone;
    ray.steepest = 0.0F;
    ray.squares = ray.cells = 0.0;
  }
}

/// How falls change with the azimuth on a sensor that is tilted: fall + x ray.x + y ray.y.
struct Tilt {
  double x = 0.0, y = 0.0;
  [[nodiscard]] float level(float fall, const GapRay& ray) const {
    return fall -
           static_cast<float>(x * static_cast<double>(ray.x) + y * static_cast<double>(ray.y));
  }
};

// The steepest beams are of one ring, in all directions that they come back from. Least squares,
// repeatedly without those that are off.
Tilt find_tilt(const std::vector<GapRay>& rays) {
  constexpr int kRounds = 4;
  constexpr double kNarrowest = 0.02, kNarrower = 0.5;
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  double band = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity() * 1e-6;
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double squares = 0.0, n = 0.0;
    for (const GapRay& ray : rays) {
      if (ray.steepest <= 0.0F) continue;
      const Eigen::Vector3d v(1.0, static_cast<double>(ray.x), static_cast<double>(ray.y));
      const double off = static_cast<double>(ray.steepest) - fit.dot(v);
      if (std::abs(off) > band) continue;
      a += v * v.transpose();
      b += static_cast<double>(ray.steepest) * v;
      squares += round == 0 ? 0.0 : off * off;
      n += 1.0;
    }
    fit = a.ldlt().solve(b);
    if (round == 0) {
      band = 0.2;
    } else {
      band = std::max(kNarrowest,
                      std::min(kNarrower * band, 2.0 * std::sqrt(squares / std::max(n, 1.0))));
    }
  }
  return {fit.y(), fit.z()};
}

// Standard deviation of the slopes of the ground from those of the plane near the robot.
double slopes_apart(const std::vector<GapRay>& rays) {
  double squares = 0.0, cells = 0.0;
  for (const GapRay& ray : rays) {
    squares += ray.squares;
    cells += ray.cells;
  }
  return std::sqrt(squares / std::max(cells, 1.0));
}

/// What tells whether beams should have come back.
struct Reach {
  Tilt tilt;
  float flattest;  // beams as steep come back from the ground in some directions, tilt taken off
  float bend;      // the ground may bend down by so much
};

Reach find_reach(GapWorkspace& workspace) {
  Reach reach{find_tilt(workspace.rays), std::numeric_limits<float>::max(), 0.0F};
  reach.bend = kLeastBend + static_cast<float>(kBends * slopes_apart(workspace.rays));
  std::vector<float>& falls = workspace.values;
  falls.clear();
  for (const GapRay& ray : workspace.rays) {
    if (ray.cells > 0.0) falls.push_back(reach.tilt.level(ray.flattest, ray));
  }
  if (falls.empty()) return reach;
  const auto at =
      falls.begin() + static_cast<std::ptrdiff_t>(kReachShare * static_cast<double>(falls.size()));
  std::nth_element(falls.begin(), at, falls.end());
  reach.flattest = *at;
  return reach;
}

// Whether nothing comes back although it should: no thing hides the ground, beams as flat come back
// elsewhere, and the ground would have to bend more than it does.
bool is_missing(const GapEvent& event, const Reach& reach, const std::vector<GapRay>& rays) {
  if (event.tolerance < reach.bend) return false;
  if (reach.tilt.level(event.fall, rays[static_cast<std::size_t>(event.ray)]) < reach.flattest)
    return false;
  for (int beside = -kShadowRays; beside <= kShadowRays; ++beside) {
    const int ray = (event.ray + beside + kRays) % kRays;
    if (rays[static_cast<std::size_t>(ray)].nearest_thing < event.far) return false;
  }
  return true;
}

void check_missing(GapWorkspace& workspace) {
  const Reach reach = find_reach(workspace);
  for (GapEvent& event : workspace.events) {
    if (event.kind != HoleKind::kDrop || event.depth > 0.0F) continue;
    if (!is_missing(event, reach, workspace.rays)) event.ray = -1;
  }
}

bool belong_together(const GapEvent& a, const GapEvent& b) {
  const int apart = std::abs(a.ray - b.ray);
  return a.kind == b.kind && std::min(apart, kRays - apart) <= kRaysApart &&
         std::abs(a.near - b.near) <= kEdgesApart + kEdgesGrowth * std::min(a.near, b.near);
}

std::int32_t root_of(const std::vector<GapEvent>& events, std::int32_t k) {
  while (events[static_cast<std::size_t>(k)].group != k)
    k = events[static_cast<std::size_t>(k)].group;
  return k;
}

// Events are in the order of their rays. The first of a group is its root.
void group_events(std::vector<GapEvent>& events) {
  const auto n = static_cast<std::int32_t>(events.size());
  for (std::int32_t k = 0; k < n; ++k) events[static_cast<std::size_t>(k)].group = k;
  for (std::int32_t k = 0; k < n; ++k) {
    const GapEvent& event = events[static_cast<std::size_t>(k)];
    if (event.ray < 0) continue;
    for (std::int32_t step = 1; step < n; ++step) {
      const std::int32_t other = (k + step) % n;
      const GapEvent& next = events[static_cast<std::size_t>(other)];
      if (next.ray >= 0 && (next.ray - event.ray + kRays) % kRays > kRaysApart) break;
      if (next.ray < 0 || !belong_together(event, next)) continue;
      const std::int32_t a = root_of(events, k), b = root_of(events, other);
      events[static_cast<std::size_t>(std::max(a, b))].group = std::min(a, b);
    }
  }
  for (std::int32_t k = 0; k < n; ++k)
    events[static_cast<std::size_t>(k)].group = root_of(events, k);
}

/// A group of events: `order[first]` to `order[last - 1]`, ray by ray.
struct GapGroup {
  const GapWorkspace& workspace;
  std::size_t first, last;

  [[nodiscard]] std::size_t size() const { return last - first; }
  [[nodiscard]] std::int32_t number(std::size_t k) const { return workspace.order[first + k]; }
  [[nodiscard]] const GapEvent& event(std::size_t k) const {
    return workspace.events[static_cast<std::size_t>(number(k))];
  }
  /// Share of the rays between the outermost ones that show it. The widest gap between rays is
  /// outside.
  [[nodiscard]] double shown() const {
    int widest = event(0).ray + kRays - event(size() - 1).ray, rays = 1;
    for (std::size_t k = 1; k < size(); ++k) {
      const int step = event(k).ray - event(k - 1).ray;
      widest = std::max(widest, step);
      rays += step > 0 ? 1 : 0;
    }
    return rays / static_cast<double>(kRays - widest + 1);
  }
  /// Extent across the beams, metres.
  [[nodiscard]] double across() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < size(); ++k) sum += static_cast<double>(event(k).begin) * kRayStep;
    return sum;
  }
};

bool is_shown(const GapGroup& group, const GapParams& params) {
  const bool seen = group.event(0).kind != HoleKind::kDrop || group.event(0).depth > 0.0F;
  return group.size() >= kFewestRays && group.shown() >= kShown &&
         group.across() >= (seen ? 1.0 : kUnseenWidth) * params.least_width;
}

// Depth that a fifth of the rays exceed.
double depth_of(const GapGroup& group, std::vector<float>& values) {
  values.clear();
  for (std::size_t k = 0; k < group.size(); ++k) values.push_back(group.event(k).depth);
  const auto fifth = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 4 / 5);
  std::nth_element(values.begin(), fifth, values.end());
  return static_cast<double>(*fifth);
}

HoleDescription describe_gap(const Rays& rays, const GapGroup& group, GapWorkspace& workspace) {
  HoleDescription result;
  result.kind = group.event(0).kind;
  const double share = 1.0 / static_cast<double>(group.size());
  double across = group.across(), along = 0.0, clear = 0.0;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const GapEvent& event = group.event(k);
    const auto ray = static_cast<std::size_t>(event.ray);
    const double middle = 0.5 * static_cast<double>(event.begin + event.far);
    result.centre.x += share * middle * static_cast<double>(workspace.rays[ray].x);
    result.centre.y += share * middle * static_cast<double>(workspace.rays[ray].y);
    along += share * static_cast<double>(event.far - event.begin);
    clear += share * static_cast<double>(event.depth > 0.0F ? 1.0F - event.tolerance / event.depth
                                                            : kNothingBack);
  }
  result.centre.x += static_cast<double>(rays.origin.x);
  result.centre.y += static_cast<double>(rays.origin.y);
  result.length = std::max(across, along);
  result.width = std::min(across, along);
  result.depth = depth_of(group, workspace.values);
  result.confidence = group.shown() * std::max(clear, 0.0);
  return result;
}

void add_cells(const Rays& rays, const GapEvent& event, const GapWorkspace& workspace,
               std::vector<std::int32_t>& cells) {
  const GridGeometry& geometry = rays.input.grid.geometry;
  const auto ray = static_cast<std::size_t>(event.ray);
  const float end = event.kind == HoleKind::kDrop ? event.begin + kStrip : event.far;
  const float step = 0.5F * static_cast<float>(geometry.cell_size());
  for (float range = event.begin; range <= end; range += step) {
    CellIndex cell;
    const float x = rays.origin.x + range * workspace.rays[ray].x;
    const float y = rays.origin.y + range * workspace.rays[ray].y;
    if (geometry.cell_at(static_cast<double>(x), static_cast<double>(y), cell))
      cells.push_back(value_of(geometry.id_of(cell)));
  }
}

bool is_cell_of_hole(const IndexRows& hole_cells, CellId cell) {
  for (std::size_t k = 0; k < hole_cells.rows(); ++k) {
    const IndexRange row = hole_cells.row(k);
    if (std::binary_search(row.begin(), row.end(), value_of(cell))) return true;
  }
  return false;
}

/// Calls f(slot) for the low cells of a group.
template <class F>
void for_low(const GapGroup& group, F&& f) {
  const std::vector<GapLow>& low = group.workspace.low;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const std::int32_t number = group.number(k);
    auto at = std::lower_bound(low.begin(), low.end(), number,
                               [](const GapLow& cell, std::int32_t n) { return cell.event < n; });
    for (; at != low.end() && at->event == number; ++at) f(static_cast<std::size_t>(at->slot));
  }
}

// Whether most of what is seen in a ditch is of a hole that was found before.
bool is_known(const Rays& rays, const GapGroup& group, const IndexRows& hole_cells) {
  int all = 0, known = 0;
  for_low(group, [&](std::size_t slot) {
    ++all;
    known += is_cell_of_hole(hole_cells, rays.input.grid.cell[slot]) ? 1 : 0;
  });
  return 2 * known > all;
}

void add_hole(const Rays& rays, const GapGroup& group, GapWorkspace& workspace,
              GroundSegmentation& ground, std::vector<HoleDescription>& holes,
              IndexRows& hole_cells) {
  HoleDescription hole = describe_gap(rays, group, workspace);
  const auto first = static_cast<std::ptrdiff_t>(hole_cells.items.size());
  for (std::size_t k = 0; k < group.size(); ++k)
    add_cells(rays, group.event(k), workspace, hole_cells.items);
  for_low(group, [&](std::size_t slot) {
    hole_cells.items.push_back(value_of(rays.input.grid.cell[slot]));
    ground.rule[slot] = GroundRule::kLow;
    const auto number = static_cast<std::int32_t>(slot);
    hole.slot = hole.slot < 0 ? number : std::min(hole.slot, number);
  });
  const auto begin = hole_cells.items.begin() + first;
  std::sort(begin, hole_cells.items.end());
  hole_cells.items.erase(std::unique(begin, hole_cells.items.end()), hole_cells.items.end());
  hole_cells.first.push_back(static_cast<std::int32_t>(hole_cells.items.size()));
  holes.push_back(hole);
}

// Events by group, and in a group by their numbers.
void sort_by_group(GapWorkspace& workspace) {
  const std::vector<GapEvent>& events = workspace.events;
  workspace.order.clear();
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (events[k].ray >= 0) workspace.order.push_back(static_cast<std::int32_t>(k));
  }
  std::sort(workspace.order.begin(), workspace.order.end(),
            [&events](std::int32_t a, std::int32_t b) {
              const std::int32_t of_a = events[static_cast<std::size_t>(a)].group;
              const std::int32_t of_b = events[static_cast<std::size_t>(b)].group;
              return of_a != of_b ? of_a < of_b : a < b;
            });
}

}  // namespace

void find_gaps(const HoleInput& input, const FieldCells& cells, const GapParams& params,
               GapWorkspace& workspace, GroundSegmentation& ground,
               std::vector<HoleDescription>& holes, IndexRows& hole_cells) {
  const Rays rays{input, cells, params, origin_of(input)};
  start_rays(input.field.surface, workspace);
  workspace.events.clear();
  workspace.low.clear();
  for (std::int32_t ray = 0; ray < kRays; ++ray) walk(rays, ground, ray, workspace);
  check_missing(workspace);
  group_events(workspace.events);
  sort_by_group(workspace);
  const std::vector<std::int32_t>& order = workspace.order;
  const auto group_at = [&](std::size_t k) {
    return workspace.events[static_cast<std::size_t>(order[k])].group;
  };
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    for (last = first; last < order.size() && group_at(last) == group_at(first);) ++last;
    const GapGroup group{workspace, first, last};
    if (!is_shown(group, params) || is_known(rays, group, hole_cells)) continue;
    add_hole(rays, group, workspace, ground, holes, hole_cells);
  }
}

}  // namespace mrpt_terrain
