// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/gap_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace mrpt_terrain::eval {
namespace {

/// A grid of 20 m of cells of 0.2 m, and a ditch of 4 m x 1 m about (5, 0) in ground of 16 m.
struct Case {
  Description description;
  ScanTruth truth;

  Case() {
    clear_grid(GridGeometry(20.0, 20.0, 0.2), description.grid);
    TrueThing ditch;
    ditch.depth = 0.5;
    ditch.footprint = {{5.0, 0.0}, 0.0, 1.0, 4.0, false};
    truth.things = {TrueThing{}, ditch};
    truth.ground_low = {-8.0, -8.0};
    truth.ground_high = {8.0, 8.0};
  }
  void add(HoleKind kind, const std::vector<Position2>& places) {
    HoleDescription hole;
    hole.kind = kind;
    hole.centre = places.front();
    description.holes.push_back(hole);
    for (const Position2 place : places) {
      CellIndex cell;
      ASSERT_TRUE(description.grid.geometry.cell_at(place.x, place.y, cell));
      description.hole_cells.items.push_back(value_of(description.grid.geometry.id_of(cell)));
    }
    description.hole_cells.first.push_back(
        static_cast<std::int32_t>(description.hole_cells.items.size()));
  }
  [[nodiscard]] GapScore score() const {
    return judge_gaps(description, truth, truth.T_map_given, GapRules{});
  }
};

TEST(GapScore, RightAtAHoleAndAtTheEdgeOfTheGround) {
  Case c;
  c.add(HoleKind::kGap, {{5.1, 1.1}});
  c.add(HoleKind::kDrop, {{7.3, 3.1}});       // 0.7 m from the edge
  c.add(HoleKind::kDrop, {{9.1, 3.1}});       // beyond it
  c.add(HoleKind::kFreeSpace, {{5.1, 2.3}});  // 0.3 m beside the ditch
  c.add(HoleKind::kGap, {{5.1, 0.1}, {1.1, 0.1}, {1.3, 0.1}, {1.5, 0.1}});  // a quarter
  const GapScore score = c.score();
  EXPECT_EQ(score.described[1], 2U);
  EXPECT_EQ(score.described[2], 2U);
  EXPECT_EQ(score.described[3], 1U);
  EXPECT_TRUE(score.wrong.empty());
}

TEST(GapScore, FalseElsewhere) {
  Case c;
  c.add(HoleKind::kGap, {{5.1, 2.7}});  // 0.7 m beside the ditch
  c.add(HoleKind::kDrop, {{6.7, 3.1}});
  c.add(HoleKind::kFloor, {{1.1, 1.1}});  // does not count here
  const GapScore score = c.score();
  ASSERT_EQ(score.wrong.size(), 2U);
  EXPECT_EQ(score.described[0], 0U);
  EXPECT_EQ(score.wrong[0].kind, HoleKind::kGap);
  EXPECT_NEAR(score.wrong[1].x, 6.7, 1e-9);
  EXPECT_NEAR(score.wrong[1].distance, std::hypot(6.7, 3.1), 1e-9);
}

TEST(GapScore, PlacesAreThoseOfTheMap) {
  Case c;
  c.truth.T_map_given.translation() = Eigen::Vector3d(4.0, 0.0, 0.0);
  c.add(HoleKind::kGap, {{1.1, 0.1}});  // (5.1, 0.1) of the map
  EXPECT_TRUE(c.score().wrong.empty());
  c.add(HoleKind::kGap, {{5.1, 0.1}});  // beyond the edge, 9.1
  c.add(HoleKind::kGap, {{-1.1, 0.1}});
  EXPECT_EQ(c.score().wrong.size(), 1U);
}

TEST(GapScore, Adds) {
  Case c;
  c.add(HoleKind::kGap, {{1.1, 0.1}});
  GapScore sum = c.score();
  sum.add(c.score());
  EXPECT_EQ(sum.described[1], 2U);
  EXPECT_EQ(sum.wrong.size(), 2U);
}

}  // namespace
}  // namespace mrpt_terrain::eval
