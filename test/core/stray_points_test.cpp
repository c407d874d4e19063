// SPDX-License-Identifier: BSD-3-Clause
#include "stray_points.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "field_worlds.h"

namespace mrpt_terrain {
namespace {

constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, 1.5F};

struct LowCells {
  worlds::FieldStages stages;
  HoleWorkspace workspace;
  /// Cells that are below the ground, before and after.
  std::size_t before = 0, after = 0;

  explicit LowCells(const Points& points, const BeamOrigins& origins, int least_points = 6) {
    worlds::measure(points, worlds::field_params(), stages);
    before = count();
    take_back_stray_cells({stages.field, stages.grid, origins}, least_points, stages.cells,
                          workspace, stages.ground);
    after = count();
  }
  [[nodiscard]] std::size_t count() const {
    std::size_t n = 0;
    for (const GroundRule rule : stages.ground.rule) n += rule == GroundRule::kLow ? 1U : 0U;
    return n;
  }
};

/// Level ground, and twenty points about (8, 1, -3).
Points ground_with_reflections(const worlds::Rect& patch) {
  Points points;
  worlds::add_flat(points, patch, 0.1, 0.0);
  for (int k = 0; k < 20; ++k) worlds::add_point(points, 8.0 + 0.02 * k, 1.0, -3.0);
  return points;
}

// The beams fall by 4.5 m over 8 m: they would have met the ground at 2.7 m, and passed through 5 m
// of it.
TEST(StrayPoints, ReflectionsBelowTheGroundAreTakenBack) {
  const LowCells low(ground_with_reflections({-9.0, 9.0, -9.0, 9.0}), {&kOrigin, nullptr});
  EXPECT_GT(low.before, 0U);
  EXPECT_EQ(low.after, 0U);
  std::size_t stray = 0;
  for (const std::uint8_t is : low.workspace.stray) stray += is;
  EXPECT_EQ(stray, 20U);
}

// Where nothing was seen along the beams, there may be an edge; and without origins nothing is
// known.
TEST(StrayPoints, WhatNothingSpeaksAgainstStays) {
  const LowCells drop(ground_with_reflections({-9.0, 2.5, -9.0, 9.0}), {&kOrigin, nullptr});
  EXPECT_GT(drop.before, 0U);
  EXPECT_EQ(drop.after, drop.before);
  const LowCells unknown(ground_with_reflections({-9.0, 9.0, -9.0, 9.0}), {});
  EXPECT_EQ(unknown.after, unknown.before);
}

TEST(StrayPoints, FewPointsAreNone) {
  const Points points = ground_with_reflections({-9.0, 2.5, -9.0, 9.0});
  EXPECT_EQ(LowCells(points, {&kOrigin, nullptr}, 21).after, 0U);
  EXPECT_GT(LowCells(points, {&kOrigin, nullptr}, 20).after, 0U);
}

}  // namespace
}  // namespace mrpt_terrain
