// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "allocation_counter.h"
#include "field_worlds.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using worlds::field_params;
using worlds::radians;
using worlds::Rect;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Description described(const Points& points, const DescriptionParams& params = field_params()) {
  Description result;
  DescriptionWorkspace workspace;
  describe(points.view(), params, workspace, result);
  return result;
}

constexpr Rect kPatch{-6.0, 6.0, -6.0, 6.0};
constexpr Rect kBox{2.0, 3.0, 1.0, 2.0};
constexpr Rect kHole{-3.0, -2.4, -2.0, -1.4};
constexpr double kBoxHeight = 0.5;

/// A patch of ground with a box on it and a hole of 0.1 m in it, tilted and raised.
Points box_and_hole(double angle, double offset) {
  Points points = worlds::patch_with_hole({-6.0, 0.0, -6.0, 6.0}, kHole, 0.1);
  worlds::add_surface(points, {0.0, 6.0, -6.0, 6.0}, 0.05, [](double x, double y) {
    return worlds::inside(kBox, x, y) ? std::nan("") : 0.0;
  });
  worlds::add_box(points, kBox, kBoxHeight, 0.05);
  return worlds::tilted(points, angle, offset);
}

void expect_one_label_per_point(const Description& d, std::size_t n) {
  EXPECT_EQ(d.labels.support.size(), n);
  EXPECT_EQ(d.labels.reason.size(), n);
  EXPECT_EQ(d.labels.terrain_class.size(), n);
  EXPECT_EQ(d.labels.cluster.size(), n);
  EXPECT_EQ(d.cells.support.size(), d.grid.observed());
  EXPECT_EQ(d.cells.terrain_class.size(), d.grid.observed());
  EXPECT_EQ(d.field.size(), d.grid.observed());
  EXPECT_EQ(d.things.size(), d.clusters.size());
  const ProjectionCounts& p = d.projection;
  EXPECT_EQ(p.in_map + p.not_finite + p.too_high + p.outside_map, n);
}

const ClusterDescription* thing_of_class(const Description& d, TerrainClass terrain_class) {
  const ClusterDescription* found = nullptr;
  for (const ClusterDescription& thing : d.things) {
    if (thing.terrain_class != terrain_class) continue;
    EXPECT_EQ(found, nullptr) << "one thing of the class";
    found = &thing;
  }
  EXPECT_NE(found, nullptr);
  return found;
}

// Analytic. The top of the box is kBoxHeight above the ground along the ground's normal, which is
// kBoxHeight / cos(angle) along z; the reference may be off by 2 cm beside things.
TEST(DescribeField, ABoxOnATiltedPlaneIsOneObstacleOfItsHeight) {
  for (const double degrees : {0.0, 5.0, 10.0, -10.0}) {
    const Points points = box_and_hole(radians(degrees), 0.2);
    const Description d = described(points);
    expect_one_label_per_point(d, points.size());
    EXPECT_EQ(d.things.size(), 2U) << degrees;
    const ClusterDescription* box = thing_of_class(d, TerrainClass::kObstacle);
    ASSERT_NE(box, nullptr) << degrees;
    EXPECT_NEAR(box->height.h_d, kBoxHeight / std::cos(radians(degrees)), 0.02) << degrees;
    EXPECT_EQ(box->height.h_f, box->height.h_d) << degrees;
    // Tilting moves the top by sin(10 deg) 0.5 m = 0.09 m; a cell at each edge.
    EXPECT_NEAR(box->min_corner.x, kBox.x0, 0.3) << degrees;
    EXPECT_NEAR(box->max_corner.x, kBox.x1, 0.3) << degrees;
    EXPECT_NEAR(box->min_corner.y, kBox.y0, 0.21) << degrees;
    EXPECT_NEAR(box->max_corner.y, kBox.y1, 0.21) << degrees;
  }
}

// Tolerance of the depth: see holes_test.
TEST(DescribeField, APotholeIsAPotholeWhoseFloorIsGround) {
  for (const double degrees : {0.0, 5.0}) {
    const Points points = box_and_hole(radians(degrees), 0.2);
    const Description d = described(points);
    const ClusterDescription* hole = thing_of_class(d, TerrainClass::kPothole);
    ASSERT_NE(hole, nullptr) << degrees;
    EXPECT_NEAR(hole->height.h_d, 0.1, 0.02) << degrees;
    EXPECT_LE(hole->height.h_f, -0.08) << degrees;
    EXPECT_NEAR(hole->centroid.x, -2.7, 0.1) << degrees;
    EXPECT_NEAR(hole->centroid.y, -1.7, 0.1) << degrees;
    int floor = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (d.labels.terrain_class[i] != TerrainClass::kPothole) continue;
      EXPECT_EQ(d.labels.support[i], Support::kGround) << i;
      ++floor;
    }
    EXPECT_EQ(floor, hole->points) << degrees;
    EXPECT_GT(floor, 100) << degrees << ": 144 points on the floor";
  }
}

// Every point of a thing has its class and its support; ground has neither thing nor class.
TEST(DescribeField, LabelsOfPointsAreThoseOfTheirThings) {
  const Points points = box_and_hole(radians(5.0), 0.2);
  const Description d = described(points);
  std::vector<std::int32_t> points_of(d.things.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int32_t cluster = d.labels.cluster[i];
    EXPECT_EQ(d.labels.reason[i], UnknownReason::kNone);
    if (cluster == kNoCluster) {
      EXPECT_EQ(d.labels.terrain_class[i], TerrainClass::kNone);
      continue;
    }
    const auto k = static_cast<std::size_t>(cluster);
    ++points_of[k];
    EXPECT_EQ(d.labels.terrain_class[i], d.things[k].terrain_class);
    if (d.things[k].terrain_class == TerrainClass::kObstacle) {
      EXPECT_EQ(d.labels.support[i], Support::kAbove);
    }
  }
  for (std::size_t k = 0; k < d.things.size(); ++k) EXPECT_EQ(points_of[k], d.things[k].points);
}

// Analytic: a box of 1 m x 1 m x 0.5 m, turned about the origin by 30 deg. Its lowest points may be
// left to the ground.
TEST(DescribeField, ABoxHasItsOrientedBoxAndItsSteps) {
  const double yaw = radians(30.0);
  const Points straight = box_and_hole(0.0, 0.0);
  Points points;
  for (std::size_t i = 0; i < straight.size(); ++i) {
    const double x = double{straight.x[i]}, y = double{straight.y[i]};
    worlds::add_point(points, std::cos(yaw) * x - std::sin(yaw) * y,
                      std::sin(yaw) * x + std::cos(yaw) * y, double{straight.z[i]});
  }
  const Description d = described(points);
  const ClusterDescription* box = thing_of_class(d, TerrainClass::kObstacle);
  ASSERT_NE(box, nullptr);
  EXPECT_NEAR(box->box.length, 1.0, 0.02);
  EXPECT_NEAR(box->box.width, 1.0, 0.02);
  EXPECT_NEAR(std::remainder(box->box.yaw - yaw, radians(90.0)), 0.0, radians(1.0));
  EXPECT_NEAR(box->box.centre.x, 2.5 * std::cos(yaw) - 1.5 * std::sin(yaw), 0.02);
  EXPECT_NEAR(box->box.centre.y, 2.5 * std::sin(yaw) + 1.5 * std::cos(yaw), 0.02);
  EXPECT_NEAR(box->box.high, kBoxHeight, 1e-5);
  EXPECT_NEAR(box->highest_step, kBoxHeight, 0.03);
  EXPECT_NEAR(box->lowest_step, kBoxHeight, 0.03) << "it has the same step on all sides";
  EXPECT_GT(box->scatter, 0.1) << "five faces are no plane";
  EXPECT_LT(box->scatter, 0.3);
  EXPECT_GT(box->confidence, 0.9);
  EXPECT_LT(box->confidence, 1.0);
  EXPECT_EQ(box->identity, 0U);
}

// Analytic: a ramp of 3 deg, 1.8 m long and 9 cm high at its end, which the reference runs over. It
// is one thing, though all of it is ground, with its highest step at its end.
TEST(DescribeField, AFlatRampIsAThingOfRaisedGround) {
  const Rect ramp{2.0, 3.8, -1.2, 1.2};
  Points points;
  worlds::add_surface(points, kPatch, 0.05, [&](double x, double y) {
    return worlds::inside(ramp, x, y) ? std::tan(radians(3.0)) * (x - ramp.x0) : 0.0;
  });
  DescriptionParams params = field_params();
  params.slope.method = SlopeMethod::kBeam;
  params.beam_slope.ring_sigma = 0.0;
  constexpr std::array<float, 3> kOrigin{0.0F, 0.0F, 1.5F};
  Description d;
  DescriptionWorkspace workspace;
  describe({points.view(), {&kOrigin, nullptr}}, params, workspace, d);
  ASSERT_EQ(d.things.size(), 1U);
  const ClusterDescription& thing = d.things.front();
  EXPECT_EQ(thing.raised, thing.points);
  EXPECT_EQ(thing.terrain_class, TerrainClass::kSlope);
  ASSERT_EQ(thing.slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(thing.slope.angle, radians(3.0), radians(0.1));
  EXPECT_NEAR(thing.slope.direction, 0.0, radians(1.0));
  ASSERT_EQ(thing.slope.to_ground.status, FeatureStatus::kOk);
  EXPECT_NEAR(thing.slope.to_ground.angle, radians(3.0), radians(0.5));
  EXPECT_NEAR(thing.highest_step, 0.094, 0.03);
  EXPECT_LT(thing.lowest_step, 0.08);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(d.labels.support[i], Support::kGround) << "a wheel can rest on it";
}

TEST(DescribeField, NoPointsGiveAnEmptyDescription) {
  const Description d = described(Points{});
  expect_one_label_per_point(d, 0);
  EXPECT_EQ(d.grid.observed(), 0U);
  EXPECT_TRUE(d.things.empty());
}

// What has no place has a label that says why, and changes nothing for the others.
TEST(DescribeField, PointsThatAreNotFiniteAreLeftOut) {
  const Points clean = box_and_hole(radians(5.0), 0.2);
  Points points;
  std::vector<std::size_t> useless;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (i % 1000 == 0) {
      useless.push_back(points.size());
      const std::size_t which = i / 1000 % 3;
      points.push_back(which == 0 ? kNan : 1.0F, which == 1 ? kInf : 1.0F,
                       which == 2 ? -kInf : 0.0F);
    }
    points.push_back(clean.x[i], clean.y[i], clean.z[i]);
  }
  const Description d = described(points);
  const Description expected = described(clean);
  expect_one_label_per_point(d, points.size());
  EXPECT_EQ(d.projection.not_finite, useless.size());
  for (const std::size_t i : useless) {
    EXPECT_EQ(d.labels.support[i], Support::kUnknown);
    EXPECT_EQ(d.labels.reason[i], UnknownReason::kNotFinite);
    EXPECT_EQ(d.labels.cluster[i], kNoCluster);
  }
  EXPECT_EQ(d.cells.support, expected.cells.support);
  EXPECT_EQ(d.cells.terrain_class, expected.cells.terrain_class);
  EXPECT_EQ(d.grid.h_mean, expected.grid.h_mean);

  Points only;
  for (int k = 0; k < 3; ++k) only.push_back(kNan, kNan, kNan);
  const Description nothing = described(only);
  expect_one_label_per_point(nothing, 3);
  EXPECT_TRUE(nothing.things.empty());
}

// Degenerate input: one description each, whatever it says.
TEST(DescribeField, FewOrEqualOrCollinearPoints) {
  std::vector<Points> scans(6);
  for (int n = 1; n <= 3; ++n) {
    for (int i = 0; i < n; ++i)
      scans[static_cast<std::size_t>(n - 1)].push_back(static_cast<float>(i), 1.0F, 0.0F);
  }
  for (int i = 0; i < 100; ++i) {
    scans[3].push_back(2.0F, 1.0F, 0.5F);
    scans[4].push_back(0.05F * static_cast<float>(i), 1.0F, 0.0F);
    scans[5].push_back(1000.0F, 1000.0F, 0.0F);
  }
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Description d = described(scans[k]);
    expect_one_label_per_point(d, scans[k].size());
    for (const ClusterDescription& thing : d.things) {
      EXPECT_TRUE(std::isfinite(thing.height.h_f)) << k;
    }
  }
  const Description outside = described(scans[5]);
  EXPECT_EQ(outside.projection.outside_map, 100U);
  for (const UnknownReason reason : outside.labels.reason)
    EXPECT_EQ(reason, UnknownReason::kOutsideMap);
}

// Support is known wherever the reference reaches, outside the map and over its ceiling, too;
// unknown support has a reason, also where the map reaches beyond the reference.
TEST(DescribeField, SupportIsUnknownOnlyForAReason) {
  Points points = box_and_hole(0.0, 0.0);
  const std::size_t first = points.size();
  points.push_back(2.5F, 1.5F, 4.0F);    // over the ceiling of 3 m
  points.push_back(40.0F, 1.5F, 0.0F);   // outside the map of 30 m
  points.push_back(500.0F, 1.5F, 0.0F);  // outside both
  const Description d = described(points);
  EXPECT_EQ(d.labels.support[first], Support::kAbove);
  EXPECT_EQ(d.labels.reason[first], UnknownReason::kNone);
  EXPECT_EQ(d.labels.cluster[first], kNoCluster);
  EXPECT_EQ(d.labels.support[first + 1], Support::kGround);
  EXPECT_EQ(d.labels.support[first + 2], Support::kUnknown);
  EXPECT_EQ(d.labels.reason[first + 2], UnknownReason::kOutsideMap);

  DescriptionParams wide = field_params();
  wide.grid.length = wide.grid.width = 300.0;
  wide.grid.cell_size = 1.0;
  points.push_back(140.0F, 0.0F, 0.0F);  // in the map, beyond the reference of 102.4 m
  const Description w = described(points, wide);
  EXPECT_EQ(w.labels.support[first + 3], Support::kUnknown);
  EXPECT_EQ(w.labels.reason[first + 3], UnknownReason::kOutsideMap);
}

/// What is compared of two descriptions.
void expect_same(const Description& a, const Description& b) {
  EXPECT_EQ(a.labels.support, b.labels.support);
  EXPECT_EQ(a.labels.reason, b.labels.reason);
  EXPECT_EQ(a.labels.terrain_class, b.labels.terrain_class);
  EXPECT_EQ(a.labels.cluster, b.labels.cluster);
  EXPECT_EQ(a.cells.support, b.cells.support);
  EXPECT_EQ(a.grid.h_mean, b.grid.h_mean);
  EXPECT_EQ(a.ground.rule, b.ground.rule);
  EXPECT_EQ(a.ground.h_mean, b.ground.h_mean);
  EXPECT_EQ(a.field.ground, b.field.ground);
  EXPECT_EQ(a.field.rim, b.field.rim);
  EXPECT_EQ(a.clusters.cluster_of, b.clusters.cluster_of);
  EXPECT_EQ(a.clusters.dropped, b.clusters.dropped);
  ASSERT_EQ(a.things.size(), b.things.size());
  for (std::size_t k = 0; k < a.things.size(); ++k) {
    EXPECT_EQ(a.things[k].terrain_class, b.things[k].terrain_class) << k;
    EXPECT_EQ(a.things[k].height.h_f, b.things[k].height.h_f) << k;
    EXPECT_EQ(a.things[k].slope.angle, b.things[k].slope.angle) << k;
    EXPECT_EQ(a.things[k].points, b.things[k].points) << k;
    EXPECT_EQ(a.things[k].centroid.x, b.things[k].centroid.x) << k;
  }
}

// Paper mode does not look at what is field mode's.
TEST(DescribeField, PaperModeDoesNotDependOnFieldParameters) {
  const Points points = worlds::world_of_all_classes(281);
  const DescriptionParams plain;
  DescriptionParams changed;
  changed.ground_surface.cell_size = 1.0;
  changed.ground_surface.tolerance = 0.5;
  changed.ground_labels.most = 1.0;
  changed.ground_labels.prior = 0.0;
  changed.holes.mean_depth = 1.0;
  changed.field_clusters.t_c = 1000;
  changed.field_clusters.link = 5.0;
  const Description a = described(points, plain);
  EXPECT_EQ(a.things.size(), 4U);
  EXPECT_EQ(a.field.size(), 0U);
  expect_same(a, described(points, changed));
}

// Field mode does not look at what is the paper's ground and clusters.
TEST(DescribeField, FieldModeDoesNotDependOnThePapersGroundAndClusters) {
  const Points points = box_and_hole(radians(5.0), 0.2);
  DescriptionParams changed = field_params();
  changed.ground.t_diff = changed.ground.t_high = 1.0;
  changed.clusters.t_c = 1000;
  expect_same(described(points), described(points, changed));
}

// Modes may change between scans: nothing of the other is left.
TEST(DescribeField, UsedMemoryOfBothModesLeavesNoTrace) {
  const Points uneven = box_and_hole(radians(5.0), 0.2);
  const Points level = worlds::world_of_all_classes(282);
  const DescriptionParams paper;
  Description used;
  DescriptionWorkspace workspace;
  for (int run = 0; run < 2; ++run) {
    describe(level.view(), paper, workspace, used);
    expect_same(used, described(level, paper));
    describe(uneven.view(), field_params(), workspace, used);
    expect_same(used, described(uneven));
    describe(level.view(), field_params(), workspace, used);
    expect_same(used, described(level));
  }
}

TEST(DescribeField, DoesNotAllocateInSteadyState) {
  const Points points = box_and_hole(radians(5.0), 0.2);
  const Points mixed = worlds::shuffled(points, 283);
  DescriptionParams params = field_params();
  params.classes.all_features = true;
  Description description;
  DescriptionWorkspace workspace;
  describe(points.view(), params, workspace, description);
  describe(mixed.view(), params, workspace, description);
  const std::size_t before = bench::allocations();
  for (int k = 0; k < 3; ++k) {
    describe(points.view(), params, workspace, description);
    describe(mixed.view(), params, workspace, description);
  }
  EXPECT_EQ(bench::allocations(), before);
}

// Invariant: shuffled points, the same labels per point. Heights may differ by rounding, so points
// within 1e-4 m of a threshold would be allowed to change; here none lies there.
TEST(DescribeField, TheOrderOfThePointsDoesNotMatter) {
  const Points points = box_and_hole(radians(5.0), 0.2);
  std::vector<std::size_t> order;
  const Points mixed = worlds::shuffled(points, 284, &order);
  const Description a = described(points);
  const Description b = described(mixed);
  ASSERT_EQ(a.things.size(), b.things.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t old = order[i];
    different +=
        a.labels.support[old] == b.labels.support[i] && a.labels.cluster[old] == b.labels.cluster[i]
            ? 0
            : 1;
  }
  EXPECT_EQ(different, 0U);
}

/// Counts how often each stage is told.
class StageCounter : public StageListener {
 public:
  void stage_done(Stage stage) override { ++count[static_cast<std::size_t>(stage)]; }
  std::vector<int> count = std::vector<int>(kStageCount, 0);
};

TEST(DescribeField, TellsEveryStageOnce) {
  StageCounter counter;
  Description description;
  DescriptionWorkspace workspace;
  const Points points = box_and_hole(0.0, 0.0);
  describe(points.view(), field_params(), workspace, description, &counter);
  EXPECT_EQ(counter.count, std::vector<int>(kStageCount, 1));
}

}  // namespace
}  // namespace mrpt_terrain
