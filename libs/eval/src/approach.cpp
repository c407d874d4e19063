// SPDX-License-Identifier: BSD-3-Clause
// Which sweeps see a hole before the wheels reach it.
#include <algorithm>
#include <cmath>

#include "mrpt_terrain/eval/world_scans.h"

namespace mrpt_terrain::eval {
namespace {

constexpr double kStep = 0.02;    // seconds between the places that are looked at
constexpr int kPlacesOnAxle = 9;  // between the front wheels, both included

/// Way driven at times that are multiples of a step.
struct Way {
  std::vector<double> metres;
  std::vector<Eigen::Isometry3d> poses;
  [[nodiscard]] double at(double time) const {
    const auto k = static_cast<std::size_t>(std::max(0.0, time / kStep));
    return metres[std::min(k, metres.size() - 1)];
  }
};

Way way_of(const sim::Motion& motion) {
  Way way;
  for (std::size_t k = 0; static_cast<double>(k) * kStep <= motion.end() + kStep; ++k) {
    way.poses.push_back(motion.at(static_cast<double>(k) * kStep));
    const double moved =
        k == 0 ? 0.0
               : (way.poses[k].translation() - way.poses[k - 1].translation()).head<2>().norm();
    way.metres.push_back(k == 0 ? 0.0 : way.metres.back() + moved);
  }
  return way;
}

bool is_under_axle(const Footprint& hole, const Eigen::Isometry3d& T_map_robot,
                   const sim::VehicleParams& vehicle) {
  for (int n = 0; n < kPlacesOnAxle; ++n) {
    const double y = vehicle.track * (static_cast<double>(n) / (kPlacesOnAxle - 1) - 0.5);
    const Eigen::Vector3d place = T_map_robot * Eigen::Vector3d(0.5 * vehicle.wheelbase, y, 0.0);
    if (hole.contains(place.head<2>())) return true;
  }
  return false;
}

/// Way at which the front axle reaches a hole; negative: never.
double way_to(const Footprint& hole, const Way& way, const sim::VehicleParams& vehicle) {
  for (std::size_t k = 0; k < way.poses.size(); ++k) {
    if (is_under_axle(hole, way.poses[k], vehicle)) return way.metres[k];
  }
  return -1.0;
}

/// Sweeps that end while the hole is between `in_time` and `farthest` ahead, the last one first.
std::vector<std::size_t> sweeps_before(const DrivenWorld& world, const Way& way, double reached,
                                       const ApproachRules& rules) {
  std::vector<std::size_t> all;
  for (std::size_t k = world.sweeps; k-- > 0;) {
    const double ahead = reached - way.at(world.start_of(k) + world.sweep_time());
    if (ahead >= rules.in_time && ahead <= rules.farthest) all.push_back(k);
  }
  if (all.size() <= rules.sweeps) return all;
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < rules.sweeps; ++k) some.push_back(all[k * all.size() / rules.sweeps]);
  return some;
}

}  // namespace

std::vector<HoleAhead> holes_ahead(const DrivenWorld& world, const ApproachRules& rules) {
  const Way way = way_of(world.motion);
  std::vector<HoleAhead> result;
  for (std::size_t t = 1; t < world.things.size(); ++t) {
    if (world.things[t].depth <= 0.0) continue;
    const double reached = way_to(world.things[t].footprint, way, world.file.vehicle);
    if (reached < 0.0) continue;
    HoleAhead hole{static_cast<std::int32_t>(t), sweeps_before(world, way, reached, rules)};
    if (!hole.sweeps.empty()) result.push_back(std::move(hole));
  }
  return result;
}

}  // namespace mrpt_terrain::eval
