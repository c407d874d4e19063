// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/pothole_score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "description_builder.h"

namespace mrpt_terrain::eval {
namespace {

using test::DescriptionBuilder;

/// A hole of 0.6 m x 0.4 m, 10 cm deep, 3 m ahead of a robot at (10, 20) that looks along y.
struct Case {
  ScanTruth truth;
  Points points;
  PotholeRules rules;

  Case() {
    truth.things.resize(2);
    truth.things[0].type = "ground";
    TrueThing& hole = truth.things[1];
    hole.type = "pothole";
    hole.terrain_class = TerrainClass::kPothole;
    hole.depth = 0.1;
    hole.footprint = {{10.0, 23.0}, M_PI / 2, 0.6, 0.4, false};
    truth.T_map_given.translation() = Eigen::Vector3d(10.0, 20.0, 1.0);
    truth.T_map_given.linear() =
        Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    truth.range_sigma = 0.01;
    truth.range_growth = 0.001;
  }
  Case& returns(int n, std::int32_t ring, float below_rim) {
    for (int k = 0; k < n; ++k) {
      points.push_back(3.0F, 0.0F, -below_rim);
      truth.thing.push_back(1);
      truth.ring.push_back(ring);
      truth.below_rim.push_back(below_rim);
      truth.support.push_back(Support::kGround);
    }
    return *this;
  }
  [[nodiscard]] HoleView look(const PotholePlaces& potholes = {}) const {
    const auto views = look_at_holes(points.view(), truth, potholes, rules);
    return views.empty() ? HoleView{} : views.front();
  }
};

TEST(PotholeScore, DueFromTenDeepReturnsOfTwoRings) {
  EXPECT_TRUE(Case().returns(9, 1, 0.09F).returns(1, 2, 0.06F).look().due);
  EXPECT_FALSE(Case().returns(8, 1, 0.09F).returns(1, 2, 0.06F).look().due) << "nine";
  EXPECT_FALSE(Case().returns(20, 1, 0.09F).look().due) << "one ring";
  EXPECT_FALSE(Case().returns(20, 1, 0.09F).returns(5, 2, 0.049F).look().due) << "not deep enough";
  const HoleView view = Case().returns(9, 1, 0.09F).returns(4, 2, 0.02F).look();
  EXPECT_EQ(view.returns, 13U);
  EXPECT_EQ(view.deep, 9U);
  EXPECT_EQ(view.rings, 1U);
  EXPECT_NEAR(view.distance, 3.0, 1e-12);
}

TEST(PotholeScore, DueBySizeAndNoise) {
  const auto due = [](double width, double depth, double sigma) {
    Case c;
    c.truth.things[1].footprint.width = width;
    c.truth.things[1].depth = depth;
    c.truth.range_sigma = sigma;
    return c.returns(10, 1, 0.19F).returns(10, 2, 0.19F).look().due;
  };
  EXPECT_TRUE(due(0.3, 0.1, 0.01));
  EXPECT_FALSE(due(0.29, 0.1, 0.01));
  EXPECT_TRUE(due(0.4, 0.2, 0.01));
  EXPECT_FALSE(due(0.4, 0.21, 0.01));
  EXPECT_FALSE(due(0.4, 0.04, 0.001));
  // At 3 m the noise is 0.003 m more.
  EXPECT_TRUE(due(0.4, 0.1, 0.0169));
  EXPECT_FALSE(due(0.4, 0.1, 0.0171));
  // The longer side does not matter.
  Case ditch;
  ditch.truth.things[1].footprint.length = 8.0;
  EXPECT_TRUE(ditch.returns(10, 1, 0.09F).returns(10, 2, 0.09F).look().due);
}

/// A description whose only cluster covers the given columns of cells at x = 2.8 to 3.2 m.
Description described(TerrainClass terrain_class, int from_w, int to_w) {
  DescriptionBuilder builder(10.0, 10.0, 0.2);
  builder.cluster(terrain_class, {39, from_w}, {40, to_w}, -0.1F, -0.05F);
  return builder.build();
}

TEST(PotholeScore, FoundWhereAPotholeLies) {
  Case c;
  c.returns(10, 1, 0.09F).returns(10, 2, 0.09F);
  const auto found = [&c](const Description& description) {
    return c.look(places_of_potholes(description, c.truth.T_map_given)).found;
  };
  EXPECT_TRUE(found(described(TerrainClass::kPothole, 24, 25)));
  EXPECT_FALSE(found(described(TerrainClass::kObstacle, 24, 25)));
  EXPECT_FALSE(found(described(TerrainClass::kPothole, 26, 27))) << "beside it";
  EXPECT_FALSE(found(described(TerrainClass::kPothole, 0, 49))) << "mostly elsewhere";
}

TEST(PotholeScore, FalseWhereNoneIs) {
  Case c;
  const auto wrong = [&c](int from_w, int to_w) {
    const Description description = described(TerrainClass::kPothole, from_w, to_w);
    c.truth.thing.assign(description.labels.cluster.size(), 0);
    return false_potholes(description, c.truth,
                          places_of_potholes(description, c.truth.T_map_given), c.rules);
  };
  EXPECT_TRUE(wrong(24, 25).empty());
  EXPECT_TRUE(wrong(26, 26).empty()) << "within 0.3 m";
  EXPECT_EQ(wrong(0, 49).size(), 1U) << "mostly elsewhere";
  const auto far = wrong(5, 6);
  ASSERT_EQ(far.size(), 1U);
  // y = -3.8 m of the robot is x = 13.8 m of the map.
  EXPECT_NEAR(far[0].x, 13.8, 1e-9);
  EXPECT_NEAR(far[0].y, 23.0, 1e-9);
  EXPECT_NEAR(far[0].distance, std::hypot(3.8, 3.0), 1e-9);
  EXPECT_EQ(far[0].at, "ground");
}

TEST(Footprint, RectangleAndEllipse) {
  Footprint hole{{1.0, 2.0}, M_PI / 6, 2.0, 1.0, false};
  const auto at = [&hole](double u, double v, double grown) {
    return hole.contains(hole.centre + Eigen::Rotation2Dd(M_PI / 6) * Eigen::Vector2d(u, v), grown);
  };
  EXPECT_TRUE(at(0.99, 0.49, 0.0));
  EXPECT_FALSE(at(1.01, 0.0, 0.0));
  EXPECT_FALSE(at(0.0, 0.51, 0.0));
  EXPECT_TRUE(at(1.29, 0.79, 0.3));
  hole.ellipse = true;
  EXPECT_FALSE(at(0.99, 0.49, 0.0));
  EXPECT_TRUE(at(0.7, 0.35, 0.0));
}

TEST(PotholeScore, ObservedGroundCountsCellsOnce) {
  Points points;
  ScanTruth truth;
  std::vector<UnknownReason> reasons;
  const auto add = [&](float x, float y, Support support, UnknownReason reason) {
    points.push_back(x, y, 0.0F);
    truth.support.push_back(support);
    reasons.push_back(reason);
  };
  add(0.05F, 0.05F, Support::kGround, UnknownReason::kNone);
  add(0.15F, 0.15F, Support::kGround, UnknownReason::kTooHigh);
  add(-0.05F, 0.05F, Support::kGround, UnknownReason::kNone);
  add(0.05F, -0.05F, Support::kGround, UnknownReason::kNone);
  add(1.0F, 1.0F, Support::kAbove, UnknownReason::kNone);
  add(2.0F, 2.0F, Support::kGround, UnknownReason::kOutsideMap);
  EXPECT_NEAR(observed_ground(points.view(), truth, reasons), 3 * 0.04, 1e-12);
}

TEST(PotholeScore, CountsApart) {
  std::vector<HoleView> holes(3);
  holes[0] = {1, 2.5, 30, 20, 4, true, true, true};
  holes[1] = {2, 2.5, 30, 20, 1, true, false, true};
  holes[2] = {3, 20.0, 30, 20, 4, false, false, false};
  PotholeScore score;
  add_holes(holes, PotholeRules{}, score);
  EXPECT_EQ(score.found.hits, 1U);
  EXPECT_EQ(score.found.total, 1U);
  EXPECT_EQ(score.found_small.total, 2U);
  EXPECT_EQ(score.found_other.total, 1U);
  EXPECT_EQ(score.due_at[1].total, 1U);
  EXPECT_EQ(score.small_at[1].hits, 2U);
  score.ground = 500.0;
  score.wrong.resize(3);
  EXPECT_DOUBLE_EQ(score.wrong_per_1000(), 6.0);
}

}  // namespace
}  // namespace mrpt_terrain::eval
