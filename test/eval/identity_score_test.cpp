// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/identity_score.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace mrpt_terrain::eval {
namespace {

ClusterMatching matching(const std::vector<std::pair<std::int32_t, std::int32_t>>& pairs) {
  ClusterMatching result;
  for (const auto& [thing, cluster] : pairs) {
    MatchedThing entry;
    entry.thing = thing;
    entry.cluster = cluster;
    result.things.push_back(entry);
  }
  return result;
}

// Literal. Thing 1 is 7, 7, missed, 9; thing 2 is 8 once and counts in one scan only; thing 3 is
// never found.
TEST(IdentityScore, CountsByHand) {
  IdentityHistory history;
  history.add_scan(matching({{1, 0}, {3, kNoCluster}}), {7, 5});
  history.add_scan(matching({{1, 1}, {2, 0}}), {8, 7});
  history.add_scan(matching({{1, kNoCluster}, {3, kNoCluster}}), {});
  history.add_scan(matching({{1, 0}}), {9});
  const IdentityScore score = history.score();
  EXPECT_EQ(score.objects, 2U);
  EXPECT_EQ(score.kept.total, 6U);
  EXPECT_EQ(score.kept.value(), 2.0 / 6.0);
  EXPECT_EQ(score.kept_where_found.total, 3U);
  EXPECT_EQ(score.kept_where_found.value(), 2.0 / 3.0);
}

TEST(IdentityScore, NoScansAreNoObjects) { EXPECT_EQ(IdentityHistory().score().objects, 0U); }

}  // namespace
}  // namespace mrpt_terrain::eval
