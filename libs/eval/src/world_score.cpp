// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/world_score.h"

#include <algorithm>
#include <chrono>

#include "description_score.h"

namespace mrpt_terrain::eval {
namespace {

/// Memory of one world's scans.
struct Scratch {
  ScanWorkspace workspace;
  TestScan scan;
  Description description;
  CellCosts costs;
};

// Cells that persons walk through: no truth of what stays tells their costs.
void leave_out_persons(const TestScan& scan, const GridGeometry& geometry,
                       std::vector<TrueCell>& kinds) {
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.truth.things[static_cast<std::size_t>(scan.truth.thing[i])].type != "person") continue;
    CellIndex cell;
    const auto x = static_cast<double>(scan.points.x[i]), y = static_cast<double>(scan.points.y[i]);
    if (!geometry.cell_at(x, y, cell)) continue;
    kinds[static_cast<std::size_t>(cell.l * geometry.cells_w() + cell.w)] = TrueCell::kNotCounted;
  }
}

void score_costs(const WorldTask& task, const DrivenWorld& world, Scratch& scratch,
                 WorldScore& score) {
  const TestScan& scan = scratch.scan;
  const CostRules& rules = task.rules.costs;
  const ElevationGrid& grid = scratch.description.grid;
  const double clear = rules.robot.height + rules.robot.overhead_reserve;
  task.costs(scan.view(), scratch.description, scratch.costs);
  const GridGeometry middle = middle_of(grid.geometry, rules.radius);
  const sim::CellTruth truth =
      sim::truth_of_cells(*world.caster, scan.truth.T_map_given, middle, clear);
  std::vector<TrueCell> kinds =
      true_cells(truth, scan.truth.things, scan.truth.T_map_given, rules.robot);
  leave_out_persons(scan, middle, kinds);
  add_costs(grid, scratch.costs, middle, kinds, rules.robot, score.costs);
}

void score_scan(const WorldTask& task, const DrivenWorld& world, std::size_t sweep,
                Scratch& scratch, WorldScore& score) {
  take_scan(world, sweep, task.options, scratch.workspace, scratch.scan);
  const TestScan& scan = scratch.scan;
  const Description& description = scratch.description;
  const auto start = std::chrono::steady_clock::now();
  task.describe(scan.view(), scratch.description);
  score.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const PointsView points = scan.points.view();
  const ClusterMatching matching =
      add_description({world, sweep, scan, description, scan.truth.T_map_given}, task.rules, score);
  if (task.list_things) {
    for (ThingRecord& record :
         list_things(points, scan.truth, description.labels, description.things, matching)) {
      record.family = world.family;
      record.seed = world.seed;
      record.sweep = sweep;
      score.things.push_back(std::move(record));
    }
  }
  if (task.costs) score_costs(task, world, scratch, score);
  if (task.listener) task.listener({world, sweep, scan, description, matching});
}

bool is_found(const WorldTask& task, const DrivenWorld& world, const HoleAhead& hole,
              std::size_t sweep, Scratch& scratch) {
  take_scan(world, sweep, task.options, scratch.workspace, scratch.scan);
  task.describe(scratch.scan.view(), scratch.description);
  const ScanTruth& truth = scratch.scan.truth;
  const PotholePlaces potholes = places_of_potholes(scratch.description, truth.T_map_given);
  const std::vector<HoleView> views =
      look_at_holes(scratch.scan.points.view(), truth, potholes, task.rules.potholes);
  return std::any_of(views.begin(), views.end(), [&hole](const HoleView& view) {
    return view.thing == hole.thing && view.found;
  });
}

void score_approach(const WorldTask& task, const DrivenWorld& world, Scratch& scratch,
                    WorldScore& score) {
  for (const HoleAhead& hole : holes_ahead(world, task.rules.approach)) {
    if (!is_right_size(world.things[static_cast<std::size_t>(hole.thing)], task.rules.potholes)) {
      continue;
    }
    score.potholes.ahead.count(std::any_of(
        hole.sweeps.begin(), hole.sweeps.end(),
        [&](std::size_t sweep) { return is_found(task, world, hole, sweep, scratch); }));
  }
}

// Describes consecutive scans about the middle of the drive and follows their things in the map.
void score_identities(const WorldTask& task, const DrivenWorld& world, Scratch& scratch,
                      WorldScore& score) {
  const std::size_t n = std::min(task.follow, world.sweeps);
  ThingTracker tracker(task.tracking);
  IdentityHistory history;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t sweep = (world.sweeps - n) / 2 + k;
    take_scan(world, sweep, task.options, scratch.workspace, scratch.scan);
    task.describe(scratch.scan.view(), scratch.description);
    const Description& description = scratch.description;
    history.add_scan(
        match_clusters(scratch.scan.points.view(), scratch.scan.truth, description.labels,
                       description.things, task.rules.clusters),
        tracker.update(description.things, scratch.scan.truth.T_map_given, world.start_of(sweep)));
  }
  score.identities = history.score();
}

}  // namespace

ClusterMatching add_description(const JudgedDescription& judged, const ScoreRules& rules,
                                WorldScore& score) {
  const auto& [world, sweep, scan, description, T_map_description] = judged;
  ++score.scans;
  score.points += scan.points.size();
  const PointsView points = scan.points.view();
  add_support(points, scan.truth, description.labels.support, score.support);
  ClusterMatching matching =
      match_clusters(points, scan.truth, description.labels, description.things, rules.clusters);
  add_clusters(matching, scan.truth, description.things, score.clusters);
  add_slopes(matching, scan.truth, description.labels, description.things, score.slopes);
  const PotholePlaces potholes = places_of_potholes(description, T_map_description);
  add_holes(look_at_holes(points, scan.truth, potholes, rules.potholes), rules.potholes,
            score.potholes);
  score.potholes.ground += observed_ground(points, scan.truth, description.labels.reason);
  for (FalsePothole& wrong : false_potholes(description, scan.truth, potholes, rules.potholes)) {
    wrong.family = world.family;
    wrong.seed = world.seed;
    wrong.sweep = sweep;
    score.potholes.wrong.push_back(std::move(wrong));
  }
  GapScore gaps = judge_gaps(description, scan.truth, T_map_description, rules.gaps);
  for (FalseGap& wrong : gaps.wrong) {
    wrong.family = world.family;
    wrong.seed = world.seed;
    wrong.sweep = sweep;
  }
  score.gaps.add(gaps);
  return matching;
}

void WorldScore::add(const WorldScore& other) {
  worlds += other.worlds;
  scans += other.scans;
  points += other.points;
  seconds += other.seconds;
  support.add(other.support);
  clusters.add(other.clusters);
  slopes.add(other.slopes);
  potholes.add(other.potholes);
  gaps.add(other.gaps);
  identities.add(other.identities);
  costs.add(other.costs);
  things.insert(things.end(), other.things.begin(), other.things.end());
}

WorldScore score_world(const WorldTask& task) {
  const auto world = make_driven_world(task.family, task.seed, task.options);
  Scratch scratch;
  WorldScore score;
  score.worlds = 1;
  for (const std::size_t sweep : spread_sweeps(world->sweeps, task.scans)) {
    score_scan(task, *world, sweep, scratch, score);
  }
  if (task.approach) score_approach(task, *world, scratch, score);
  if (task.follow > 0) score_identities(task, *world, scratch, score);
  return score;
}

}  // namespace mrpt_terrain::eval
