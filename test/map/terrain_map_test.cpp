// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/terrain_map.h"

#include <gtest/gtest.h>
#include <mrpt/maps/CMetricMapEvents.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/metric_map_types.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/system/CObserver.h>
#include <octomap/OcTree.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "description_builder.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using testing::lidar_pose;
using testing::observation_of;
using testing::scene_points;
using testing::small_map;

CTerrainMap seen_map(const CPose3D& T_map_robot = {}) {
  CTerrainMap map(small_map());
  EXPECT_TRUE(map.insertObservation(observation_of(scene_points(), lidar_pose()), T_map_robot));
  return map;
}

/// Where a ring meets level ground behind the robot, robot frame.
Position2 far_ground() {
  const Points points = scene_points();
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points.x[k] < -2.2F && points.x[k] > -2.6F && std::abs(points.y[k]) < 1.0F &&
        std::abs(points.z[k]) < 0.01F) {
      return {static_cast<double>(points.x[k]), static_cast<double>(points.y[k])};
    }
  }
  ADD_FAILURE() << "no ground in the scene";
  return {};
}

TEST(TerrainMap, IsEmptyAtFirstAndAfterClear) {
  CTerrainMap map(small_map());
  EXPECT_TRUE(map.isEmpty());
  EXPECT_EQ(map.snapshot()->revision, 0U);
  EXPECT_EQ(map.cell_at(0, 0).status, PlaceStatus::kOutside);
  EXPECT_EQ(map.cost_at(0, 0, 0).status, CostStatus::kOutside);
  map = seen_map();
  EXPECT_FALSE(map.isEmpty());
  EXPECT_GT(map.octree()->size(), 100U);
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_EQ(map.octree()->size(), 0U);
}

// Oracle: `describe` on the same points, moved into the robot's frame by hand.
TEST(TerrainMap, DescribesTheLastScanAsDescribeDoes) {
  CTerrainMap map(small_map());
  const CPose3D T_robot_sensor(0.3, -0.2, 0.9, 0.4, 0.02, -0.03);
  const auto observation = observation_of(scene_points(7), T_robot_sensor);
  ASSERT_TRUE(map.insertObservation(observation_of(scene_points(1), lidar_pose()), CPose3D()));
  ASSERT_TRUE(map.insertObservation(observation, CPose3D(5, 6, 0, 1.0, 0, 0)));
  io::SensorPoints sensor;
  io::Scan scan;
  ASSERT_EQ(io::convert_observation(observation, map.params().input, {}, sensor).status,
            io::ConversionStatus::kOk);
  io::to_robot_frame(sensor, nullptr, map.params().input, scan);
  DescriptionWorkspace workspace;
  Description expected;
  describe(scan.points.view(), map.params().description, workspace, expected);
  const Description& found = map.snapshot()->description;
  EXPECT_EQ(map.snapshot()->revision, 2U);
  EXPECT_EQ(found.grid.h_mean, expected.grid.h_mean);
  EXPECT_EQ(found.labels.support, expected.labels.support);
  EXPECT_EQ(found.labels.cluster, expected.labels.cluster);
  ASSERT_EQ(found.things.size(), expected.things.size());
  for (std::size_t k = 0; k < found.things.size(); ++k) {
    EXPECT_EQ(found.things[k].terrain_class, expected.things[k].terrain_class);
    EXPECT_EQ(found.things[k].height.h_f, expected.things[k].height.h_f);
    EXPECT_EQ(found.things[k].slope.angle, expected.things[k].slope.angle);
  }
}

// A scene seen from a turned, shifted and tilted robot lies where it lies in the map.
TEST(TerrainMap, PlacesWhatItSeesInTheMap) {
  const CPose3D T_map_robot(100, -50, 3, 2.0, 0, 0);
  const CTerrainMap map = seen_map(T_map_robot);
  const auto in_map = [&](double x, double y) {
    double mx, my, mz;
    T_map_robot.composePoint(x, y, 0.0, mx, my, mz);
    return std::array<double, 2>{mx, my};
  };
  const auto box = in_map(2.05, 0.75), pothole = in_map(-1.9, 0.0);
  const Position2 seen = far_ground();
  const auto ground = in_map(seen.x, seen.y);
  const auto far = in_map(5.2, 0.0);
  EXPECT_EQ(map.cell_at(box[0], box[1]).terrain_class, TerrainClass::kObstacle);
  EXPECT_NEAR(map.cell_at(box[0], box[1]).highest, 3.5, 0.05);
  EXPECT_EQ(map.cost_at(box[0], box[1], 0.0).status, CostStatus::kLethal);
  EXPECT_EQ(map.cell_at(pothole[0], pothole[1]).terrain_class, TerrainClass::kPothole);
  EXPECT_EQ(map.cell_at(ground[0], ground[1]).support, Support::kGround);
  EXPECT_NEAR(map.cell_at(ground[0], ground[1]).height, 3.0, 0.02);
  EXPECT_EQ(map.cell_at(far[0], far[1]).status, PlaceStatus::kOutside);
  EXPECT_EQ(map.cell_at(T_map_robot.x(), T_map_robot.y()).status, PlaceStatus::kUnknown);
  const auto found = map.clusters_in({{box[0] - 0.1, box[1] - 0.1}, {box[0] + 0.1, box[1] + 0.1}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].description.terrain_class, TerrainClass::kObstacle);
  EXPECT_NEAR(found[0].centre.x(), box[0], 0.3);
  EXPECT_NEAR(found[0].centre.y(), box[1], 0.3);
  EXPECT_TRUE(map.clusters_in({{0, 0}, {1, 1}}).empty());
}

TEST(TerrainMap, TheSensorsPoseCounts) {
  CTerrainMap on_robot(small_map()), elsewhere(small_map());
  const Points points = scene_points();
  on_robot.insertObservation(observation_of(points, lidar_pose()), CPose3D());
  elsewhere.insertObservation(observation_of(points, CPose3D(1, 2, 0.5, 0.7, 0.1, 0.2)), CPose3D());
  EXPECT_NEAR(on_robot.cell_at(2.05, 0.75).highest, elsewhere.cell_at(2.05, 0.75).highest, 1e-3);
  EXPECT_EQ(on_robot.snapshot()->clusters.size(), elsewhere.snapshot()->clusters.size());
}

// Oracle: octomap's own insertion.
TEST(TerrainMap, TheOctreeIsOctomaps) {
  const CPose3D T_map_robot(1, 2, 0.5, 0.3, 0.02, -0.01);
  MapParams params = small_map();
  params.octree.max_range = 4.0;
  CTerrainMap map(params);
  octomap::OcTree expected(0.1);
  expected.setClampingThresMin(params.octree.clamping_min);
  expected.setClampingThresMax(params.octree.clamping_max);
  expected.setProbHit(params.octree.prob_hit);
  expected.setProbMiss(params.octree.prob_miss);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto observation = observation_of(scene_points(seed), lidar_pose());
    ASSERT_TRUE(map.insertObservation(observation, T_map_robot));
    octomap::Pointcloud cloud;
    const TerrainSnapshotPtr now = map.snapshot();
    for (std::size_t k = 0; k < now->points.size(); ++k) {
      const Eigen::Vector3d p =
          now->T_map_robot *
          Eigen::Vector3f(now->points.x[k], now->points.y[k], now->points.z[k]).cast<double>();
      cloud.push_back(p.cast<float>().x(), p.cast<float>().y(), p.cast<float>().z());
    }
    const auto& origin = now->ray_origins.front();
    const Eigen::Vector3f o =
        (now->T_map_robot * Eigen::Vector3f(origin[0], origin[1], origin[2]).cast<double>())
            .cast<float>();
    expected.insertPointCloud(cloud, octomap::point3d(o.x(), o.y(), o.z()), 4.0);
  }
  EXPECT_TRUE(*map.octree() == expected);
  params.creation.octree = false;
  EXPECT_EQ(CTerrainMap(params).octree(), nullptr);
}

TEST(TerrainMap, WhatHasNoGeometryIsPassedOverWithAReason) {
  CTerrainMap map(small_map());
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationGPS(), CPose3D()));
  EXPECT_NE(map.last_refusal(), "");
  EXPECT_TRUE(map.isEmpty());
  Points nothing;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  nothing.push_back(nan, nan, nan);
  EXPECT_FALSE(map.insertObservation(observation_of(nothing), CPose3D()));
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.insertObservation(observation_of(scene_points(), lidar_pose())));
  EXPECT_EQ(map.last_refusal(), "");
}

TEST(TerrainMap, SnapshotsDoNotChange) {
  CTerrainMap map = seen_map();
  const TerrainSnapshotPtr before = map.snapshot();
  const std::vector<float> heights = before->description.grid.h_mean;
  const auto tree = map.octree();
  const std::size_t nodes = tree->size();
  map.insertObservation(observation_of(scene_points(2), lidar_pose()), CPose3D(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(before->description.grid.h_mean, heights);
  EXPECT_EQ(before->revision, 1U);
  EXPECT_EQ(tree->size(), nodes);
  EXPECT_NE(map.octree()->size(), nodes);
  EXPECT_EQ(map.octree(), map.octree()) << "one copy until the next insertion";
}

// Who asks for costs pays for them, and nobody else.
TEST(TerrainMap, CostsAreComputedWhenSomebodyAsks) {
  for (const auto& fusion : enum_names(Fusion{})) {
    MapParams params = small_map();
    params.creation.fusion = fusion.value;
    params.fusion.length = params.fusion.width = 20.0;
    CTerrainMap map(params);
    const auto observation = observation_of(scene_points(), lidar_pose());
    map.insertObservation(observation, CPose3D());
    map.insertObservation(observation, CPose3D());
    const TerrainSnapshotPtr now = map.snapshot();
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << map;
    mrpt::opengl::CSetOfObjects objects;
    map.getVisualizationInto(objects);
    EXPECT_EQ(map.cell_at(2.05, 0.75).status, PlaceStatus::kKnown);
    EXPECT_EQ(map.clusters_in({{2.0, 0.7}, {2.1, 0.8}}).size(), 1U);
    (void)map.computeObservationLikelihood(observation, CPose3D());
    EXPECT_EQ(now->known_costs(), nullptr) << fusion.name;

    EXPECT_EQ(map.cost_at(2.05, 0.75, 0.0).status, CostStatus::kLethal);
    ASSERT_NE(now->known_costs(), nullptr);
    EXPECT_EQ(now->known_costs(), &now->costs());
    CostWorkspace workspace;
    CellCosts expected;
    compute_cell_costs(now->description.grid, now->robot, workspace, expected);
    EXPECT_EQ(now->costs().step, expected.step);
    EXPECT_EQ(now->costs().gradient_x, expected.gradient_x);
    EXPECT_EQ(now->costs().roughness, expected.roughness);
    EXPECT_EQ(now->costs().status, expected.status);

    map.insertObservation(observation, CPose3D(0.5, 0, 0, 0, 0, 0));
    EXPECT_EQ(map.snapshot()->known_costs(), nullptr) << "those of another snapshot";
    map.clear();
    EXPECT_EQ(map.snapshot()->costs().size(), 0U);
  }
}

// The same of what is drawn, converted and saved.
TEST(TerrainMap, PicturesOfCostsAskForThem) {
  CTerrainMap map = seen_map();
  (void)map.as_occupancy_grid();
  EXPECT_NE(map.snapshot()->known_costs(), nullptr);
  map = seen_map();
  MapRenderParams render = map.params().render;
  render.colouring = CellColouring::kCost;
  map.set_render_params(render);
  mrpt::opengl::CSetOfObjects objects;
  map.getVisualizationInto(objects);
  EXPECT_NE(map.snapshot()->known_costs(), nullptr);
}

TEST(TerrainMap, ThingsKeepTheirIdentityWhileTheyAreSeen) {
  CTerrainMap map = seen_map();
  const auto box_identity = [&map] {
    const auto found = map.clusters_in({{2.0, 0.6}, {2.3, 0.9}});
    return found.size() == 1 ? found[0].identity : 0;
  };
  const std::uint64_t first = box_identity();
  EXPECT_NE(first, 0U);
  for (int k = 1; k <= 3; ++k) {
    // The robot moves on; the things stay where they are in the map.
    const CPose3D T_map_robot(0.05 * k, 0, 0, 0.02 * k, 0, 0);
    Points moved = scene_points(static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < moved.size(); ++i) {
      double x, y, z;
      T_map_robot.inverseComposePoint(moved.x[i], moved.y[i], moved.z[i], x, y, z);
      moved.x[i] = static_cast<float>(x);
      moved.y[i] = static_cast<float>(y);
      moved.z[i] = static_cast<float>(z);
    }
    ASSERT_TRUE(map.insertObservation(observation_of(moved, lidar_pose()), T_map_robot));
    EXPECT_EQ(box_identity(), first);
  }
  std::set<std::uint64_t> identities;
  for (const ClusterView& cluster : map.snapshot()->clusters) identities.insert(cluster.identity);
  EXPECT_EQ(identities.size(), map.snapshot()->clusters.size());
}

TEST(TerrainMap, TellsItsObservers) {
  struct Listener : mrpt::system::CObserver {
    int inserted = 0, cleared = 0;
    void OnEvent(const mrpt::system::mrptEvent& event) override {
      if (event.isOfType<mrpt::maps::mrptEventMetricMapInsert>()) ++inserted;
      if (event.isOfType<mrpt::maps::mrptEventMetricMapClear>()) ++cleared;
    }
  } listener;
  CTerrainMap map(small_map());
  listener.observeBegin(map);
  map.insertObservation(observation_of(scene_points(), lidar_pose()));
  map.insertObservation(mrpt::obs::CObservationGPS());
  map.clear();
  EXPECT_EQ(listener.inserted, 1);
  EXPECT_EQ(listener.cleared, 1);
  listener.observeEnd(map);
}

TEST(TerrainMap, CopiesAreIndependent) {
  CTerrainMap map = seen_map();
  const CTerrainMap copy(map);
  map.clear();
  EXPECT_FALSE(copy.isEmpty());
  EXPECT_EQ(copy.cell_at(2.05, 0.75).terrain_class, TerrainClass::kObstacle);
  EXPECT_GT(copy.octree()->size(), 100U);
}

TEST(TerrainMap, ConvertsToStockMaps) {
  const CTerrainMap map = seen_map(CPose3D(10, 0, 1, 0, 0, 0));
  const auto points = map.as_points_map();
  ASSERT_EQ(points->size(), map.snapshot()->points.size());
  float x, y, z;
  points->getPoint(0, x, y, z);
  EXPECT_NEAR(x, map.snapshot()->points.x[0] + 10.0F, 1e-4);
  EXPECT_NEAR(z, map.snapshot()->points.z[0] + 1.0F, 1e-4);
  const auto grid = map.as_occupancy_grid();
  EXPECT_LT(grid->getPos(12.05F, 0.75F), 0.05F) << "the box is occupied";
  const Position2 ground = far_ground();
  EXPECT_GT(grid->getPos(static_cast<float>(ground.x + 10.0), static_cast<float>(ground.y)), 0.5F)
      << "flat ground is free";
  EXPECT_NEAR(grid->getPos(10.0F, 0.0F), 0.5F, 0.01F) << "nobody sees below the robot";
  const auto voxels = map.as_voxels();
  std::size_t leaves = 0;
  for (auto leaf = map.octree()->begin_leafs(); leaf != map.octree()->end_leafs(); ++leaf) ++leaves;
  EXPECT_EQ(voxels->getVoxelCount(0) + voxels->getVoxelCount(1), leaves);
}

TEST(TerrainMap, DrawsWhatIsAskedForInTheMapsFrame) {
  CTerrainMap map = seen_map(CPose3D(10, 0, 1, 0, 0, 0));
  MapRenderParams render;
  render.points = render.octree = true;
  map.set_render_params(render);
  mrpt::opengl::CSetOfObjects objects;
  map.getVisualizationInto(objects);
  auto window =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(objects.getByName("terrain"));
  ASSERT_TRUE(window);
  EXPECT_EQ(window->getPoseX(), 10.0);
  for (const char* name : {"cells", "clusters"}) EXPECT_TRUE(window->getByName(name));
  ASSERT_TRUE(objects.getByName("points"));
  EXPECT_EQ(objects.getByName("points")->getPoseX(), 10.0);
  EXPECT_TRUE(objects.getByName("octree"));
  map.genericMapParams.enableSaveAs3DObject = false;
  mrpt::opengl::CSetOfObjects none;
  map.getVisualizationInto(none);
  EXPECT_TRUE(none.empty());
}

TEST(TerrainMap, AnswersWhatHostsAskOfEveryMap) {
  const CTerrainMap map = seen_map();
  EXPECT_EQ(map.compute3DMatchingRatio(&map, CPose3D(), {}), 0.0F);
  EXPECT_NE(map.asString().find("1 scans"), std::string::npos);
  EXPECT_EQ(map.getAsSimplePointsMap(), nullptr);
}

}  // namespace
}  // namespace mrpt_terrain
