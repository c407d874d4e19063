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

/// A grid with one cell, (0, 0), of the layers 0.2 m; heights in metres, a scan each row.
struct OneCell {
  FusionParams params = growing();
  FusedGrid grid{params};
  FusionWorkspace workspace;
  double time = 0.0;

  void see(const std::vector<float>& heights, float x = 0.1F, float y = 0.1F) {
    Points points;
    for (const float z : heights) points.push_back(x, y, z);
    time += 1.0;
    fuse_scan({points.view(), Eigen::Isometry3d::Identity(), time}, params, workspace, grid);
  }
  /// Free space found by a scan that is `later` than the last one.
  FreeSpaceCounts free(const std::vector<LayerSpan>& spans, double later = 1.0) {
    FreeSpaceGrid free;
    free.lattice = grid.now().lattice;
    free.time = time + later;
    free.begin_cell({0, 0});
    for (const LayerSpan& span : spans) free.add_span(span);
    return apply_free_space(free, params, grid);
  }
  [[nodiscard]] std::vector<int> layers() const {
    std::vector<int> found;
    const Tile* tile = grid.now().tiles.find({0, 0});
    for_each_bin(*tile, 0, [&](const HeightBin& bin) { found.push_back(bin.layer); });
    return found;
  }
};

using Layers = std::vector<int>;

TEST(ApplyFreeSpace, AllThatARemovedLayerHeldIsGoneWithoutATrace) {
  OneCell with;
  OneCell without;
  for (int k = 0; k < 3; ++k) {
    with.see({0.05F, 0.06F, 0.9F, 1.1F, 1.3F});
    without.see({0.05F, 0.06F});
  }
  const FreeSpaceCounts counts = with.free({{1, 10}});
  EXPECT_EQ(counts.bins_removed, 3U);
  EXPECT_EQ(counts.points_removed, 9U);
  EXPECT_EQ(with.layers(), (Layers{0}));
  FusedCell a, b;
  ASSERT_TRUE(read_cell(with.grid.now(), {0, 0}, with.params, a));
  ASSERT_TRUE(read_cell(without.grid.now(), {0, 0}, without.params, b));
  EXPECT_EQ(a.h_max, b.h_max);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.variance, b.variance);
  EXPECT_EQ(a.moments.n, b.moments.n);
  EXPECT_EQ(a.moments.mean_z, b.moments.mean_z);
  EXPECT_EQ(a.moments.m_zz, b.moments.m_zz);
  EXPECT_EQ(a.moments.m_xz, b.moments.m_xz);
  EXPECT_EQ(a.free, (LayerSpan{1, 10}));
}

TEST(ApplyFreeSpace, GrazedGroundStaysHoweverOften) {
  OneCell cell;
  cell.see({0.05F});
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(cell.free({{0, 8}}, 1.0 + k).bins_removed, 0U);
  }
  EXPECT_EQ(cell.layers(), (Layers{0}));
}

TEST(ApplyFreeSpace, WhatRaysWentUnderGoes) {
  OneCell cell;
  cell.see({0.85F, 1.1F});
  EXPECT_EQ(cell.free({{4, 8}}).bins_removed, 1U) << "0.85 may be ground that was grazed";
  EXPECT_EQ(cell.layers(), (Layers{4}));
  EXPECT_EQ(cell.free({{3, 8}}).bins_removed, 1U) << "rays passed 0.25 m below it";
  EXPECT_TRUE(cell.layers().empty());
  FusedCell read;
  EXPECT_FALSE(read_cell(cell.grid.now(), {0, 0}, cell.params, read));
  EXPECT_EQ(memory_of(cell.grid).cells, 0U);
}

TEST(ApplyFreeSpace, WhatStandsOutOfTheGroundAroundGoes) {
  for (const int ground_cells : {0, 3, 5}) {
    OneCell cell;
    cell.see({0.45F});
    for (int k = 0; k < ground_cells; ++k) {
      cell.see({0.0F}, 0.3F + 0.2F * static_cast<float>(k % 3), k < 3 ? 0.1F : 0.3F);
    }
    // Of four known cells three are ground: three quarters; without ground nothing is known.
    EXPECT_EQ(cell.free({{2, 8}}).bins_removed, ground_cells == 0 ? 0U : 1U) << ground_cells;
  }
  OneCell edge;
  edge.see({0.45F});
  for (int k = 0; k < 3; ++k)
    edge.see(
        {
            0.0F,
        },
        0.3F + 0.2F * static_cast<float>(k), 0.1F);
  for (int k = 0; k < 3; ++k) edge.see({0.46F}, 0.3F + 0.2F * static_cast<float>(k), 0.3F);
  EXPECT_EQ(edge.free({{2, 8}}).bins_removed, 0U) << "the edge of a platform is grazed, too";
}

TEST(ApplyFreeSpace, ARoofThatIsGrazedStaysAndOneThatIsPassedGoes) {
  OneCell cell;
  cell.see({0.0F, 1.45F});
  EXPECT_EQ(cell.free({{7, 12}}).bins_removed, 0U) << "rays above the roof free its layer only";
  EXPECT_EQ(cell.free({{6, 12}}).bins_removed, 1U);
  EXPECT_EQ(cell.layers(), (Layers{0}));
}

TEST(ApplyFreeSpace, HeightsCloseToTheGroundNeedScansThatSeeTheCell) {
  OneCell cell;
  cell.params.renew_scans = 0;
  cell.see({0.0F, 0.22F});
  const auto scan = [&](const std::vector<float>& heights) {
    cell.see(heights);
    return cell.free({{1, 8}}, 0.0).bins_removed;
  };
  for (int k = 0; k < 20; ++k) EXPECT_EQ(cell.free({{1, 8}}).bins_removed, 0U) << "not seen";
  for (int k = 0; k < 4; ++k) EXPECT_EQ(scan({0.0F}), 0U);
  EXPECT_EQ(scan({0.0F, 0.22F}), 0U) << "a hit ends the count";
  for (int k = 0; k < 4; ++k) EXPECT_EQ(scan({0.0F}), 0U);
  EXPECT_EQ(scan({0.0F}), 1U) << "the fifth scan in a row";
  EXPECT_EQ(cell.layers(), (Layers{0}));
}

TEST(ApplyFreeSpace, WhatTheSameScanHitStays) {
  OneCell cell;
  cell.see({0.0F, 1.1F});
  EXPECT_EQ(cell.free({{0, 10}}, 0.0).bins_removed, 0U);
  EXPECT_EQ(cell.free({{0, 10}}, 0.5).bins_removed, 1U);
}

TEST(ApplyFreeSpace, OldAndNewBinsOfALayerGoTogether) {
  OneCell cell;
  cell.params.renew_scans = 2;
  for (int k = 0; k < 3; ++k) cell.see({0.0F, 1.1F});
  EXPECT_EQ(cell.layers(), (Layers{0, 0, 5, 5}));
  EXPECT_EQ(cell.free({{3, 10}}, 0.0).bins_removed, 0U) << "the layer was hit";
  EXPECT_EQ(cell.free({{3, 10}}).bins_removed, 2U);
  EXPECT_EQ(cell.layers(), (Layers{0, 0}));
}

TEST(ApplyFreeSpace, OfTwoFreeSpacesTheLowerOneIsKeptIfARobotFits) {
  OneCell cell;
  cell.see({0.0F});
  cell.free({{1, 13}, {15, 60}});
  FusedCell read;
  ASSERT_TRUE(read_cell(cell.grid.now(), {0, 0}, cell.params, read));
  EXPECT_EQ(read.free, (LayerSpan{1, 13}));
  cell.free({{13, 14}, {16, 90}});
  ASSERT_TRUE(read_cell(cell.grid.now(), {0, 0}, cell.params, read));
  EXPECT_EQ(read.free, (LayerSpan{1, 13})) << "and is not forgotten for one above";
  cell.free({{5, 14}});
  ASSERT_TRUE(read_cell(cell.grid.now(), {0, 0}, cell.params, read));
  EXPECT_EQ(read.free, (LayerSpan{1, 14}));
}

TEST(ApplyFreeSpace, OfCellsThatAreNotKnownNothingIsKept) {
  OneCell cell;
  EXPECT_EQ(cell.free({{0, 9}}).bins_removed, 0U);
  EXPECT_EQ(memory_of(cell.grid).tiles, 0U);
}

TEST(ApplyFreeSpace, TilesThatDoNotChangeAreNotCopied) {
  OneCell cell;
  cell.see({0.0F, 1.1F});
  cell.free({{3, 10}});
  const FusedSnapshot snapshot = cell.grid.snapshot();
  cell.free({{3, 10}}, 2.0);
  EXPECT_EQ(cell.grid.now().tiles.find({0, 0}), snapshot.tiles.find({0, 0}));
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
