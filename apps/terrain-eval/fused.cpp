// SPDX-License-Identifier: BSD-3-Clause
// terrain-eval worlds --fused: a terrain map of many scans against the descriptions of single ones.
#include <exception>
#include <memory>

#include "exit_code.h"
#include "mrpt_terrain/eval/fused_score.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "plan.h"
#include "report.h"
#include "report_text.h"
#include "stop_signal.h"

using namespace mrpt_terrain;

namespace {

MapParams map_params(const DescriptionParams& description) {
  MapParams params;
  params.description = description;
  params.creation.fusion = Fusion::kRolling;
  params.creation.octree_resolution = description.grid.cell_size;
  return params;
}

mrpt::poses::CPose3D pose_of(const Eigen::Isometry3d& T) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(i, j) = T.matrix()(i, j);
  }
  return mrpt::poses::CPose3D(matrix);
}

/// The terrain map of one world.
class MapUnderTest {
 public:
  explicit MapUnderTest(const DescriptionParams& description) : map_(map_params(description)) {}

  eval::MapDescription insert(const eval::TestScan& from, double time,
                              const Eigen::Isometry3d& T_map_robot) {
    io::Scan scan;
    scan.stamp = time;
    scan.points = from.points;
    scan.ray_origins = from.ray_origins;
    scan.origin_of = from.origin_of;
    map_.insert_scan(scan, pose_of(T_map_robot));
    snapshot_ = map_.snapshot();
    return {&snapshot_->description, snapshot_->T_map_window};
  }

 private:
  CTerrainMap map_;
  TerrainSnapshotPtr snapshot_;
};

eval::FusedScore score(const Plan& plan, const sim::Family& family, std::uint64_t seed,
                       std::size_t scans) {
  DescriptionWorkspace workspace;
  const eval::Describe describe_one = [&](const ScanView& scan, Description& description) {
    describe(scan, plan.description, workspace, description);
  };
  MapUnderTest map(plan.description);
  const eval::InsertScan insert = [&map](const eval::TestScan& scan, double time,
                                         const Eigen::Isometry3d& T_map_robot) {
    return map.insert(scan, time, T_map_robot);
  };
  eval::FusedTask task{family, seed, scans, 4, 12.0, plan.scans, plan.rules, describe_one, insert};
  return eval::score_fused_world(task);
}

struct NamedFused {
  std::string name;
  eval::FusedScore score;
};

TextTable cells_table(const std::vector<NamedFused>& scores) {
  TextTable table{
      "Cells up to 12 m from the robot, %: single scan, map in the same cells, map where the last "
      "scan sees nothing",
      {},
      {},
      ""};
  table.header = {"",    "IoU", "TPR",   "map IoU",   "map TPR", "cells",
                  "IoU", "TPR", "cells", "obstacles", "ms"};
  for (const auto& [name, score] : scores) {
    const eval::SupportCounts& one = score.single_places.cells;
    const eval::SupportCounts& map = score.fused_places.cells;
    const eval::SupportCounts& more = score.only_in_map;
    const std::size_t obstacles = more.true_obstacle + more.missed_obstacle;
    table.rows.push_back(
        {name, percent(one.iou()), percent(one.obstacle_tpr()), percent(map.iou()),
         percent(map.obstacle_tpr()),
         count(map.true_ground + map.missed_ground + map.true_obstacle + map.missed_obstacle),
         percent(more.iou()), percent(more.obstacle_tpr()),
         count(more.true_ground + more.missed_ground + obstacles), count(obstacles),
         number(1000.0 * score.insert_seconds / score.insertions, 1)});
  }
  return table;
}

TextTable points_table(const std::vector<NamedFused>& scores) {
  TextTable table{"Points of the last scan, %: single scan, map", {}, {}, ""};
  table.header = {""};
  for (const std::string& prefix : {std::string(), std::string("map ")}) {
    for (const char* name : {"IoU", "TPR", "recall", "precision", "split", "merged"})
      table.header.push_back(prefix + name);
  }
  table.header.emplace_back("scans");
  for (const auto& [name, score] : scores) {
    std::vector<std::string> row{name};
    for (const eval::WorldScore* world : {&score.single, &score.fused}) {
      row.push_back(percent(world->support.all.iou()));
      row.push_back(percent(world->support.all.obstacle_tpr()));
      row.push_back(percent(world->clusters.found));
      row.push_back(percent(world->clusters.right));
      row.push_back(percent(world->clusters.split));
      row.push_back(percent(world->clusters.merged));
    }
    row.push_back(count(score.single.scans));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable holes_table(const std::vector<NamedFused>& scores) {
  TextTable table{
      "Potholes: of those within 12 m that some scan so far had to show, those that one scan had "
      "to show, false ones; single scan, map",
      {},
      {},
      ""};
  table.header = {"",        "so far",      "found %", "map found %", "due",
                  "found %", "map found %", "false",   "map false"};
  for (const auto& [name, score] : scores) {
    const eval::PotholeScore& one = score.single.potholes;
    const eval::PotholeScore& map = score.fused.potholes;
    table.rows.push_back({name, count(score.single_places.holes.total),
                          percent(score.single_places.holes), percent(score.fused_places.holes),
                          count(one.found.total), percent(one.found), percent(map.found),
                          count(one.wrong.size()), count(map.wrong.size())});
  }
  return table;
}

}  // namespace

int run_fused_worlds(const WorldsOptions& options) {
  Messages messages(options.common.verbosity);
  try {
    const Plan plan = make_plan(options);
    std::vector<NamedFused> scores;
    NamedFused pooled{"pooled", {}};
    std::size_t done = 0;
    for (const sim::Family& family : plan.families) {
      NamedFused named{family.name, {}};
      for (std::uint64_t seed = plan.seeds.first; seed < plan.seeds.end; ++seed) {
        if (stop_requested()) {
          messages.warn("interrupted; nothing was written");
          return kExitInterrupted;
        }
        named.score.add(score(plan, family, seed, options.fused));
        ++done;
        messages.bar().show(
            static_cast<double>(done) / static_cast<double>(plan.worlds()),
            std::to_string(done) + " of " + std::to_string(plan.worlds()) + " worlds");
      }
      pooled.score.add(named.score);
      scores.push_back(std::move(named));
    }
    messages.bar().clear();
    scores.push_back(std::move(pooled));
    std::string text;
    for (const TextTable& table : {cells_table(scores), points_table(scores), holes_table(scores)})
      text += as_text(table) + "\n";
    messages.info(text);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  return kExitOk;
}
