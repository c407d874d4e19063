// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/csv.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "description_builder.h"

namespace mrpt_terrain::view {
namespace {

/// Reads RFC 4180: per record its fields.
std::vector<std::vector<std::string>> parse(const std::string& text) {
  std::vector<std::vector<std::string>> records{{""}};
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quoted && c == '"' && k + 1 < text.size() && text[k + 1] == '"') {
      records.back().back() += text[++k];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      records.back().emplace_back();
    } else if (!quoted && c == '\n') {
      records.push_back({""});
    } else {
      records.back().back() += c;
    }
  }
  EXPECT_EQ(records.back(), std::vector<std::string>{""}) << "the last line has no end";
  records.pop_back();
  return records;
}

/// Records after the header as maps from column name to field.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
  const auto records = parse(text);
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t k = 1; k < records.size(); ++k) {
    EXPECT_EQ(records[k].size(), records[0].size());
    rows.emplace_back();
    for (std::size_t column = 0; column < records[0].size(); ++column) {
      EXPECT_TRUE(rows.back().emplace(records[0][column], records[k].at(column)).second)
          << "two columns are called " << records[0][column];
    }
  }
  return rows;
}

double number(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = std::numeric_limits<double>::quiet_NaN();
  in >> value;
  return value;
}

Description two_clusters() {
  test::DescriptionBuilder builder(10.0, 10.0, 0.1);
  builder.cluster(TerrainClass::kSlope, {60, 40}, {69, 45}, 0.15F, 0.6F);
  auto& slope = builder.last();
  slope.height = {0.45, 1.0 / 3.0, 0.45};
  slope.roughness = {FeatureStatus::kOk, true, {{1e-7, 0.2, 0.9}}};
  slope.slope.status = FeatureStatus::kOk;
  slope.slope.angle = 0.5;
  slope.slope.normal = {0.1, -0.2, 0.97};
  slope.slope.inliers = 55;
  slope.slope.iterations = 12;
  builder.cluster(TerrainClass::kPothole, {5, 15}, {5, 15}, -0.3F, -0.2F);
  builder.last().roughness.lambda[0] = std::numeric_limits<double>::quiet_NaN();
  return builder.build();
}

ScanRecord some_scan() {
  ScanRecord scan;
  scan.file = "a \"b\", c\nd.rawlog";
  scan.entry = 17;
  scan.index = 3;
  scan.stamp = 1317042136.0825;
  scan.sensor_label = "LIDAR,front";
  scan.left_out = {11, 12, 13};
  scan.counts = count(two_clusters());
  scan.milliseconds.io = 0.1;
  scan.milliseconds.stage[static_cast<std::size_t>(Stage::kSlope)] = 2.25;
  scan.milliseconds.total = 1.0 / 3.0;
  return scan;
}

std::string clusters_csv() {
  std::ostringstream out;
  write_clusters_csv_header(out);
  write_clusters_csv(out, some_scan(), two_clusters());
  return out.str();
}

std::string scans_csv() {
  std::ostringstream out;
  write_scans_csv_header(out);
  write_scans_csv(out, some_scan());
  return out.str();
}

TEST(Csv, ClustersReadBackExactly) {
  const auto rows = rows_of(clusters_csv());
  ASSERT_EQ(rows.size(), 2U);
  const auto& row = rows[0];
  EXPECT_EQ(row.at("scan"), "3");
  EXPECT_EQ(number(row.at("stamp")), 1317042136.0825);
  EXPECT_EQ(row.at("cluster"), "0");
  EXPECT_EQ(row.at("class"), "slope");
  EXPECT_EQ(number(row.at("h_m")), 1.0 / 3.0);
  EXPECT_EQ(row.at("h_min"), "0.15");
  EXPECT_EQ(number(row.at("lambda_0")), 1e-7);
  EXPECT_EQ(row.at("rough"), "1");
  EXPECT_DOUBLE_EQ(number(row.at("angle_deg")), 28.64788975654116);
  EXPECT_EQ(number(row.at("normal_y")), -0.2);
  EXPECT_EQ(row.at("inliers"), "55");
  EXPECT_EQ(row.at("iterations"), "12");
  EXPECT_EQ(row.at("cells"), "60");
  EXPECT_NEAR(number(row.at("min_x")), 1.0, 1e-9);
  EXPECT_NEAR(number(row.at("max_y")), -0.4, 1e-9);
}

// The paper's method gives a direction, but no uncertainty; the beam method both.
TEST(Csv, UncertaintiesAreThereWhereTheMethodKnowsThem) {
  EXPECT_EQ(rows_of(clusters_csv())[0].at("direction_deg"), "0");
  EXPECT_EQ(rows_of(clusters_csv())[0].at("angle_sigma_deg"), "");
  Description description = two_clusters();
  Slope& slope = description.things[0].slope;
  slope.direction = 0.25;
  slope.angle_sigma = 0.001;
  slope.direction_sigma = 0.125;
  slope.range_sigma = 0.02;
  slope.to_ground = {FeatureStatus::kOk, 0.5, 0.0625, {0.0, 0.0, 1.0}, 0.0};
  std::ostringstream out;
  write_clusters_csv_header(out);
  write_clusters_csv(out, some_scan(), description);
  const auto row = rows_of(out.str())[0];
  EXPECT_DOUBLE_EQ(number(row.at("direction_deg")), 14.32394487827058);
  EXPECT_DOUBLE_EQ(number(row.at("angle_sigma_deg")), 0.05729577951308232);
  EXPECT_DOUBLE_EQ(number(row.at("direction_sigma_deg")), 7.16197243913529);
  EXPECT_EQ(row.at("range_sigma"), "0.02");
  EXPECT_EQ(row.at("to_ground_status"), "ok");
  EXPECT_DOUBLE_EQ(number(row.at("to_ground_deg")), 28.64788975654116);
  EXPECT_DOUBLE_EQ(number(row.at("to_ground_sigma_deg")), 3.580986219567645);
}

// What field mode measures, empty in paper mode.
TEST(Csv, FeaturesOfFieldMode) {
  for (const char* column :
       {"raised", "scatter", "lowest_step", "highest_step", "confidence", "box_x", "box_y",
        "box_yaw_deg", "box_length", "box_width", "identity"}) {
    EXPECT_EQ(rows_of(clusters_csv())[0].at(column), "") << column;
  }
  Description description = two_clusters();
  ClusterDescription& thing = description.things[0];
  thing.box = {{1.5, -2.5}, 0.5, 3.0, 1.25, 0.0F, 1.0F};
  thing.raised = 7;
  thing.scatter = 0.03;
  thing.lowest_step = 0.1;
  thing.highest_step = 0.4;
  thing.confidence = 0.75;
  std::ostringstream out;
  write_clusters_csv_header(out);
  write_clusters_csv(out, some_scan(), description);
  thing.identity = 18;
  write_clusters_csv(out, some_scan(), description);
  const auto rows = rows_of(out.str());
  EXPECT_EQ(rows[0].at("raised"), "7");
  EXPECT_EQ(rows[0].at("scatter"), "0.03");
  EXPECT_EQ(rows[0].at("lowest_step"), "0.1");
  EXPECT_EQ(rows[0].at("highest_step"), "0.4");
  EXPECT_EQ(rows[0].at("confidence"), "0.75");
  EXPECT_EQ(rows[0].at("box_x"), "1.5");
  EXPECT_EQ(rows[0].at("box_y"), "-2.5");
  EXPECT_DOUBLE_EQ(number(rows[0].at("box_yaw_deg")), 28.64788975654116);
  EXPECT_EQ(rows[0].at("box_length"), "3");
  EXPECT_EQ(rows[0].at("box_width"), "1.25");
  EXPECT_EQ(rows[0].at("identity"), "") << "without poses";
  EXPECT_EQ(rows[2].at("identity"), "18");
}

TEST(Csv, FeaturesThatWereNotComputedAreEmptyAndNeverNaN) {
  const auto rows = rows_of(clusters_csv());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].at("roughness_status"), "not_needed");
  EXPECT_EQ(rows[1].at("slope_status"), "not_needed");
  for (const char* column : {"rough", "lambda_0", "lambda_1", "lambda_2", "angle_deg", "normal_x",
                             "normal_y", "normal_z", "inliers", "iterations", "direction_deg",
                             "angle_sigma_deg", "range_sigma", "to_ground_deg"}) {
    EXPECT_EQ(rows[1].at(column), "") << column;
  }
  EXPECT_EQ(clusters_csv().find("nan"), std::string::npos);
}

TEST(Csv, ScansReadBackWithQuotedText) {
  const auto rows = rows_of(scans_csv());
  ASSERT_EQ(rows.size(), 1U);
  const auto& row = rows[0];
  EXPECT_EQ(row.at("file"), some_scan().file);
  EXPECT_EQ(row.at("sensor_label"), "LIDAR,front");
  EXPECT_EQ(row.at("entry"), "17");
  EXPECT_EQ(row.at("scan"), "3");
  EXPECT_EQ(row.at("left_out_no_return"), "11");
  EXPECT_EQ(row.at("left_out_out_of_range"), "13");
  EXPECT_EQ(row.at("points"), "61");
  EXPECT_EQ(row.at("points_too_high"), "0");
  EXPECT_EQ(row.at("points_above"), "60");
  EXPECT_EQ(row.at("points_below"), "1");
  EXPECT_EQ(row.at("cells_non_ground"), "61");
  EXPECT_EQ(row.at("clusters_slope"), "1");
  EXPECT_EQ(row.at("clusters_pothole"), "1");
  EXPECT_EQ(row.at("clusters_obstacle"), "0");
  EXPECT_EQ(row.at("ms_slope"), "2.25");
  EXPECT_EQ(number(row.at("ms_total")), 1.0 / 3.0);
}

TEST(Csv, TheLocaleDoesNotMatter) {
  const std::string expected = clusters_csv() + scans_csv();
  struct CommaForDecimals : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new CommaForDecimals));
  const std::string actual = clusters_csv() + scans_csv();
  std::locale::global(before);
  EXPECT_EQ(actual, expected);
}

TEST(HolesCsv, ALinePerHole) {
  Description description;
  description.clusters.cluster_of = {3};
  HoleDescription hole;
  hole.centre = {1.5, -2.0};
  hole.length = 0.5;
  hole.width = 0.25;
  hole.depth = 0.125;
  hole.confidence = 0.75;
  hole.points = 12;
  hole.rings = 2;
  hole.slot = 0;
  description.holes = {hole, hole};
  description.holes[1].slot = -1;
  description.holes[1].kind = HoleKind::kDrop;
  ScanRecord scan;
  scan.index = 4;
  scan.stamp = 0.5;
  std::ostringstream out;
  write_holes_csv_header(out);
  write_holes_csv(out, scan, description);
  EXPECT_EQ(out.str(),
            "scan,stamp,hole,kind,cluster,x,y,length,width,depth,points,rings,confidence\n"
            "4,0.5,0,floor,3,1.5,-2,0.5,0.25,0.125,12,2,0.75\n"
            "4,0.5,1,drop,,1.5,-2,0.5,0.25,0.125,12,2,0.75\n");
}

}  // namespace
}  // namespace mrpt_terrain::view
