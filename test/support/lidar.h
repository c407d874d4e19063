// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

/// \file
/// A level ring-scanning LiDAR over the plane z = 0 with convex solids on it and rectangular holes
/// in it, by closed-form intersections. Metres, radians, robot frame.
namespace mrpt_terrain::worlds {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Half-space normal . p <= bound.
struct HalfSpace {
  Vec3 normal;
  double bound = 0.0;
};

/// Intersection of half-spaces.
struct Solid {
  std::vector<HalfSpace> faces;
  int object = 0;  ///< number of the thing it belongs to, >= 0
};

/// Ground object of hits on z = 0.
inline constexpr int kGroundObject = -1;

struct Scene {
  std::vector<Solid> solids;
  std::vector<Solid> holes;  ///< boxes below z = 0 without a lid
};

/// Box over `rect` from z0 to z1.
[[nodiscard]] inline Solid box_solid(const Rect& rect, double z0, double z1, int object) {
  return {{{{1, 0, 0}, rect.x1},
           {{-1, 0, 0}, -rect.x0},
           {{0, 1, 0}, rect.y1},
           {{0, -1, 0}, -rect.y0},
           {{0, 0, 1}, z1},
           {{0, 0, -1}, -z0}},
          object};
}

/// Wedge over `rect` whose top rises along +x from height 0 at rect.x0.
[[nodiscard]] inline Solid ramp_solid(const Rect& rect, double angle, int object) {
  Solid solid = box_solid(rect, 0.0, 100.0, object);
  solid.faces[4] = {{-std::sin(angle), 0, std::cos(angle)}, -std::sin(angle) * rect.x0};
  return solid;
}

/// Where a ray is inside a solid: [enter, leave], empty if enter > leave.
struct Span {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
};
[[nodiscard]] inline Span clip(const Vec3& origin, const Vec3& direction, const Solid& solid) {
  Span span;
  for (const HalfSpace& face : solid.faces) {
    const double room = face.bound - dot(face.normal, origin);
    const double rate = dot(face.normal, direction);
    if (rate > 0.0) span.leave = std::min(span.leave, room / rate);
    if (rate < 0.0) span.enter = std::max(span.enter, room / rate);
    if (rate == 0.0 && room < 0.0) return {1.0, 0.0};
  }
  return span;
}

struct Hit {
  double range = std::numeric_limits<double>::infinity();
  int object = kGroundObject;
};

/// First thing that a ray from above the ground meets; range is infinite if there is none.
[[nodiscard]] inline Hit cast(const Scene& scene, const Vec3& origin, const Vec3& direction) {
  Hit hit;
  if (direction.z < 0.0) hit.range = -origin.z / direction.z;
  for (const Solid& hole : scene.holes) {
    const Span span = clip(origin, direction, hole);
    // Through the open lid to the wall or floor where the ray leaves the hole.
    if (span.enter < span.leave && std::abs(span.enter - hit.range) < 1e-9) {
      hit = {span.leave, hole.object};
      break;
    }
  }
  for (const Solid& solid : scene.solids) {
    const Span span = clip(origin, direction, solid);
    if (span.enter <= span.leave && span.enter > 0.0 && span.enter < hit.range) {
      hit = {span.enter, solid.object};
    }
  }
  return hit;
}

/// A level spinning sensor above the robot's origin.
struct LidarModel {
  double height = 0.81;
  double lowest_deg = -30.67;
  double highest_deg = 10.67;
  int beams = 32;
  double azimuth_step_deg = 0.166;
  double max_range = 70.0;
  double range_sigma = 0.0;  ///< metres
};
[[nodiscard]] inline LidarModel thirty_two_beams(double range_sigma) {
  LidarModel model;
  model.range_sigma = range_sigma;
  return model;
}
[[nodiscard]] inline LidarModel sixteen_beams() { return {0.81, -15.0, 15.0, 16, 0.2, 70.0, 0.0}; }

struct LidarScan {
  Points points;
  std::vector<int> object;  ///< per point: which thing it hit, or kGroundObject
};

/// One turn of the sensor.
[[nodiscard]] inline LidarScan scan(const Scene& scene, const LidarModel& model,
                                    RandomGenerator& random) {
  LidarScan result;
  const auto steps = static_cast<int>(360.0 / model.azimuth_step_deg);
  const double beam_step = (model.highest_deg - model.lowest_deg) / (model.beams - 1);
  const Vec3 origin{0.0, 0.0, model.height};
  for (int step = 0; step < steps; ++step) {
    const double azimuth = radians(step * model.azimuth_step_deg);
    for (int beam = 0; beam < model.beams; ++beam) {
      const double elevation = radians(model.lowest_deg + beam * beam_step);
      const Vec3 direction{std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      const Hit hit = cast(scene, origin, direction);
      if (!(hit.range < model.max_range)) continue;
      const double range = hit.range + model.range_sigma * normal_deviate(random);
      add_point(result.points, origin.x + range * direction.x, origin.y + range * direction.y,
                origin.z + range * direction.z);
      result.object.push_back(hit.object);
    }
  }
  return result;
}

}  // namespace mrpt_terrain::worlds
