// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/cost_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mrpt_terrain::eval {
namespace {

// Shares of the limits between which a cell is neither traversable nor lethal for sure.
constexpr double kSurelyLess = 0.5, kSurelySteep = 1.1, kSurelyFlat = 0.8;

std::size_t number_of(const GridGeometry& geometry, CellIndex cell) {
  return static_cast<std::size_t>(cell.l) * static_cast<std::size_t>(geometry.cells_w()) +
         static_cast<std::size_t>(cell.w);
}

/// Truth of one cell and those around it.
class Judge {
 public:
  Judge(const sim::CellTruth& truth, const std::vector<TrueThing>& things,
        const Eigen::Isometry3d& T_map_grid, const RobotParams& robot)
      : truth_(truth), T_map_grid_(T_map_grid), robot_(robot) {
    for (const TrueThing& thing : things) {
      if (thing.depth > 0.0) holes_.push_back(&thing);
    }
  }

  [[nodiscard]] TrueCell kind_of(CellIndex cell) const {
    const std::size_t k = number_of(truth_.geometry, cell);
    if (std::isnan(truth_.max[k]) || std::isnan(truth_.ground_height[k])) {
      return TrueCell::kNotCounted;
    }
    const double limit = std::min(robot_.max_climb, robot_.max_tilt);
    const auto slope = static_cast<double>(truth_.slope[k]);
    const double in_cell = std::tan(slope) * 0.7 * truth_.geometry.cell_size();
    const auto rises = static_cast<double>(truth_.max[k] - truth_.ground_height[k]);
    const bool stands = truth_.support[k] == Support::kAbove;
    if (stands && rises - in_cell > robot_.max_step) return TrueCell::kObstacle;
    const double drop = drop_at(cell);
    if (drop > robot_.max_step) return TrueCell::kHole;
    const double edge = edge_at(cell, slope);
    if (drop == 0.0 && edge > robot_.max_step) return TrueCell::kEdge;
    if (drop == 0.0 && slope > kSurelySteep * limit) return TrueCell::kSteep;
    const bool even = rises < in_cell + kSurelyLess * robot_.max_step &&
                      (drop > 0.0 || edge < kSurelyLess * robot_.max_step) &&
                      slope < kSurelyFlat * limit;
    const bool ground = truth_.support[k] == Support::kGround || drop > 0.0;
    return ground && even ? TrueCell::kTraversable : TrueCell::kNotCounted;
  }

 private:
  // By how much a wheel falls into a hole at a cell, whichever way it rolls; 0 without a hole.
  [[nodiscard]] double drop_at(CellIndex cell) const {
    const Position2 centre = truth_.geometry.centre_of(cell);
    const Eigen::Vector2d place =
        (T_map_grid_ * Eigen::Vector3d(centre.x, centre.y, 0.0)).head<2>();
    double drop = 0.0;
    for (const TrueThing* hole : holes_) {
      if (!hole->footprint.contains(place)) continue;
      const double extent = std::max(hole->footprint.length, hole->footprint.width);
      drop = std::max(drop, wheel_drop(hole->depth, extent, robot_.wheel_radius));
    }
    return drop;
  }

  // Greatest difference of the ground to the cells at the four sides beyond the slope of either.
  [[nodiscard]] double edge_at(CellIndex cell, double slope) const {
    const std::size_t k = number_of(truth_.geometry, cell);
    double edge = 0.0;
    for (const CellIndex side :
         {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
      const CellIndex other{cell.l + side.l, cell.w + side.w};
      if (!truth_.geometry.contains(other)) continue;
      const std::size_t n = number_of(truth_.geometry, other);
      if (std::isnan(truth_.ground_height[n])) continue;
      const double steepest = std::max(slope, static_cast<double>(truth_.slope[n]));
      const double explained = std::tan(steepest) * truth_.geometry.cell_size();
      const double rise =
          std::abs(static_cast<double>(truth_.ground_height[k] - truth_.ground_height[n]));
      edge = std::max(edge, rise - explained);
    }
    return edge;
  }

  const sim::CellTruth& truth_;
  const Eigen::Isometry3d& T_map_grid_;
  const RobotParams& robot_;
  std::vector<const TrueThing*> holes_;
};

bool is_lethal_kind(TrueCell kind) { return kind >= TrueCell::kObstacle; }

template <class Visit>
void for_cells_beside(const GridGeometry& geometry, CellIndex cell, Visit&& visit) {
  for (int l = std::max(0, cell.l - 1); l <= std::min(geometry.cells_l() - 1, cell.l + 1); ++l) {
    for (int w = std::max(0, cell.w - 1); w <= std::min(geometry.cells_w() - 1, cell.w + 1); ++w) {
      visit(CellIndex{l, w});
    }
  }
}

}  // namespace

void CostScore::add(const CostScore& other) {
  blocked.add(other.blocked);
  blocked_free.add(other.blocked_free);
  for (std::size_t k = 0; k < kTrueCellCount; ++k) {
    open[k].add(other.open[k]);
    unknown[k].add(other.unknown[k]);
    all_open[k].add(other.all_open[k]);
  }
}

GridGeometry middle_of(const GridGeometry& grid, double radius) {
  const double cell = grid.cell_size();
  const double half = std::min({grid.half_length(), grid.half_width(), radius});
  const double side = 2.0 * cell * std::floor(half / cell + 1e-9);
  return {side, side, cell};
}

std::vector<TrueCell> true_cells(const sim::CellTruth& truth, const std::vector<TrueThing>& holes,
                                 const Eigen::Isometry3d& T_map_grid, const RobotParams& robot) {
  const Judge judge(truth, holes, T_map_grid, robot);
  std::vector<TrueCell> kinds;
  for (int l = 0; l < truth.geometry.cells_l(); ++l) {
    for (int w = 0; w < truth.geometry.cells_w(); ++w) kinds.push_back(judge.kind_of({l, w}));
  }
  return kinds;
}

void add_costs(const ElevationGrid& grid, const CellCosts& costs, const GridGeometry& middle,
               const std::vector<TrueCell>& kinds, const RobotParams& robot, CostScore& score) {
  const auto status_at = [&](CellIndex cell) {
    const Position2 centre = middle.centre_of(cell);
    return cost_at(grid, costs, centre, robot).status;
  };
  for (int l = 0; l < middle.cells_l(); ++l) {
    for (int w = 0; w < middle.cells_w(); ++w) {
      const CellIndex cell{l, w};
      const std::size_t k = number_of(middle, cell);
      const Position2 centre = middle.centre_of(cell);
      CellIndex place;
      if (kinds[k] == TrueCell::kNotCounted || !grid.geometry.cell_at(centre.x, centre.y, place) ||
          grid.slot_at(place) == kUnobserved) {
        continue;
      }
      const CostStatus status = status_at(cell);
      const bool lethal = status == CostStatus::kLethal;
      bool any_lethal = false, all_free = true;
      for_cells_beside(middle, cell, [&](CellIndex beside) {
        any_lethal = any_lethal || status_at(beside) == CostStatus::kLethal;
        all_free = all_free && kinds[number_of(middle, beside)] == TrueCell::kTraversable;
      });
      if (is_lethal_kind(kinds[k])) {
        const auto kind = static_cast<std::size_t>(kinds[k]);
        score.open[kind].count(!lethal);
        score.unknown[kind].count(status == CostStatus::kUnknown);
        score.all_open[kind].count(!any_lethal);
        continue;
      }
      score.blocked.count(lethal);
      if (all_free) score.blocked_free.count(lethal);
    }
  }
}

}  // namespace mrpt_terrain::eval
