// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/run_summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mrpt_terrain::view {
namespace {

ScanRecord scan_of(std::size_t index, double total_ms) {
  ScanRecord scan;
  scan.file = "drive.rawlog";
  scan.entry = 10 + index;
  scan.index = index;
  scan.counts.points = 100;
  scan.left_out = {1, 2, 4};
  scan.counts.clusters[static_cast<std::size_t>(TerrainClass::kPothole)] = 2;
  scan.milliseconds.stage[static_cast<std::size_t>(Stage::kGround)] = 0.5 * total_ms;
  scan.milliseconds.total = total_ms;
  return scan;
}

TEST(RunSummary, QuantilesAreMeasuredValues) {
  std::vector<double> values;
  for (int k = 20; k >= 1; --k) values.push_back(k);
  const Quantiles result = quantiles(values);
  EXPECT_EQ(result.median, 10.0);  // rank 10 of 20
  EXPECT_EQ(result.p95, 19.0);     // rank 19 of 20
  EXPECT_EQ(result.max, 20.0);
  EXPECT_EQ(quantiles({7.0}).median, 7.0);
  EXPECT_EQ(quantiles({7.0}).p95, 7.0);
  EXPECT_EQ(quantiles({}).max, 0.0);
}

TEST(RunSummary, JsonReadsBack) {
  RunSummary summary;
  summary.version = "1.2.3";
  summary.inputs = {"drive.rawlog", "second.rawlog"};
  summary.scans_skipped = {{"planar_scan", 4}, {"no_points", 1}};
  summary.unknown_classes = {{"CObservationFoo", 3}};
  summary.wall_seconds = 1.5;
  add_scan(summary, scan_of(0, 8.0));
  add_scan(summary, scan_of(1, 30.0));
  add_scan(summary, scan_of(2, 9.0));
  summary.worst_scan = ScanReference{"drive.rawlog", 12, 2, "most potholes"};

  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["inputs"].size(), 2U);
  EXPECT_EQ(json["scans_processed"], 3);
  EXPECT_EQ(json["scans_skipped"], 5);
  EXPECT_EQ(json["skipped_because"]["planar_scan"], 4);
  EXPECT_EQ(json["unknown_classes"]["CObservationFoo"], 3);
  EXPECT_EQ(json["points"], 300);
  EXPECT_EQ(json["left_out"]["no_return"], 3);
  EXPECT_EQ(json["left_out"]["not_finite"], 6);
  EXPECT_EQ(json["left_out"]["out_of_range"], 12);
  EXPECT_EQ(json["clusters"]["pothole"], 6);
  EXPECT_EQ(json["clusters"]["slope"], 0);
  EXPECT_FALSE(json["clusters"].contains("none"));
  EXPECT_EQ(json["milliseconds"]["total"]["median"], 9.0);
  EXPECT_EQ(json["milliseconds"]["total"]["max"], 30.0);
  EXPECT_EQ(json["milliseconds"]["ground"]["median"], 4.5);
  EXPECT_EQ(json["slowest_scan"]["scan"], 1);
  EXPECT_EQ(json["slowest_scan"]["entry"], 11);
  EXPECT_EQ(json["worst_scan"]["why"], "most potholes");
  EXPECT_EQ(json["wall_seconds"], 1.5);
}

TEST(RunSummary, ARunWithoutScansIsStillValid) {
  const auto json = nlohmann::json::parse(summary_json(RunSummary{}));
  EXPECT_EQ(json["scans_processed"], 0);
  EXPECT_TRUE(json["slowest_scan"].is_null());
  EXPECT_TRUE(json["worst_scan"].is_null());
  EXPECT_TRUE(json["skipped_because"].is_object());
  EXPECT_TRUE(json["inputs"].is_array());
}

TEST(RunSummary, NamesThatAreNotUtf8DoNotLoseTheSummary) {
  RunSummary summary;
  summary.inputs = {"caf\xE9.rawlog"};
  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_EQ(json["inputs"][0], "caf\xEF\xBF\xBD.rawlog");
}

}  // namespace
}  // namespace mrpt_terrain::view
