// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/families.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "family_fields.h"
#include "holes.h"
#include "mrpt_terrain/core/random.h"
#include "polygon.h"
#include "solid_bodies.h"

namespace mrpt_terrain::sim {
namespace {

constexpr int kTries = 40;
// Between two things, so that walls of holes and sides of solids never touch.
constexpr double kGap = 0.1;
// Of the sides of ramps, which the corridor must lie between.
constexpr double kThinSide = 0.01;
constexpr std::uint32_t kSeedHalf = 1U << 20U;

/// Which share of the random numbers a part of the world has, so that a change to one part leaves
/// the others as they are. Types of things count on from kThings.
enum Part : std::uint64_t { kGroundPart, kVehiclePart, kPathPart, kSensorPart, kThings };

// FNV-1a: worlds of the same seed in different families have nothing in common.
std::uint64_t hash_of(const std::string& name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char letter : name) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  }
  return hash;
}

RandomGenerator generator_of(const Family& family, std::uint64_t seed, std::uint64_t part) {
  return RandomGenerator(seed, (hash_of(family.name) & 0xFFFFFFFFFFFFULL) * 64U + part);
}

double between(double low, double high, RandomGenerator& random) {
  return low + (high - low) * random.uniform();
}
int between(int low, int high, RandomGenerator& random) {
  return low + static_cast<int>(random.below(static_cast<std::uint32_t>(high - low) + 1U));
}

/// Draws one field; `result` holds the lowest value when it comes in. Every field takes its random
/// numbers, whether its range is empty or not.
void draw(const params::Field& high, params::Field& result, RandomGenerator& random) {
  if (auto* seed = std::get_if<std::uint64_t*>(&result.value)) {
    **seed = random.below(kSeedHalf) * std::uint64_t{kSeedHalf} + random.below(kSeedHalf);
  } else if (auto* real = std::get_if<double*>(&result.value)) {
    **real = between(**real, *std::get<double*>(high.value), random);
  } else if (auto* whole = std::get_if<int*>(&result.value)) {
    **whole = between(**whole, *std::get<int*>(high.value), random);
  } else if (auto* flag = std::get_if<bool*>(&result.value)) {
    if (random.below(2) == 1) **flag = *std::get<bool*>(high.value);
  } else if (auto* word = std::get_if<params::EnumField>(&result.value)) {
    const auto& other = std::get<params::EnumField>(high.value);
    if (random.below(2) == 1) word->assign(word->value, other.name(other.value));
  }
}

void draw_all(const std::vector<params::Field>& high, std::vector<params::Field> result,
              RandomGenerator& random) {
  for (std::size_t k = 0; k < result.size(); ++k) draw(high[k], result[k], random);
}

template <class Params>
Params drawn(const Span<Params>& span, RandomGenerator random) {
  Params high = span.high;
  Params result = span.low;
  draw_all(params::fields_of(high), params::fields_of(result), random);
  return result;
}

Shape drawn_shape(const Span<Shape>& span, RandomGenerator& random) {
  // Numbers that lie in their ranges may not go together: one in thousands of long ellipses is
  // narrower at its ends than its walls are wide, and is drawn again.
  Shape result = span.low;
  for (int k = 0; k < kTries; ++k) {
    Shape high = span.high;
    result = span.low;
    draw_all(fields_of_shape(high), fields_of_shape(result), random);
    if (leaves_floor(result)) break;
  }
  return result;
}

std::string drawn_sensor(const FamilySensors& sensors, RandomGenerator random) {
  const std::vector<std::string> names = sensors.names();
  return names[random.below(static_cast<std::uint32_t>(names.size()))];
}

/// A chain of legs whose bounding box is centred on the ground.
DrivePath drawn_path(const Span<FamilyPath>& span, const Ground& ground, RandomGenerator random) {
  const int legs = between(span.low.legs, span.high.legs, random);
  double heading = between(-M_PI, M_PI, random);
  DrivePath path;
  path.speed = between(span.low.speed, span.high.speed, random);
  path.waypoints.emplace_back(0.0, 0.0);
  for (int k = 0; k < legs; ++k) {
    const double length = between(span.low.leg, span.high.leg, random);
    if (k > 0) heading += between(span.low.bend, span.high.bend, random);
    path.waypoints.push_back(path.waypoints.back() +
                             length * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
  }
  Eigen::Vector2d low = path.waypoints[0], high = path.waypoints[0];
  for (const Eigen::Vector2d& point : path.waypoints) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector2d shift = Eigen::Vector2d(ground.x, ground.y) - (low + high) / 2;
  for (Eigen::Vector2d& point : path.waypoints) point += shift;
  path.yaw = std::atan2(path.waypoints[1].y() - path.waypoints[0].y(),
                        path.waypoints[1].x() - path.waypoints[0].x());
  return path;
}

/// The long sides of a rectangle whose length comes first, as strips inside of it.
std::vector<Polygon> long_sides(const Polygon& rectangle, double thickness) {
  const Eigen::Vector2d inwards = (rectangle[3] - rectangle[0]).normalized() * thickness;
  return {{rectangle[0], rectangle[1], rectangle[1] + inwards, rectangle[0] + inwards},
          {rectangle[3] - inwards, rectangle[2] - inwards, rectangle[2], rectangle[3]}};
}

bool is_grass(const Shape& shape) { return std::holds_alternative<Grass>(shape); }

/// Finds free places for the things of one world.
class Placer {
 public:
  Placer(const DrivePath& path, const Ground& ground) : path_(path) {
    ground_ = turned_rectangle({ground.x, ground.y}, 0.0, ground.length, ground.width);
    start_ = turned_ellipse(path.waypoints[0], 0.0, 2 * kFreeStart, 2 * kFreeStart, 16);
    for (std::size_t k = 0; k + 1 < path.waypoints.size(); ++k) {
      const Eigen::Vector2d along = path.waypoints[k + 1] - path.waypoints[k];
      corridor_.push_back(turned_rectangle((path.waypoints[k] + path.waypoints[k + 1]) / 2,
                                           std::atan2(along.y(), along.x()),
                                           along.norm() + 2 * kHalfCorridor, 2 * kHalfCorridor));
    }
  }

  /// Puts the shape somewhere; nothing if every try met something.
  std::optional<Solid> place(const Shape& shape, const ThingRule& rule, bool on_path,
                             RandomGenerator& random) {
    Solid solid;
    solid.shape = shape;
    solid.placement.material = rule.material;
    for (int k = 0; k < kTries; ++k) {
      draw_place(rule, on_path, random, solid.placement);
      if (!is_free(solid, on_path)) continue;
      taken_.push_back({footprint_of(solid), is_grass(shape)});
      return solid;
    }
    return std::nullopt;
  }

 private:
  struct Taken {
    Polygon footprint;
    bool is_grass;
  };

  void draw_place(const ThingRule& rule, bool on_path, RandomGenerator& random,
                  Placement& placement) const {
    const std::size_t leg = random.below(static_cast<std::uint32_t>(path_.waypoints.size() - 1));
    const Eigen::Vector2d along = path_.waypoints[leg + 1] - path_.waypoints[leg];
    const double heading = std::atan2(along.y(), along.x());
    const Eigen::Vector2d left(-std::sin(heading), std::cos(heading));
    const double part = random.uniform();
    const double side = random.below(2) == 1 ? 1.0 : -1.0;
    const double distance = between(rule.aside_min, rule.aside_max, random);
    const double turn = between(rule.turn_min, rule.turn_max, random);
    const Eigen::Vector2d place =
        path_.waypoints[leg] + part * along + (on_path ? 0.0 : side * distance) * left;
    placement.x = place.x();
    placement.y = place.y();
    placement.yaw = std::remainder(heading + (on_path ? rule.on_path_turn : turn), 2 * M_PI);
  }

  [[nodiscard]] bool is_free(const Solid& solid, bool on_path) const {
    const Polygon footprint = footprint_of(solid);
    const Polygon wide = inset(footprint, -kGap).value_or(footprint);
    if (!std::all_of(wide.begin(), wide.end(),
                     [&](const Eigen::Vector2d& corner) { return contains(ground_, corner); })) {
      return false;
    }
    const bool grows = is_grass(solid.shape);
    for (const Taken& other : taken_) {
      if (grows == other.is_grass && overlap(wide, other.footprint)) return false;
    }
    if (grows) return true;
    return on_path ? can_be_driven(solid, footprint) : !meets_corridor(footprint);
  }

  [[nodiscard]] bool meets_corridor(const Polygon& polygon) const {
    return std::any_of(corridor_.begin(), corridor_.end(),
                       [&](const Polygon& leg) { return overlap(leg, polygon); });
  }

  /// Whoever drives over a ramp or through a bridge does so from end to end, between its sides.
  [[nodiscard]] bool can_be_driven(const Solid& solid, const Polygon& footprint) const {
    const auto* bridge = std::get_if<Bridge>(&solid.shape);
    if (bridge == nullptr && overlap(start_, footprint)) return false;
    if (bridge == nullptr && !std::holds_alternative<Ramp>(solid.shape)) return true;
    for (const Polygon& side : long_sides(footprint, bridge ? bridge->wall : kThinSide)) {
      if (meets_corridor(side)) return false;
    }
    return true;
  }

  const DrivePath& path_;
  Polygon ground_, start_;
  std::vector<Polygon> corridor_;
  std::vector<Taken> taken_;
};

/// Places all things of one type.
void add_things(const FamilyThings& things, bool on_path, RandomGenerator& random, Placer& placer,
                FamilyWorld& world) {
  const ThingRule& rule = things.rule;
  const int count = on_path ? between(rule.on_path_min, rule.on_path_max, random)
                            : between(rule.count_min, rule.count_max, random);
  std::vector<Solid>& solids = world.file.scene.solids;
  for (int k = 0; k < count; ++k) {
    const Shape shape = drawn_shape(things.shape, random);
    std::optional<Solid> solid = placer.place(shape, rule, on_path, random);
    if (!solid) {
      ++world.left_out;
      continue;
    }
    solid->placement.id = static_cast<int>(solids.size()) + 1;
    solids.push_back(std::move(*solid));
  }
}

}  // namespace

bool is_seed(const params::Field& field) {
  return std::holds_alternative<std::uint64_t*>(field.value);
}

bool may_be_on_path(const Shape& shape) {
  return std::holds_alternative<Ramp>(shape) || std::holds_alternative<Bridge>(shape) ||
         std::holds_alternative<Curb>(shape) || std::holds_alternative<Pothole>(shape) ||
         is_grass(shape);
}

std::vector<std::string> FamilySensors::names() const {
  std::vector<std::string> names;
  visit_params(*this, [&names](bool permitted, const ParamInfo& info) {
    if (permitted) names.emplace_back(info.key);
  });
  return names;
}

FamilyWorld make_world(const Family& family, std::uint64_t seed) {
  FamilyWorld world;
  SceneFile& file = world.file;
  file.scene.name = family.name + "_" + std::to_string(seed);
  file.scene.source = family.source + ": seed " + std::to_string(seed);
  file.scene.ground = drawn(family.ground, generator_of(family, seed, kGroundPart));
  file.vehicle = drawn(family.vehicle, generator_of(family, seed, kVehiclePart));
  file.path = drawn_path(family.path, file.scene.ground, generator_of(family, seed, kPathPart));
  file.sensor = drawn_sensor(family.sensors, generator_of(family, seed, kSensorPart));

  Placer placer(file.path, file.scene.ground);
  std::vector<RandomGenerator> random;
  for (std::size_t k = 0; k < family.things.size(); ++k) {
    random.push_back(generator_of(family, seed, kThings + k));
  }
  // Places on the path are few, so they go first.
  for (const bool on_path : {true, false}) {
    for (std::size_t k = 0; k < family.things.size(); ++k) {
      add_things(family.things[k], on_path, random[k], placer, world);
    }
  }
  return world;
}

}  // namespace mrpt_terrain::sim
