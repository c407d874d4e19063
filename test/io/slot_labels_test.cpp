// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/slot_labels.h"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <limits>

namespace mrpt_terrain::io {
namespace {

using Labels = std::vector<std::uint32_t>;

TEST(SlotLabels, LiteralValuesOfSupportsAndClasses) {
  EXPECT_EQ(slot_label(Support::kUnknown, TerrainClass::kNone), 0U);
  EXPECT_EQ(slot_label(Support::kGround, TerrainClass::kNone), 40U);
  EXPECT_EQ(slot_label(Support::kAbove, TerrainClass::kSlope), 0x10032U);
  EXPECT_EQ(slot_label(Support::kBelow, TerrainClass::kPothole), 0x20034U);
  EXPECT_EQ(slot_label(Support::kAbove, TerrainClass::kObstacle), 0x30032U);
  EXPECT_EQ(slot_label(Support::kGround, TerrainClass::kOther), 0x40028U);
}

/// Supports and classes that tell the points apart, whatever a description would say.
PointLabels marked(std::initializer_list<Support> supports,
                   std::initializer_list<TerrainClass> classes) {
  PointLabels labels;
  labels.support = supports;
  labels.terrain_class = classes;
  return labels;
}

TEST(SlotLabels, PointsKeepTheirPlacesAmongSlotsThatWereLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::array<float, 3>> slots = {{0, 0, 0}, {1, 0, 0},    {nan, 1, 1},
                                                   {0, 0, 0}, {0, 2, 0},    {500, 0, 0},
                                                   {0, 0, 3}, {0.1F, 0, 0}, {0, 0, 0}};
  mrpt::obs::CObservationPointCloud cloud;
  cloud.pointcloud = mrpt::maps::CSimplePointsMap::Create();
  cloud.pointcloud->resize(slots.size());
  for (std::size_t k = 0; k < slots.size(); ++k) {
    cloud.pointcloud->setPointFast(k, slots[k][0], slots[k][1], slots[k][2]);
  }
  SensorPoints points;
  ASSERT_EQ(convert_observation(cloud, {}, {}, points).status, ConversionStatus::kOk);
  Scan scan;
  to_robot_frame(points, nullptr, {}, scan);
  ASSERT_EQ(scan.points.size(), 3U);
  Labels labels(2, 77U);  // of an earlier scan
  label_slots(scan,
              marked({Support::kGround, Support::kAbove, Support::kBelow},
                     {TerrainClass::kNone, TerrainClass::kObstacle, TerrainClass::kOther}),
              labels);
  EXPECT_EQ(labels, (Labels{0, 40, 0, 0, 0x30032, 0, 0x40034, 0, 0}));
}

TEST(SlotLabels, WithoutPointsAllSlotsAreUnknown) {
  Scan scan;
  scan.source_size = 3;
  Labels labels{1, 2, 3, 4};
  label_slots(scan, {}, labels);
  EXPECT_EQ(labels, (Labels{0, 0, 0}));
}

}  // namespace
}  // namespace mrpt_terrain::io
