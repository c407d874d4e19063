// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/insert_scan.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <iostream>

#include "collect_cells.h"
#include "lidar.h"
#include "mrpt_terrain/io/scan.h"
#include "octomap_insertion.h"
#include "octree_scans.h"
#include "update_tree.h"

namespace mrpt_terrain::octree {
namespace {

using octomap::OcTree;
using test::OctreeScan;

/// Inserts the scans one by one, by this library and by OctoMap, into trees that must stay equal.
void expect_equal_trees(const std::vector<OctreeScan>& scans, const InsertionOptions& options,
                        double resolution) {
  InsertionWorkspace workspace;
  OcTree own(resolution), reference(resolution);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const InsertionResult result =
        insert_scan(scans[k].ends(), scans[k].starts(), options, workspace, own);
    EXPECT_EQ(result.inserter, Inserter::kOwn);
    test::insert_by_octomap(scans[k], options, reference);
    ASSERT_TRUE(own == reference) << "scan " << k;
  }
  EXPECT_TRUE(test::same_tree(own, reference));
}

struct RealCase {
  const char* sequence;
  std::size_t scans, every;
  double resolution, max_range;
  bool discretize;
};

class RealScans : public testing::TestWithParam<RealCase> {};

TEST_P(RealScans, OracleTheTreeIsThatOfOctomap) {
  RealCase given = GetParam();
  if (test::kSanitized) {
    std::cout << "one scan only, and cells of 0.4 m, under a sanitizer\n";
    given.scans = 1;
    given.resolution = 0.4;
  }
  const auto scans = test::kitti_scans(given.sequence, given.scans, given.every);
  if (scans.empty()) {
    GTEST_SKIP() << test::data_folder() / given.sequence << " is missing (TERRAIN_DATA_DIR)";
  }
  ASSERT_EQ(scans.size(), given.scans);
  expect_equal_trees(scans, {given.max_range, given.discretize}, given.resolution);
}

INSTANTIATE_TEST_SUITE_P(Kitti, RealScans,
                         testing::Values(RealCase{"kitti_raw_0001", 2, 1, 0.2, -1.0, false},
                                         RealCase{"kitti_raw_0001", 2, 15, 0.2, -1.0, true},
                                         RealCase{"kitti_raw_0001", 1, 1, 0.1, 20.0, false},
                                         RealCase{"kitti_raw_0001", 1, 1, 0.15, -1.0, true},
                                         RealCase{"kitti_00", 3, 1, 0.2, 10.0, false},
                                         RealCase{"kitti_00", 2, 5, 0.25, -1.0, true},
                                         RealCase{"kitti_00", 1, 1, 0.1, 20.0, true}));

/// The VLP-16 scan of Debian's mrpt-common in the frame of the sensor; empty if it is missing.
OctreeScan vlp16_scan() {
  OctreeScan scan;
  const auto file = test::mrpt_datasets() / "test_velodyne_VLP16.rawlog";
  if (!std::filesystem::exists(file)) return scan;
  mrpt::io::CFileGZInputStream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject());
  io::SensorPoints points;
  const auto conversion = io::convert_observation(*observation, {}, {}, points);
  EXPECT_EQ(conversion.status, io::ConversionStatus::kOk) << conversion.reason;
  scan.x = points.points.x;
  scan.y = points.points.y;
  scan.z = points.points.z;
  return scan;
}

TEST(InsertScan, OracleVlp16ScanGivesTheTreeOfOctomap) {
  const OctreeScan scan = vlp16_scan();
  if (scan.x.empty()) GTEST_SKIP() << "the VLP-16 scan is missing (Debian package mrpt-common)";
  const double resolution = test::kSanitized ? 0.3 : 0.1;
  for (const bool discretize : {false, true}) {
    for (const double range : {-1.0, 15.0}) {
      expect_equal_trees({scan}, {range, discretize}, resolution);
    }
  }
}

/// Scans of a drive past boxes, one of which is gone in the second half.
std::vector<OctreeScan> simulated_drive() {
  worlds::LidarModel lidar = worlds::sixteen_beams();
  lidar.azimuth_step_deg = 1.0;
  lidar.max_range = 30.0;
  lidar.range_sigma = 0.02;
  RandomGenerator random(4);
  std::vector<OctreeScan> scans;
  for (int step = 0; step < 20; ++step) {
    const double at = 0.5 * step;
    worlds::Scene scene;
    scene.solids.push_back(worlds::box_solid({6 - at, 2, 8 - at, 4}, 0.0, 2.0, 0));
    if (step < 10) {
      scene.solids.push_back(worlds::box_solid({9 - at, -3, 9.5 - at, -2.5}, 0.0, 1.8, 1));
    }
    const Points points = worlds::scan(scene, lidar, random).points;
    OctreeScan scan;
    scan.origins = {{static_cast<float>(at), 0.0F, static_cast<float>(lidar.height)}};
    for (std::size_t k = 0; k < points.size(); ++k) {
      scan.push_back(points.x[k] + static_cast<float>(at), points.y[k], points.z[k]);
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

TEST(InsertScan, OracleSimulatedDriveGivesTheTreeOfOctomap) {
  const auto scans = simulated_drive();
  expect_equal_trees(scans, {-1.0, false}, 0.2);
  expect_equal_trees(scans, {12.0, true}, 0.15);
}

constexpr std::uint32_t kFuzzTrees = test::kSanitized ? 150 : 600;

TEST(InsertScan, OracleFuzzOfScansGivesTheTreesOfOctomap) {
  if (test::kSanitized) std::cout << "fewer trees under a sanitizer\n";
  InsertionWorkspace workspace;
  std::size_t scans = 0;
  for (std::uint32_t seed = 0; seed < kFuzzTrees; ++seed) {
    RandomGenerator random(seed);
    OcTree own = test::random_tree(random);
    OcTree reference(own);
    const double resolution = own.getResolution();
    const std::uint32_t count = 1 + random.below(8);
    for (std::uint32_t k = 0; k < count; ++k, ++scans) {
      const OctreeScan scan = test::random_scan(random, resolution, 1);
      const InsertionOptions options = test::random_options(random, resolution);
      const auto result = insert_scan(scan.ends(), scan.starts(), options, workspace, own);
      ASSERT_EQ(result.inserter, Inserter::kOwn);
      test::insert_by_octomap(scan, options, reference);
      ASSERT_TRUE(test::same_tree(own, reference)) << "seed " << seed << ", scan " << k;
    }
  }
  std::cout << scans << " scans\n";
  EXPECT_TRUE(test::kSanitized || scans >= 2000U);
}

/// What `insert_scan` promises for several origins, cell by cell.
void insert_by_brute_force(const OctreeScan& scan, const InsertionOptions& options, OcTree& tree) {
  const test::QuietOctomap quiet;
  octomap::KeySet free, occupied;
  octomap::KeyRay ray;
  for (std::size_t k = 0; k < scan.x.size(); ++k) {
    octomap::point3d end(scan.x[k], scan.y[k], scan.z[k]);
    octomap::OcTreeKey key;
    if (!std::isfinite(scan.x[k] + scan.y[k] + scan.z[k])) continue;
    const bool in_range = tree.coordToKeyChecked(end, key);
    if (options.discretize && !in_range) continue;
    if (options.discretize) end = tree.keyToCoord(key);
    const octomap::point3d origin = scan.origin(k);
    if (options.max_range < 0.0 || (end - origin).norm() <= options.max_range) {
      if (in_range) occupied.insert(key);
    } else {
      end = origin + (end - origin).normalized() * static_cast<float>(options.max_range);
    }
    if (tree.computeRayKeys(origin, end, ray)) free.insert(ray.begin(), ray.end());
  }
  for (const auto& key : occupied) tree.updateNode(key, true);
  for (const auto& key : free) {
    if (occupied.count(key) == 0) tree.updateNode(key, false);
  }
}

TEST(InsertScan, OracleFuzzWithSeveralOriginsUpdatesEachCellOnce) {
  InsertionWorkspace workspace;
  for (std::uint32_t seed = 0; seed < kFuzzTrees / 2; ++seed) {
    RandomGenerator random(seed, 1);
    OcTree own = test::random_tree(random);
    OcTree reference(own);
    const double resolution = own.getResolution();
    for (int k = 0; k < 3; ++k) {
      const OctreeScan scan = test::random_scan(random, resolution, 1 + random.below(5));
      const InsertionOptions options = test::random_options(random, resolution);
      insert_scan(scan.ends(), scan.starts(), options, workspace, own);
      insert_by_brute_force(scan, options, reference);
      ASSERT_TRUE(test::same_tree(own, reference)) << "seed " << seed << ", scan " << k;
    }
  }
}

TEST(InsertScan, AFlippedTieRuleIsNoticed) {
  CollectionWorkspace workspace;
  std::size_t different = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    RandomGenerator random(seed);
    OcTree own = test::random_tree(random);
    OcTree reference(own);
    const OctreeScan scan = test::random_scan(random, own.getResolution(), 1);
    const InsertionOptions options;
    (void)collect_cells<Ties::kFlipped>(scan.ends(), scan.starts(), options, own.getResolution(),
                                        workspace);
    update_tree(workspace.cells, own, nullptr, nullptr);
    test::insert_by_octomap(scan, options, reference);
    if (!test::same_tree(own, reference)) ++different;
  }
  EXPECT_GE(different, 10U);
}

TEST(InsertScan, TreesThatAreNotPrunedBecomeWhatOctomapMakesOfThem) {
  InsertionWorkspace workspace;
  for (std::uint32_t seed = 0; seed < kFuzzTrees / 4; ++seed) {
    RandomGenerator random(seed, 2);
    OcTree own = test::random_tree(random);
    const double resolution = own.getResolution();
    const OctreeScan lazy = test::random_scan(random, resolution, 1);
    own.insertPointCloud(test::cloud_of(lazy, {}, own), lazy.origin(0), -1.0, true);
    OcTree reference(own);
    for (int k = 0; k < 3; ++k) {
      const OctreeScan scan = test::random_scan(random, resolution, 1);
      insert_scan(scan.ends(), scan.starts(), {}, workspace, own);
      test::insert_by_octomap(scan, {}, reference);
      ASSERT_TRUE(test::same_tree(own, reference)) << "seed " << seed << ", scan " << k;
    }
  }
}

TEST(InsertScan, APrunedCubeAtItsLimitStaysWhole) {
  OcTree own(0.1);
  for (int k = 0; k < 16 * 16 * 16; ++k) {
    const octomap::OcTreeKey key(static_cast<std::uint16_t>(32768 + k % 16),
                                 static_cast<std::uint16_t>(32768 + k / 16 % 16),
                                 static_cast<std::uint16_t>(32768 + k / 256));
    own.updateNode(key, 10.0F);
  }
  OcTree reference(own);
  EXPECT_EQ(own.getNumLeafNodes(), 1U);
  OctreeScan scan;
  scan.origins = {{-1.05F, 0.05F, 0.05F}};
  scan.push_back(0.05F, 0.05F, 0.05F);
  InsertionWorkspace workspace;
  insert_scan(scan.ends(), scan.starts(), {}, workspace, own);
  test::insert_by_octomap(scan, {}, reference);
  EXPECT_TRUE(test::same_tree(own, reference));
}

TEST(InsertScan, WhatCannotBeEqualIsLeftToOctomap) {
  RandomGenerator random(1);
  const OctreeScan scan = test::random_scan(random, 0.1, 1);
  const OctreeScan moving = test::random_scan(random, 0.1, 4);
  InsertionWorkspace workspace;
  const auto check = [&](const auto& prepare) {
    OcTree own(0.1), reference(0.1);
    prepare(own);
    prepare(reference);
    EXPECT_FALSE(is_supported(own));
    EXPECT_EQ(insert_scan(scan.ends(), scan.starts(), {}, workspace, own).inserter,
              Inserter::kOctomap);
    test::insert_by_octomap(scan, {}, reference);
    EXPECT_TRUE(test::same_tree(own, reference));
    EXPECT_EQ(own.numChangesDetected(), reference.numChangesDetected());
    EXPECT_GT(own.size(), 0U);
    if (own.bbxSet()) return;  // the brute force knows no limits
    EXPECT_EQ(insert_scan(moving.ends(), moving.starts(), {0.5, true}, workspace, own).inserter,
              Inserter::kOctomap);
    insert_by_brute_force(moving, {0.5, true}, reference);
    EXPECT_TRUE(own == reference);
  };
  check([](OcTree& tree) {
    octomap::point3d low(-0.5F, -0.5F, -0.5F), high(0.5F, 0.5F, 0.5F);
    tree.setBBXMin(low);
    tree.setBBXMax(high);
    tree.useBBXLimit(true);
  });
  check([](OcTree& tree) { tree.enableChangeDetection(true); });
  check([](OcTree& tree) { tree.setClampingThresMax(1.0); });
}

TEST(InsertScan, DerivedClassesAreLeftToOctomap) {
  class Derived : public OcTree {
    using OcTree::OcTree;
  };
  const Derived tree(0.1);
  EXPECT_FALSE(is_supported(tree));
  EXPECT_TRUE(is_supported(OcTree(0.1)));
}

TEST(InsertScan, LiteralPointsThatAreDroppedAreCounted) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  OctreeScan scan;
  scan.push_back(1.0F, nan, 0.0F);
  scan.push_back(infinity, 0.0F, 0.0F);
  scan.push_back(1.0F, 2.0F, -infinity);
  scan.push_back(5000.0F, 0.0F, 0.0F);
  scan.push_back(0.55F, 0.05F, 0.05F);
  scan.push_back(0.55F, 0.06F, 0.04F);
  InsertionWorkspace workspace;
  OcTree tree(0.1);
  const auto plain = insert_scan(scan.ends(), scan.starts(), {}, workspace, tree);
  EXPECT_EQ(plain.non_finite, 3U);
  EXPECT_EQ(plain.out_of_range, 1U);
  EXPECT_EQ(plain.rays, 2U);
  EXPECT_EQ(tree.getNumLeafNodes(), 6U);
  const auto joined = insert_scan(scan.ends(), scan.starts(), {-1.0, true}, workspace, tree);
  EXPECT_EQ(joined.rays, 1U);
  EXPECT_EQ(joined.out_of_range, 1U);
  EXPECT_EQ(tree.getNumLeafNodes(), 6U);
  const auto cut = insert_scan(scan.ends(), scan.starts(), {1.0, false}, workspace, tree);
  EXPECT_EQ(cut.rays, 3U);
  EXPECT_NE(tree.search(0.85F, 0.05F, 0.05F), nullptr);
}

TEST(InsertScan, DegenerateScans) {
  InsertionWorkspace workspace;
  OcTree tree(0.1);
  OctreeScan scan;
  insert_scan(scan.ends(), scan.starts(), {}, workspace, tree);
  EXPECT_EQ(tree.getRoot(), nullptr);
  scan.push_back(0.0F, 0.0F, 0.0F);  // at its origin
  insert_scan(scan.ends(), scan.starts(), {}, workspace, tree);
  EXPECT_EQ(tree.getNumLeafNodes(), 1U);
  EXPECT_TRUE(tree.isNodeOccupied(tree.search(0.0, 0.0, 0.0)));
  scan.origins = {{std::nanf(""), 0.0F, 0.0F}};
  const auto result = insert_scan(scan.ends(), scan.starts(), {}, workspace, tree);
  EXPECT_EQ(result.non_finite, 1U);
  EXPECT_EQ(tree.getNumLeafNodes(), 1U);
}

TEST(InsertScan, OriginsOutOfRangeOccupyButFreeNothing) {
  InsertionWorkspace workspace;
  OctreeScan scan;
  scan.origins = {{4000.0F, 0.0F, 0.0F}};
  scan.push_back(1.0F, 1.0F, 1.0F);
  OcTree own(0.1), reference(0.1);
  insert_scan(scan.ends(), scan.starts(), {}, workspace, own);
  test::insert_by_octomap(scan, {}, reference);
  EXPECT_TRUE(test::same_tree(own, reference));
  EXPECT_EQ(own.getNumLeafNodes(), 1U);
}

TEST(InsertScan, RaysAlongTheEdgeOfTheRange) {
  // Near the last key, a ray that misses its end cell by rounding must not leave the range.
  RandomGenerator random(7);
  InsertionWorkspace workspace;
  const double edge = 0.1 * 32768;
  for (int round = 0; round < 200; ++round) {
    OctreeScan scan;
    scan.origins[0] = {static_cast<float>(edge - random.uniform()), 1.0F, 1.0F};
    for (int k = 0; k < 20; ++k) {
      scan.push_back(static_cast<float>(edge - 0.2 * random.uniform()),
                     static_cast<float>(1.0 + random.uniform()), 1.0F);
    }
    OcTree own(0.1), reference(0.1);
    insert_scan(scan.ends(), scan.starts(), {}, workspace, own);
    test::insert_by_octomap(scan, {}, reference);
    ASSERT_TRUE(test::same_tree(own, reference)) << round;
  }
}

/// Cells that are occupied in one tree and free in the other.
std::set<CellCode> freed_cells(const OcTree& before, const OcTree& after) {
  std::set<CellCode> cells;
  for (auto leaf = before.begin_leafs(); leaf != before.end_leafs(); ++leaf) {
    if (!before.isNodeOccupied(*leaf)) continue;
    const auto low = leaf.getIndexKey();
    const int size = 1 << (16 - static_cast<int>(leaf.getDepth()));
    for (int k = 0; k < size * size * size; ++k) {
      const CellKey key = {static_cast<std::uint16_t>(low[0] + k % size),
                           static_cast<std::uint16_t>(low[1] + k / size % size),
                           static_cast<std::uint16_t>(low[2] + k / size / size)};
      const auto* node = after.search(octomap::OcTreeKey(key[0], key[1], key[2]));
      if (!after.isNodeOccupied(node)) cells.insert(code_of(key));
    }
  }
  return cells;
}

TEST(InsertScan, OracleFreedCellsAreThoseThatWereOccupiedBefore) {
  InsertionWorkspace workspace;
  std::size_t total = 0;
  for (std::uint32_t seed = 0; seed < kFuzzTrees / 8; ++seed) {
    RandomGenerator random(seed, 3);
    OcTree tree = test::random_tree(random);
    for (int k = 0; k < 4; ++k) {
      const OctreeScan scan = test::random_scan(random, tree.getResolution(), 2);
      const OcTree before(tree);
      std::vector<FreedCube> freed;
      insert_scan(scan.ends(), scan.starts(), {}, workspace, tree, &freed);
      std::set<CellCode> reported;
      for (const FreedCube& cube : freed) {
        for (int n = 0; n < cube.cells * cube.cells * cube.cells; ++n) {
          const CellKey key = {
              static_cast<std::uint16_t>(cube.key[0] + n % cube.cells),
              static_cast<std::uint16_t>(cube.key[1] + n / cube.cells % cube.cells),
              static_cast<std::uint16_t>(cube.key[2] + n / cube.cells / cube.cells)};
          EXPECT_TRUE(reported.insert(code_of(key)).second);
        }
      }
      ASSERT_EQ(reported, freed_cells(before, tree)) << "seed " << seed << ", scan " << k;
      total += reported.size();
    }
  }
  EXPECT_GT(total, 10U);
}

TEST(InsertScan, AnObjectThatLeavesIsReportedAsFreed) {
  InsertionWorkspace workspace;
  OcTree tree(0.1);
  OctreeScan seen, gone;
  seen.push_back(1.05F, 0.05F, 0.05F);
  gone.push_back(2.05F, 0.05F, 0.05F);
  gone.origins = seen.origins = {{0.05F, 0.05F, 0.05F}};
  std::vector<FreedCube> freed;
  insert_scan(seen.ends(), seen.starts(), {}, workspace, tree, &freed);
  EXPECT_TRUE(freed.empty());
  std::size_t scans = 0;
  while (freed.empty() && ++scans < 10) {
    insert_scan(gone.ends(), gone.starts(), {}, workspace, tree, &freed);
  }
  EXPECT_EQ(scans, 3U);  // hit +0.85, miss -0.41 each
  ASSERT_EQ(freed.size(), 1U);
  EXPECT_EQ(freed[0].key, (std::array<std::uint16_t, 3>{32768 + 10, 32768, 32768}));
  EXPECT_EQ(freed[0].cells, 1U);
}

// --- Guarded cells -------------------------------------------------------------------------------

/// A scan of one ray in a row of cells of 0.1 m: from the first cell of a layer to another place.
OctreeScan ray(std::array<float, 3> from, std::array<float, 3> to) {
  OctreeScan scan;
  scan.origins = {from};
  scan.push_back(to[0], to[1], to[2]);
  return scan;
}

/// Column x = 10 cells, y = 0: ground in layer 0, gone if the two layers below are free.
const std::vector<GuardedCells> kGround = {{32768 + 10, 32768, 32768, 32768, 32768 - 2}};

TEST(GuardedCells, LiteralAGrazingRayFreesThemNot) {
  InsertionWorkspace workspace;
  const OctreeScan ground = ray({0.05F, 0.05F, 0.55F}, {1.05F, 0.05F, 0.05F});
  const OctreeScan grazing = ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  for (const bool guarded : {false, true}) {
    OcTree tree(0.1);
    insert_scan(ground.ends(), ground.starts(), {}, workspace, tree);
    const InsertionOptions options{-1.0, false, guarded ? &kGround : nullptr};
    for (int k = 0; k < 10; ++k) {
      const auto result = insert_scan(grazing.ends(), grazing.starts(), options, workspace, tree);
      EXPECT_EQ(result.kept, guarded ? 1U : 0U);
    }
    EXPECT_EQ(tree.isNodeOccupied(tree.search(1.05, 0.05, 0.05)), guarded);
    EXPECT_FALSE(tree.isNodeOccupied(tree.search(0.95, 0.05, 0.05))) << "beside it";
    EXPECT_TRUE(tree.isNodeOccupied(tree.search(2.05, 0.05, 0.05)));
  }
}

TEST(GuardedCells, LiteralASurfaceThatIsGoneIsFreed) {
  InsertionWorkspace workspace;
  OcTree tree(0.1);
  const OctreeScan ground = ray({0.05F, 0.05F, 0.55F}, {1.05F, 0.05F, 0.05F});
  insert_scan(ground.ends(), ground.starts(), {}, workspace, tree);
  const InsertionOptions options{-1.0, false, &kGround};
  const OctreeScan into_the_pit = ray({1.05F, 0.05F, 0.55F}, {1.05F, 0.05F, -0.45F});
  const OctreeScan not_so_deep = ray({1.05F, 0.05F, 0.55F}, {1.05F, 0.05F, -0.15F});
  for (int k = 0; k < 5; ++k) {
    insert_scan(not_so_deep.ends(), not_so_deep.starts(), options, workspace, tree);
  }
  EXPECT_TRUE(tree.isNodeOccupied(tree.search(1.05, 0.05, 0.05))) << "layer -2 was never free";
  FreeCells known;
  known.assign(tree);
  std::vector<FreedCube> freed;
  for (int k = 0; k < 5; ++k) {
    insert_scan(into_the_pit.ends(), into_the_pit.starts(), options, workspace, tree, &freed,
                &known);
  }
  EXPECT_FALSE(tree.isNodeOccupied(tree.search(1.05, 0.05, 0.05)));
}

TEST(GuardedCells, AHitForgetsWhatGrazingRaysDidBefore) {
  InsertionWorkspace workspace;
  const OctreeScan ground = ray({0.05F, 0.05F, 0.55F}, {1.05F, 0.05F, 0.05F});
  const OctreeScan grazing = ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  for (const bool told : {false, true}) {
    OcTree tree(0.1);
    FreeCells free;
    FreeCells* const given = told ? &free : nullptr;
    for (int k = 0; k < 5; ++k) {
      insert_scan(grazing.ends(), grazing.starts(), {}, workspace, tree, nullptr, given);
    }
    ASSERT_FALSE(tree.isNodeOccupied(tree.search(1.05, 0.05, 0.05)));
    const InsertionOptions options{-1.0, false, &kGround};
    insert_scan(ground.ends(), ground.starts(), options, workspace, tree, nullptr, given);
    EXPECT_EQ(tree.search(1.05, 0.05, 0.05)->getLogOdds(), tree.getProbHitLog());
    EXPECT_LT(tree.search(0.95, 0.05, 0.05)->getLogOdds(), 0.0F) << "beside it";
    EXPECT_EQ(free.column(32768 + 10, 32768, 32768) & 1, 0U);
  }
}

TEST(GuardedCells, WhatIsKnownToBeFreeBelowCounts) {
  InsertionWorkspace workspace;
  OcTree tree(0.1);
  const OctreeScan below = ray({1.05F, 0.05F, -0.05F}, {1.05F, 0.05F, -0.45F});
  const OctreeScan ground = ray({0.05F, 0.05F, 0.55F}, {1.05F, 0.05F, 0.05F});
  const OctreeScan grazing = ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  FreeCells known;
  for (const OctreeScan& scan : {below, ground}) {
    insert_scan(scan.ends(), scan.starts(), {}, workspace, tree, nullptr, &known);
  }
  const InsertionOptions options{-1.0, false, &kGround};
  insert_scan(grazing.ends(), grazing.starts(), options, workspace, tree, nullptr, &known);
  const float after_one_miss = tree.search(1.05, 0.05, 0.05)->getLogOdds();
  EXPECT_LT(after_one_miss, tree.getProbHitLog());
  insert_scan(grazing.ends(), grazing.starts(), options, workspace, tree);
  EXPECT_EQ(tree.search(1.05, 0.05, 0.05)->getLogOdds(), after_one_miss) << "not told: guarded";
}

std::vector<GuardedCells> random_guards(RandomGenerator& random) {
  std::vector<GuardedCells> guards;
  const auto key = [&random](int low, std::uint32_t range) {
    return static_cast<std::uint16_t>(32768 + low + static_cast<int>(random.below(range)));
  };
  for (std::uint32_t n = random.below(300); n > 0; --n) {
    const std::uint16_t low = key(-8, 16);
    guards.push_back({key(-12, 24), key(-12, 24), low,
                      static_cast<std::uint16_t>(low + random.below(3)),
                      static_cast<std::uint16_t>(low - random.below(3))});
  }
  return guards;
}

// OctoMap's own sets of cells, less what is guarded.
TEST(GuardedCells, OracleFuzzGivesTheTreesOfOctomapsOwnUpdates) {
  InsertionWorkspace workspace;
  std::size_t kept = 0;
  for (std::uint32_t seed = 0; seed < kFuzzTrees / 2; ++seed) {
    RandomGenerator random(seed, 9);
    OcTree own = test::random_tree(random);
    OcTree reference(own);
    FreeCells known, known_before;
    known.assign(own);
    for (int k = 0; k < 4; ++k) {
      const OctreeScan scan = test::random_scan(random, own.getResolution(), 1 + random.below(3));
      InsertionOptions options = test::random_options(random, own.getResolution());
      const std::vector<GuardedCells> guards = random_guards(random);
      options.guarded = &guards;
      known_before.clear();
      known_before.assign(reference);
      const auto result =
          insert_scan(scan.ends(), scan.starts(), options, workspace, own, nullptr, &known);
      const test::QuietOctomap quiet;
      const auto expected =
          insert_with_octomap(scan.ends(), scan.starts(), options, reference, &known_before);
      EXPECT_EQ(result.kept, expected.kept);
      FreeCells now;
      now.assign(own);
      for (const GuardedCells& at : guards) {
        ASSERT_EQ(known.column(at.x, at.y, at.low), now.column(at.x, at.y, at.low));
      }
      ASSERT_TRUE(test::same_tree(own, reference)) << "seed " << seed << ", scan " << k;
      kept += result.kept;
    }
  }
  EXPECT_GT(kept, 100U);
}

}  // namespace
}  // namespace mrpt_terrain::octree
