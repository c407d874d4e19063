// SPDX-License-Identifier: BSD-3-Clause
// Scans of worlds and the score of a method that knows the truth.
#include "mrpt_terrain/eval/world_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::eval {
namespace {

sim::Family family(const std::string& name) {
  return sim::resolve_family(name, MRPT_TERRAIN_SOURCE_DIR "/params/families");
}

ScanOptions options() {
  ScanOptions result;
  result.sensor_folder = MRPT_TERRAIN_SOURCE_DIR "/params/sensors";
  result.sensor = "vlp16";
  return result;
}

/// How far points lie from where the returns truly are, and the greatest such distance.
double greatest_error(const std::string& name, const ScanOptions& scan_options) {
  const auto world = make_driven_world(family(name), 3, scan_options);
  world->sensor.model.noise = {};
  ScanWorkspace workspace;
  TestScan scan;
  take_scan(*world, world->sweeps / 2, scan_options, workspace, scan);
  EXPECT_GT(scan.points.size(), 1000U);
  double greatest = 0.0;
  std::size_t i = 0;
  const sim::Sweep& sweep = workspace.sweep;
  for (std::size_t k = 0; k < sweep.slot.size(); ++k) {
    if (sweep.range[sweep.slot[k]] < static_cast<float>(scan_options.min_range)) continue;
    const Eigen::Vector3d given(scan.points.x[i], scan.points.y[i], scan.points.z[i]);
    const Eigen::Vector3d truth(sweep.true_points.x[k], sweep.true_points.y[k],
                                sweep.true_points.z[k]);
    greatest = std::max(greatest, (scan.truth.T_map_given * given - truth).norm());
    ++i;
  }
  EXPECT_EQ(i, scan.points.size());
  return greatest;
}

// 100 m in floats have steps of 8 um; a handful of roundings.
constexpr double kRounding = 1e-4;

TEST(WorldScans, PointsAreWhereTheReturnsAre) {
  EXPECT_LT(greatest_error("hills", options()), kRounding);
  ScanOptions level = options();
  level.level = true;
  EXPECT_LT(greatest_error("hills", level), kRounding);
  // A disturbed pose moves the frame and the points alike.
  ScanOptions disturbed = options();
  disturbed.pitch = 0.1;
  disturbed.raise = 0.2;
  EXPECT_LT(greatest_error("hills", disturbed), kRounding);
  ScanOptions skewed = options();
  skewed.skewed = true;
  EXPECT_GT(greatest_error("hills", skewed), 0.02);
}

TEST(WorldScans, DisturbancesMoveThePoints) {
  const auto world = make_driven_world(family("flat_urban"), 0, options());
  ScanWorkspace workspace;
  TestScan plain, moved;
  take_scan(*world, 0, options(), workspace, plain);
  ScanOptions disturbed = options();
  disturbed.pitch = 0.05;
  disturbed.raise = 0.1;
  take_scan(*world, 0, disturbed, workspace, moved);
  ASSERT_EQ(plain.points.size(), moved.points.size());
  for (std::size_t i = 0; i < plain.points.size(); i += 97) {
    const double x = plain.points.x[i], z = plain.points.z[i];
    ASSERT_NEAR(moved.points.x[i], x * std::cos(0.05) + z * std::sin(0.05), 1e-4);
    ASSERT_NEAR(moved.points.z[i], 0.1 + z * std::cos(0.05) - x * std::sin(0.05), 1e-4);
  }
  EXPECT_NEAR(moved.ray_origins[0][2] - plain.ray_origins[0][2], 0.1, 0.02);
}

TEST(WorldScans, GroundUnderTheRobotIsZero) {
  ScanOptions scan_options = options();
  scan_options.sensor = "hdl32e";
  const auto world = make_driven_world(family("flat_urban"), 0, scan_options);
  ScanWorkspace workspace;
  TestScan scan;
  take_scan(*world, 0, scan_options, workspace, scan);
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const bool near = std::hypot(scan.points.x[i], scan.points.y[i]) < 5.0F;
    if (!near || scan.truth.support[i] != Support::kGround || scan.truth.thing[i] != 0) continue;
    sum += static_cast<double>(scan.points.z[i]);
    ++n;
  }
  ASSERT_GT(n, 100U);
  EXPECT_NEAR(sum / static_cast<double>(n), 0.0, 0.02);
}

TEST(WorldScans, SweepsAreSpread) {
  EXPECT_EQ(spread_sweeps(10, 2), (std::vector<std::size_t>{2, 7}));
  EXPECT_EQ(spread_sweeps(3, 8), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(spread_sweeps(100, 1), (std::vector<std::size_t>{50}));
}

TEST(WorldScans, ApproachEndsAMetreBeforeTheWheels) {
  const auto world = make_driven_world(family("potholes"), 0, options());
  const auto holes = holes_ahead(*world, {});
  ASSERT_FALSE(holes.empty());
  for (const HoleAhead& hole : holes) {
    const Footprint& footprint = world->things[static_cast<std::size_t>(hole.thing)].footprint;
    const double reach = 0.5 * std::hypot(footprint.length, footprint.width);
    ASSERT_TRUE(std::is_sorted(hole.sweeps.rbegin(), hole.sweeps.rend()));
    const double end = world->start_of(hole.sweeps.front()) + world->sweep_time();
    const Eigen::Isometry3d pose = world->motion.at(end);
    const Eigen::Vector3d axle = pose * Eigen::Vector3d(world->file.vehicle.wheelbase / 2, 0, 0);
    const double ahead = (footprint.centre - axle.head<2>()).norm();
    // From the axle to the rim: 1 m of way, at most one sweep more, half a track aside at most.
    EXPECT_GT(ahead, 1.0 - 0.05);
    EXPECT_LT(ahead, 1.0 + reach + world->file.path.speed * world->sweep_time() + 0.45);
  }
}

/// Describes a scan as the truth is: every thing a cluster with its class and slope.
class Oracle {
 public:
  void describe(const TestScan& scan, Description& description) {
    const GridParams grid{120.0, 120.0, 0.1, 100.0};
    description = {};
    build_elevation_grid(scan.points.view(), grid, workspace_, description.grid, slots_);
    const ScanTruth& truth = scan.truth;
    const std::size_t n = scan.points.size();
    description.labels.support = truth.support;
    description.labels.reason.assign(n, UnknownReason::kNone);
    description.labels.cluster.assign(n, kNoCluster);
    std::vector<std::vector<std::int32_t>> cells(truth.things.size());
    for (std::size_t t = 1; t < truth.things.size(); ++t) add_thing(truth, t, description);
    for (std::size_t i = 0; i < n; ++i) {
      const auto t = static_cast<std::size_t>(truth.thing[i]);
      if (t == 0) continue;
      description.labels.cluster[i] = truth.thing[i] - 1;
      cells[t].push_back(slots_[i]);
      if (truth.face[i] == kNoFace) continue;
      Slope& slope = description.things[t - 1].slope;
      const TrueFace& face = truth.faces[static_cast<std::size_t>(truth.face[i])];
      slope.status = FeatureStatus::kOk;
      slope.angle = std::acos(face.normal.z());
      slope.direction = direction_of(face.normal);
    }
    for (std::size_t t = 1; t < cells.size(); ++t) {
      if (cells[t].empty()) description.things[t - 1].terrain_class = TerrainClass::kNone;
      add_cells(cells[t], description);
    }
  }

 private:
  static void add_thing(const ScanTruth& truth, std::size_t t, Description& description) {
    description.things.emplace_back();
    description.things.back().terrain_class = truth.things[t].terrain_class;
  }
  static void add_cells(std::vector<std::int32_t>& slots, Description& description) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    IndexRows& rows = description.clusters.slots;
    rows.items.insert(rows.items.end(), slots.begin(), slots.end());
    rows.first.push_back(static_cast<std::int32_t>(rows.items.size()));
  }
  ElevationGridWorkspace workspace_;
  PointSlots slots_;
};

TEST(WorldScore, WhoKnowsTheTruthIsPerfect) {
  for (const std::string name : {"mixed", "potholes", "ramps"}) {
    ScanOptions scan_options = options();
    scan_options.sensor = "os1-64";
    const auto world = make_driven_world(family(name), 1, scan_options);
    ScanWorkspace workspace;
    TestScan scan;
    take_scan(*world, world->sweeps / 2, scan_options, workspace, scan);
    Description description;
    Oracle().describe(scan, description);
    const PointsView points = scan.points.view();
    SupportScore support;
    add_support(points, scan.truth, description.labels.support, support);
    EXPECT_EQ(support.all.iou(), 1.0);
    EXPECT_EQ(support.all.obstacle_tpr(), 1.0);
    const ClusterMatching matching =
        match_clusters(points, scan.truth, description.labels, description.things, {});
    ClusterScore clusters;
    add_clusters(matching, scan.truth, description.things, clusters);
    EXPECT_GT(clusters.found.total, 3U) << name;
    EXPECT_EQ(clusters.found.hits, clusters.found.total) << name;
    EXPECT_EQ(clusters.right.hits, clusters.right.total) << name;
    EXPECT_EQ(clusters.split.hits, 0U);
    EXPECT_EQ(clusters.merged.hits, 0U);
    SlopeScore slopes;
    add_slopes(matching, scan.truth, description.labels, description.things, slopes);
    for (const SlopeSample& sample : slopes.samples) EXPECT_LT(std::abs(sample.angle_error), 1e-6);
    const PotholeRules rules;
    const PotholePlaces places = places_of_potholes(description, scan.truth.T_map_given);
    PotholeScore potholes;
    add_holes(look_at_holes(points, scan.truth, places, rules), rules, potholes);
    EXPECT_EQ(potholes.found.hits, potholes.found.total) << name;
    for (const FalsePothole& wrong : false_potholes(description, scan.truth, places, rules)) {
      ADD_FAILURE() << name << ": false pothole at " << wrong.x << ", " << wrong.y << ", "
                    << wrong.distance << " m away, " << wrong.at;
    }
    if (name == "potholes") {
      EXPECT_GT(potholes.found.total, 0U);
    }
    if (name == "ramps") {
      EXPECT_GT(slopes.ramps, 0U);
    }
  }
}

TEST(WorldScans, FacesOfRampsHaveTheirAngle) {
  ScanOptions level = options();
  level.level = true;
  const auto world = make_driven_world(family("ramps"), 1, level);
  ScanWorkspace workspace;
  TestScan scan;
  take_scan(*world, 0, level, workspace, scan);
  std::size_t inclined = 0;
  for (const TrueFace& face : scan.truth.faces) {
    if (face.inclination < kLeastInclination) continue;
    ++inclined;
    const double slope = world->things[static_cast<std::size_t>(face.thing)].slope;
    EXPECT_NEAR(face.inclination, slope, 1e-6);
    EXPECT_NEAR(std::acos(face.normal.z()), slope, 1e-6) << "vertical z";
  }
  EXPECT_GT(inclined, 0U);
}

TEST(WorldScans, DepthsBelowTheRimAreThoseOfTheHoles) {
  const auto world = make_driven_world(family("potholes"), 1, options());
  ScanWorkspace workspace;
  TestScan scan;
  take_scan(*world, world->sweeps / 2, options(), workspace, scan);
  std::size_t floors = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const TrueThing& thing = world->things[static_cast<std::size_t>(scan.truth.thing[i])];
    const double below = scan.truth.below_rim[i];
    ASSERT_LT(below, thing.depth + 1e-4);
    ASSERT_GT(below, -1e-4);
    if (thing.depth > 0.0 && scan.truth.support[i] == Support::kGround) {
      EXPECT_NEAR(below, thing.depth, 1e-4);
      ++floors;
    }
  }
  EXPECT_GT(floors, 20U);
}

WorldScore scored(const std::string& name, const ScoredScanListener& listener = {}) {
  const sim::Family wanted = family(name);
  const ScanOptions scan_options = options();
  const ScoreRules rules;
  DescriptionWorkspace workspace;
  const DescriptionParams params;
  const Describe method = [&](const ScanView& scan, Description& description) {
    describe(scan, params, workspace, description);
  };
  return score_world({wanted, 2, 3, true, false, 0, {}, scan_options, rules, method, listener});
}

TEST(WorldScore, SameWorldSameScoreAndSumsAdd) {
  std::size_t told = 0;
  const WorldScore a = scored("potholes", [&told](const ScoredScan& scan) {
    EXPECT_EQ(scan.description.labels.support.size(), scan.scan.points.size());
    EXPECT_FALSE(scan.matching.things.empty());
    ++told;
  });
  const WorldScore b = scored("potholes");
  EXPECT_EQ(told, 3U);
  EXPECT_EQ(a.scans, 3U);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.support.all.true_ground, b.support.all.true_ground);
  EXPECT_EQ(a.potholes.ground, b.potholes.ground);
  EXPECT_EQ(a.clusters.confusion, b.clusters.confusion);
  WorldScore sum = a;
  sum.add(b);
  EXPECT_EQ(sum.worlds, 2U);
  EXPECT_EQ(sum.support.all.true_obstacle, 2 * a.support.all.true_obstacle);
  EXPECT_EQ(sum.potholes.wrong.size(), 2 * a.potholes.wrong.size());
  EXPECT_EQ(sum.clusters.found.total, 2 * a.clusters.found.total);
  EXPECT_GT(a.potholes.ahead.total, 0U);
}

}  // namespace
}  // namespace mrpt_terrain::eval
