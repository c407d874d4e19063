// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/labelled_scans.h"

#include <gtest/gtest.h>

#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "test_files.h"

namespace mrpt_terrain::eval {
namespace {

namespace fs = std::filesystem;
using test::fresh_folder;

TEST(LabelledScans, ClassLists) {
  const auto support = [](LabelSet set, std::uint32_t label) {
    return support_of_label(set, label);
  };
  EXPECT_EQ(support(LabelSet::kSemanticKitti, 40), Support::kGround);
  EXPECT_EQ(support(LabelSet::kSemanticKitti, 7U << 16U | 72U), Support::kGround);
  EXPECT_EQ(support(LabelSet::kSemanticKitti, 252), Support::kAbove) << "everything else";
  EXPECT_EQ(support(LabelSet::kSemanticKitti, 70), Support::kUnknown) << "vegetation";
  EXPECT_EQ(support(LabelSet::kRellis, 33), Support::kGround);
  EXPECT_EQ(support(LabelSet::kRellis, 19), Support::kAbove);
  EXPECT_EQ(support(LabelSet::kRellis, 7), Support::kUnknown) << "sky is in no list";
  EXPECT_EQ(support(LabelSet::kTerrain, 5U << 16U | 40U), Support::kGround);
  EXPECT_EQ(support(LabelSet::kTerrain, 50), Support::kAbove);
  EXPECT_EQ(support(LabelSet::kTerrain, 0), Support::kUnknown);
}

fs::path write_set(const std::vector<std::uint32_t>& labels) {
  const fs::path folder = fresh_folder();
  fs::create_directories(folder / "velodyne");
  fs::create_directories(folder / "labels");
  Points points;
  points.push_back(1.0F, 2.0F, 3.0F);
  points.push_back(0.0F, 0.0F, 0.0F);
  points.push_back(-1.0F, 0.5F, -2.0F);
  write_kitti_points((folder / "velodyne" / "000007.bin").string(), points);
  io::write_labels((folder / "labels" / "000007.label").string(), labels);
  return folder;
}

TEST(LabelledScans, ZeroReturnsAreLeftOut) {
  const auto files = find_labelled_scans(write_set({40, 40, 50}).string());
  ASSERT_EQ(files.size(), 1U);
  const LabelledScan scan = read_labelled_scan(files[0], LabelSet::kTerrain);
  EXPECT_EQ(scan.slots, 3U);
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.slot, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(scan.support, (std::vector<Support>{Support::kGround, Support::kAbove}));
  EXPECT_EQ(scan.points.z[1], -2.0F);
}

TEST(LabelledScans, WrongFilesAreRefused) {
  const fs::path folder = write_set({40, 40});
  const auto files = find_labelled_scans(folder.string());
  EXPECT_THROW((void)read_labelled_scan(files[0], LabelSet::kTerrain), io::ReadError);
  test::write_file(folder / "velodyne" / "000007.bin", "12345");
  EXPECT_THROW((void)read_labelled_scan(files[0], LabelSet::kTerrain), io::ReadError);
  fs::remove(folder / "labels" / "000007.label");
  EXPECT_THROW((void)find_labelled_scans(folder.string()), io::ReadError);
  EXPECT_THROW((void)find_labelled_scans((folder / "nothing").string()), io::ReadError);
}

TEST(LabelledScans, PredictionsHoldSupportAndClass) {
  PointLabels labels;
  labels.support = {Support::kGround, Support::kAbove, Support::kBelow, Support::kUnknown};
  labels.terrain_class = {TerrainClass::kSlope, TerrainClass::kObstacle, TerrainClass::kNone,
                          TerrainClass::kNone};
  EXPECT_EQ(prediction_labels(labels),
            (std::vector<std::uint32_t>{1U << 16U | 40U, 3U << 16U | 50U, 52, 0}));
}

}  // namespace
}  // namespace mrpt_terrain::eval
