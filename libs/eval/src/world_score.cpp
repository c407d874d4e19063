// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/world_score.h"

#include <algorithm>
#include <chrono>

namespace mrpt_terrain::eval {
namespace {

/// Memory of one world's scans.
struct Scratch {
  ScanWorkspace workspace;
  TestScan scan;
  Description description;
};

void score_scan(const WorldTask& task, const DrivenWorld& world, std::size_t sweep,
                Scratch& scratch, WorldScore& score) {
  take_scan(world, sweep, task.options, scratch.workspace, scratch.scan);
  const TestScan& scan = scratch.scan;
  const Description& description = scratch.description;
  const auto start = std::chrono::steady_clock::now();
  task.describe(scan.view(), scratch.description);
  score.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ++score.scans;
  score.points += scan.points.size();

  const PointsView points = scan.points.view();
  add_support(points, scan.truth, description.labels.support, score.support);
  const ClusterMatching matching = match_clusters(points, scan.truth, description.labels,
                                                  description.things, task.rules.clusters);
  add_clusters(matching, scan.truth, description.things, score.clusters);
  add_slopes(matching, scan.truth, description.labels, description.things, score.slopes);

  const PotholeRules& rules = task.rules.potholes;
  const PotholePlaces potholes = places_of_potholes(description, scan.truth.T_map_given);
  add_holes(look_at_holes(points, scan.truth, potholes, rules), rules, score.potholes);
  score.potholes.ground += observed_ground(points, scan.truth, description.labels.reason);
  for (FalsePothole& wrong : false_potholes(description, scan.truth, potholes, rules)) {
    wrong.family = world.family;
    wrong.seed = world.seed;
    wrong.sweep = sweep;
    score.potholes.wrong.push_back(std::move(wrong));
  }
  GapScore gaps = judge_gaps(description, scan.truth, task.rules.gaps);
  for (FalseGap& wrong : gaps.wrong) {
    wrong.family = world.family;
    wrong.seed = world.seed;
    wrong.sweep = sweep;
  }
  score.gaps.add(gaps);
  if (task.list_things) {
    for (ThingRecord& record :
         list_things(points, scan.truth, description.labels, description.things, matching)) {
      record.family = world.family;
      record.seed = world.seed;
      record.sweep = sweep;
      score.things.push_back(std::move(record));
    }
  }
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
