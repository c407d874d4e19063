// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/cluster_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::eval {
namespace {

constexpr auto kNone = static_cast<std::size_t>(TerrainClass::kNone);
constexpr auto kSlope = static_cast<std::size_t>(TerrainClass::kSlope);
constexpr auto kObstacle = static_cast<std::size_t>(TerrainClass::kObstacle);

/// Points of things and clusters by number, all counted unless said otherwise.
struct Case {
  Points points;
  ScanTruth truth;
  PointLabels labels;
  std::vector<ClusterDescription> clusters;
  ClusterRules rules;

  explicit Case(const std::vector<TerrainClass>& things) {
    truth.things.resize(1);
    for (const TerrainClass c : things) {
      truth.things.emplace_back();
      truth.things.back().terrain_class = c;
    }
  }
  Case& described(TerrainClass c) {
    clusters.emplace_back();
    clusters.back().terrain_class = c;
    return *this;
  }
  Case& add(int n, std::int32_t thing, std::int32_t cluster, Support support = Support::kAbove,
            bool cover = false) {
    for (int k = 0; k < n; ++k) {
      points.push_back(5.0F, 0.0F, 0.0F);
      truth.thing.push_back(thing);
      truth.support.push_back(support);
      truth.cover.push_back(cover ? 1 : 0);
      labels.cluster.push_back(cluster);
    }
    return *this;
  }
  [[nodiscard]] ClusterMatching matching() const {
    return match_clusters(points.view(), truth, labels, clusters, rules);
  }
  [[nodiscard]] ClusterScore score() const {
    ClusterScore result;
    add_clusters(matching(), truth, clusters, result);
    return result;
  }
};

TEST(ClusterScore, OneFoundOneMissedOneFalse) {
  Case c({TerrainClass::kObstacle, TerrainClass::kSlope});
  c.described(TerrainClass::kObstacle).described(TerrainClass::kSlope);
  c.add(80, 1, 0).add(20, 1, kNoCluster).add(20, 0, 0);  // IoU 80 / 120
  c.add(30, 2, kNoCluster);
  c.add(40, 0, 1, Support::kGround);
  const ClusterMatching matching = c.matching();
  ASSERT_EQ(matching.things.size(), 2U);
  EXPECT_EQ(matching.things[0].cluster, 0);
  EXPECT_DOUBLE_EQ(matching.things[0].iou, 80.0 / 120.0);
  EXPECT_EQ(matching.things[1].cluster, kNoCluster);
  EXPECT_EQ(matching.fate[1], ClusterFate::kFalse);
  const ClusterScore score = c.score();
  EXPECT_DOUBLE_EQ(score.found.value(), 0.5);
  EXPECT_DOUBLE_EQ(score.right.value(), 0.5);
  EXPECT_EQ(score.confusion[kObstacle][kObstacle], 1U);
  EXPECT_EQ(score.confusion[kSlope][kNone], 1U);
  EXPECT_EQ(score.confusion[kNone][kSlope], 1U);
  EXPECT_DOUBLE_EQ(score.found_of_class[kSlope].value(), 0.0);
  EXPECT_EQ(score.found_at[0].total, 2U);
}

TEST(ClusterScore, HalfIsNotEnough) {
  Case c({TerrainClass::kObstacle});
  c.described(TerrainClass::kObstacle).add(20, 1, 0).add(20, 1, kNoCluster);
  EXPECT_EQ(c.score().found.hits, 0U);
  c.add(1, 1, 0);
  EXPECT_EQ(c.score().found.hits, 1U);
}

TEST(ClusterScore, UncountedPointsAndCoverChangeNoIou) {
  Case c({TerrainClass::kObstacle});
  c.described(TerrainClass::kObstacle).add(30, 1, 0);
  c.add(200, 1, kNoCluster, Support::kUnknown).add(300, 1, kNoCluster, Support::kGround, true);
  c.add(25, 0, 0, Support::kUnknown);
  EXPECT_DOUBLE_EQ(c.matching().things[0].iou, 1.0);
}

TEST(ClusterScore, SmallThingsAndClustersDoNotCount) {
  Case c({TerrainClass::kObstacle, TerrainClass::kObstacle});
  c.described(TerrainClass::kObstacle).described(TerrainClass::kObstacle);
  c.add(9, 1, 0);                                   // too few returns
  c.add(4, 2, 1).add(20, 2, 1, Support::kUnknown);  // too few that count
  const ClusterScore score = c.score();
  EXPECT_EQ(score.found.total, 0U);
  EXPECT_EQ(score.right.total, 0U);
  EXPECT_EQ(score.not_counted, 2U);
}

TEST(ClusterScore, ClusterMostlyOfPointsThatDoNotCountIsNotFalse) {
  Case c({TerrainClass::kNone});
  c.described(TerrainClass::kObstacle).described(TerrainClass::kObstacle);
  c.add(11, 0, 0, Support::kUnknown).add(10, 0, 0);
  c.add(11, 1, 1).add(10, 0, 1);  // a thing without class
  const ClusterMatching matching = c.matching();
  EXPECT_EQ(matching.fate[0], ClusterFate::kNotCounted);
  EXPECT_EQ(matching.fate[1], ClusterFate::kNotCounted);
  c.add(2, 0, 0);
  EXPECT_EQ(c.matching().fate[0], ClusterFate::kFalse);
}

TEST(ClusterScore, SplitAndMerged) {
  Case c({TerrainClass::kObstacle, TerrainClass::kObstacle, TerrainClass::kObstacle});
  for (int k = 0; k < 3; ++k) c.described(TerrainClass::kObstacle);
  c.add(50, 1, 0).add(50, 1, 1);
  c.add(60, 2, 2).add(60, 3, 2);
  const ClusterScore score = c.score();
  EXPECT_EQ(score.split.hits, 1U);
  EXPECT_EQ(score.split.total, 3U);
  EXPECT_EQ(score.merged.hits, 1U);
  EXPECT_EQ(score.merged.total, 3U);
}

TEST(ClusterScore, ClustersWithoutClassAreNone) {
  Case c({TerrainClass::kObstacle});
  c.described(TerrainClass::kNone).add(30, 1, 0);
  EXPECT_EQ(c.score().found.hits, 0U);
  EXPECT_EQ(c.score().right.total, 0U);
}

TEST(ClusterScore, NothingDescribed) {
  Case c({TerrainClass::kObstacle});
  c.add(30, 1, kNoCluster);
  EXPECT_EQ(c.score().found.total, 1U);
  EXPECT_EQ(c.score().found.hits, 0U);
}

std::set<std::size_t> counted_members(const Case& c, const std::vector<std::int32_t>& of,
                                      std::int32_t number) {
  std::set<std::size_t> members;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const bool counts = c.truth.support[i] != Support::kUnknown && c.truth.cover[i] == 0;
    if (of[i] == number && counts) members.insert(i);
  }
  return members;
}

/// IoU of every pair by sets.
double slow_iou(const Case& c, std::int32_t thing, std::int32_t cluster) {
  const auto a = counted_members(c, c.truth.thing, thing);
  const auto b = counted_members(c, c.labels.cluster, cluster);
  std::vector<std::size_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  const auto n = static_cast<double>(both.size());
  return n / (static_cast<double>(a.size() + b.size()) - n);
}

Case random_case(RandomGenerator& random) {
  constexpr std::uint32_t kThings = 6, kClusters = 7;
  Case c(std::vector<TerrainClass>(kThings, TerrainClass::kObstacle));
  for (std::uint32_t k = 0; k < kClusters; ++k) c.described(TerrainClass::kObstacle);
  for (int k = 0; k < 400; ++k) {
    const auto thing = static_cast<std::int32_t>(random.below(kThings + 1));
    // Mostly the cluster of the same number.
    const auto cluster =
        random.uniform() < 0.8 ? thing : static_cast<std::int32_t>(random.below(kClusters + 1)) - 1;
    c.add(1, thing, cluster, random.uniform() < 0.1 ? Support::kUnknown : Support::kAbove,
          random.uniform() < 0.05);
  }
  return c;
}

TEST(ClusterScore, AgreesWithBruteForce) {
  RandomGenerator random(11);
  std::size_t matched = 0;
  for (int round = 0; round < 50; ++round) {
    const Case c = random_case(random);
    const ClusterMatching matching = c.matching();
    ASSERT_EQ(matching.things.size(), c.truth.things.size() - 1);
    for (const MatchedThing& thing : matching.things) {
      std::int32_t best = kNoCluster;
      for (std::size_t k = 0; k < c.clusters.size(); ++k) {
        const auto cluster = static_cast<std::int32_t>(k);
        if (slow_iou(c, thing.thing, cluster) > 0.5) best = cluster;
      }
      ASSERT_EQ(thing.cluster, best) << "round " << round << " thing " << thing.thing;
      if (best == kNoCluster) continue;
      ++matched;
      ASSERT_DOUBLE_EQ(thing.iou, slow_iou(c, thing.thing, best));
    }
  }
  EXPECT_GT(matched, 100U);
}

// Literal: a found thing, one that was mostly called ground, a cluster that is none.
TEST(ClusterScore, ThingsAreListedWithTheirBestClusters) {
  Case c({TerrainClass::kObstacle, TerrainClass::kSlope});
  c.truth.things[1].id = 11;
  c.truth.things[1].type = "box";
  c.described(TerrainClass::kObstacle).described(TerrainClass::kOther);
  c.add(80, 1, 0).add(20, 1, kNoCluster).add(20, 0, 0);
  c.add(30, 2, kNoCluster).add(10, 2, 1);
  c.add(40, 0, 1, Support::kGround);
  c.labels.support.assign(c.points.size(), Support::kAbove);
  for (std::size_t i = 120; i < 150; ++i) c.labels.support[i] = Support::kGround;
  const std::vector<ThingRecord> list =
      list_things(c.points.view(), c.truth, c.labels, c.clusters, c.matching());
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].thing, 11);
  EXPECT_EQ(list[0].type, "box");
  EXPECT_EQ(list[0].of_thing, 100U);
  EXPECT_EQ(list[0].of_cluster, 100U);
  EXPECT_EQ(list[0].shared, 80U);
  EXPECT_DOUBLE_EQ(list[0].iou(), 80.0 / 120.0);
  EXPECT_EQ(list[0].loose, 0U);
  EXPECT_EQ(list[0].dropped, 20U);
  EXPECT_DOUBLE_EQ(list[0].x, 5.0);
  EXPECT_EQ(list[1].truth, TerrainClass::kSlope);
  EXPECT_EQ(list[1].loose, 30U);
  EXPECT_EQ(list[1].cluster, 1);
  EXPECT_EQ(list[1].shared, 10U);
  EXPECT_FALSE(list[1].is_false);
  EXPECT_TRUE(list[2].is_false);
  EXPECT_EQ(list[2].cluster, 1);
  EXPECT_EQ(list[2].described, TerrainClass::kOther);
  EXPECT_EQ(list[2].shared, 40U);
}

}  // namespace
}  // namespace mrpt_terrain::eval
