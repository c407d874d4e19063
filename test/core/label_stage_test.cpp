// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/label_stage.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Five cells: ground, one of each rule; clusters 0 and 1, and one cell of a dropped cluster.
struct FiveCells {
  GroundSegmentation ground;
  Clusters clusters;
  std::vector<TerrainClass> class_of = {TerrainClass::kSlope, TerrainClass::kPothole};

  FiveCells() {
    ground.rule = {GroundRule::kGround, GroundRule::kDifference, GroundRule::kHigh,
                   GroundRule::kLow, GroundRule::kKernel};
    clusters.cluster_of = {kNoCluster, 0, kNoCluster, 1, 0};
  }
};

TEST(LabelCells, ByHand) {
  const FiveCells cells;
  CellLabels labels;
  label_cells(cells.ground, cells.clusters, cells.class_of, labels);
  EXPECT_EQ(labels.support,
            (std::vector<Support>{Support::kGround, Support::kAbove, Support::kAbove,
                                  Support::kBelow, Support::kAbove}));
  EXPECT_EQ(
      labels.terrain_class,
      (std::vector<TerrainClass>{TerrainClass::kNone, TerrainClass::kSlope, TerrainClass::kNone,
                                 TerrainClass::kPothole, TerrainClass::kSlope}));
}

struct LabelledPoint {
  float z;
  std::int32_t point_slot;
  Support support;
  UnknownReason reason;
  TerrainClass terrain_class;
  std::int32_t cluster;
};

TEST(LabelPoints, ByHand) {
  using S = Support;
  using R = UnknownReason;
  using C = TerrainClass;
  const std::vector<LabelledPoint> expected = {
      {0.01F, 0, S::kGround, R::kNone, C::kNone, kNoCluster},
      {-0.04F, 0, S::kGround, R::kNone, C::kNone, kNoCluster},
      {0.3F, 1, S::kAbove, R::kNone, C::kSlope, 0},
      {-0.3F, 1, S::kBelow, R::kNone, C::kSlope, 0},
      {-0.05F, 1, S::kBelow, R::kNone, C::kSlope, 0},  // "at or below T_low"
      {-0.049F, 1, S::kAbove, R::kNone, C::kSlope, 0},
      {0.3F, 2, S::kAbove, R::kNone, C::kNone, kNoCluster},
      {-0.1F, 3, S::kBelow, R::kNone, C::kPothole, 1},
      {-0.01F, 3, S::kAbove, R::kNone, C::kPothole, 1},
      {0.03F, 4, S::kAbove, R::kNone, C::kSlope, 0},
      {kNan, point_slot_of(R::kNotFinite), S::kUnknown, R::kNotFinite, C::kNone, kNoCluster},
      {9.0F, point_slot_of(R::kTooHigh), S::kUnknown, R::kTooHigh, C::kNone, kNoCluster},
      {-9.0F, point_slot_of(R::kOutsideMap), S::kUnknown, R::kOutsideMap, C::kNone, kNoCluster},
  };
  Points points;
  PointSlots slots;
  for (const LabelledPoint& p : expected) {
    points.push_back(0.0F, 0.0F, p.z);
    slots.push_back(p.point_slot);
  }
  const FiveCells cells;
  CellLabels cell_labels;
  label_cells(cells.ground, cells.clusters, cells.class_of, cell_labels);
  LabelWorkspace workspace;
  PointLabels labels;
  label_points(points.view(), slots, cell_labels, cells.clusters, GroundParams{}, workspace,
               labels);
  ASSERT_EQ(labels.support.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_STREQ(name_of(labels.support[i]), name_of(expected[i].support)) << "point " << i;
    EXPECT_STREQ(name_of(labels.reason[i]), name_of(expected[i].reason)) << "point " << i;
    EXPECT_STREQ(name_of(labels.terrain_class[i]), name_of(expected[i].terrain_class)) << i;
    EXPECT_EQ(labels.cluster[i], expected[i].cluster) << "point " << i;
  }
}

TEST(LabelPoints, NoPointsNoLabels) {
  LabelWorkspace workspace;
  PointLabels labels;
  labels.support.resize(3);
  label_points(PointsView{}, {}, CellLabels{}, Clusters{}, GroundParams{}, workspace, labels);
  EXPECT_TRUE(labels.support.empty());
  EXPECT_TRUE(labels.reason.empty());
  EXPECT_TRUE(labels.terrain_class.empty());
  EXPECT_TRUE(labels.cluster.empty());
}

// Oracle: the definition, point by point, on random cells; memory is reused between calls.
TEST(LabelPoints, EqualTheDefinition) {
  RandomGenerator random(71);
  LabelWorkspace workspace;
  PointLabels labels;
  CellLabels cells;
  for (int k = 0; k < 50; ++k) {
    const std::uint32_t slots = 1 + random.below(40);
    GroundSegmentation ground;
    Clusters clusters;
    const std::vector<TerrainClass> class_of = {TerrainClass::kSlope, TerrainClass::kObstacle,
                                                TerrainClass::kOther};
    for (std::uint32_t s = 0; s < slots; ++s) {
      ground.rule.push_back(static_cast<GroundRule>(random.below(5)));
      clusters.cluster_of.push_back(ground.is_ground(s) ? kNoCluster
                                                        : static_cast<int>(random.below(4)) - 1);
    }
    Points points;
    PointSlots point_slots;
    for (int i = 0; i < 300; ++i) {
      points.push_back(0, 0, static_cast<float>(random.uniform() - 0.5));
      point_slots.push_back(static_cast<int>(random.below(slots + 3)) - 4);
      if (point_slots.back() == point_slot_of(UnknownReason::kNone)) point_slots.back() = 0;
    }
    label_cells(ground, clusters, class_of, cells);
    label_points(points.view(), point_slots, cells, clusters, GroundParams{}, workspace, labels);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::int32_t slot = point_slots[i];
      ASSERT_EQ(labels.reason[i], reason_of(slot));
      if (slot < 0) {
        EXPECT_EQ(labels.support[i], Support::kUnknown);
        EXPECT_EQ(labels.cluster[i], kNoCluster);
        EXPECT_EQ(labels.terrain_class[i], TerrainClass::kNone);
        continue;
      }
      const auto s = static_cast<std::size_t>(slot);
      const Support off = points.z[i] <= -0.05F ? Support::kBelow : Support::kAbove;
      EXPECT_EQ(labels.support[i], ground.is_ground(s) ? Support::kGround : off);
      const std::int32_t cluster = clusters.cluster_of[s];
      EXPECT_EQ(labels.cluster[i], cluster);
      EXPECT_EQ(labels.terrain_class[i], cluster == kNoCluster
                                             ? TerrainClass::kNone
                                             : class_of[static_cast<std::size_t>(cluster)]);
    }
  }
}

}  // namespace
}  // namespace mrpt_terrain
