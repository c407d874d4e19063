// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;

OrientedBox box_of(const Points& points) {
  std::vector<std::int32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  OrientedBoxWorkspace workspace;
  return box_around(points.view(), all_of(all), workspace);
}

/// Corners of a rectangle and points within it.
Points rectangle(double x, double y, double yaw, double length, double width,
                 RandomGenerator& random) {
  Points points;
  const auto add = [&](double u, double v) {
    points.push_back(static_cast<float>(x + std::cos(yaw) * u - std::sin(yaw) * v),
                     static_cast<float>(y + std::sin(yaw) * u + std::cos(yaw) * v),
                     static_cast<float>(random.uniform()));
  };
  for (int k = 0; k < 200; ++k)
    add(length * (random.uniform() - 0.5), width * (random.uniform() - 0.5));
  for (const double u : {-0.5, 0.5}) {
    for (const double v : {-0.5, 0.5}) add(u * length, v * width);
  }
  return points;
}

// Analytic; floats at 20 m have steps of 2 um.
TEST(OrientedBoxes, ARectangleIsItsOwnBox) {
  RandomGenerator random(71, 0);
  for (int trial = 0; trial < 50; ++trial) {
    const double yaw = kPi * (random.uniform() - 0.5);
    const double x = 40.0 * (random.uniform() - 0.5), y = 40.0 * (random.uniform() - 0.5);
    const OrientedBox box = box_of(rectangle(x, y, yaw, 3.0, 1.0, random));
    EXPECT_NEAR(box.centre.x, x, 1e-4) << trial;
    EXPECT_NEAR(box.centre.y, y, 1e-4) << trial;
    EXPECT_NEAR(std::remainder(box.yaw - yaw, kPi), 0.0, 1e-4) << trial;
    EXPECT_NEAR(box.length, 3.0, 1e-4) << trial;
    EXPECT_NEAR(box.width, 1.0, 1e-4) << trial;
    EXPECT_GT(box.yaw, -0.5 * kPi - 1e-9);
    EXPECT_LE(box.yaw, 0.5 * kPi + 1e-9);
  }
}

// Oracle: of rectangles turned by hundredths of a degree none is smaller, and the least of them is
// not much larger.
TEST(OrientedBoxes, NoTurnedRectangleIsSmaller) {
  RandomGenerator random(72, 0);
  for (int trial = 0; trial < 20; ++trial) {
    Points points;
    const int n = 3 + trial;
    for (int k = 0; k < n; ++k) {
      points.push_back(static_cast<float>(4.0 * random.uniform()),
                       static_cast<float>(random.uniform()), 0.0F);
    }
    const OrientedBox box = box_of(points);
    double least = 1e9;
    for (int step = 0; step < 9000; ++step) {
      const double angle = step * kPi / 18000.0, c = std::cos(angle), s = std::sin(angle);
      double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double px = double{points.x[i]}, py = double{points.y[i]};
        low_u = std::min(low_u, c * px + s * py);
        high_u = std::max(high_u, c * px + s * py);
        low_v = std::min(low_v, c * py - s * px);
        high_v = std::max(high_v, c * py - s * px);
      }
      least = std::min(least, (high_u - low_u) * (high_v - low_v));
    }
    EXPECT_LE(box.length * box.width, least + 1e-6) << trial;
    EXPECT_GE(box.length * box.width, least - 0.01) << trial;
  }
}

// Invariant: every point lies in the box.
TEST(OrientedBoxes, AllPointsAreInside) {
  RandomGenerator random(73, 0);
  Points points;
  for (int k = 0; k < 500; ++k) {
    points.push_back(static_cast<float>(random.uniform() + random.uniform()),
                     static_cast<float>(3.0 * random.uniform() * random.uniform()),
                     static_cast<float>(random.uniform()));
  }
  const OrientedBox box = box_of(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dx = double{points.x[i]} - box.centre.x, dy = double{points.y[i]} - box.centre.y;
    EXPECT_LE(std::abs(std::cos(box.yaw) * dx + std::sin(box.yaw) * dy), 0.5 * box.length + 1e-6);
    EXPECT_LE(std::abs(std::cos(box.yaw) * dy - std::sin(box.yaw) * dx), 0.5 * box.width + 1e-6);
    EXPECT_GE(points.z[i], box.low);
    EXPECT_LE(points.z[i], box.high);
  }
}

/// The corners of the convex hull, by gift wrapping.
Points hull_of(const Points& points) {
  const auto x = [&points](std::size_t i) { return static_cast<double>(points.x[i]); };
  const auto y = [&points](std::size_t i) { return static_cast<double>(points.y[i]); };
  std::size_t start = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (x(i) < x(start) || (x(i) == x(start) && y(i) < y(start))) start = i;
  }
  Points hull;
  std::size_t at = start;
  do {
    hull.push_back(points.x[at], points.y[at], points.z[at]);
    std::size_t next = at == 0 ? 1 : 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double side = (x(next) - x(at)) * (y(i) - y(at)) - (y(next) - y(at)) * (x(i) - x(at));
      if (side < 0.0) next = i;
    }
    at = next;
  } while (at != start && hull.size() < points.size());
  return hull;
}

// Oracle: leaving points out that lie inside changes nothing, of walls that are hardly wider than
// noise and of round things, whose hulls have many corners.
TEST(OrientedBoxes, ManyPointsHaveTheBoxOfTheirHull) {
  RandomGenerator random(74, 0);
  for (int trial = 0; trial < 40; ++trial) {
    const double yaw = kPi * random.uniform(), length = 20.0 * random.uniform() + 1.0;
    const bool round = trial % 4 == 0;
    Points points;
    for (int k = 0; k < 3000; ++k) {
      const double turn = 2.0 * kPi * random.uniform(), radius = std::sqrt(random.uniform());
      const double u = round ? radius * std::cos(turn) : length * random.uniform();
      const double v =
          round ? radius * std::sin(turn) : 0.02 * (random.uniform() + random.uniform());
      points.push_back(static_cast<float>(15.0 + std::cos(yaw) * u - std::sin(yaw) * v),
                       static_cast<float>(std::sin(yaw) * u + std::cos(yaw) * v), 0.0F);
    }
    const Points hull = hull_of(points);
    ASSERT_LT(hull.size(), 300U) << trial;
    const OrientedBox box = box_of(points), of_hull = box_of(hull);
    EXPECT_EQ(box.length, of_hull.length) << trial;
    EXPECT_EQ(box.width, of_hull.width) << trial;
    EXPECT_EQ(box.yaw, of_hull.yaw) << trial;
    EXPECT_EQ(box.centre.x, of_hull.centre.x) << trial;
  }
}

TEST(OrientedBoxes, FewPointsAreNoSpecialCase) {
  EXPECT_EQ(box_of(Points{}).length, 0.0);
  Points points;
  points.push_back(1.0F, 2.0F, 3.0F);
  EXPECT_EQ(box_of(points).length, 0.0);
  EXPECT_EQ(box_of(points).centre.x, 1.0);
  EXPECT_EQ(box_of(points).low, 3.0F);
  points.push_back(2.0F, 3.0F, 3.0F);
  points.push_back(3.0F, 4.0F, 3.0F);
  const OrientedBox line = box_of(points);
  EXPECT_NEAR(line.length, std::sqrt(8.0), 1e-6);
  EXPECT_NEAR(line.width, 0.0, 1e-6);
  EXPECT_NEAR(line.yaw, kPi / 4.0, 1e-6);
  for (int k = 0; k < 10; ++k) points.push_back(2.0F, 3.0F, 3.0F);
  EXPECT_NEAR(box_of(points).length, std::sqrt(8.0), 1e-6) << "the same place many times";
}

}  // namespace
}  // namespace mrpt_terrain
