// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/gap_score.h"

#include <algorithm>

namespace mrpt_terrain::eval {
namespace {

bool is_right(const Eigen::Vector2d& place, const ScanTruth& truth, const GapRules& rules) {
  const bool inside = (place.array() > truth.ground_low.array() + rules.edge).all() &&
                      (place.array() < truth.ground_high.array() - rules.edge).all();
  if (!inside) return true;
  return std::any_of(truth.things.begin(), truth.things.end(), [&](const TrueThing& thing) {
    return thing.depth > 0.0 && thing.footprint.contains(place, rules.grown);
  });
}

Eigen::Vector2d map_place(const Eigen::Isometry3d& T_map_description, Position2 at) {
  return (T_map_description * Eigen::Vector3d(at.x, at.y, 0.0)).head<2>();
}

FalseGap false_gap(const HoleDescription& hole, const ScanTruth& truth,
                   const Eigen::Isometry3d& T_map_description) {
  FalseGap result;
  const Eigen::Vector2d place = map_place(T_map_description, hole.centre);
  result.kind = hole.kind;
  result.x = place.x();
  result.y = place.y();
  result.distance = (place - truth.T_map_given.translation().head<2>()).norm();
  result.length = hole.length;
  result.width = hole.width;
  result.depth = hole.depth;
  result.confidence = hole.confidence;
  return result;
}

}  // namespace

void GapScore::add(const GapScore& other) {
  for (std::size_t kind = 0; kind < described.size(); ++kind)
    described[kind] += other.described[kind];
  wrong.insert(wrong.end(), other.wrong.begin(), other.wrong.end());
}

GapScore judge_gaps(const Description& description, const ScanTruth& truth,
                    const Eigen::Isometry3d& T_map_description, const GapRules& rules) {
  GapScore score;
  const GridGeometry& geometry = description.grid.geometry;
  for (std::size_t k = 0; k < description.holes.size(); ++k) {
    const HoleDescription& hole = description.holes[k];
    if (hole.kind == HoleKind::kFloor) continue;
    ++score.described[static_cast<std::size_t>(hole.kind)];
    std::size_t all = 0, right = 0;
    for (const std::int32_t cell : description.hole_cells.row(k)) {
      const Position2 centre = geometry.centre_of(geometry.index_of(CellId{cell}));
      ++all;
      right += is_right(map_place(T_map_description, centre), truth, rules) ? 1U : 0U;
    }
    if (static_cast<double>(right) < rules.least_inside * static_cast<double>(all) || all == 0)
      score.wrong.push_back(false_gap(hole, truth, T_map_description));
  }
  return score;
}

}  // namespace mrpt_terrain::eval
