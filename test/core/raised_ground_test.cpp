// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/raised_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "field_worlds.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using worlds::field_params;
using worlds::FieldStages;
using worlds::radians;
using worlds::Rect;

struct Raised : FieldStages {
  RaisedGroundWorkspace workspace;
};
void find(const Points& points, const RaisedGroundParams& params, Raised& result) {
  worlds::measure(points, field_params(), result);
  find_raised_ground(points.view(), result.field, result.grid, result.ground, result.point_slots,
                     params, result.workspace, result.cells);
}

/// A patch of 12 m with noise of 5 mm along z, of which `height` is added.
template <class Height>
Points patch(Height&& height, std::uint64_t seed = 1) {
  Points points;
  RandomGenerator random(seed, 0);
  worlds::add_surface(points, {-6.0, 6.0, -6.0, 6.0}, 0.07, [&](double x, double y) {
    return height(x, y) + 0.005 * std::sqrt(12.0) * (random.uniform() - 0.5);
  });
  return points;
}

constexpr Rect kStrip{2.0, 2.4, -4.0, 4.0};

// Analytic. A strip 7 cm high, as a low curb: its points stand out by 14 standard deviations, the
// others by none. The plane may be off by a few millimetres.
TEST(RaisedGround, AStripStandsOutOfATiltedPlane) {
  for (const double degrees : {0.0, 4.0, 8.0}) {
    const Points flat =
        patch([](double x, double y) { return worlds::inside(kStrip, x, y) ? 0.07 : 0.0; });
    const Points points = worlds::tilted(flat, radians(degrees));
    Raised result;
    find(points, {}, result);
    int strip = 0, found = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (result.field.points.support[i] != Support::kGround) continue;
      const bool inside = worlds::inside(kStrip, double{flat.x[i]}, double{flat.y[i]});
      const bool raised = result.workspace.height[i] > 0.0F;
      EXPECT_FALSE(raised && !inside) << degrees << " deg, " << flat.x[i] << ' ' << flat.y[i];
      strip += inside ? 1 : 0;
      found += raised ? 1 : 0;
      if (!raised) continue;
      EXPECT_NEAR(result.workspace.height[i], 0.07, 0.02) << degrees;
    }
    EXPECT_GT(strip, 100) << degrees << ": the labels have not left it to this step";
    EXPECT_EQ(found, strip) << degrees;
  }
}

// Points that are above the ground, or below it, have no height here.
TEST(RaisedGround, OnlyPointsOfTheGroundAreRaised) {
  Points points = patch([](double, double) { return 0.0; });
  worlds::add_box(points, {2.0, 3.0, 1.0, 2.0}, 0.5, 0.05);
  Raised result;
  find(points, {}, result);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (result.field.points.support[i] == Support::kGround) continue;
    EXPECT_EQ(result.workspace.height[i], 0.0F) << i;
  }
}

// The counts of a cell are those of its points.
TEST(RaisedGround, CellsCountTheirRaisedPoints) {
  const Points points =
      patch([](double x, double y) { return worlds::inside(kStrip, x, y) ? 0.07 : 0.0; });
  Raised result;
  find(points, {}, result);
  std::vector<std::int32_t> count(result.grid.observed(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (result.workspace.height[i] == 0.0F) continue;
    const auto slot = static_cast<std::size_t>(result.point_slots[i]);
    ++count[slot];
    EXPECT_LE(result.cells.raised_low[slot], result.workspace.height[i]);
    EXPECT_GE(result.cells.raised_high[slot], result.workspace.height[i]);
  }
  EXPECT_EQ(result.cells.raised, count);
}

// A box stands above the plane of the ground, cells of the ground that are taken for things do not.
TEST(RaisedGround, NonGroundCellsMayBeNoHigherThanTheGroundAround) {
  Points points = patch([](double x, double) { return 0.05 * x; });
  worlds::add_box(points, {2.0, 3.0, 1.0, 2.0}, 0.5, 0.05);
  Raised result;
  worlds::measure(points, field_params(), result);
  const auto slot_of = [&](double x, double y) {
    CellIndex cell;
    EXPECT_TRUE(result.grid.geometry.cell_at(x, y, cell));
    return static_cast<std::size_t>(result.grid.slot_at(cell));
  };
  const std::size_t box = slot_of(2.1, 1.1), open = slot_of(-2.1, 1.1),
                    ground = slot_of(-2.1, -2.1);
  ASSERT_EQ(result.ground.rule[box], GroundRule::kHigh);
  result.ground.rule[open] = GroundRule::kHigh;
  find_raised_ground(points.view(), result.field, result.grid, result.ground, result.point_slots,
                     {}, result.workspace, result.cells);
  EXPECT_EQ(result.cells.level[box], 0);
  EXPECT_EQ(result.cells.level[open], 1);
  EXPECT_EQ(result.cells.level[ground], 0);
}

int sum(const std::vector<std::int8_t>& values) {
  int total = 0;
  for (const std::int8_t value : values) total += value;
  return total;
}

// The edges of a strip are sharp, those of a smooth bump of 10 cm and 4 m across are not.
TEST(RaisedGround, EdgesOfASwellAreSmooth) {
  Raised strip, bump;
  find(patch([](double x, double y) { return worlds::inside(kStrip, x, y) ? 0.07 : 0.0; }), {},
       strip);
  find(patch([](double x, double y) {
         const double r = std::hypot(x - 2.5, y);
         return r < 2.0 ? 0.05 * (1.0 + std::cos(3.14159265 * r / 2.0)) : 0.0;
       }),
       {}, bump);
  EXPECT_GT(sum(strip.cells.sharp_edges), 60);  // 8 m on two sides: 80
  EXPECT_LT(sum(strip.cells.smooth_edges), 5);
  EXPECT_GT(sum(bump.cells.smooth_edges), 10);
  // What `sharp` of field_clusters.h tells apart.
  EXPECT_LT(sum(bump.cells.sharp_edges),
            0.3 * (sum(bump.cells.sharp_edges) + sum(bump.cells.smooth_edges)));
}

// Degenerate input: nothing is raised, nothing is not finite.
TEST(RaisedGround, TooFewPointsAreNoPlane) {
  for (const std::size_t n : {0U, 1U, 3U, 7U}) {
    Points points;
    for (std::size_t k = 0; k < n; ++k)
      points.push_back(1.0F + 0.3F * static_cast<float>(k), 1.0F, k == 0 ? 0.1F : 0.0F);
    Raised result;
    find(points, {}, result);
    for (const float height : result.workspace.height) EXPECT_EQ(height, 0.0F) << n;
    EXPECT_EQ(result.workspace.height.size(), n);
  }
}

// A hand-made plane: leverage grows with the distance from the points, as of any regression.
TEST(RaisedGround, LeverageIsThatOfTheRegression) {
  GroundAround plane;
  plane.known = true;
  plane.centre_x = 1.0F;
  // Four points at (+-1, +-1) about the centre: N = diag(4, 4, 4).
  plane.spread[0] = plane.spread[3] = plane.spread[5] = 0.25F;
  EXPECT_FLOAT_EQ(plane.leverage_at(1.0F, 0.0F), 0.25F);
  EXPECT_FLOAT_EQ(plane.leverage_at(2.0F, 1.0F), 0.75F);
}

}  // namespace
}  // namespace mrpt_terrain
