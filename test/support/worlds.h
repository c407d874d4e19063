// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/random.h"

/// \file
/// Builders of point clouds whose truth is known in closed form, and moves of whole clouds.
/// Metres, robot frame (x forward, y left, z up).
namespace mrpt_terrain::worlds {

inline constexpr double kPi = 3.14159265358979323846;
[[nodiscard]] constexpr double radians(double degrees) { return degrees * kPi / 180.0; }

/// Normal deviate of mean 0 and variance 1 (Box and Muller).
inline double normal_deviate(RandomGenerator& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * kPi * random.uniform());
}

/// Closed rectangle in the horizontal plane, metres.
struct Rect {
  double x0, x1, y0, y1;
};

inline void add_point(Points& points, double x, double y, double z) {
  points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
}

/// Lattice of points over `rect`: half a spacing away from its edges, so that patches that share an
/// edge neither overlap nor put points on the borders of cells.
/// \param height called as height(x, y), metres; NaN leaves the point out
template <class Height>
void add_surface(Points& points, const Rect& rect, double spacing, Height&& height) {
  const auto nx = static_cast<int>(std::lround((rect.x1 - rect.x0) / spacing));
  const auto ny = static_cast<int>(std::lround((rect.y1 - rect.y0) / spacing));
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < ny; ++k) {
      const double x = rect.x0 + (i + 0.5) * spacing;
      const double y = rect.y0 + (k + 0.5) * spacing;
      const double z = height(x, y);
      if (!std::isnan(z)) add_point(points, x, y, z);
    }
  }
}

inline void add_flat(Points& points, const Rect& rect, double spacing, double z) {
  add_surface(points, rect, spacing, [z](double, double) { return z; });
}

/// Ramp that rises along +x from height 0 at rect.x0, with normal noise of `sigma` along its
/// normal.
inline void add_ramp(Points& points, const Rect& rect, double spacing, double angle, double sigma,
                     RandomGenerator& random) {
  const std::size_t before = points.size();
  add_surface(points, rect, spacing,
              [&](double x, double) { return (x - rect.x0) * std::tan(angle); });
  for (std::size_t i = before; i < points.size(); ++i) {
    const double noise = sigma * normal_deviate(random);
    points.x[i] -= static_cast<float>(noise * std::sin(angle));
    points.z[i] += static_cast<float>(noise * std::cos(angle));
  }
}

/// Upright wall in the plane x = `x`, from y0 to y1 and up to `top`, with normal noise along x.
inline void add_wall(Points& points, double x, double y0, double y1, double top, double spacing,
                     double sigma, RandomGenerator& random) {
  const std::size_t before = points.size();
  add_surface(points, {y0, y1, 0.0, top}, spacing, [](double, double) { return 0.0; });
  for (std::size_t i = before; i < points.size(); ++i) {
    points.z[i] = std::exchange(points.y[i], points.x[i]);
    points.x[i] = static_cast<float>(x + sigma * normal_deviate(random));
  }
}

/// Flat top and four sides of a box that stands on z = 0.
inline void add_box(Points& points, const Rect& rect, double top, double spacing) {
  add_flat(points, rect, spacing, top);
  const auto layers = static_cast<int>(std::lround(top / spacing));
  const auto nx = static_cast<int>(std::lround((rect.x1 - rect.x0) / spacing));
  const auto ny = static_cast<int>(std::lround((rect.y1 - rect.y0) / spacing));
  for (int k = 0; k < layers; ++k) {
    const double z = (k + 0.5) * spacing;
    for (int i = 0; i < nx; ++i) {
      const double x = rect.x0 + (i + 0.5) * spacing;
      add_point(points, x, rect.y0 + 1e-3, z);
      add_point(points, x, rect.y1 - 1e-3, z);
    }
    for (int i = 0; i < ny; ++i) {
      const double y = rect.y0 + (i + 0.5) * spacing;
      add_point(points, rect.x0 + 1e-3, y, z);
      add_point(points, rect.x1 - 1e-3, y, z);
    }
  }
}

/// `n` points spread evenly over the volume above `rect` up to `top`: no surface at all.
inline void add_heap(Points& points, const Rect& rect, double top, int n, RandomGenerator& random) {
  for (int i = 0; i < n; ++i) {
    const double x = rect.x0 + (rect.x1 - rect.x0) * random.uniform();
    const double y = rect.y0 + (rect.y1 - rect.y0) * random.uniform();
    add_point(points, x, y, top * random.uniform());
  }
}

/// A world of 5 m x 5 m with one thing of each class, each where the constants say.
inline constexpr double kRampAngle = radians(15.0);
inline constexpr Rect kRampRect{1.0, 2.0, -2.0, -1.0};
inline constexpr Rect kBoxRect{1.0, 1.4, 1.0, 1.4};
inline constexpr Rect kPotholeRect{-1.4, -1.0, 1.0, 1.4};
inline constexpr Rect kHeapRect{-2.0, -1.4, -2.0, -1.4};
[[nodiscard]] inline bool inside(const Rect& rect, double x, double y) {
  return x > rect.x0 && x < rect.x1 && y > rect.y0 && y < rect.y1;
}
/// \param sigma noise of the ramp, metres
[[nodiscard]] inline Points world_of_all_classes(std::uint64_t seed, double sigma = 0.0) {
  RandomGenerator random(seed);
  Points points;
  add_surface(points, {-2.5, 2.5, -2.5, 2.5}, 0.025, [](double x, double y) {
    const bool covered =
        inside(kRampRect, x, y) || inside(kBoxRect, x, y) || inside(kHeapRect, x, y);
    return covered ? std::nan("") : (inside(kPotholeRect, x, y) ? -0.12 : 0.0);
  });
  add_ramp(points, kRampRect, 0.025, kRampAngle, sigma, random);
  add_box(points, kBoxRect, 0.3, 0.025);
  add_heap(points, kHeapRect, 0.5, 2000, random);
  return points;
}

/// The same points in another order (Fisher and Yates). `order` gets the old index of each point.
[[nodiscard]] inline Points shuffled(const Points& points, std::uint64_t seed,
                                     std::vector<std::size_t>* order = nullptr) {
  RandomGenerator random(seed);
  std::vector<std::size_t> index(points.size());
  for (std::size_t i = 0; i < index.size(); ++i) index[i] = i;
  for (std::size_t i = index.size(); i > 1; --i) {
    std::swap(index[i - 1], index[random.below(static_cast<std::uint32_t>(i))]);
  }
  Points result;
  for (const std::size_t i : index) result.push_back(points.x[i], points.y[i], points.z[i]);
  if (order != nullptr) *order = index;
  return result;
}

/// Turned by 90 deg about z, counter-clockwise: (x, y) becomes (-y, x).
[[nodiscard]] inline Points turned_left(const Points& points) {
  Points result = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.x[i] = -points.y[i];
    result.y[i] = points.x[i];
  }
  return result;
}

[[nodiscard]] inline Points shifted(const Points& points, float dx, float dy) {
  Points result = points;
  for (float& x : result.x) x += dx;
  for (float& y : result.y) y += dy;
  return result;
}

}  // namespace mrpt_terrain::worlds
