// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "field_worlds.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using worlds::FieldStages;
using worlds::radians;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Points whose heights and supports are written down; the reference is z = 0.
class WrittenPoints {
 public:
  WrittenPoints& add(float x, float y, float height, Support support) {
    points.push_back(x, y, height);
    heights_.push_back(height);
    supports_.push_back(support);
    return *this;
  }
  /// Measured on a grid of 4 m with cells of 1 m.
  [[nodiscard]] FieldStages measured() const {
    FieldStages stages;
    find_field_ground(PointsView{}, {}, {}, stages.field);
    stages.field.points = {heights_, supports_};
    ElevationGridWorkspace workspace;
    build_elevation_grid(points.view(), {4.0, 4.0, 1.0, 3.0}, workspace, stages.grid,
                         stages.point_slots, heights_.data());
    measure_field_cells(points.view(), stages.field, stages.grid, stages.point_slots, stages.cells,
                        stages.ground);
    return stages;
  }

  Points points;

 private:
  std::vector<float> heights_;
  std::vector<Support> supports_;
};

// Literal: one cell of each sort, in the order of the grid.
TEST(FieldCells, FourCellsByHand) {
  const FieldStages stages = WrittenPoints{}
                                 .add(1.5F, 1.5F, 0.5F, Support::kAbove)  // last cell
                                 .add(1.5F, 1.5F, 0.0625F, Support::kGround)
                                 .add(1.5F, 1.5F, 2.0F, Support::kAbove)
                                 .add(1.5F, 1.5F, 5.0F, Support::kAbove)      // too high
                                 .add(-1.5F, -1.5F, 0.25F, Support::kGround)  // first cell
                                 .add(-1.5F, -1.5F, -0.125F, Support::kGround)
                                 .add(0.5F, 0.5F, -0.5F, Support::kBelow)
                                 .add(0.5F, 0.5F, -1.0F, Support::kBelow)
                                 .add(0.5F, 0.5F, 0.0F, Support::kGround)
                                 .add(-0.5F, 0.5F, -0.5F, Support::kBelow)
                                 .add(-0.5F, 0.5F, 0.5F, Support::kAbove)
                                 .add(9.0F, 0.5F, 0.5F, Support::kAbove)  // outside
                                 .measured();
  const FieldCells& cells = stages.cells;
  ASSERT_EQ(cells.size(), 4U);
  using Counts = std::vector<std::int32_t>;
  using Heights = std::vector<float>;
  EXPECT_EQ(cells.on, (Counts{2, 0, 1, 1}));
  EXPECT_EQ(cells.above, (Counts{0, 1, 0, 2}));
  EXPECT_EQ(cells.below, (Counts{0, 1, 2, 0}));
  EXPECT_EQ(cells.low, (Heights{0.0F, 0.5F, 0.0F, 0.5F}));
  EXPECT_EQ(cells.high, (Heights{0.0F, 0.5F, 0.0F, 2.0F}));
  EXPECT_EQ(cells.floor, (Heights{0.0625F, -0.5F, -0.5F, 0.0625F}));
  EXPECT_EQ(cells.ground, (Heights{0.0F, 0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(stages.ground.rule, (std::vector<GroundRule>{GroundRule::kGround, GroundRule::kHigh,
                                                         GroundRule::kLow, GroundRule::kHigh}));
  EXPECT_EQ(stages.ground.h_mean, stages.grid.h_mean);
}

/// Ground that falls by 5 deg, a box and a wall on it, points under it, and useless points.
Points uneven_world(std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  worlds::add_flat(points, {-6.0, 6.0, -6.0, 6.0}, 0.1, 0.0);
  worlds::add_box(points, {2.0, 3.0, 2.0, 3.0}, 1.0, 0.1);
  worlds::add_wall(points, 4.05, -3.0, 1.0, 4.5, 0.1, 0.004, random);
  points = worlds::tilted(points, radians(5.0), 0.1);
  for (int k = 0; k < 20; ++k) {
    worlds::add_point(points, 5.0 * random.uniform() - 5.5, 5.0 * random.uniform() - 5.5, -1.5);
  }
  points.push_back(kNan, 0.0F, 0.0F);
  points.push_back(0.0F, kInf, 0.0F);
  points.push_back(0.0F, 0.0F, -kInf);
  points.push_back(500.0F, 0.0F, 0.0F);
  return worlds::shuffled(points, seed);
}

// Oracle: for every cell, all points.
TEST(FieldCells, SameAsLookingThroughAllPointsForEveryCell) {
  for (const std::uint64_t seed : {251, 252}) {
    const Points points = uneven_world(seed);
    FieldStages stages;
    worlds::measure(points, worlds::field_params(), stages);
    ASSERT_EQ(stages.cells.size(), stages.grid.observed());
    std::vector<std::int32_t> id_of(points.size(), -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      CellIndex cell;
      const bool in_map =
          stages.grid.geometry.cell_at(double{points.x[i]}, double{points.y[i]}, cell) &&
          stages.field.points.height[i] < 3.0F;
      if (in_map) id_of[i] = value_of(stages.grid.geometry.id_of(cell));
    }
    int above_cells = 0, below_cells = 0;
    for (std::size_t slot = 0; slot < stages.cells.size(); ++slot) {
      std::int32_t on = 0, above = 0, below = 0;
      float low = kInf, high = 0.0F;
      double floor = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (id_of[i] != value_of(stages.grid.cell[slot])) continue;
        const float height = stages.field.points.height[i];
        const Support support = stages.field.points.support[i];
        on += support == Support::kGround ? 1 : 0;
        below += support == Support::kBelow ? 1 : 0;
        above += support == Support::kAbove ? 1 : 0;
        if (support == Support::kAbove) {
          low = std::min(low, height);
          high = std::max(high, height);
        } else {
          floor += double{height};
        }
      }
      ASSERT_EQ(stages.cells.on[slot], on) << slot;
      ASSERT_EQ(stages.cells.above[slot], above) << slot;
      ASSERT_EQ(stages.cells.below[slot], below) << slot;
      ASSERT_EQ(stages.cells.low[slot], above > 0 ? low : 0.0F) << slot;
      ASSERT_EQ(stages.cells.high[slot], high) << slot;
      if (on + below > 0) {
        ASSERT_NEAR(stages.cells.floor[slot], stages.cells.ground[slot] + floor / (on + below),
                    1e-5)
            << slot;
      }
      const GroundRule expected = above > 0   ? GroundRule::kHigh
                                  : below > 0 ? GroundRule::kLow
                                              : GroundRule::kGround;
      ASSERT_EQ(stages.ground.rule[slot], expected) << slot;
      above_cells += above > 0 ? 1 : 0;
      below_cells += below > 0 ? 1 : 0;
    }
    EXPECT_GT(above_cells, 20) << seed;
    EXPECT_GT(below_cells, 5) << seed;
  }
}

// Analytic: the reference at the centres of the cells is the plane. 2 cm, as the tests of the
// reference allow where things stand and wild points lie.
TEST(FieldCells, GroundOfTheCellsIsThePlane) {
  FieldStages stages;
  worlds::measure(uneven_world(253), worlds::field_params(), stages);
  for (std::size_t slot = 0; slot < stages.cells.size(); ++slot) {
    const auto& geometry = stages.grid.geometry;
    const Position2 centre = geometry.centre_of(geometry.index_of(stages.grid.cell[slot]));
    if (std::abs(centre.x) > 5.5 || std::abs(centre.y) > 5.5) continue;
    EXPECT_NEAR(stages.cells.ground[slot], 0.1 - std::tan(radians(5.0)) * centre.x, 0.02)
        << centre.x << " " << centre.y;
  }
}

// Heights and labels come in the order of the scan, whatever the order of the cells.
TEST(FieldCells, PointsKeepTheOrderOfTheScan) {
  const Points points = uneven_world(254);
  FieldWorkspace workspace;
  find_field_ground(points.view(), {}, {}, workspace);
  ASSERT_EQ(workspace.points.height.size(), points.size());
  ASSERT_EQ(workspace.points.support.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool finite =
        std::isfinite(points.x[i]) && std::isfinite(points.y[i]) && std::isfinite(points.z[i]);
    const float height = workspace.points.height[i];
    EXPECT_EQ(std::isnan(height), !finite) << i;
    if (!finite || points.x[i] > 400.0F) {
      EXPECT_EQ(workspace.points.support[i], Support::kUnknown) << i;
      continue;
    }
    EXPECT_NEAR(height, points.z[i] - workspace.surface.height_at(points.x[i], points.y[i]), 1e-5)
        << i;
    EXPECT_NE(workspace.points.support[i], Support::kUnknown) << i;
  }
}

// A scan of useless points after a full one: nothing of the first is left.
TEST(FieldCells, UsedMemoryLeavesNoTrace) {
  FieldStages used;
  worlds::measure(uneven_world(255), worlds::field_params(), used);
  Points useless;
  useless.push_back(kNan, 0.0F, 0.0F);
  useless.push_back(1.0F, 1.0F, kNan);
  worlds::measure(useless, worlds::field_params(), used);
  EXPECT_EQ(used.cells.size(), 0U);
  EXPECT_TRUE(used.ground.rule.empty());
  EXPECT_EQ(used.field.points.support,
            (std::vector<Support>{Support::kUnknown, Support::kUnknown}));
  worlds::measure(Points{}, worlds::field_params(), used);
  EXPECT_EQ(used.cells.size(), 0U);
  EXPECT_TRUE(used.field.points.height.empty());
}

}  // namespace
}  // namespace mrpt_terrain
