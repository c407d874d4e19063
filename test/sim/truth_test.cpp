// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes.h"
#include "sweeps.h"

namespace mrpt_terrain::sim {
namespace {

using worlds::level_scene;
using worlds::put;

constexpr double kDegrees = M_PI / 180.0;

/// A sweep whose returns are chosen one by one.
class ChosenReturns {
 public:
  void add(const Eigen::Vector3d& place, std::int32_t solid, SurfaceKind kind,
           float true_range = 1.0F) {
    sweep_.slot.push_back(static_cast<std::uint32_t>(sweep_.solid.size()));
    sweep_.solid.push_back(solid);
    sweep_.kind.push_back(kind);
    sweep_.true_range.push_back(true_range);
    sweep_.points.push_back(0, 0, 0);
    const Eigen::Vector3f at = place.cast<float>();
    sweep_.true_points.push_back(at.x(), at.y(), at.z());
  }
  [[nodiscard]] PointTruth truth_in(const World& world) const {
    return truth_of(RayCaster(world), sweep_);
  }

 private:
  Sweep sweep_;
};

/// Support of a return from an object, at a height above level ground.
Support support_at(const Shape& shape, double height) {
  Scene scene = level_scene();
  const auto solid = put(scene, shape, 3.0, 2.0);
  ChosenReturns returns;
  returns.add({3.0, 2.0, height}, solid, SurfaceKind::kObject);
  return returns.truth_in(build_world(scene)).support[0];
}

TEST(PointTruth, DrivableSurfacesAreGroundAtAnyHeight) {
  Scene scene = level_scene();
  const auto ramp = put(scene, Ramp{}, 5, 0), hole = put(scene, Pothole{}, -5, 0);
  ChosenReturns returns;
  returns.add({0, 0, 0}, kGroundSolid, SurfaceKind::kDrivable);
  returns.add({5.5, 0, 0.1}, ramp, SurfaceKind::kDrivable);
  returns.add({-5, 0, -0.09}, hole, SurfaceKind::kDrivable);
  const PointTruth truth = returns.truth_in(build_world(scene));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(truth.support[k], Support::kGround) << k;
    EXPECT_EQ(truth.height[k], 0.0F) << k;
  }
  EXPECT_EQ(truth.solid, (std::vector<std::int32_t>{0, ramp, hole}));
  EXPECT_EQ(truth.terrain_class,
            (std::vector<TerrainClass>{TerrainClass::kNone, TerrainClass::kSlope,
                                       TerrainClass::kPothole}));
}

TEST(PointTruth, FlanksOfHolesAreNotCounted) {
  Scene scene = level_scene();
  Pothole pothole;
  pothole.depth = 0.5;
  const auto hole = put(scene, pothole, -5, 0);
  ChosenReturns returns;
  returns.add({-4.75, 0, -0.3}, hole, SurfaceKind::kFlank);
  const PointTruth truth = returns.truth_in(build_world(scene));
  EXPECT_EQ(truth.support[0], Support::kUnknown);
  EXPECT_EQ(truth.height[0], 0.0F);
  EXPECT_EQ(truth.terrain_class[0], TerrainClass::kPothole);
}

TEST(PointTruth, RubbleAndGrassUpToFiveCentimetresAreGround) {
  for (const Shape& shape : {Shape(Rubble{}), Shape(Grass{})}) {
    SCOPED_TRACE(type_of(shape));
    EXPECT_EQ(support_at(shape, 0.0), Support::kGround);
    EXPECT_EQ(support_at(shape, 0.0499), Support::kGround);
    EXPECT_EQ(support_at(shape, 0.0501), Support::kUnknown);
    EXPECT_EQ(support_at(shape, 0.0999), Support::kUnknown);
    EXPECT_EQ(support_at(shape, 0.1001), Support::kAbove);
  }
}

TEST(PointTruth, LowPartsOfObjectsAreNotCounted) {
  for (const Shape& shape : {Shape(Box{}), Shape(Wall{}), Shape(Pole{}), Shape(Cylinder{}),
                             Shape(Table{}), Shape(Stairs{}), Shape(Bush{}), Shape(Person{})}) {
    SCOPED_TRACE(type_of(shape));
    EXPECT_EQ(support_at(shape, 0.01), Support::kUnknown);
    EXPECT_EQ(support_at(shape, 0.0999), Support::kUnknown);
    EXPECT_EQ(support_at(shape, 0.1001), Support::kAbove);
    EXPECT_EQ(support_at(shape, 1.0), Support::kAbove);
  }
}

TEST(PointTruth, UnderATableTheGroundBelowCounts) {
  Scene scene = level_scene();
  const auto table = put(scene, Table{}, 5, 5);
  ChosenReturns returns;
  returns.add({5, 5, 0}, kGroundSolid, SurfaceKind::kDrivable);
  returns.add({5, 5, 0.7}, table, SurfaceKind::kObject);
  const PointTruth truth = returns.truth_in(build_world(scene));
  EXPECT_EQ(truth.support, (std::vector<Support>{Support::kGround, Support::kAbove}));
  EXPECT_FLOAT_EQ(truth.height[1], 0.7F);
}

TEST(PointTruth, HeightsOnASlopeAreVertical) {
  Scene scene = level_scene();
  scene.ground.slope = 20 * kDegrees;
  const auto box = put(scene, Box{}, 4, 0);
  ChosenReturns returns;
  const double ground = 4.0 * std::tan(20 * kDegrees);
  returns.add({4, 0, ground + 0.3}, box, SurfaceKind::kObject);
  const PointTruth truth = returns.truth_in(build_world(scene));
  EXPECT_NEAR(truth.height[0], 0.3, 1e-5);
}

// The side of a curb stands where the terrain jumps: its height counts from the lower ground, on
// whichever side of the jump rounding puts it.
TEST(PointTruth, SidesOfCurbsCountFromTheLowerGround) {
  Scene scene = level_scene();
  Curb curb;
  curb.length = 4.0;
  curb.width = 2.0;
  curb.height = 0.15;
  const auto solid = put(scene, curb, 0, 5);
  ChosenReturns returns;
  for (const double aside : {-1e-6, 0.0, 1e-6}) {
    returns.add({0, 4.0 + aside, 0.12}, solid, SurfaceKind::kObject);
    returns.add({0, 4.0 + aside, 0.07}, solid, SurfaceKind::kObject);
  }
  const PointTruth truth = returns.truth_in(build_world(scene));
  for (std::size_t k = 0; k < 6; k += 2) {
    EXPECT_NEAR(truth.height[k], 0.12, 1e-5);
    EXPECT_EQ(truth.support[k], Support::kAbove);
    EXPECT_EQ(truth.support[k + 1], Support::kUnknown);
  }
}

TEST(PointTruth, WithoutGroundTheHeightIsNotObserved) {
  Scene scene = level_scene();
  const auto box = put(scene, Box{}, 4, 0);
  ChosenReturns returns;
  returns.add({50, 0, 1}, box, SurfaceKind::kObject);
  const PointTruth truth = returns.truth_in(build_world(scene));
  EXPECT_TRUE(std::isnan(truth.height[0]));
  EXPECT_EQ(truth.support[0], Support::kUnknown);
}

/// Invariants of a real sweep: what the true points say in closed form is what truth says.
TEST(PointTruth, OfASweepAgreesWithTheTruePoints) {
  Scene scene = level_scene();
  Box box;
  box.length = box.width = 1.0;
  box.height = 1.0;
  const auto solid = put(scene, box, 4, 0);
  const World world = build_world(scene);
  const RayCaster caster(world);
  auto sensor = worlds::mounted(worlds::perfect_sensor({-0.3, -0.2, -0.1, 0.0}, 720), 0.8);
  sensor.model.noise.range_sigma = 0.3;
  SweepWorkspace workspace;
  Sweep sweep;
  simulate_sweep(caster, sensor, Motion(), 0.0, 7, 0, workspace, sweep);
  const PointTruth truth = truth_of(caster, sweep);
  ASSERT_EQ(truth.support.size(), sweep.points.size());
  std::size_t above = 0;
  for (std::size_t k = 0; k < sweep.points.size(); ++k) {
    const double x = sweep.true_points.x[k], y = sweep.true_points.y[k], z = sweep.true_points.z[k];
    EXPECT_NEAR(truth.true_range[k], std::hypot(x, y, z - 0.8), 1e-4);
    EXPECT_NEAR(truth.height[k], z, 1e-5);
    const bool on_box = z > 1e-4;
    EXPECT_EQ(truth.solid[k], on_box ? solid : 0);
    EXPECT_EQ(truth.support[k], !on_box    ? Support::kGround
                                : z > 0.1F ? Support::kAbove
                                           : Support::kUnknown);
    above += truth.support[k] == Support::kAbove ? 1U : 0U;
  }
  EXPECT_GT(above, 50U);
}

std::size_t cell_of(const CellTruth& truth, double x, double y) {
  CellIndex cell;
  EXPECT_TRUE(truth.geometry.cell_at(x, y, cell));
  return static_cast<std::size_t>(cell.l * truth.geometry.cells_w() + cell.w);
}

CellTruth cells_in(const Scene& scene, const GridGeometry& geometry = GridGeometry(20, 20, 0.2),
                   const Eigen::Isometry3d& T_map_grid = Eigen::Isometry3d::Identity()) {
  const World world = build_world(scene);
  return truth_of_cells(RayCaster(world), T_map_grid, geometry);
}

TEST(CellTruth, OfAPlaneIsInClosedForm) {
  Scene scene = level_scene();
  scene.ground.slope = 15 * kDegrees;
  scene.ground.slope_direction = 30 * kDegrees;
  const CellTruth truth = cells_in(scene);
  ASSERT_EQ(truth.support.size(), 10000U);
  const double rise_x = std::tan(15 * kDegrees) * std::cos(30 * kDegrees);
  const double rise_y = std::tan(15 * kDegrees) * std::sin(30 * kDegrees);
  const std::size_t k = cell_of(truth, 3.1, -2.3);
  const double centre = 3.1 * rise_x - 2.3 * rise_y;
  EXPECT_NEAR(truth.ground_height[k], centre, 1e-5);
  EXPECT_NEAR(truth.mean[k], centre, 1e-5);
  // The outermost of five places lie 0.4 cells from the centre.
  EXPECT_NEAR(truth.max[k], centre + 0.08 * (rise_x + rise_y), 1e-5);
  EXPECT_NEAR(truth.min[k], centre - 0.08 * (rise_x + rise_y), 1e-5);
  for (std::size_t cell = 0; cell < truth.support.size(); ++cell) {
    ASSERT_EQ(truth.support[cell], Support::kGround);
    ASSERT_EQ(truth.terrain_class[cell], TerrainClass::kNone);
    ASSERT_NEAR(truth.slope[cell], 15 * kDegrees, 1e-6);
    ASSERT_NEAR(truth.slope_direction[cell], 30 * kDegrees, 1e-6);
  }
}

// The same places, seen from a grid that is moved, turned and raised.
TEST(CellTruth, FollowsTheGrid) {
  Scene scene = level_scene();
  scene.ground.slope = 15 * kDegrees;
  Eigen::Isometry3d T_map_grid = Eigen::Isometry3d::Identity();
  T_map_grid.translation() << 2, 1, 0.5;
  T_map_grid.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  const CellTruth truth = cells_in(scene, GridGeometry(4, 4, 0.2), T_map_grid);
  // Grid (1.1, -0.7) is map (2.7, 2.1).
  const std::size_t k = cell_of(truth, 1.1, -0.7);
  EXPECT_NEAR(truth.ground_height[k], 2.7 * std::tan(15 * kDegrees) - 0.5, 1e-5);
  EXPECT_NEAR(truth.slope[k], 15 * kDegrees, 1e-6);
  EXPECT_NEAR(truth.slope_direction[k], -M_PI / 2, 1e-6);
}

TEST(CellTruth, OfABoxIsAboveAndKnowsTheGroundUnderneath) {
  Scene scene = level_scene();
  Box box;
  box.length = box.width = 1.0;
  box.height = 0.5;
  put(scene, box, 3, 3);
  const CellTruth truth = cells_in(scene);
  const std::size_t k = cell_of(truth, 3.1, 3.1), beside = cell_of(truth, 3.7, 3.1);
  EXPECT_EQ(truth.support[k], Support::kAbove);
  EXPECT_EQ(truth.terrain_class[k], TerrainClass::kObstacle);
  EXPECT_NEAR(truth.min[k], 0.5, 1e-5);
  EXPECT_NEAR(truth.ground_height[k], 0.0, 1e-5);
  EXPECT_EQ(truth.support[beside], Support::kGround);
  EXPECT_EQ(truth.terrain_class[beside], TerrainClass::kNone);
}

TEST(CellTruth, LowObjectsAreNotCounted) {
  Scene scene = level_scene();
  Box box;
  box.length = box.width = 1.0;
  box.height = 0.08;
  put(scene, box, 3, 3);
  const CellTruth truth = cells_in(scene);
  const std::size_t k = cell_of(truth, 3.1, 3.1);
  EXPECT_EQ(truth.support[k], Support::kUnknown);
  EXPECT_EQ(truth.terrain_class[k], TerrainClass::kObstacle);
}

TEST(CellTruth, OfARampIsGroundWithItsSlopeAndClass) {
  Scene scene = level_scene();
  Ramp ramp;
  ramp.length = 3.0;
  ramp.width = 2.0;
  ramp.angle = 12 * kDegrees;
  put(scene, ramp, 3, 0);
  const CellTruth truth = cells_in(scene);
  const std::size_t k = cell_of(truth, 4.1, 0.1);
  EXPECT_EQ(truth.support[k], Support::kGround);
  EXPECT_EQ(truth.terrain_class[k], TerrainClass::kSlope);
  EXPECT_NEAR(truth.slope[k], 12 * kDegrees, 1e-6);
  EXPECT_NEAR(truth.slope_direction[k], 0.0, 1e-6);
  EXPECT_NEAR(truth.ground_height[k], 1.1 * std::tan(12 * kDegrees), 1e-5);
}

TEST(CellTruth, OfAPotholeFloorIsGroundAndOfItsFlankIsNotCounted) {
  Scene scene = level_scene();
  Pothole pothole;
  pothole.length = pothole.width = 3.0;
  pothole.depth = 1.0;
  pothole.wall_angle = 63.43494882292201 * kDegrees;  // 2 down on 1: half a metre wide
  put(scene, pothole, 0, 0);
  const CellTruth truth = cells_in(scene);
  const std::size_t floor = cell_of(truth, 0.1, 0.1), flank = cell_of(truth, 1.3, 0.1);
  EXPECT_EQ(truth.support[floor], Support::kGround);
  EXPECT_EQ(truth.terrain_class[floor], TerrainClass::kPothole);
  EXPECT_NEAR(truth.ground_height[floor], -1.0, 1e-5);
  EXPECT_EQ(truth.support[flank], Support::kUnknown);
  EXPECT_EQ(truth.terrain_class[flank], TerrainClass::kPothole);
  EXPECT_NEAR(truth.ground_height[flank], -0.4, 1e-5);
  EXPECT_EQ(truth.support[cell_of(truth, 1.7, 0.1)], Support::kGround);
}

TEST(CellTruth, UnderAHighBridgeIsGroundAndUnderATableAbove) {
  Scene scene = level_scene();
  put(scene, Bridge{}, 5, 5);  // 6 m x 3 m, 2.2 m of free height, walls of 0.3 m beside it
  put(scene, Table{}, -5, -5);
  const World world = build_world(scene);
  const RayCaster caster(world);
  const GridGeometry geometry(20, 20, 0.2);
  const CellTruth truth = truth_of_cells(caster, Eigen::Isometry3d::Identity(), geometry);
  const std::size_t passage = cell_of(truth, 5.1, 5.1), side = cell_of(truth, 5.1, 6.7);
  EXPECT_EQ(truth.support[passage], Support::kGround);
  EXPECT_NEAR(truth.max[passage], 0.0, 1e-5);
  EXPECT_EQ(truth.support[side], Support::kAbove);
  EXPECT_NEAR(truth.max[side], 2.5, 1e-5);
  EXPECT_EQ(truth.support[cell_of(truth, -4.9, -4.9)], Support::kAbove);
  EXPECT_NEAR(truth.ground_height[cell_of(truth, -4.9, -4.9)], 0.0, 1e-5);
  const CellTruth tall = truth_of_cells(caster, Eigen::Isometry3d::Identity(), geometry, 2.3);
  EXPECT_EQ(tall.support[passage], Support::kAbove);
  EXPECT_NEAR(tall.max[passage], 2.5, 1e-5);
}

TEST(CellTruth, OfGrassDependsOnItsHeight) {
  const std::pair<double, Support> cases[] = {
      {0.04, Support::kGround}, {0.08, Support::kUnknown}, {0.15, Support::kAbove}};
  for (const auto& [height, support] : cases) {
    Scene scene = level_scene();
    Grass grass;
    grass.height = height;
    put(scene, grass, 3, 3, 0.5);
    const CellTruth truth = cells_in(scene);
    const std::size_t k = cell_of(truth, 3.1, 3.1);
    EXPECT_EQ(truth.support[k], support) << height;
    EXPECT_EQ(truth.terrain_class[k], TerrainClass::kOther);
    EXPECT_NEAR(truth.max[k], height, 1e-5);
    EXPECT_NEAR(truth.ground_height[k], 0.0, 1e-6);
    EXPECT_EQ(truth.support[cell_of(truth, -3.1, 3.1)], Support::kGround);
  }
}

TEST(CellTruth, OfABushIsItsOuterForm) {
  Scene scene = level_scene();
  put(scene, Bush{}, 3, 3);  // half axes 0.6, 0.6, 0.5
  const CellTruth truth = cells_in(scene);
  EXPECT_NEAR(truth.max[cell_of(truth, 3.1, 3.1)],
              0.5 + 0.5 * std::sqrt(1 - 2 * std::pow(0.02 / 0.6, 2)), 1e-5);
  EXPECT_EQ(truth.support[cell_of(truth, 3.1, 3.1)], Support::kAbove);
  EXPECT_EQ(truth.support[cell_of(truth, 3.9, 3.1)], Support::kGround);
}

TEST(CellTruth, OutsideTheSceneIsNotObserved) {
  const CellTruth truth = cells_in(level_scene(), GridGeometry(50, 50, 1.0));
  const std::size_t k = cell_of(truth, 22.5, 0.5);
  for (const auto* field : {&truth.min, &truth.mean, &truth.max, &truth.ground_height, &truth.slope,
                            &truth.slope_direction}) {
    EXPECT_TRUE(std::isnan((*field)[k]));
    EXPECT_FALSE(std::isnan((*field)[cell_of(truth, 0.5, 0.5)]));
  }
  EXPECT_EQ(truth.support[k], Support::kUnknown);
}

TEST(ObjectTruth, HasTheMeasuresOfTheScene) {
  Scene scene = level_scene();
  Ramp ramp;
  ramp.angle = 12 * kDegrees;
  ramp.length = 3.0;
  Pothole pothole;
  pothole.depth = 0.2;
  Box box, low;
  box.height = 0.4;
  low.height = 0.07;
  put(scene, ramp, 5, 0, 0.3);
  put(scene, pothole, -5, 0);
  put(scene, box, 0, 5);
  put(scene, low, 0, -5);
  put(scene, Curb{}, 8, 8);
  const auto objects = truth_of_objects(build_world(scene));
  ASSERT_EQ(objects.size(), 5U);
  const Support supports[] = {Support::kGround, Support::kGround, Support::kAbove,
                              Support::kUnknown, Support::kGround};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(objects[k].id, static_cast<int>(k) + 1);
    EXPECT_EQ(objects[k].support, supports[k]) << objects[k].type;
  }
  EXPECT_EQ(objects[0].type, "ramp");
  EXPECT_EQ(objects[0].terrain_class, TerrainClass::kSlope);
  EXPECT_NEAR(objects[0].slope, 12 * kDegrees, 1e-12);
  EXPECT_NEAR(objects[0].height, 3.0 * std::tan(12 * kDegrees), 1e-9);
  EXPECT_NEAR(objects[0].length, 3.0, 1e-12);
  EXPECT_TRUE(objects[0].T_map_object.translation().isApprox(Eigen::Vector3d(5, 0, 0)));
  EXPECT_NEAR(objects[1].height, -0.2, 1e-12);
  EXPECT_NEAR(objects[2].height, 0.4, 1e-12);
}

}  // namespace
}  // namespace mrpt_terrain::sim
