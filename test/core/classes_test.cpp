// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace mrpt_terrain {
namespace {

HeightIndex height(double h_f) { return {0.0, 0.0, h_f}; }

Roughness measured_roughness(bool rough) { return {FeatureStatus::kOk, rough, {{0, 0, 0}}}; }

Slope measured_slope(double angle) {
  Slope slope;
  slope.status = FeatureStatus::kOk;
  slope.angle = angle;
  return slope;
}

const ClassParams kParams;
constexpr double kGentle = 0.3;  // radians

// Table 1 by hand.
TEST(Classes, TableOneByHand) {
  struct Case {
    double h_f;
    bool rough;
    TerrainClass expected;
  };
  for (const Case& c :
       {Case{-0.09, true, TerrainClass::kPothole}, Case{-0.09, false, TerrainClass::kPothole},
        Case{0.15, true, TerrainClass::kObstacle}, Case{0.15, false, TerrainClass::kSlope},
        Case{0.02, true, TerrainClass::kOther}, Case{0.02, false, TerrainClass::kOther},
        Case{-0.02, false, TerrainClass::kOther}, Case{0.0, false, TerrainClass::kOther}}) {
    EXPECT_EQ(
        classify(height(c.h_f), measured_roughness(c.rough), measured_slope(kGentle), kParams),
        c.expected)
        << c.h_f << " " << c.rough;
  }
}

// Row "Table 1 versus text at the limits": the table includes both limits.
TEST(PaperReading, LimitsOfTableOneBelongToPotholeAndObstacle) {
  EXPECT_EQ(class_from_height(height(-0.05), kParams), TerrainClass::kPothole);
  EXPECT_EQ(class_from_height(height(std::nextafter(-0.05F, 0.0F)), kParams), TerrainClass::kOther);
  EXPECT_EQ(class_from_height(height(0.05), kParams), TerrainClass::kNone);
  EXPECT_EQ(class_from_height(height(std::nextafter(0.05F, 0.0F)), kParams), TerrainClass::kOther);
  // Heights are floats: one that is written like the threshold is at the threshold, for all values.
  ClassParams params;
  params.t_pos = 0.7;  // more than 0.7F
  EXPECT_EQ(class_from_height(height(0.7F), params), TerrainClass::kNone);
}

// The same row: every height index has exactly one class, and the height alone decides unless the
// cluster rises to T_pos.
TEST(PaperReading, TableOneIsACompletePartition) {
  for (int k = -200; k <= 200; ++k) {
    const double h_f = k * 0.001;
    for (const bool rough : {false, true}) {
      const TerrainClass c =
          classify(height(h_f), measured_roughness(rough), measured_slope(kGentle), kParams);
      const int rows = (h_f <= -0.05 && c == TerrainClass::kPothole ? 1 : 0) +
                       (h_f >= 0.05 && rough && c == TerrainClass::kObstacle ? 1 : 0) +
                       (h_f >= 0.05 && !rough && c == TerrainClass::kSlope ? 1 : 0) +
                       (h_f > -0.05 && h_f < 0.05 && c == TerrainClass::kOther ? 1 : 0);
      EXPECT_EQ(rows, 1) << h_f << " " << rough;
      const TerrainClass by_height = class_from_height(height(h_f), kParams);
      EXPECT_EQ(by_height, h_f >= 0.05 ? TerrainClass::kNone : c) << h_f;
    }
  }
}

// "An application gives the interval of angles that counts as a slope": closed, in radians.
TEST(Classes, OnlyAnglesOfTheIntervalAreSlopes) {
  ClassParams params;
  params.slope_min = 0.25;
  params.slope_max = 0.5;
  const auto class_at = [&](double angle) {
    return classify(height(0.3), measured_roughness(false), measured_slope(angle), params);
  };
  EXPECT_EQ(class_at(0.25), TerrainClass::kSlope);
  EXPECT_EQ(class_at(0.5), TerrainClass::kSlope);
  EXPECT_EQ(class_at(std::nextafter(0.25, 0.0)), TerrainClass::kObstacle);
  EXPECT_EQ(class_at(std::nextafter(0.5, 1.0)), TerrainClass::kObstacle);
}

TEST(Classes, AWallIsAnObstacle) {
  EXPECT_EQ(classify(height(1.0), measured_roughness(false), measured_slope(1.57), kParams),
            TerrainClass::kObstacle);
}

// Poor data: a feature that could not be computed never makes a slope.
TEST(Classes, FeaturesThatCouldNotBeComputedMakeObstacles) {
  for (const FeatureStatus status : {FeatureStatus::kNotNeeded, FeatureStatus::kTooFewPoints,
                                     FeatureStatus::kDegenerate, FeatureStatus::kNoConsensus}) {
    Roughness poor_roughness = measured_roughness(false);
    poor_roughness.status = status;
    Slope poor_slope = measured_slope(kGentle);
    poor_slope.status = status;
    EXPECT_EQ(classify(height(0.3), poor_roughness, measured_slope(kGentle), kParams),
              TerrainClass::kObstacle)
        << name_of(status);
    EXPECT_EQ(classify(height(0.3), measured_roughness(false), poor_slope, kParams),
              TerrainClass::kObstacle)
        << name_of(status);
    EXPECT_EQ(classify(height(-0.3), poor_roughness, poor_slope, kParams), TerrainClass::kPothole);
    EXPECT_EQ(classify(height(0.01), poor_roughness, poor_slope, kParams), TerrainClass::kOther);
  }
}

}  // namespace
}  // namespace mrpt_terrain
