// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/world.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/sim/ground_surface.h"
#include "mrpt_terrain/sim/ray_caster.h"

namespace mrpt_terrain::sim {
namespace {

Solid solid_of(Shape shape, double x, double y, double yaw = 0.0) {
  Solid solid;
  solid.shape = std::move(shape);
  solid.placement.x = x;
  solid.placement.y = y;
  solid.placement.yaw = yaw;
  return solid;
}

Scene scene_of(std::vector<Solid> solids, Ground ground = {}) {
  Scene scene;
  scene.ground = ground;
  scene.solids = std::move(solids);
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    scene.solids[k].placement.id = static_cast<int>(k) + 1;
  }
  return scene;
}

Ground hilly_ground() {
  Ground ground;
  ground.form = GroundForm::kFractal;
  ground.spacing = 0.2;
  ground.amplitude = 0.8;
  ground.wavelength = 6.0;
  ground.seed = 5;
  return ground;
}

std::array<Eigen::Vector3d, 3> corners(const Mesh& mesh, std::size_t t) {
  return {mesh.vertices[mesh.triangles[t][0]], mesh.vertices[mesh.triangles[t][1]],
          mesh.vertices[mesh.triangles[t][2]]};
}

// Divergence theorem: six times the volume is the sum of the triangles' determinants.
double volume_of(const Mesh& mesh, std::int32_t solid) {
  double six = 0.0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    if (mesh.solid[t] != solid) continue;
    const auto [a, b, c] = corners(mesh, t);
    six += a.dot(b.cross(c));
  }
  return six / 6.0;
}

// Sum of the area vectors: zero for a closed surface.
Eigen::Vector3d area_vector(const Mesh& mesh, const std::function<bool(std::size_t)>& wanted) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    if (!wanted(t)) continue;
    const auto [a, b, c] = corners(mesh, t);
    sum += (b - a).cross(c - a) / 2.0;
  }
  return sum;
}

double area_of(const Mesh& mesh, const std::function<bool(std::size_t)>& wanted) {
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    if (!wanted(t)) continue;
    const auto [a, b, c] = corners(mesh, t);
    area += (b - a).cross(c - a).norm() / 2.0;
  }
  return area;
}

// Every edge of a closed body is passed once in each direction.
bool is_watertight(const Mesh& mesh, std::int32_t solid) {
  using Corner = std::array<std::int64_t, 3>;
  const auto key = [](const Eigen::Vector3d& p) -> Corner {
    return {std::llround(p.x() * 1e7), std::llround(p.y() * 1e7), std::llround(p.z() * 1e7)};
  };
  std::map<std::pair<Corner, Corner>, int> passes;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    if (mesh.solid[t] != solid) continue;
    const auto c = corners(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner from = key(c[i]);
      const Corner to = key(c[(i + 1) % 3]);
      if (from < to) {
        ++passes[{from, to}];
      } else {
        --passes[{to, from}];
      }
    }
  }
  return !passes.empty() && std::all_of(passes.begin(), passes.end(),
                                        [](const auto& edge) { return edge.second == 0; });
}

TEST(World, GroundAloneIsAPlane) {
  Ground ground;
  ground.slope = 0.2;
  ground.slope_direction = 0.7;
  const World world = build_world(scene_of({}, ground));
  ASSERT_EQ(world.solids.size(), 1U);
  EXPECT_EQ(world.solids[0].id, 0);
  for (const Eigen::Vector3d& p : world.mesh.vertices) {
    EXPECT_NEAR(p.z(), std::tan(0.2) * (std::cos(0.7) * p.x() + std::sin(0.7) * p.y()), 1e-12);
  }
  EXPECT_NEAR(area_of(world.mesh, [](std::size_t) { return true; }), 1600.0 / std::cos(0.2), 1e-8);
}

// Closed forms: the parts of bodies that lie above z = 0, and what sinks below.
TEST(World, BodiesAreClosedAndHaveTheirVolume) {
  struct Case {
    Shape shape;
    double above;      // volume over the ground
    double footprint;  // area that is drawn down below the ground
  };
  Ramp ramp;
  ramp.length = 2.0;
  ramp.width = 1.5;
  ramp.angle = 0.3;
  ramp.platform = 1.0;
  ramp.way_down = true;
  const double rise = 2.0 * std::tan(0.3);
  Stairs stairs;
  const double steps = stairs.width * stairs.tread * stairs.riser * (1 + 2 + 3 + 4 + 5);
  Box raised;
  raised.lift = 0.5;
  raised.tilt = 0.4;
  Cylinder cylinder;
  const double round = 32.0 * std::sin(2.0 * M_PI / 64.0) * cylinder.radius * cylinder.radius;
  const std::vector<Case> cases{
      {ramp, 1.5 * (2.0 * rise + rise), 7.5},
      {Box{}, 0.4 * 0.4 * 0.3, 0.16},
      {raised, 0.4 * 0.4 * 0.3, 0.0},
      {Curb{}, 10.0 * 0.3 * 0.12, 3.0},
      {stairs, steps, 1.5 * 1.5},
      {Wall{}, 5.0 * 0.2 * 2.0, 1.0},
      {cylinder, round * cylinder.height, round},
  };
  for (const Case& test : cases) {
    const World world = build_world(scene_of({solid_of(test.shape, 3.0, -2.0, 0.6)}));
    const double sunk = 0.2 * test.footprint;  // bodies reach 20 cm below level ground
    EXPECT_NEAR(volume_of(world.mesh, 1), test.above + sunk, 1e-9) << type_of(test.shape);
    const Eigen::Vector3d open =
        area_vector(world.mesh, [&](std::size_t t) { return world.mesh.solid[t] == 1; });
    EXPECT_LT(open.norm(), 1e-9) << type_of(test.shape);
    // The sides of stairs meet their risers between corners.
    if (std::holds_alternative<Stairs>(test.shape)) continue;
    EXPECT_TRUE(is_watertight(world.mesh, 1)) << type_of(test.shape);
  }
}

TEST(World, TablesBridgesHeapsAndPeopleAreClosed) {
  const World world = build_world(
      scene_of({solid_of(Table{}, 2, 0), solid_of(Bridge{}, 8, 0), solid_of(Rubble{}, -3, 0)}));
  for (const std::int32_t solid : {1, 2, 3}) {
    EXPECT_TRUE(is_watertight(world.mesh, solid)) << solid;
    EXPECT_GT(volume_of(world.mesh, solid), 0.0) << "seen from outside" << solid;
  }
  const World walk = build_world(scene_of({solid_of(Person{}, 0, 0, 1.0)}));
  ASSERT_EQ(walk.movers.size(), 1U);
  EXPECT_TRUE(is_watertight(walk.movers[0].mesh, 1));
  EXPECT_GT(volume_of(walk.movers[0].mesh, 1), 0.05);
  EXPECT_LT(volume_of(walk.movers[0].mesh, 1), 0.15);
  EXPECT_NEAR((walk.movers[0].to - walk.movers[0].from).norm(), 4.0, 1e-12);
}

// Closed form: ground, floor and sloped walls of holes cover the ground's area once, seen from
// above; upright walls cover nothing. The volume of the hole is that under the cut.
TEST(World, HolesAreCutOutOfAnyGround) {
  Pothole upright;
  Pothole sloped;
  sloped.form = RimForm::kEllipse;
  sloped.length = 1.2;
  sloped.width = 0.8;
  sloped.depth = 0.15;
  sloped.wall_angle = 0.9;
  for (const Ground& ground : {Ground{}, hilly_ground()}) {
    const World world =
        build_world(scene_of({solid_of(upright, 1.234, 0.567, 0.3),
                              solid_of(sloped, -2.1, 1.3, 1.1), solid_of(Ditch{}, 0.0, -6.0, 0.2)},
                             ground));
    const Eigen::Vector3d all = area_vector(world.mesh, [](std::size_t) { return true; });
    EXPECT_NEAR(all.z(), 1600.0, 1e-7) << "as seen from above";
    const double walls = area_of(world.mesh, [&](std::size_t t) {
      return world.mesh.solid[t] == 1 && world.mesh.kind[t] == SurfaceKind::kFlank;
    });
    EXPECT_NEAR(walls, 4 * 0.5 * 0.09, ground.form == GroundForm::kPlane ? 1e-9 : 0.005);
    EXPECT_NEAR(area_vector(world.mesh,
                            [&](std::size_t t) {
                              return world.mesh.solid[t] == 1 &&
                                     world.mesh.kind[t] == SurfaceKind::kDrivable;
                            })
                    .z(),
                0.25, 1e-9)
        << "floor of the upright pothole";
  }
}

// Oracle: a vertical ray meets the ground where the height function says, lowered in holes.
TEST(World, HeightsOfTheMeshAreThoseOfTheGround) {
  Pothole pothole;
  pothole.length = pothole.width = 2.0;
  pothole.depth = 0.3;
  pothole.wall_angle = M_PI / 4;
  const Ground ground = hilly_ground();
  const World world = build_world(scene_of({solid_of(pothole, 1.0, 1.0)}, ground));
  const GroundSurface surface(ground);
  const RayCaster caster(world);
  RandomGenerator random(3);
  for (int k = 0; k < 2000; ++k) {
    const double x = -4.0 + 8.0 * random.uniform();
    const double y = -4.0 + 8.0 * random.uniform();
    const double inside = 1.0 - std::max(std::abs(x - 1.0), std::abs(y - 1.0));
    const double lowered = std::clamp(inside, 0.0, 0.3);
    const auto top = caster.top_at(x, y);
    ASSERT_TRUE(top.has_value());
    EXPECT_NEAR(top->height, surface.height(x, y) - lowered, 1e-9) << x << " " << y;
  }
}

TEST(World, ThingsStandOnTheGroundUnderThem) {
  Ground slope;
  slope.slope = 0.2;
  Box box;
  const World world = build_world(scene_of({solid_of(box, 5.0, 0.0)}, slope));
  const RayCaster caster(world);
  EXPECT_NEAR(caster.top_at(5.0, 0.0)->height, 5.0 * std::tan(0.2) + 0.3, 1e-9);
  EXPECT_NEAR(world.solids[1].height, 0.3, 1e-12);
  // No gap under the edge on the downhill side: the body reaches below the ground there.
  double lowest = 1e9;
  for (std::size_t t = 0; t < world.mesh.size(); ++t) {
    if (world.mesh.solid[t] != 1) continue;
    for (const Eigen::Vector3d& p : corners(world.mesh, t)) lowest = std::min(lowest, p.z());
  }
  EXPECT_LT(lowest, 4.8 * std::tan(0.2));
}

TEST(World, ThingsStandOnRampsThatCameBefore) {
  Ramp ramp;
  ramp.angle = 0.135;
  Box box;
  box.length = box.width = 0.1;
  box.height = 0.12;
  const World world = build_world(scene_of({solid_of(ramp, 1.25, 0.0), solid_of(box, 1.75, 0.0)}));
  const RayCaster caster(world);
  EXPECT_NEAR(caster.top_at(1.75, 0.0)->height, 0.5 * std::tan(0.135) + 0.12, 1e-9);
  EXPECT_NEAR(caster.terrain_at(1.75, 0.0)->height, 0.5 * std::tan(0.135), 1e-9);
  EXPECT_NEAR(world.solids[1].slope, 0.135, 1e-12);
  EXPECT_NEAR(world.solids[1].height, 1.2 * std::tan(0.135), 1e-12);
}

TEST(World, FractalsStayBelowTheirSlopeAndBeginFlat) {
  Ground ground = hilly_ground();
  ground.amplitude = 5.0;
  ground.max_slope = 0.3;
  ground.flat_radius = 2.0;
  const GroundSurface surface(ground);
  RandomGenerator random(9);
  double steepest = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double x = -20.0 + 40.0 * random.uniform();
    const double y = -20.0 + 40.0 * random.uniform();
    const double slope = std::acos(surface.normal(x, y).z());
    steepest = std::max(steepest, slope);
    if (std::hypot(x, y) < 1.8) {
      EXPECT_EQ(surface.height(x, y), 0.0);
    }
  }
  EXPECT_LE(steepest, 0.3 + 1e-9);
  EXPECT_GT(steepest, 0.2) << "it is scaled down no more than needed";
}

TEST(World, SameSeedSameGroundOtherSeedOther) {
  Ground ground = hilly_ground();
  const double before = GroundSurface(ground).height(3.3, 4.4);
  EXPECT_EQ(GroundSurface(ground).height(3.3, 4.4), before);
  ground.seed = 6;
  EXPECT_NE(GroundSurface(ground).height(3.3, 4.4), before);
}

std::string message_of(const Scene& scene) {
  try {
    (void)build_world(scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(World, APotholeWiderThanItsGroundIsRefused) {
  Ground ground;
  ground.length = ground.width = 4.0;
  Pothole pothole;
  pothole.width = 5.0;
  Scene scene = scene_of({solid_of(pothole, 0, 0)}, ground);
  scene.source = "x.yaml";
  const std::string message = message_of(scene);
  EXPECT_NE(message.find("x.yaml: solids[0] pothole"), std::string::npos) << message;
  EXPECT_NE(message.find("must lie on the ground, x -2 to 2"), std::string::npos) << message;
}

TEST(World, HolesThatOverlapOrHaveNoFloorAreRefused) {
  EXPECT_NE(message_of(scene_of({solid_of(Pothole{}, 0, 0), solid_of(Pothole{}, 0.3, 0)}))
                .find("holes must not overlap"),
            std::string::npos);
  Pothole funnel;
  funnel.depth = 0.4;
  funnel.wall_angle = 0.5;
  EXPECT_NE(message_of(scene_of({solid_of(funnel, 0, 0)})).find("must leave a floor"),
            std::string::npos);
}

TEST(World, IdsGivenTwiceAreRefused) {
  Scene scene = scene_of({solid_of(Box{}, 0, 0), solid_of(Box{}, 2, 0)});
  scene.solids[1].placement.id = 1;
  EXPECT_NE(message_of(scene).find("id = 1: must be unique"), std::string::npos);
}

}  // namespace
}  // namespace mrpt_terrain::sim
