// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/apply_free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fused_worlds.h"
#include "mrpt_terrain/core/describe_fused.h"

namespace mrpt_terrain {
namespace {

using worlds::box_solid;
using worlds::drive_scan;
using worlds::DriveScan;
using worlds::LidarModel;
using worlds::Mapper;
using worlds::Rect;
using worlds::Scene;

// A coarse sensor on a car's roof, which looks ahead only to keep the tests quick.
LidarModel coarse_sensor() {
  LidarModel model;
  model.height = 1.2;
  model.beams = 32;
  model.azimuth_step_deg = 0.5;
  model.max_range = 20.0;
  model.range_sigma = 0.005;
  return model;
}
constexpr double kAhead = 50.0;

FusionParams growing() {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  return params;
}

Rect person_at(double x, double y) { return {x - 0.2, x + 0.2, y - 0.2, y + 0.2}; }

// Greatest height over the ground among the known cells of a rectangle.
double highest_in(const Mapper& mapper, const Rect& rect) {
  double highest = 0.0;
  for (double x = rect.x0 + 0.1; x < rect.x1; x += 0.2) {
    for (double y = rect.y0 + 0.1; y < rect.y1; y += 0.2) {
      if (mapper.knows(x, y)) highest = std::max(highest, mapper.cell_at(x, y).h_max);
    }
  }
  return highest;
}

TEST(FreedWorld, APersonWhoWalkedAwayIsGone) {
  RandomGenerator random(1);
  Mapper mapper(growing());
  LidarModel sensor = coarse_sensor();
  sensor.max_range = 12.0;
  // Stands, walks across the way, and leaves.
  for (int k = 0; k < 25; ++k) {
    const double y = k < 10 ? -1.0 : -1.0 + 0.25 * (k - 9);
    const Scene scene{{box_solid(person_at(6.0, y), 0.0, 1.75, 1)}, {}};
    mapper.fuse_and_free(drive_scan(scene, sensor, 0.0, 0.0, random, kAhead));
    if (k == 9) {
      EXPECT_GT(highest_in(mapper, {5.4, 6.6, -1.6, -0.4}), 1.5);
    }
  }
  const Rect way{5.4, 6.6, -1.8, 1.8};
  const Scene empty;
  int scans_until_gone = 0;
  for (int k = 0; k < 45; ++k) {
    mapper.fuse_and_free(drive_scan(empty, sensor, 0.1 * k, 0.0, random, kAhead));
    if (highest_in(mapper, way) > 0.4) scans_until_gone = k + 1;
  }
  EXPECT_LE(scans_until_gone, 8) << "most of a person goes as soon as the octree knows";
  EXPECT_LT(highest_in(mapper, way), 0.05) << "feet, too, once the ground has been seen again";
  EXPECT_GT(mapper.cell_at(6.1, 0.1).moments.n, 0.0) << "the ground stays";
}

TEST(FreedWorld, ACurbAndTheGroundUnderGrazingRaysStay) {
  RandomGenerator random(2);
  Mapper with(growing());
  Mapper without(growing());
  const Scene scene{{box_solid({-5.0, 40.0, 2.0, 6.0}, 0.0, 0.12, 1)}, {}};
  LidarModel sensor = coarse_sensor();
  sensor.max_range = 15.0;
  for (int k = 0; k < 30; ++k) {
    const DriveScan scan = drive_scan(scene, sensor, 0.4 * k, 0.0, random, kAhead);
    with.fuse_and_free(scan);
    without.fuse(scan);
  }
  std::size_t cells = 0;
  std::size_t curb = 0;
  without.grid.now().tiles.for_each([&](TileIndex index, const Tile& tile) {
    for (std::size_t place = 0; place < kTileCells; ++place) {
      FusedCell expected;
      const MapCell where = cell_of(index, place);
      if (!read_cell(without.grid.now(), where, without.params, expected)) continue;
      FusedCell found;
      ++cells;
      ASSERT_TRUE(read_cell(with.grid.now(), where, with.params, found))
          << "cell " << where.i << ", " << where.j;
      EXPECT_EQ(found.height, expected.height);
      EXPECT_EQ(found.h_max, expected.h_max);
      EXPECT_EQ(found.moments.n, expected.moments.n);
      if (expected.h_max > 0.1) ++curb;
    }
    (void)tile;
  });
  EXPECT_GT(cells, 3000U);
  EXPECT_GT(curb, 500U);
  EXPECT_GT(with.freed.bins_guarded, 0U) << "rays did graze";
}

TEST(FreedWorld, FreeSpaceUnderABridgeStaysKnown) {
  RandomGenerator random(3);
  Mapper mapper(growing());
  const Rect deck{6.0, 9.0, -4.0, 4.0};
  const Scene scene{{box_solid(deck, 2.6, 2.9, 1)}, {}};
  LidarModel sensor = coarse_sensor();
  sensor.highest_deg = 25.0;
  sensor.max_range = 12.0;
  for (int k = 0; k < 20; ++k) {
    mapper.fuse_and_free(drive_scan(scene, sensor, 0.7 * k, 0.0, random, kAhead));
  }
  // Long after the passage only the rays beyond the bridge are new.
  for (const double x : {6.5, 7.1, 7.9, 8.5}) {
    const FusedCell cell = mapper.cell_at(x, 0.1);
    EXPECT_TRUE(cell.overhung) << x;
    EXPECT_NEAR(cell.overhang, 2.6, 0.05) << x;
    EXPECT_LT(cell.h_max, 0.05) << "what hangs over is no part of the ground; " << x;
    EXPECT_LE(mapper.grid.now().lattice.bottom_of(cell.free.low), 0.4);
    EXPECT_GE(mapper.grid.now().lattice.bottom_of(cell.free.high), 2.4);
  }
}

}  // namespace
}  // namespace mrpt_terrain
