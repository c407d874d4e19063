// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/support_score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::eval {
namespace {

constexpr auto kG = Support::kGround, kA = Support::kAbove, kB = Support::kBelow,
               kU = Support::kUnknown;

struct Case {
  Points points;
  ScanTruth truth;
  std::vector<Support> described;
  void add(float x, Support is, float height, Support said) {
    points.push_back(x, 0.0F, 0.0F);
    truth.support.push_back(is);
    truth.height.push_back(height);
    described.push_back(said);
  }
  [[nodiscard]] SupportScore score() const {
    SupportScore result;
    add_support(points.view(), truth, described, result);
    return result;
  }
};

TEST(SupportScore, ByHand) {
  Case c;
  for (int k = 0; k < 6; ++k) c.add(1.0F, kG, 0.0F, kG);
  c.add(1.0F, kG, 0.0F, kA);
  c.add(1.0F, kG, 0.0F, kU);   // unknown ground is missed
  c.add(1.0F, kA, 0.15F, kG);  // the only two that are called ground or nothing
  c.add(1.0F, kA, 0.3F, kU);
  c.add(1.0F, kA, 1.0F, kA);
  c.add(1.0F, kA, 1.0F, kB);  // below is no ground either
  c.add(1.0F, kU, 0.07F, kG);
  const SupportCounts all = c.score().all;
  EXPECT_DOUBLE_EQ(all.precision(), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(all.recall(), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(all.f1(), 0.75);
  EXPECT_DOUBLE_EQ(all.iou(), 6.0 / 10.0);
  EXPECT_DOUBLE_EQ(all.obstacle_tpr(), 0.5);
  const auto heights = c.score().obstacles_by_height;
  EXPECT_DOUBLE_EQ(heights[0].value(), 0.0);
  EXPECT_DOUBLE_EQ(heights[1].value(), 0.0);
  EXPECT_DOUBLE_EQ(heights[2].value(), 1.0);
  EXPECT_EQ(heights[2].total, 2U);
}

TEST(SupportScore, DistanceIsHorizontalAndEdgesBelongToTheUpperBin) {
  Case c;
  c.add(9.99F, kG, 0.0F, kG);
  c.add(-10.0F, kG, 0.0F, kG);
  c.add(39.0F, kG, 0.0F, kU);
  c.add(41.0F, kG, 0.0F, kG);
  c.points.y[0] = 0.2F;
  c.points.z[0] = 50.0F;
  const auto bins = c.score().by_distance;
  EXPECT_EQ(bins[0].true_ground, 1U);
  EXPECT_EQ(bins[1].true_ground, 1U);
  EXPECT_EQ(bins[2].missed_ground, 1U);
  EXPECT_EQ(bins[3].true_ground, 1U);
}

TEST(SupportScore, NothingIsNoNumber) {
  EXPECT_TRUE(std::isnan(SupportCounts{}.iou()));
  EXPECT_TRUE(std::isnan(SupportCounts{}.obstacle_tpr()));
  EXPECT_TRUE(std::isnan(Share{}.value()));
}

/// The rules of /tools/score_ground.py, word by word.
struct Script {
  std::size_t tp = 0, fp = 0, fn = 0, tn = 0;
  void count(Support truth, Support pred) {
    if (truth == kU) return;
    const bool is_ground = pred == kG, is_unknown = pred == kU;
    if (truth == kG) {
      tp += is_ground;
      fn += !is_ground;
    } else {
      tn += !is_unknown && !is_ground;
      fp += is_unknown || is_ground;
    }
  }
};

TEST(SupportScore, AgreesWithTheScriptOnRandomLabels) {
  RandomGenerator random(5);
  Case c;
  Script script;
  for (int k = 0; k < 5000; ++k) {
    const auto is = static_cast<Support>(random.below(3));  // nothing is truly below
    const auto said = static_cast<Support>(random.below(4));
    c.add(50.0F * static_cast<float>(random.uniform()), is, 0.5F, said);
    script.count(is, said);
  }
  const SupportScore score = c.score();
  EXPECT_EQ(score.all.true_ground, script.tp);
  EXPECT_EQ(score.all.missed_ground, script.fn);
  EXPECT_EQ(score.all.true_obstacle, script.tn);
  EXPECT_EQ(score.all.missed_obstacle, script.fp);
  SupportCounts sum;
  for (const SupportCounts& bin : score.by_distance) sum.add(bin);
  EXPECT_EQ(sum.true_ground, script.tp);
  EXPECT_EQ(sum.missed_obstacle, script.fp);
}

}  // namespace
}  // namespace mrpt_terrain::eval
