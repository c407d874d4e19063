// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/fused_score.h"

#include <chrono>
#include <vector>

#include "description_score.h"
#include "mrpt_terrain/sim/truth.h"

namespace mrpt_terrain::eval {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The support of the cell of a description that lies at a place of the map, seen from above.
Support support_at(const MapDescription& map, const Eigen::Vector3d& place) {
  const Eigen::Vector3d local = map.T_map_window.inverse() * place;
  CellIndex cell;
  if (!map.description->grid.geometry.cell_at(local.x(), local.y(), cell)) return Support::kUnknown;
  const Slot slot = map.description->grid.slot_at(cell);
  if (slot == kUnobserved) return Support::kUnknown;
  return map.description->cells.support[static_cast<std::size_t>(slot)];
}

void count(Support truth, Support described, SupportCounts& counts) {
  if (truth == Support::kGround) {
    ++(described == Support::kGround ? counts.true_ground : counts.missed_ground);
  } else {
    ++(described == Support::kGround ? counts.missed_obstacle : counts.true_obstacle);
  }
}

void score_cells(const DrivenWorld& world, const MapDescription& single, const MapDescription& map,
                 double reach, FusedScore& score) {
  const GridGeometry geometry(2.0 * reach, 2.0 * reach, map.description->grid.geometry.cell_size());
  const sim::CellTruth truth = sim::truth_of_cells(*world.caster, map.T_map_window, geometry);
  for (int l = 0; l < geometry.cells_l(); ++l) {
    for (int w = 0; w < geometry.cells_w(); ++w) {
      const auto k = static_cast<std::size_t>(l * geometry.cells_w() + w);
      if (truth.support[k] == Support::kUnknown) continue;
      const Position2 centre = geometry.centre_of({l, w});
      const double height = static_cast<double>(truth.ground_height[k]);
      const Eigen::Vector3d place = map.T_map_window * Eigen::Vector3d(centre.x, centre.y, height);
      const Support of_map = support_at(map, place), of_scan = support_at(single, place);
      if (of_map == Support::kUnknown) continue;
      if (of_scan == Support::kUnknown) {
        count(truth.support[k], of_map, score.only_in_map);
      } else {
        count(truth.support[k], of_map, score.fused_places.cells);
        count(truth.support[k], of_scan, score.single_places.cells);
      }
    }
  }
}

/// Holes that some scan had to show.
class DueHoles {
 public:
  DueHoles(const DrivenWorld& world, const PotholeRules& rules)
      : world_(world), rules_(rules), due_(world.things.size(), 0) {}

  void look(const TestScan& scan) {
    for (const HoleView& view : look_at_holes(scan.points.view(), scan.truth, {}, rules_)) {
      if (view.due) due_[static_cast<std::size_t>(view.thing)] = 1;
    }
  }

  /// Those within reach of the scan.
  void count(const TestScan& scan, const MapDescription& map, double reach, Share& found) const {
    const PotholePlaces potholes = places_of_potholes(*map.description, map.T_map_window);
    for (std::size_t t = 0; t < due_.size(); ++t) {
      if (due_[t] == 0) continue;
      const Eigen::Vector2d& centre = world_.things[t].footprint.centre;
      const Eigen::Vector3d& robot = scan.truth.T_map_given.translation();
      if ((centre - robot.head<2>()).cwiseAbs().maxCoeff() > reach) continue;
      found.count(is_found(world_.things[t], potholes, rules_));
    }
  }

 private:
  const DrivenWorld& world_;
  const PotholeRules& rules_;
  std::vector<std::uint8_t> due_;
};

}  // namespace

void PlaceScore::add(const PlaceScore& other) {
  cells.add(other.cells);
  holes.add(other.holes);
}

void FusedScore::add(const FusedScore& other) {
  single.add(other.single);
  fused.add(other.fused);
  single_places.add(other.single_places);
  fused_places.add(other.fused_places);
  only_in_map.add(other.only_in_map);
  insertions += other.insertions;
  insert_seconds += other.insert_seconds;
}

FusedScore score_fused_world(const FusedTask& task) {
  const auto world = make_driven_world(task.family, task.seed, task.options);
  const std::vector<std::size_t> sweeps = spread_sweeps(world->sweeps, task.scans);
  ScanWorkspace workspace;
  TestScan scan;
  Description description;
  DueHoles holes(*world, task.rules.potholes);
  FusedScore score;
  score.single.worlds = score.fused.worlds = 1;
  for (std::size_t n = 0; n < sweeps.size(); ++n) {
    take_scan(*world, sweeps[n], task.options, workspace, scan);
    const Eigen::Isometry3d& T_map_given = scan.truth.T_map_given;
    const auto start = Clock::now();
    const MapDescription map = task.insert(scan, world->start_of(sweeps[n]), T_map_given);
    score.insert_seconds += seconds_since(start);
    score.insertions += 1.0;
    holes.look(scan);
    if ((sweeps.size() - 1 - n) % task.every != 0) continue;
    const auto single_start = Clock::now();
    task.describe(scan.view(), description);
    score.single.seconds += seconds_since(single_start);
    const MapDescription single{&description, T_map_given};
    (void)add_description({*world, sweeps[n], scan, description, T_map_given}, task.rules,
                          score.single);
    (void)add_description({*world, sweeps[n], scan, *map.description, map.T_map_window}, task.rules,
                          score.fused);
    score_cells(*world, single, map, task.reach, score);
    holes.count(scan, single, task.reach, score.single_places.holes);
    holes.count(scan, map, task.reach, score.fused_places.holes);
  }
  return score;
}

}  // namespace mrpt_terrain::eval
