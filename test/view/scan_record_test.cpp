// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/scan_record.h"

#include <gtest/gtest.h>

#include "description_builder.h"

namespace mrpt_terrain::view {
namespace {

template <class Enum>
std::size_t at(Enum value) {
  return static_cast<std::size_t>(value);
}

TEST(ScanRecord, CountsPointsCellsAndClustersByHand) {
  test::DescriptionBuilder builder(2.0, 2.0, 0.5);
  builder.ground({0, 0}, 0.0F).ground({0, 1}, 0.0F).dropped({0, 3}, 0.3F);
  builder.cluster(TerrainClass::kPothole, {2, 0}, {2, 1}, -0.4F, -0.2F);
  builder.cluster(TerrainClass::kObstacle, {3, 3}, {3, 3}, 0.5F, 0.9F);
  Description description = builder.build();
  description.labels.support.push_back(Support::kUnknown);
  description.labels.reason.push_back(UnknownReason::kTooHigh);
  const DescriptionCounts counts = count(description);
  EXPECT_EQ(counts.points, 7U);
  EXPECT_EQ(counts.per_support[at(Support::kGround)], 2U);
  EXPECT_EQ(counts.per_support[at(Support::kAbove)], 2U);
  EXPECT_EQ(counts.per_support[at(Support::kBelow)], 2U);
  EXPECT_EQ(counts.per_support[at(Support::kUnknown)], 1U);
  EXPECT_EQ(counts.per_reason[at(UnknownReason::kTooHigh)], 1U);
  EXPECT_EQ(counts.per_reason[at(UnknownReason::kNone)], 6U);
  EXPECT_EQ(counts.observed_cells, 6U);
  EXPECT_EQ(counts.ground_cells, 2U);
  EXPECT_EQ(counts.non_ground_cells, 4U);
  EXPECT_EQ(counts.clusters[at(TerrainClass::kPothole)], 1U);
  EXPECT_EQ(counts.clusters[at(TerrainClass::kObstacle)], 1U);
  EXPECT_EQ(counts.clusters[at(TerrainClass::kSlope)], 0U);
  EXPECT_EQ(counts.dropped_groups, 1U);
}

TEST(ScanRecord, AnEmptyDescriptionCountsNothing) {
  const DescriptionCounts counts = count(Description{});
  EXPECT_EQ(counts.points, 0U);
  EXPECT_EQ(counts.observed_cells, 0U);
}

}  // namespace
}  // namespace mrpt_terrain::view
