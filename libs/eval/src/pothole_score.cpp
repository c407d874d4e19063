// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/pothole_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

namespace mrpt_terrain::eval {
namespace {

std::size_t hole_bin(double distance) {
  return static_cast<std::size_t>(std::upper_bound(kHoleEdges.begin(), kHoleEdges.end(), distance) -
                                  kHoleEdges.begin());
}

Eigen::Vector2d map_place(const Eigen::Isometry3d& T_map_given, Position2 at, double z) {
  return (T_map_given * Eigen::Vector3d(at.x, at.y, z)).head<2>();
}

/// Middles of the observed cells of a thing; the middle of its rectangle if it has none.
std::vector<Eigen::Vector2d> places_of(const Description& description, std::size_t thing,
                                       const Eigen::Isometry3d& T_map_given) {
  std::vector<Eigen::Vector2d> places;
  for (const std::int32_t slot : description.clusters.slots.row(thing)) {
    const auto s = static_cast<std::size_t>(slot);
    const ElevationGrid& grid = description.grid;
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[s]));
    places.push_back(map_place(T_map_given, centre, static_cast<double>(grid.h_mean[s])));
  }
  if (!places.empty()) return places;
  const ClusterDescription& is = description.things[thing];
  const Position2 middle{0.5 * (is.min_corner.x + is.max_corner.x),
                         0.5 * (is.min_corner.y + is.max_corner.y)};
  return {map_place(T_map_given, middle, static_cast<double>(is.h_min))};
}

/// Whether enough of a pothole lies at a hole and some of it in the hole itself.
bool is_at(const std::vector<Eigen::Vector2d>& places, const Footprint& hole,
           const PotholeRules& rules) {
  std::size_t near = 0;
  bool inside = false;
  for (const Eigen::Vector2d& place : places) {
    near += hole.contains(place, rules.grown) ? 1U : 0U;
    inside = inside || hole.contains(place);
  }
  return inside &&
         static_cast<double>(near) >= rules.least_inside * static_cast<double>(places.size());
}

bool is_false(const std::vector<Eigen::Vector2d>& places, const ScanTruth& truth,
              const PotholeRules& rules) {
  std::size_t near = 0;
  for (const Eigen::Vector2d& place : places) {
    const bool at_hole =
        std::any_of(truth.things.begin(), truth.things.end(), [&](const TrueThing& thing) {
          return thing.depth > 0.0 && thing.footprint.contains(place, rules.grown);
        });
    near += at_hole ? 1U : 0U;
  }
  return static_cast<double>(near) < rules.least_inside * static_cast<double>(places.size());
}

/// Counts the returns of every hole; entries of things that are none stay empty.
std::vector<HoleView> count_returns(const PointsView& points, const ScanTruth& truth) {
  std::vector<HoleView> views(truth.things.size());
  std::vector<std::vector<std::int32_t>> rings(truth.things.size());
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto t = static_cast<std::size_t>(truth.thing[i]);
    if (truth.things[t].depth <= 0.0) continue;
    views[t].thing = truth.thing[i];
    ++views[t].returns;
    if (static_cast<double>(truth.below_rim[i]) <= 0.5 * truth.things[t].depth) continue;
    ++views[t].deep;
    const std::int32_t ring = truth.ring[i];
    if (std::find(rings[t].begin(), rings[t].end(), ring) == rings[t].end()) {
      rings[t].push_back(ring);
    }
  }
  for (std::size_t t = 0; t < views.size(); ++t) views[t].rings = rings[t].size();
  return views;
}

void judge(const ScanTruth& truth, const PotholePlaces& potholes, const PotholeRules& rules,
           HoleView& view) {
  const TrueThing& hole = truth.things[static_cast<std::size_t>(view.thing)];
  const Eigen::Vector3d robot = truth.T_map_given.translation();
  view.distance = (hole.footprint.centre - robot.head<2>()).norm();
  view.right_size = is_right_size(hole, rules);
  const double sigma = truth.range_sigma + truth.range_growth * view.distance;
  view.due = view.right_size && view.deep >= rules.deep_returns && view.rings >= rules.rings &&
             hole.depth >= rules.depth_in_sigmas * sigma;
  view.found = is_found(hole, potholes, rules);
}

/// Per described thing, how many points come from each type of truth.
using TypeCounts = std::map<std::string, std::size_t>;

std::string most_frequent(const TypeCounts& counts) {
  std::string type = "nothing";
  std::size_t most = 0;
  for (const auto& [name, count] : counts) {
    if (count > most) type = name;
    most = std::max(most, count);
  }
  return type;
}

FalsePothole false_pothole(const ClusterDescription& thing,
                           const std::vector<Eigen::Vector2d>& places, const ScanTruth& truth) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& place : places) middle += place / static_cast<double>(places.size());
  FalsePothole result;
  result.x = middle.x();
  result.y = middle.y();
  result.distance = (middle - truth.T_map_given.translation().head<2>()).norm();
  result.cells = thing.cells;
  result.points = thing.points;
  result.h_min = static_cast<double>(thing.h_min);
  result.h_max = static_cast<double>(thing.h_max);
  return result;
}

}  // namespace

bool is_right_size(const TrueThing& hole, const PotholeRules& rules) {
  // The ranges are closed; decimal fractions are not exact.
  constexpr double kRounding = 1e-9;
  const double width = std::min(hole.footprint.length, hole.footprint.width);
  return width >= rules.width_min - kRounding && width <= rules.width_max + kRounding &&
         hole.depth >= rules.depth_min - kRounding && hole.depth <= rules.depth_max + kRounding;
}

bool is_found(const TrueThing& hole, const PotholePlaces& potholes, const PotholeRules& rules) {
  return std::any_of(potholes.places.begin(), potholes.places.end(), [&](const auto& places) {
    return !places.empty() && is_at(places, hole.footprint, rules);
  });
}

PotholePlaces places_of_potholes(const Description& description,
                                 const Eigen::Isometry3d& T_map_given) {
  PotholePlaces potholes;
  potholes.places.resize(description.things.size());
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    if (description.things[k].terrain_class != TerrainClass::kPothole) continue;
    potholes.places[k] = places_of(description, k, T_map_given);
  }
  return potholes;
}

std::vector<HoleView> look_at_holes(const PointsView& points, const ScanTruth& truth,
                                    const PotholePlaces& potholes, const PotholeRules& rules) {
  std::vector<HoleView> views = count_returns(points, truth);
  views.erase(std::remove_if(views.begin(), views.end(),
                             [](const HoleView& view) { return view.thing == kNoThing; }),
              views.end());
  for (HoleView& view : views) judge(truth, potholes, rules, view);
  return views;
}

std::vector<FalsePothole> false_potholes(const Description& description, const ScanTruth& truth,
                                         const PotholePlaces& potholes, const PotholeRules& rules) {
  std::vector<FalsePothole> result;
  std::vector<std::size_t> number(description.things.size(), description.things.size());
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    if (potholes.places[k].empty() || !is_false(potholes.places[k], truth, rules)) continue;
    number[k] = result.size();
    result.push_back(false_pothole(description.things[k], potholes.places[k], truth));
  }
  if (result.empty()) return result;
  std::vector<TypeCounts> types(result.size());
  for (std::size_t i = 0; i < truth.thing.size(); ++i) {
    const std::int32_t cluster = description.labels.cluster[i];
    if (cluster == kNoCluster) continue;
    const std::size_t n = number[static_cast<std::size_t>(cluster)];
    if (n < types.size()) ++types[n][truth.things[static_cast<std::size_t>(truth.thing[i])].type];
  }
  for (std::size_t n = 0; n < result.size(); ++n) result[n].at = most_frequent(types[n]);
  return result;
}

double observed_ground(const PointsView& points, const ScanTruth& truth,
                       const std::vector<UnknownReason>& reasons) {
  std::vector<std::int64_t> cells;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (truth.support[i] != Support::kGround || reasons[i] == UnknownReason::kOutsideMap) continue;
    const auto l =
        static_cast<std::int64_t>(std::floor(static_cast<double>(points.x[i]) / kAreaCell));
    const auto w =
        static_cast<std::int64_t>(std::floor(static_cast<double>(points.y[i]) / kAreaCell));
    cells.push_back(l * (std::int64_t{1} << 32) + w);
  }
  std::sort(cells.begin(), cells.end());
  const auto end = std::unique(cells.begin(), cells.end());
  return static_cast<double>(end - cells.begin()) * kAreaCell * kAreaCell;
}

void add_holes(const std::vector<HoleView>& holes, const PotholeRules& rules, PotholeScore& score) {
  for (const HoleView& hole : holes) {
    const std::size_t bin = hole_bin(hole.distance);
    if (!hole.right_size) {
      if (hole.deep >= rules.deep_returns && hole.rings >= rules.rings) {
        score.found_other.count(hole.found);
      }
      continue;
    }
    score.found_small.count(hole.found);
    score.small_at[bin].count(hole.found);
    if (!hole.due) continue;
    score.found.count(hole.found);
    score.due_at[bin].count(hole.found);
  }
}

void PotholeScore::add(const PotholeScore& other) {
  found.add(other.found);
  found_small.add(other.found_small);
  found_other.add(other.found_other);
  for (std::size_t k = 0; k < kHoleBins; ++k) {
    due_at[k].add(other.due_at[k]);
    small_at[k].add(other.small_at[k]);
  }
  ground += other.ground;
  wrong.insert(wrong.end(), other.wrong.begin(), other.wrong.end());
  ahead.add(other.ahead);
}

double PotholeScore::wrong_per_1000() const {
  if (ground <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  return 1000.0 * static_cast<double>(wrong.size()) / ground;
}

}  // namespace mrpt_terrain::eval
