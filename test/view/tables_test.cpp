// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/tables.h"

#include <gtest/gtest.h>

#include "description_builder.h"

namespace mrpt_terrain::view {
namespace {

/// Three clusters: a slope, a small pothole whose features were not needed, a bush whose plane
/// could not be found.
Description three_clusters() {
  test::DescriptionBuilder builder(10.0, 10.0, 0.5);
  builder.cluster(TerrainClass::kSlope, {14, 6}, {17, 12}, 0.1F, 0.6F);
  builder.last().height.h_f = 0.5;
  builder.last().roughness = {FeatureStatus::kOk, false, {{0.0001, 0.2, 0.9}}};
  builder.last().slope.status = FeatureStatus::kOk;
  builder.last().slope.angle = 0.25;
  builder.cluster(TerrainClass::kPothole, {5, 15}, {5, 15}, -0.3F, -0.2F);
  builder.last().height.h_f = -0.25;
  builder.cluster(TerrainClass::kObstacle, {1, 1}, {2, 2}, 0.0F, 1.2F);
  builder.last().height.h_f = 1.2;
  builder.last().roughness.status = FeatureStatus::kDegenerate;
  builder.last().slope.status = FeatureStatus::kNoConsensus;
  return builder.build();
}

TEST(Tables, ATableOfThreeClusters) {
  EXPECT_EQ(cluster_table(three_clusters()),
            "#  class     x [m]  y [m]     size [m]  cells  points  H_f [m]  rough [cm]  "
            "slope [deg]  status\n"
            "0  slope      3.00  -0.25  2.00 x 3.50     28      28    0.500         1.0  "
            "       14.3  ok\n"
            "2  obstacle  -4.00  -4.00  1.00 x 1.00      4       4    1.200           -  "
            "          -  roughness: degenerate, slope: no_consensus\n"
            "1  pothole   -2.25   2.75  0.50 x 0.50      1       1   -0.250           -  "
            "          -  ok\n");
}

TEST(Tables, OnlyTheLargestAndHowManyMore) {
  const std::string table = cluster_table(three_clusters(), 1);
  EXPECT_NE(table.find("slope"), std::string::npos);
  EXPECT_EQ(table.find("pothole"), std::string::npos);
  EXPECT_NE(table.find("\n... and 2 more\n"), std::string::npos);
}

TEST(Tables, WithoutClustersThereIsTheHeader) {
  EXPECT_EQ(cluster_table(Description{}),
            "#  class  x [m]  y [m]  size [m]  cells  points  H_f [m]  rough [cm]  slope [deg]  "
            "status\n");
}

TEST(Tables, ClassSummary) {
  Description description = three_clusters();
  description.clusters.dropped = 1;
  EXPECT_EQ(class_summary(description),
            "3 clusters: 1 obstacle, 1 slope, 1 pothole, 0 other; 1 group too small");
  EXPECT_EQ(class_summary(Description{}),
            "0 clusters: 0 obstacle, 0 slope, 0 pothole, 0 other; 0 groups too small");
}

TEST(Tables, AnEigenvalueSlightlyBelowZeroIsNoRoughness) {
  Description description = three_clusters();
  description.things[0].roughness.lambda[0] = -1e-18;
  EXPECT_NE(cluster_table(description).find("0.0         14.3  ok"), std::string::npos)
      << cluster_table(description);
}

TEST(HoleTable, HolesWithTheirClusters) {
  Description description;
  EXPECT_EQ(hole_table(description), "");
  description.clusters.cluster_of = {kNoCluster, 7};
  HoleDescription hole;
  hole.centre = {4.25, -1.0};
  hole.length = 0.61;
  hole.width = 0.4;
  hole.depth = 0.083;
  hole.confidence = 0.456;
  hole.points = 31;
  hole.rings = 4;
  hole.slot = 1;
  description.holes = {hole, hole};
  description.holes[1].slot = 0;
  description.holes[1].kind = HoleKind::kGap;
  EXPECT_EQ(
      hole_table(description),
      "hole   kind  cluster  x [m]  y [m]     size [m]  depth [cm]  points  rings  confidence\n"
      "  h0  floor        7   4.25  -1.00  0.61 x 0.40         8.3      31      4        0.46\n"
      "  h1    gap        -   4.25  -1.00  0.61 x 0.40         8.3      31      4        0.46\n");
  EXPECT_NE(hole_table(description, 1).find("... and 1 more\n"), std::string::npos);
}

}  // namespace
}  // namespace mrpt_terrain::view
