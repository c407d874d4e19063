// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "field_worlds.h"
#include "mrpt_terrain/core/ground_surface.h"

namespace mrpt_terrain {
namespace {

/// Seen by 64 beams from 1.7 m.
template <class Height>
Points seen(Height&& height) {
  return worlds::ring_scan(worlds::coarse_rings(64), 1.7, height);
}

GroundSurface surface_of(const Points& points) {
  GroundSurface result;
  GroundSurfaceWorkspace workspace;
  find_ground_surface(points.view(), {}, workspace, result);
  return result;
}

/// Greatest and least error of the reference at those points of a scan that are wanted.
struct Errors {
  float least = 1e9F, greatest = -1e9F;
  int points = 0;
};
template <class Height, class Wanted>
Errors errors_of(Height&& height, Wanted&& wanted) {
  const Points points = seen(height);
  const GroundSurface surface = surface_of(points);
  Errors errors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = double{points.x[i]}, y = double{points.y[i]};
    if (!wanted(x, y)) continue;
    const float error =
        surface.height_at(points.x[i], points.y[i]) - static_cast<float>(height(x, y));
    errors.least = std::min(errors.least, error);
    errors.greatest = std::max(errors.greatest, error);
    ++errors.points;
  }
  return errors;
}

/// Half the floor of a ditch 2 m wide and 0.4 m deep is seen over its edge.
constexpr double kMiddle = 4.4, kHalfWidth = 1.0;

/// A ditch along y from -3 m to 3 m on ground with a slope.
double ditch(double x, double y, double gradient) {
  const bool inside = std::abs(x - kMiddle) < kHalfWidth && std::abs(y) < 3.0;
  return gradient * x - (inside ? 0.4 : 0.0);
}

// What lies up to 2 m beside it would be a thing, did the reference go down into the ditch.
TEST(DitchCells, TheGroundBesideADitchStaysWhereItIs) {
  for (const double gradient : {0.0, 0.08}) {
    const auto height = [gradient](double x, double y) { return ditch(x, y, gradient); };
    const Errors beside = errors_of(height, [](double x, double y) {
      const double across = std::abs(x - kMiddle);
      return across > kHalfWidth + 0.2 && across < kHalfWidth + 2.0 && std::abs(y) < 2.0;
    });
    EXPECT_GT(beside.points, 1000);
    EXPECT_GT(beside.least, -0.06F) << gradient;
    EXPECT_LT(beside.greatest, 0.06F) << gradient;
  }
}

// Its floor lies below the reference, as deep as it is.
TEST(DitchCells, TheFloorOfADitchIsBelowTheGround) {
  const auto height = [](double x, double y) { return ditch(x, y, 0.0); };
  const Errors floor = errors_of(height, [](double x, double y) {
    return std::abs(x - kMiddle) < kHalfWidth - 0.1 && std::abs(y) < 2.0;
  });
  EXPECT_GT(floor.points, 100);
  EXPECT_GT(floor.least, 0.3F);
}

// A round hollow 0.2 m deep, half of that at 1.8 m, has no steep sides: the reference follows it.
TEST(DitchCells, AHollowIsFollowed) {
  const auto hollow = [](double x, double y) {
    const double distance = std::hypot(x - 5.0, y);
    return -0.2 * std::exp(-0.5 * distance * distance / (1.5 * 1.5));
  };
  const Errors errors =
      errors_of(hollow, [](double x, double y) { return std::hypot(x - 5.0, y) < 4.0; });
  EXPECT_GT(errors.points, 1000);
  EXPECT_GT(errors.least, -0.02F);
  EXPECT_LT(errors.greatest, 0.02F);
}

// A path between two raised beds, 2.4 m wide each, is the ground: most of what is around is as low.
TEST(DitchCells, APathBetweenRaisedBedsIsTheGround) {
  const auto beds = [](double x, double) {
    const double across = std::abs(x - kMiddle);
    return across > kHalfWidth && across < kHalfWidth + 2.4 ? 0.3 : 0.0;
  };
  const Errors path = errors_of(beds, [](double x, double y) {
    return std::abs(x - kMiddle) < kHalfWidth - 0.1 && std::abs(y) < 2.0;
  });
  EXPECT_GT(path.points, 100);
  EXPECT_LT(path.greatest, 0.06F);
}

}  // namespace
}  // namespace mrpt_terrain
