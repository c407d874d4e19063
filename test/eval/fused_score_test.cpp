// SPDX-License-Identifier: BSD-3-Clause
// Maps that know the truth, nothing, or the wrong against single scans.
#include "mrpt_terrain/eval/fused_score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt_terrain/sim/truth.h"

namespace mrpt_terrain::eval {
namespace {

sim::Family family(const std::string& name) {
  return sim::resolve_family(name, MRPT_TERRAIN_SOURCE_DIR "/params/families");
}

/// Every cell of a square of 20 m about the robot has one support, whatever is there.
void call_all(Support support, Description& description, std::size_t points) {
  clear_grid(GridGeometry(20.0, 20.0, 0.2), description.grid);
  const GridGeometry& geometry = description.grid.geometry;
  for (int l = 0; l < geometry.cells_l(); ++l) {
    for (int w = 0; w < geometry.cells_w(); ++w) {
      const CellId id = geometry.id_of({l, w});
      description.grid.slot_of[static_cast<std::size_t>(value_of(id))] =
          static_cast<Slot>(description.grid.cell.size());
      description.grid.cell.push_back(id);
    }
  }
  const std::size_t n = description.grid.cell.size();
  description.cells.support.assign(n, support);
  description.clusters = Clusters{};
  description.clusters.slots.first.assign(1, 0);
  description.clusters.cluster_of.assign(n, kNoCluster);
  description.things.clear();
  description.labels.support.assign(points, support);
  description.labels.reason.assign(points, UnknownReason::kNone);
  description.labels.terrain_class.assign(points, TerrainClass::kNone);
  description.labels.cluster.assign(points, kNoCluster);
}

FusedScore score_of(Support single, Support map, std::size_t* scans = nullptr) {
  ScanOptions options;
  options.sensor_folder = MRPT_TERRAIN_SOURCE_DIR "/params/sensors";
  options.sensor = "vlp16";
  const ScoreRules rules;
  Description of_map;
  const Describe describe = [&](const ScanView& scan, Description& description) {
    call_all(single, description, scan.points.size);
  };
  const InsertScan insert = [&](const TestScan& scan, double, const Eigen::Isometry3d& T) {
    if (scans != nullptr) ++*scans;
    call_all(map, of_map, scan.points.size());
    Eigen::Isometry3d window = Eigen::Isometry3d::Identity();
    window.translation() = T.translation();
    return MapDescription{&of_map, window};
  };
  const sim::Family potholes = family("flat_urban");
  return score_fused_world({potholes, 1, 5, 2, 6.0, options, rules, describe, insert});
}

TEST(FusedScore, CountsCellsOfTheScanAndOfTheMap) {
  std::size_t scans = 0;
  const FusedScore score = score_of(Support::kGround, Support::kGround, &scans);
  EXPECT_EQ(scans, 5U);
  EXPECT_EQ(score.insertions, 5.0);
  EXPECT_EQ(score.single.scans, 3U) << "the last one, and every second before";
  const SupportCounts& cells = score.fused_places.cells;
  EXPECT_EQ(cells.missed_ground, 0U);
  EXPECT_EQ(cells.true_obstacle, 0U);
  // 60 x 60 cells, of which hardly any are neither ground nor obstacle.
  EXPECT_GT(cells.true_ground + cells.missed_obstacle, 3U * 3400U);
  EXPECT_LE(cells.true_ground + cells.missed_obstacle, 3U * 3600U);
  EXPECT_EQ(score.single_places.cells.true_ground, cells.true_ground);
  EXPECT_EQ(score.only_in_map.true_ground, 0U);
}

TEST(FusedScore, CellsThatTheScanDoesNotKnowAreTheMapsOwn) {
  const FusedScore score = score_of(Support::kUnknown, Support::kAbove);
  EXPECT_EQ(score.fused_places.cells.missed_ground, 0U);
  EXPECT_EQ(score.only_in_map.true_ground, 0U);
  EXPECT_GT(score.only_in_map.missed_ground, 3U * 2000U);
  EXPECT_GT(score.only_in_map.true_obstacle, 0U);
}

TEST(FusedScore, SumsAdd) {
  FusedScore score = score_of(Support::kGround, Support::kGround);
  const std::size_t ground = score.fused_places.cells.true_ground;
  score.add(score_of(Support::kGround, Support::kGround));
  EXPECT_EQ(score.fused_places.cells.true_ground, 2 * ground);
  EXPECT_EQ(score.insertions, 10.0);
}

}  // namespace
}  // namespace mrpt_terrain::eval
