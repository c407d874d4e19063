// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/ray_caster.h"

#include <gtest/gtest.h>
#include <immintrin.h>

#include <cmath>
#include <limits>

#include "sim_oracle.h"

namespace mrpt_terrain::sim {
namespace {

using Eigen::Vector3d;

using worlds::add_ray;
using worlds::Block;
using worlds::ConvexSolid;
using worlds::kNoHit;
using worlds::Ray;

World ground_and_box() {
  World world;
  worlds::add_ground(world, 0.0, 0.0, 0.0, 20.0);
  worlds::add_box(world.mesh, {5, -1, 0}, {6, 1, 2}, 1);
  return world;
}

TEST(RayCaster, LiteralRaysMeetGroundBoxAndSky) {
  const World world = ground_and_box();
  const RayCaster caster(world);
  Rays rays;
  add_ray(rays, {{0, 0, 1}, {0, 0, -1}});
  add_ray(rays, {{0, 0, 1}, {1, 0, 0}});
  add_ray(rays, {{0, 0, 1}, {0, 0, 1}});
  add_ray(rays, {{0, 0, 1}, Vector3d(0, 3, -1).normalized()});
  Hits hits;
  caster.cast(rays, 100.0, hits);
  EXPECT_DOUBLE_EQ(hits.range[0], 1.0);
  EXPECT_EQ(hits.solid[0], kGroundSolid);
  EXPECT_EQ(hits.kind[0], SurfaceKind::kDrivable);
  EXPECT_DOUBLE_EQ(hits.range[1], 5.0);
  EXPECT_EQ(hits.solid[1], 1);
  EXPECT_EQ(hits.kind[1], SurfaceKind::kObject);
  EXPECT_EQ(hits.range[2], std::numeric_limits<double>::infinity());
  EXPECT_EQ(hits.solid[2], kNoSolid);
  EXPECT_NEAR(hits.range[3], std::sqrt(10.0), 1e-12);
  EXPECT_NEAR(hits.cos_incidence[3], 1.0 / std::sqrt(10.0), 1e-7);
}

TEST(RayCaster, TerrainPassesUnderObjectsAndTopDoesNot) {
  const World world = ground_and_box();
  const RayCaster caster(world);
  ASSERT_TRUE(caster.terrain_at(5.5, 0.2));
  EXPECT_NEAR(caster.terrain_at(5.5, 0.2)->height, 0.0, 1e-12);
  EXPECT_NEAR(caster.top_at(5.5, 0.2)->height, 2.0, 1e-12);
  EXPECT_EQ(caster.top_at(5.5, 0.2)->solid, 1);
  EXPECT_EQ(caster.top_at(4.5, 0.2)->solid, kGroundSolid);
  for (const double edge : {-20.0, 20.0}) {
    EXPECT_TRUE(caster.terrain_at(edge, edge)) << edge;
    EXPECT_FALSE(caster.terrain_at(std::nextafter(edge, 2 * edge), 0.0)) << edge;
  }
}

Hits cast(const World& world, const Rays& rays, double max_range = 1000.0) {
  Hits hits;
  RayCaster(world).cast(rays, max_range, hits);
  return hits;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A square at 10 m whose normal is turned away from the ray by up to 85 degrees, far from the map's
// origin and turned at random.
TEST(RayCaster, RangesOfObliquePlanesAgreeWithTheClosedForm) {
  RandomGenerator random(3);
  std::vector<double> errors;
  for (int trial = 0; trial < 400; ++trial) {
    const double incidence = 85.0 * M_PI / 180.0 * trial / 399.0;
    const Vector3d direction = worlds::random_direction(random);
    const Vector3d aside = direction.unitOrthogonal();
    const Vector3d normal = -std::cos(incidence) * direction + std::sin(incidence) * aside;
    const Vector3d origin = worlds::random_point(random, {-900, -900, -9}, {900, 900, 9});
    const Vector3d centre = origin + 10.0 * direction;
    const Vector3d u = 40.0 * normal.unitOrthogonal(), v = normal.cross(u);
    World world;
    worlds::add_patch(world.mesh, centre - 0.5 * (u + v), u, v, 0, SurfaceKind::kDrivable);
    Rays rays;
    std::vector<double> expected;
    for (int k = 0; k < 10; ++k) {
      const Vector3d d = (direction + 0.02 * worlds::random_direction(random)).normalized();
      add_ray(rays, {origin, d});
      expected.push_back(normal.dot(centre - origin) / normal.dot(d));
    }
    const Hits hits = cast(world, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      errors.push_back(std::abs(hits.range[k] - expected[k]));
    }
  }
  EXPECT_LT(median(errors), 1e-6);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 20e-6);
}

// Rays that pass an edge within 0.1 mm are left out: single precision about the centre of a 20 m
// world resolves 1 micrometre.
TEST(RayCaster, BoxesAndWedgesAgreeWithHalfSpaces) {
  RandomGenerator random(5);
  World world;
  std::vector<ConvexSolid> solids;
  for (int k = 0; k < 40; ++k) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = worlds::random_point(random, {-10, -10, -10}, {10, 10, 10});
    pose.rotate(Eigen::AngleAxisd(6.0 * random.uniform(), worlds::random_direction(random)));
    const Block block{pose, 0.5 + 4 * random.uniform(), 0.5 + 4 * random.uniform(),
                      0.1 + 3 * random.uniform(), k % 2 == 0};
    solids.push_back(block.solid());
    block.add_to(world.mesh, k);
  }
  Rays rays;
  std::vector<worlds::SolidHit> expected;
  while (rays.size() < 20000) {
    const Ray ray{worlds::random_point(random, {-12, -12, -12}, {12, 12, 12}),
                  worlds::random_direction(random)};
    const auto hit = cast_solids(solids, ray), grown = cast_solids(solids, ray, 1e-4),
               shrunk = cast_solids(solids, ray, -1e-4);
    const bool inside = std::any_of(solids.begin(), solids.end(), [&](const ConvexSolid& solid) {
      return std::all_of(solid.faces.begin(), solid.faces.end(), [&](const auto& face) {
        return face.normal.dot(ray.origin) <= face.bound + 1e-4;
      });
    });
    const auto same = [&](const worlds::SolidHit& other) {
      return other.solid == hit.solid && other.face == hit.face;
    };
    if (inside || !same(grown) || !same(shrunk)) continue;
    add_ray(rays, ray);
    expected.push_back(hit);
  }
  const Hits hits = cast(world, rays);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    ASSERT_EQ(hits.solid[k], expected[k].solid) << k;
    if (expected[k].solid < 0) continue;
    ++met;
    ASSERT_NEAR(hits.range[k], expected[k].range, 1e-9) << k;
  }
  EXPECT_GT(met, 3000U);
}

TEST(RayCaster, RandomTrianglesAgreeWithAllTrianglesOneByOne) {
  RandomGenerator random(7);
  World world;
  for (int k = 0; k < 500; ++k) {
    const Vector3d a = worlds::random_point(random, {-5, -5, -5}, {5, 5, 5});
    worlds::add_triangle(world.mesh, a, a + 2.0 * worlds::random_direction(random),
                         a + 2.0 * worlds::random_direction(random), k,
                         k % 3 == 0 ? SurfaceKind::kDrivable : SurfaceKind::kObject);
  }
  Rays rays;
  std::vector<worlds::TriangleHit> expected;
  for (int k = 0; k < 5000; ++k) {
    const Ray ray{worlds::random_point(random, {-6, -6, -6}, {6, 6, 6}),
                  worlds::random_direction(random)};
    const auto hit = worlds::cast_triangles(world.mesh, ray);
    // Two triangles that the ray meets at the same place are both right.
    if (!hit.clear) continue;
    add_ray(rays, ray);
    expected.push_back(hit);
  }
  ASSERT_GT(rays.size(), 2000U);
  const Hits hits = cast(world, rays);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (expected[k].range == kNoHit) {
      ASSERT_EQ(hits.range[k], kNoHit) << k;
      continue;
    }
    ASSERT_NEAR(hits.range[k], expected[k].range, 1e-6) << k;
    EXPECT_EQ(hits.kind[k], world.mesh.kind[expected[k].triangle]) << k;
  }
}

TEST(RayCaster, RangesDoNotDependOnWhereTheMapBegins) {
  World here = ground_and_box(), there = ground_and_box();
  const Vector3d shift(80000.0, -60000.0, 500.0);
  for (Vector3d& vertex : there.mesh.vertices) vertex += shift;
  there.min_corner += shift.head<2>();
  there.max_corner += shift.head<2>();
  RandomGenerator random(9);
  Rays rays, shifted;
  for (int k = 0; k < 1000; ++k) {
    Vector3d direction = worlds::random_direction(random);
    direction.z() = -std::abs(direction.z());
    add_ray(rays, {{0, 0, 1}, direction});
    add_ray(shifted, {Vector3d(0, 0, 1) + shift, direction});
  }
  const Hits a = cast(here, rays), b = cast(there, shifted);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (a.range[k] == kNoHit) continue;
    // The coordinates themselves have a step of 1.5e-11 m out there.
    ASSERT_NEAR(a.range[k], b.range[k],
                1e-8 * a.range[k] / static_cast<double>(a.cos_incidence[k]));
  }
}

TEST(RayCaster, TerrainReachesToTheVeryEdgeOfTheGround) {
  RandomGenerator random(19);
  for (int trial = 0; trial < 200; ++trial) {
    World world;
    worlds::add_ground(world, 1000.0 * random.uniform(), 10.0 * random.uniform(), 0.25,
                       1.0 + 30.0 * random.uniform());
    const RayCaster caster(world);
    const Eigen::Vector2d low = world.min_corner, high = world.max_corner;
    for (const double x : {low.x() + 1e-9, high.x() - 1e-9}) {
      for (const double y : {low.y() + 1e-9, 0.7 * low.y() + 0.3 * high.y(), high.y() - 1e-9}) {
        ASSERT_TRUE(caster.terrain_at(x, y)) << x << " " << y;
        EXPECT_NEAR(caster.terrain_at(x, y)->height, 0.25, 1e-12);
      }
    }
  }
}

TEST(RayCaster, OddRaysHaveDefinedResults) {
  const World world = ground_and_box();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<Ray, double> cases[] = {
      {{{0, 0, 1}, {0, 0, 0}}, kNoHit},        {{{0, 0, 1}, {kNan, 0, -1}}, kNoHit},
      {{{kNan, 0, 1}, {0, 0, -1}}, kNoHit},    {{{kNoHit, 0, 1}, {0, 0, -1}}, kNoHit},
      {{{1e300, 0, 1}, {0, 0, -1}}, kNoHit},   {{{0, 0, 1}, {0, kNoHit, 0}}, kNoHit},
      {{{5.5, 0, 1}, {1, 0, 0}}, 0.5},          // from within the box
      {{{0, 0, -1}, {0, 0, 1}}, 1.0},           // from under the ground
      {{{0, 0, 2.5}, {1, 0, 0}}, kNoHit},       // above and parallel to the top of the box
      {{{0, 1.01, 1}, {1, 0, 0}}, kNoHit},      // beside it
      {{{0, 0, 1}, {-1, 0, 0}}, kNoHit},        // away from it
      {{{19.0, 0, 1}, {0.6, 0, -0.8}}, 1.25},   // ground near the edge
      {{{19.5, 0, 1}, {0.6, 0, -0.8}}, kNoHit}  // past the edge
  };
  Rays rays;
  for (const auto& [ray, range] : cases) add_ray(rays, ray);
  const Hits hits = cast(world, rays);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (cases[k].second == kNoHit) {
      EXPECT_EQ(hits.range[k], kNoHit) << k;
      EXPECT_EQ(hits.solid[k], kNoSolid) << k;
    } else {
      EXPECT_NEAR(hits.range[k], cases[k].second, 1e-12) << k;
    }
  }
}

TEST(RayCaster, ReachIsKeptInDouble) {
  Rays rays;
  add_ray(rays, {{0, 0, 1}, {1, 0, 0}});
  EXPECT_EQ(cast(ground_and_box(), rays, 5.0).range[0], 5.0);
  EXPECT_EQ(cast(ground_and_box(), rays, std::nextafter(5.0, 0.0)).range[0], kNoHit);
}

TEST(RayCaster, EmptyWorldHasNothingToMeet) {
  const World world;
  const RayCaster caster(world);
  Rays rays;
  add_ray(rays, {{0, 0, 1}, {0, 0, -1}});
  Hits hits;
  caster.cast(rays, 100.0, hits);
  EXPECT_EQ(hits.range[0], kNoHit);
  EXPECT_FALSE(caster.terrain_at(0, 0));
  EXPECT_FALSE(caster.top_at(0, 0));
  caster.cast(Rays{}, 100.0, hits);
  EXPECT_TRUE(hits.range.empty());
}

TEST(RayCaster, LeavesTheRoundingModeOfItsCallerAlone) {
  const unsigned before = _mm_getcsr();
  Rays rays;
  add_ray(rays, {{0, 0, 1}, {1, 0, 0}});
  static_cast<void>(cast(ground_and_box(), rays));
  // The lowest six bits say which exceptions occurred.
  EXPECT_EQ(_mm_getcsr() & ~0x3FU, before & ~0x3FU);
}

TEST(RayCaster, TerrainOfManyPlacesIsThatOfEachPlace) {
  World world;
  worlds::add_height_field(world, 50, 0.2, worlds::uneven_height);
  worlds::add_box(world.mesh, {1, 1, -1}, {2, 2, 3}, 1);
  const RayCaster caster(world);
  RandomGenerator random(11);
  std::vector<double> x, y;
  for (int k = 0; k < 1001; ++k) {
    x.push_back(12.0 * (random.uniform() - 0.5));
    y.push_back(12.0 * (random.uniform() - 0.5));
  }
  std::vector<std::optional<TerrainPoint>> terrain, tops;
  caster.terrain_under(x, y, terrain);
  caster.tops_under(x, y, tops);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool inside = std::max(std::abs(x[k]), std::abs(y[k])) <= 5.0;
    ASSERT_EQ(terrain[k].has_value(), inside);
    if (!inside) continue;
    EXPECT_EQ(terrain[k]->height, caster.terrain_at(x[k], y[k])->height);
    EXPECT_EQ(tops[k]->height, caster.top_at(x[k], y[k])->height);
    // The greatest curvature is about 0.34 per metre, the half diagonal of a square 0.14 m.
    EXPECT_NEAR(terrain[k]->height, worlds::uneven_height(x[k], y[k]), 0.5 * 0.34 * 0.02);
    EXPECT_NEAR(terrain[k]->normal.norm(), 1.0, 1e-12);
  }
}

// The foot of a ramp, a regular place after the other: whichever patch comes first in the mesh is
// found in all of them, on every processor.
TEST(RayCaster, OnAnEdgeTheFirstPatchOfTheMeshIsFound) {
  for (const bool ramp_first : {false, true}) {
    World world;
    const auto add = [&](double x, double z, double rise, std::int32_t solid) {
      worlds::add_patch(world.mesh, {x, -4, z}, {4, 0, rise}, {0, 8, 0}, solid,
                        SurfaceKind::kDrivable);
    };
    if (ramp_first) add(0, 0, 1, 1);
    add(-4, 0, 0, 0);
    if (!ramp_first) add(0, 0, 1, 1);
    const RayCaster caster(world);
    std::vector<double> x, y;
    for (int k = -63; k < 64; ++k) {
      x.push_back(0.0);
      y.push_back(k / 16.0);
    }
    std::vector<std::optional<TerrainPoint>> terrain;
    caster.terrain_under(x, y, terrain);
    for (std::size_t k = 0; k < x.size(); ++k) {
      ASSERT_TRUE(terrain[k]) << y[k];
      EXPECT_NEAR(terrain[k]->height, 0.0, 1e-12);
      EXPECT_EQ(terrain[k]->solid, ramp_first ? 1 : 0) << y[k];
    }
  }
}

// Along the vertical wall between two levels, where no triangle of the terrain lies across.
TEST(RayCaster, TerrainIsWholeAlongVerticalWalls) {
  RandomGenerator random(23);
  for (int trial = 0; trial < 50; ++trial) {
    const double x0 = -3.0 - random.uniform(), x1 = 2.0 * random.uniform() - 1.0,
                 x2 = 3.0 + random.uniform();
    World world;
    worlds::add_patch(world.mesh, {x0, x0, 0}, {x1 - x0, 0, 0}, {0, x2 - x0, 0}, 0,
                      SurfaceKind::kDrivable);
    worlds::add_patch(world.mesh, {x1, x0, -0.3}, {x2 - x1, 0, 0}, {0, x2 - x0, 0}, 1,
                      SurfaceKind::kDrivable);
    worlds::add_patch(world.mesh, {x1, x0, -0.3}, {0, x2 - x0, 0}, {0, 0, 0.3}, 1,
                      SurfaceKind::kFlank);
    const RayCaster caster(world);
    for (int k = 0; k < 2000; ++k) {
      const double y = x0 + (x2 - x0) * random.uniform();
      ASSERT_TRUE(caster.terrain_at(x1, y)) << x1 << " " << y;
    }
  }
}

/// A pothole of 1 m x 1 m x 0.2 m in the middle of a square of 4 m, with a sloped flank at its far
/// side.
World pothole_world() {
  World world;
  Mesh& mesh = world.mesh;
  const auto floor = SurfaceKind::kDrivable, flank = SurfaceKind::kFlank;
  worlds::add_patch(mesh, {-2, -2, 0}, {4, 0, 0}, {0, 1.5, 0}, 0, floor);
  worlds::add_patch(mesh, {-2, 0.5, 0}, {4, 0, 0}, {0, 1.5, 0}, 0, floor);
  worlds::add_patch(mesh, {-2, -0.5, 0}, {1.5, 0, 0}, {0, 1, 0}, 0, floor);
  worlds::add_patch(mesh, {0.5, -0.5, 0}, {1.5, 0, 0}, {0, 1, 0}, 0, floor);
  worlds::add_patch(mesh, {-0.5, -0.5, -0.2}, {0.9, 0, 0}, {0, 1, 0}, 1, floor);
  worlds::add_patch(mesh, {0.4, -0.5, -0.2}, {0.1, 0, 0.2}, {0, 1, 0}, 1, flank);
  worlds::add_patch(mesh, {-0.5, -0.5, -0.2}, {0, 1, 0}, {0, 0, 0.2}, 1, flank);
  world.min_corner = {-2, -2};
  world.max_corner = {2, 2};
  return world;
}

TEST(RayCaster, TerrainIsWholeOverPotholes) {
  const World world = pothole_world();
  const RayCaster caster(world);
  EXPECT_NEAR(caster.terrain_at(0.0, 0.0)->height, -0.2, 1e-12);
  EXPECT_EQ(caster.terrain_at(0.0, 0.0)->solid, 1);
  EXPECT_NEAR(caster.terrain_at(0.45, 0.1)->height, -0.1, 1e-12);
  EXPECT_NEAR(caster.terrain_at(-1.0, 0.1)->height, 0.0, 1e-12);
  for (int k = 0; k <= 200; ++k) {
    const double y = -2.0 + 0.02 * k;
    EXPECT_TRUE(caster.terrain_at(-0.5, y)) << "along the vertical wall, y = " << y;
    EXPECT_TRUE(caster.terrain_at(0.5, y)) << "along the upper rim, y = " << y;
  }
}

TEST(RayCaster, TerrainHasNoGapsInABuiltScene) {
  Scene scene;
  scene.ground.length = scene.ground.width = 12.0;
  scene.ground.form = GroundForm::kFractal;
  Pothole hole;
  scene.solids.push_back({{}, hole, ""});
  scene.solids.push_back({{}, Curb{}, ""});
  scene.solids.push_back({{}, Person{}, ""});
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    scene.solids[k].placement.id = static_cast<int>(k + 1);
    scene.solids[k].placement.y = 2.5 * static_cast<double>(k) - 3.0;
    scene.solids[k].placement.yaw = 0.3 * static_cast<double>(k);
  }
  const World world = build_world(scene);
  const RayCaster caster(world);
  std::vector<double> x, y;
  for (int j = 0; j <= 300; ++j) {
    for (int i = 0; i <= 300; ++i) {
      x.push_back(-6.0 + 0.04 * i);
      y.push_back(-6.0 + 0.04 * j);
    }
  }
  for (double& v : x) v = std::clamp(v, world.min_corner.x(), world.max_corner.x());
  for (double& v : y) v = std::clamp(v, world.min_corner.y(), world.max_corner.y());
  std::vector<std::optional<TerrainPoint>> terrain;
  caster.terrain_under(x, y, terrain);
  for (std::size_t k = 0; k < x.size(); ++k) ASSERT_TRUE(terrain[k]) << x[k] << " " << y[k];
}

/// Somebody 0.4 m deep, 0.6 m wide and 1.8 m high who walks along y at x = 5.
World walker_world() {
  World world = ground_and_box();
  world.mesh = Mesh();
  worlds::add_ground(world, 0.0, 0.0, 0.0, 20.0);
  Mover mover;
  mover.solid = 1;
  worlds::add_box(mover.mesh, {-0.2, -0.3, 0}, {0.2, 0.3, 1.8}, 1);
  mover.from = {5, -3, 0};
  mover.to = {5, 3, 0};
  mover.speed = 1.0;
  world.movers.push_back(mover);
  return world;
}

TEST(RayCaster, MoversAreWhereTheyAreAtTheTimeOfTheRay) {
  const World world = walker_world();
  Rays rays;
  // Ahead of x = 5 it is at y = time - 3, on the way back at y = 9 - time, and so on every 12 s.
  const std::pair<double, double> cases[] = {{3.0, 4.7},     {2.79, kNoHit}, {2.81, 4.7},
                                             {3.21, kNoHit}, {0.0, kNoHit},  {9.0, 4.7},
                                             {8.79, kNoHit}, {9.19, 4.7},    {15.0, 4.7}};
  for (const auto& [time, range] : cases) {
    add_ray(rays, {{0, 0, 1}, {1, 0, 0}});
    rays.time.push_back(time);
  }
  const Hits hits = cast(world, rays);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(hits.solid[k], cases[k].second == kNoHit ? kNoSolid : 1) << cases[k].first;
    if (cases[k].second != kNoHit) {
      EXPECT_NEAR(hits.range[k], cases[k].second, 1e-12);
    }
  }
}

TEST(RayCaster, MoversAgreeWithBlocksThatStandWhereTheyAre) {
  const World world = walker_world();
  RandomGenerator random(13);
  Rays rays;
  std::vector<double> expected;
  for (int k = 0; k < 20000; ++k) {
    const double time = 24.0 * random.uniform();
    const Block block{world.movers[0].pose_at(time), 0.4, 0.6, 1.8, false};
    const Vector3d origin = worlds::random_point(random, {0, -5, 0.5}, {4, 5, 2.5});
    const Vector3d aim = block.pose * worlds::random_point(random, {-1, -1, 0}, {1, 1, 2});
    const Ray ray{origin, (aim - origin).normalized()};
    const std::vector<ConvexSolid> solids{block.solid()};
    const double range = cast_solids(solids, ray).range;
    if (std::isfinite(cast_solids(solids, ray, 1e-4).range) !=
        std::isfinite(cast_solids(solids, ray, -1e-4).range)) {
      continue;
    }
    add_ray(rays, ray);
    rays.time.push_back(time);
    const double ground = ray.direction.z() < 0.0 ? -ray.origin.z() / ray.direction.z() : kNoHit;
    expected.push_back(range < ground ? range : kNoHit);
  }
  const Hits hits = cast(world, rays);
  std::size_t met = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (expected[k] == kNoHit) {
      ASSERT_NE(hits.solid[k], 1) << k;
      continue;
    }
    ++met;
    ASSERT_EQ(hits.solid[k], 1) << k;
    ASSERT_NEAR(hits.range[k], expected[k], 1e-6) << k;
  }
  EXPECT_GT(met, 3000U);
}

/// Hills under grass of 0.15 m in a turned rectangle.
World grassy_hills() {
  World world;
  world.solids.resize(2);
  worlds::add_height_field(world, 200, 0.1, worlds::uneven_height);
  Medium grass;
  grass.solid = 1;
  grass.height = 0.15;
  grass.density = 1.5;
  grass.T_map_medium.rotate(Eigen::AngleAxisd(0.4, Vector3d::UnitZ()));
  grass.half_extent = {6.0, 5.0, 0.0};
  world.media.push_back(grass);
  return world;
}

struct GrassPath {
  double length = 0.0;  ///< metres of a ray in the grass
  int entries = 0;      ///< how often it comes in
};

/// In small steps.
GrassPath path_in_grass(const RayCaster& caster, const Ray& ray, double end, double step) {
  const Medium& grass = caster.world().media[0];
  const Eigen::Isometry3d T_grass_map = grass.T_map_medium.inverse();
  GrassPath path;
  bool inside = false;
  for (double t = 0.5 * step; t < end; t += step) {
    const Vector3d p = ray.origin + t * ray.direction;
    const Vector3d own = T_grass_map * p;
    const bool over = std::abs(own.x()) <= 6.0 && std::abs(own.y()) <= 5.0;
    const bool was_inside = inside;
    inside = over && p.z() - caster.terrain_at(p.x(), p.y())->height <= grass.height;
    if (inside) path.length += step;
    if (inside && !was_inside) ++path.entries;
  }
  return path;
}

/// Rays that come into the grass more than once.
std::vector<Ray> rays_over_crests(const RayCaster& caster, std::size_t n) {
  RandomGenerator random(17);
  std::vector<Ray> result;
  while (result.size() < n) {
    const double angle = 2.0 * M_PI * random.uniform();
    const Vector3d from(-7.0 * std::cos(angle), -7.0 * std::sin(angle),
                        0.2 + 0.8 * random.uniform());
    const Vector3d to = worlds::random_point(random, {-4, -4, 0}, {4, 4, 0.8});
    const Ray ray{from, (to - from).normalized()};
    Rays rays;
    add_ray(rays, ray);
    Hits hits;
    caster.cast(rays, 15.0, hits);
    if (caster.terrain_at(from.x(), from.y())->height > from.z()) continue;
    const GrassPath path = path_in_grass(caster, ray, std::min(9.0, hits.range[0]), 0.02);
    if (path.entries > 1 && path.length < 1.5) result.push_back(ray);
  }
  return result;
}

// The share of rays that get through is exp(-density * path).
TEST(RayCaster, RaysThroughGrassOnHillsAreStoppedByItsWholePath) {
  const World world = grassy_hills();
  const RayCaster caster(world);
  constexpr int kTrials = 4000;
  constexpr double kStep = 0.002;
  for (const Ray& ray : rays_over_crests(caster, 12)) {
    Rays rays;
    for (int trial = 0; trial < kTrials; ++trial) add_ray(rays, ray);
    Hits hits;
    caster.cast(rays, 9.0, hits);
    const GrassPath path = path_in_grass(caster, ray, std::min(9.0, hits.range[0]), kStep);
    caster.scatter(rays, 9.0, 5, 0, hits);
    const auto stopped = std::count(hits.solid.begin(), hits.solid.end(), 1);
    const double expected = 1.0 - std::exp(-1.5 * path.length);
    // Four standard deviations, and a step of the oracle at each way in and out.
    EXPECT_NEAR(
        static_cast<double>(stopped) / kTrials, expected,
        4.0 * std::sqrt(expected * (1.0 - expected) / kTrials) + 1.5 * kStep * 2.0 * path.entries)
        << "path " << path.length << ", entries " << path.entries;
  }
}

}  // namespace
}  // namespace mrpt_terrain::sim
