// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/describe_fused.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "allocation_counter.h"
#include "lidar.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;
using worlds::Rect;

struct Robot {
  FusionParams fusion;
  DescriptionParams params;
  FusedGrid grid{MapLattice(0.05, 0.05)};
  FusionWorkspace fusing;
  FusedDescriptionWorkspace workspace;
  FusedDescription result;
  double time = 0.0;

  Robot() {
    fusion.extent = FusionExtent::kGrowing;
    fusion.cell_size = fusion.layer_height = 0.05;
    fusion.renew_scans = 0;
    fusion.least_share = 0.0;
    fusion.spread_limit = 1e6;
  }
  void fuse(const Points& points, const Eigen::Isometry3d& pose) {
    time += 0.1;
    fuse_scan({points.view(), pose, time}, fusion, fusing, grid);
  }
  const FusedDescription& describe(const Points& points, const Eigen::Isometry3d& pose) {
    describe_fused(grid.now(), {{points.view(), pose, time}, {}, 0}, {params, fusion}, workspace,
                   result);
    return result;
  }
};

Eigen::Isometry3d at(double x, double y, double z = 0.0, double yaw = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

const ClusterDescription& thing_in(const Description& d, const Rect& rect) {
  static const ClusterDescription kMissing;
  for (const ClusterDescription& thing : d.things) {
    if (worlds::inside(rect, thing.centroid.x, thing.centroid.y)) return thing;
  }
  ADD_FAILURE() << "no cluster about " << rect.x0 << ", " << rect.y0;
  return kMissing;
}

// Points well within their cells, so that rounding by 2^-17 m moves none into another cell.
Points world_within_cells() {
  Points points = worlds::world_of_all_classes(5);
  for (auto* axis : {&points.x, &points.y}) {
    for (float& v : *axis) v = std::floor(v / 0.0125F) * 0.0125F + 0.00625F;
  }
  return points;
}

TEST(DescribeFused, OfOneScanIsTheDescriptionOfTheScan) {
  Robot robot;
  const Points points = world_within_cells();
  const Eigen::Isometry3d pose = at(12.0, -40.0, 3.0);
  robot.fuse(points, pose);
  const Description& fused = robot.describe(points, pose).description;
  Description single;
  DescriptionWorkspace workspace;
  describe(points.view(), robot.params, workspace, single);
  EXPECT_EQ(fused.grid.cell, single.grid.cell);
  EXPECT_EQ(fused.projection.in_map, single.projection.in_map);
  EXPECT_EQ(fused.projection.outside_map, single.projection.outside_map);
  EXPECT_EQ(fused.ground.rule, single.ground.rule);
  EXPECT_EQ(fused.clusters.slots.items, single.clusters.slots.items);
  EXPECT_EQ(fused.labels.support, single.labels.support);
  EXPECT_EQ(fused.labels.cluster, single.labels.cluster);
  ASSERT_EQ(fused.things.size(), single.things.size());
  ASSERT_EQ(fused.things.size(), 4U);
  for (std::size_t k = 0; k < single.things.size(); ++k) {
    EXPECT_EQ(fused.things[k].terrain_class, single.things[k].terrain_class);
    EXPECT_EQ(fused.things[k].points, single.things[k].points);
    EXPECT_NEAR(fused.things[k].height.h_f, single.things[k].height.h_f, 1e-4);
    EXPECT_EQ(fused.things[k].roughness.rough, single.things[k].roughness.rough);
    EXPECT_EQ(fused.things[k].slope.status, single.things[k].slope.status);
    EXPECT_EQ(fused.things[k].slope.source, PlaneSource::kPoints);
    EXPECT_NEAR(fused.things[k].slope.angle, single.things[k].slope.angle, 1e-3);
  }
}

TEST(DescribeFused, WithoutPointsOfTheScanThePlaneComesFromTheMoments) {
  Robot robot;
  const Points points = world_within_cells();
  robot.fuse(points, at(0, 0));
  const Points none;
  robot.fuse(none, at(0, 0));
  const ClusterDescription& ramp =
      thing_in(robot.describe(none, at(0, 0)).description, worlds::kRampRect);
  EXPECT_EQ(ramp.terrain_class, TerrainClass::kSlope);
  EXPECT_EQ(ramp.slope.status, FeatureStatus::kOk);
  EXPECT_EQ(ramp.slope.source, PlaneSource::kMoments);
  EXPECT_NEAR(ramp.slope.angle, worlds::kRampAngle, radians(0.2));
  EXPECT_NEAR(std::abs(ramp.slope.direction), 0.0, radians(0.5));
  EXPECT_EQ(ramp.slope.points, ramp.points);
}

TEST(DescribeFused, PointsCountOnlyIfTheyCoverTheCluster) {
  Robot robot;
  const Points all = world_within_cells();
  robot.fuse(all, at(0, 0));
  for (const double share : {0.3, 0.7}) {
    Points some;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.x[i] < 1.0 + share) some.push_back(all.x[i], all.y[i], all.z[i]);
    }
    const Slope slope =
        thing_in(robot.describe(some, at(0, 0)).description, worlds::kRampRect).slope;
    EXPECT_EQ(slope.source, share < 0.5 ? PlaneSource::kMoments : PlaneSource::kPoints) << share;
    EXPECT_NEAR(slope.angle, worlds::kRampAngle, radians(0.2));
  }
}

TEST(DescribeFused, ManyPosesSeeTheSameWorld) {
  // A box and a ramp, seen from several places and under several headings.
  Robot robot;
  robot.params.grid.cell_size = 0.1;
  robot.fusion.cell_size = robot.fusion.layer_height = 0.1;
  robot.grid = FusedGrid(robot.fusion);
  robot.params.grid.length = robot.params.grid.width = 8.0;
  robot.params.classes.all_features = true;  // with its upright sides the ramp is rough
  const Rect ramp_at{3.0, 4.2, -2.2, -1.0};
  const worlds::Scene scene{{worlds::box_solid({3.0, 3.6, 1.0, 1.6}, 0.0, 0.4, 1),
                             worlds::ramp_solid(ramp_at, radians(15.0), 2)},
                            {}};
  worlds::LidarModel model = worlds::thirty_two_beams(0.003);
  RandomGenerator random(1);
  Points last;
  Eigen::Isometry3d pose;
  for (int k = 0; k < 12; ++k) {
    worlds::Scene moved = scene;  // the sensor of lidar.h stands at the origin
    const double x = 0.15 * k;
    for (worlds::Solid& solid : moved.solids) {
      for (worlds::HalfSpace& face : solid.faces) face.bound -= face.normal.x * x;
    }
    const double yaw = 0.2 * k;
    pose = at(x, 0.0, 0.0, yaw);
    last.clear();
    const worlds::LidarScan scan = worlds::scan(moved, model, random);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d p =
          Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()) *
          Eigen::Vector3d(scan.points.x[i], scan.points.y[i], scan.points.z[i]);
      worlds::add_point(last, p.x(), p.y(), p.z());
    }
    robot.fuse(last, pose);
  }
  const FusedDescription& result = robot.describe(last, pose);
  const auto in_window = [&](const Rect& r) {
    return Rect{r.x0 - result.frame.x, r.x1 - result.frame.x, r.y0 - result.frame.y,
                r.y1 - result.frame.y};
  };
  const ClusterDescription& box = thing_in(result.description, in_window({2.9, 3.7, 0.9, 1.7}));
  EXPECT_EQ(box.terrain_class, TerrainClass::kObstacle);
  EXPECT_NEAR(box.h_max, 0.4, 0.02);
  const ClusterDescription& ramp = thing_in(result.description, in_window(ramp_at));
  EXPECT_EQ(ramp.slope.source, PlaneSource::kPoints);
  EXPECT_NEAR(ramp.slope.angle, radians(15.0), radians(1.0));
  std::size_t ground = 0;
  for (std::size_t slot = 0; slot < result.description.grid.observed(); ++slot) {
    ground += result.description.ground.is_ground(slot) ? 1U : 0U;
  }
  EXPECT_GT(ground, 2500U);
}

TEST(DescribeFused, TheBeamMethodUsesTheCurrentScan) {
  Robot robot;
  robot.params.slope.method = SlopeMethod::kBeam;
  const Points points = world_within_cells();
  const Eigen::Isometry3d pose = at(3.0, 4.0, 0.0, 0.0);
  for (int k = 0; k < 5; ++k) robot.fuse(points, pose);
  const std::array<float, 3> origin = {0.0F, 0.0F, 0.81F};
  BeamOrigins origins;
  origins.origins = &origin;
  describe_fused(robot.grid.now(), {{points.view(), pose, robot.time}, origins, 1},
                 {robot.params, robot.fusion}, robot.workspace, robot.result);
  const Slope slope = thing_in(robot.result.description, worlds::kRampRect).slope;
  EXPECT_EQ(slope.source, PlaneSource::kPoints);
  EXPECT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, worlds::kRampAngle, radians(0.3));
  EXPECT_EQ(slope.to_ground.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.to_ground.angle, worlds::kRampAngle, radians(0.5));

  DescriptionWorkspace workspace;
  Description single;
  describe(ScanView(points.view(), origins), robot.params, workspace, single);
  EXPECT_EQ(slope.points, thing_in(single, worlds::kRampRect).slope.points)
      << "five scans in the cells, but the points of one";
}

TEST(DescribeFused, WhatTheMapDoesNotHoldIsOutside) {
  Robot robot;
  const float nan = std::nanf("");
  Points points;
  points.push_back(0.0F, 0.0F, 0.0F);
  points.push_back(nan, 0.0F, 0.0F);
  points.push_back(0.0F, 0.0F, 1.6F);
  points.push_back(1.0F, 1.0F, 0.0F);
  points.push_back(99.0F, 1.0F, 0.0F);
  Points fused;
  fused.push_back(0.0F, 0.0F, 0.0F);
  robot.fuse(fused, at(0, 0));
  const Description& d = robot.describe(points, at(0, 0)).description;
  EXPECT_EQ(d.projection.in_map, 1U);
  EXPECT_EQ(d.projection.not_finite, 1U);
  EXPECT_EQ(d.projection.too_high, 1U);
  EXPECT_EQ(d.projection.outside_map, 2U);
  ASSERT_EQ(d.labels.reason.size(), 5U);
  EXPECT_EQ(d.labels.support[0], Support::kGround);
  EXPECT_EQ(d.labels.reason[3], UnknownReason::kOutsideMap);
  Robot empty;
  EXPECT_EQ(empty.describe(points, at(0, 0)).description.grid.observed(), 0U);
}

TEST(DescribeFused, ASecondTimeDoesNotAllocateAndGivesTheSame) {
  Robot robot;
  const Points points = world_within_cells();
  robot.fuse(points, at(0, 0));
  robot.describe(points, at(0, 0));
  const std::vector<float> h_mean = robot.result.description.grid.h_mean;
  const double angle = thing_in(robot.result.description, worlds::kRampRect).slope.angle;
  robot.describe(points, at(0, 0));
  const std::size_t before = bench::allocations();
  robot.describe(points, at(0, 0));
  EXPECT_EQ(bench::allocations(), before);
  EXPECT_EQ(robot.result.description.grid.h_mean, h_mean);
  EXPECT_EQ(thing_in(robot.result.description, worlds::kRampRect).slope.angle, angle);
}

TEST(SlopeFromMoments, IsThePlaneOfAllPoints) {
  SlopeParams params;
  for (const double degrees : {0.0, 10.0, 40.0, 80.0}) {
    const double angle = radians(degrees);
    MomentSums sums;
    for (int i = 0; i < 20; ++i) {
      for (int k = 0; k < 20; ++k) {
        sums.add(0.05 * i * std::cos(angle), 0.05 * k, 0.05 * i * std::sin(angle) + 1.0);
      }
    }
    const Slope slope = slope_from_moments(moments_from(sums), params);
    EXPECT_EQ(slope.status, FeatureStatus::kOk);
    EXPECT_EQ(slope.source, PlaneSource::kMoments);
    EXPECT_NEAR(slope.angle, angle, 1e-6);
    EXPECT_NEAR(slope.normal.dot(Eigen::Vector3d(0, 0, 1)) + slope.offset, 0.0, 1e-9);
  }
}

TEST(SlopeFromMoments, OfTooLittleIsAStatus) {
  const SlopeParams params;
  EXPECT_EQ(slope_from_moments({}, params).status, FeatureStatus::kTooFewPoints);
  MomentSums line;
  for (int k = 0; k < 9; ++k) line.add(k, 2.0 * k, 0.5 * k);
  EXPECT_EQ(slope_from_moments(moments_from(line), params).status, FeatureStatus::kDegenerate);
  MomentSums spot;
  for (int k = 0; k < 9; ++k) spot.add(1.0, 2.0, 3.0);
  EXPECT_EQ(slope_from_moments(moments_from(spot), params).status, FeatureStatus::kDegenerate);
}

}  // namespace
}  // namespace mrpt_terrain
