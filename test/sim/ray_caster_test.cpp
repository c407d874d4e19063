// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "meshes.h"

namespace mrpt_terrain::sim {
namespace {

using Eigen::Vector3d;

void add_ray(Rays& rays, const Vector3d& origin, const Vector3d& direction) {
  rays.origin_x.push_back(origin.x());
  rays.origin_y.push_back(origin.y());
  rays.origin_z.push_back(origin.z());
  rays.direction_x.push_back(direction.x());
  rays.direction_y.push_back(direction.y());
  rays.direction_z.push_back(direction.z());
}

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
  add_ray(rays, {0, 0, 1}, {0, 0, -1});
  add_ray(rays, {0, 0, 1}, {1, 0, 0});
  add_ray(rays, {0, 0, 1}, {0, 0, 1});
  add_ray(rays, {0, 0, 1}, Vector3d(0, 3, -1).normalized());
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

}  // namespace
}  // namespace mrpt_terrain::sim
