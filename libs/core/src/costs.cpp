// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/costs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace mrpt_terrain {
namespace {

// What the stages below share of one call.
struct Ground {
  const ElevationGrid& grid;
  const std::vector<LocalPlane>& planes;
  const std::vector<Slot>& surface;
  double max_gradient;  // tan(max_climb)

  [[nodiscard]] const LocalPlane* surface_of(Slot slot) const {
    if (slot == kUnobserved) return nullptr;
    const Slot window = surface[static_cast<std::size_t>(slot)];
    return window == kUnobserved ? nullptr : &planes[static_cast<std::size_t>(window)];
  }
  [[nodiscard]] Slot slot_beside(std::size_t slot, std::int32_t offset) const {
    return grid.slot_of[static_cast<std::size_t>(value_of(grid.cell[slot]) + offset)];
  }
};

// Mean of the points of a cell, metres.
struct Place {
  double x, y, z;
};
Place mean_of(const ElevationGrid& grid, std::size_t slot) {
  const MomentSums& sums = grid.sums[slot];
  const double share = 1.0 / sums.n;
  return {sums.x * share, sums.y * share, sums.z * share};
}

// How badly a plane is known: its variance over the number of cells that it was found from.
double doubt(const LocalPlane& plane) {
  return double{plane.roughness} * double{plane.roughness} / plane.cells;
}

// The window whose plane is known best of those that contain the cell. Windows with fewer
// cells than its own are left out, because few points lie on a plane by chance.
Slot best_window(const ElevationGrid& grid, int reach, std::size_t slot,
                 const std::vector<LocalPlane>& planes) {
  const CellIndex centre = grid.geometry.index_of(grid.cell[slot]);
  const LocalPlane& own = planes[slot];
  const bool own_is_ok = own.status == FeatureStatus::kOk;
  Slot best = own_is_ok ? static_cast<Slot>(slot) : kUnobserved;
  double least = own_is_ok ? doubt(own) : std::numeric_limits<double>::infinity();
  for (int dl = -reach; dl <= reach; dl += reach) {
    for (int dw = -reach; dw <= reach; dw += reach) {
      const Slot other = grid.slot_at({centre.l + dl, centre.w + dw});
      if (other == kUnobserved) continue;
      const LocalPlane& plane = planes[static_cast<std::size_t>(other)];
      if (plane.status != FeatureStatus::kOk || plane.cells < own.cells) continue;
      const double its_doubt = doubt(plane);
      if (its_doubt >= least) continue;
      least = its_doubt;
      best = other;
    }
  }
  return best;
}

// By how much more two cells without surfaces differ in height than the robot can climb.
double unclimbable_rise(const Ground& ground, const Place& here, Slot other) {
  const Place there = mean_of(ground.grid, static_cast<std::size_t>(other));
  const double dx = there.x - here.x;
  const double dy = there.y - here.y;
  return std::abs(there.z - here.z) - ground.max_gradient * std::sqrt(dx * dx + dy * dy);
}

// The surfaces before and behind a cell; that of the cell where there is no other.
struct Sides {
  const LocalPlane* before;
  const LocalPlane* behind;
};
Sides sides_of(const Ground& ground, std::size_t slot, std::int32_t offset) {
  const LocalPlane* own = ground.surface_of(static_cast<Slot>(slot));
  const LocalPlane* before = ground.surface_of(ground.slot_beside(slot, -offset));
  const LocalPlane* behind = ground.surface_of(ground.slot_beside(slot, offset));
  return {before != nullptr ? before : own, behind != nullptr ? behind : own};
}

// Difference between the two surfaces carried on to the cell, and its own height.
// `tolerance`: how far the own height may be off by noise.
double spread_of_heights(const Sides& sides, const Place& here, double tolerance) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const LocalPlane* side : {sides.before, sides.behind}) {
    if (side == nullptr) continue;
    lowest = std::min(lowest, side->height_at(here.x, here.y));
    highest = std::max(highest, side->height_at(here.x, here.y));
  }
  if (highest < lowest) return 0.0;
  return std::max({highest - lowest, highest - here.z - tolerance, here.z - lowest - tolerance});
}

// Step of a cell without any surface around in this direction.
double step_between_heights(const Ground& ground, std::size_t slot, const Place& here,
                            std::int32_t offset) {
  double rise = 0.0;
  for (const std::int32_t way : {offset, -offset}) {
    const Slot other = ground.slot_beside(slot, way);
    if (other != kUnobserved) rise = std::max(rise, unclimbable_rise(ground, here, other));
  }
  return rise;
}

// Least roughness of the surfaces of the cell and its eight neighbours: the noise of the points.
double least_roughness_around(const Ground& ground, std::size_t slot) {
  const int stride = ground.grid.geometry.stride();
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t row : {-stride, 0, stride}) {
    for (const std::int32_t offset : {row - 1, row, row + 1}) {
      const LocalPlane* surface = ground.surface_of(ground.slot_beside(slot, offset));
      if (surface != nullptr) least = std::min(least, double{surface->roughness});
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

// The cell's own extent in height beyond what slope and noise explain.
double step_within(const Ground& ground, std::size_t slot, double noise) {
  constexpr double kNoiseExtent = 6.0;  // plus and minus three standard deviations
  const LocalPlane* own = ground.surface_of(static_cast<Slot>(slot));
  double gradient = std::sqrt(2.0) * ground.max_gradient;
  if (own != nullptr) {
    const double sum = std::abs(own->gradient_x) + std::abs(own->gradient_y);
    gradient = std::min(gradient, sum);
  }
  const double by_slope = gradient * ground.grid.geometry.cell_size();
  return ground.grid.h_diff(slot) - by_slope - kNoiseExtent * noise;
}

// The smoother of two sides, if they are apart at the cell by more than their roughness explains.
const LocalPlane* smoother_of_apart(const Sides& sides, const Place& here) {
  constexpr double kApart = 4.0;
  if (sides.before == nullptr || sides.behind == nullptr) return nullptr;
  const double jump =
      std::abs(sides.before->height_at(here.x, here.y) - sides.behind->height_at(here.x, here.y));
  const LocalPlane* rougher = sides.before;
  const LocalPlane* smoother = sides.behind;
  if (rougher->roughness < smoother->roughness) std::swap(rougher, smoother);
  return jump > kApart * double{rougher->roughness} ? smoother : nullptr;
}

void measure(const Ground& ground, std::size_t slot, CellCosts& costs) {
  constexpr double kSurelyNoise = 2.0;  // standard deviations of a mean height
  const Place here = mean_of(ground.grid, slot);
  const int stride = ground.grid.geometry.stride();
  const LocalPlane* surface = ground.surface_of(static_cast<Slot>(slot));
  const double noise = least_roughness_around(ground, slot);
  const double tolerance = kSurelyNoise * noise / std::sqrt(ground.grid.sums[slot].n);
  double step = std::max(0.0, step_within(ground, slot, noise));
  for (const std::int32_t offset : {1, stride - 1, stride, stride + 1}) {
    const Sides sides = sides_of(ground, slot, offset);
    if (sides.before == nullptr && sides.behind == nullptr) {
      step = std::max(step, step_between_heights(ground, slot, here, offset));
      continue;
    }
    step = std::max(step, spread_of_heights(sides, here, tolerance));
    const LocalPlane* side = smoother_of_apart(sides, here);
    if (side != nullptr && (surface == nullptr || side->roughness < surface->roughness)) {
      surface = side;
    }
  }
  costs.step[slot] = static_cast<float>(step);
  const bool known = surface != nullptr;
  costs.gradient_x[slot] = known ? surface->gradient_x : 0.0F;
  costs.gradient_y[slot] = known ? surface->gradient_y : 0.0F;
  costs.roughness[slot] = known ? surface->roughness : 0.0F;
  costs.status[slot] = known ? FeatureStatus::kOk : ground.planes[slot].status;
}

// Cost from a slope part that is already known.
Cost cost_with(const CellCosts& costs, std::size_t slot, const RobotParams& robot, double slope) {
  Cost result;
  // Limits as floats: a step that equals the limit in the file is equal here too.
  result.parts.step = double{costs.step[slot] / static_cast<float>(robot.max_step)};
  const bool known = costs.status[slot] == FeatureStatus::kOk;
  if (known) {
    result.parts.slope = slope;
    result.parts.roughness =
        double{costs.roughness[slot] / static_cast<float>(robot.max_roughness)};
  }
  const double largest = std::max({result.parts.slope, result.parts.step, result.parts.roughness});
  result.cost = std::min(1.0, largest);
  if (largest >= 1.0) {
    result.status = CostStatus::kLethal;
  } else {
    result.status = known ? CostStatus::kOk : CostStatus::kUnknown;
  }
  return result;
}

// Calls `cost` with the slot of a position.
template <class CostOfSlot>
Cost at_position(const ElevationGrid& grid, Position2 position, CostOfSlot&& cost) {
  CellIndex cell;
  if (grid.geometry.cell_at(position.x, position.y, cell)) return cost(grid.slot_at(cell));
  Cost outside;
  outside.status = CostStatus::kOutside;
  return outside;
}

}  // namespace

int window_reach(const RobotParams& robot, double cell_size) {
  const double cells = std::round(0.25 * robot.footprint_width / cell_size);
  return static_cast<int>(std::clamp(cells, 1.0, double{kMaxReach}));
}

void compute_cell_costs(const ElevationGrid& grid, const RobotParams& robot,
                        CostWorkspace& workspace, CellCosts& costs) {
  const std::size_t size = grid.observed();
  const int reach = window_reach(robot, grid.geometry.cell_size());
  fit_local_planes(grid, reach, workspace.planes);
  workspace.surface.resize(size);
  for (std::size_t slot = 0; slot < size; ++slot) {
    workspace.surface[slot] = best_window(grid, reach, slot, workspace.planes);
  }
  costs.gradient_x.resize(size);
  costs.gradient_y.resize(size);
  costs.step.resize(size);
  costs.roughness.resize(size);
  costs.status.resize(size);
  const Ground ground{grid, workspace.planes, workspace.surface, std::tan(robot.max_climb)};
  for (std::size_t slot = 0; slot < size; ++slot) measure(ground, slot, costs);
}

Cost cost_of(const CellCosts& costs, Slot slot, const RobotParams& robot, double heading) {
  if (slot == kUnobserved) return {};
  const auto k = static_cast<std::size_t>(slot);
  assert(k < costs.size());
  const double gx = costs.gradient_x[k];
  const double gy = costs.gradient_y[k];
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double along = std::atan(std::abs(c * gx + s * gy)) / robot.max_climb;
  const double across = std::atan(std::abs(c * gy - s * gx)) / robot.max_tilt;
  return cost_with(costs, k, robot, std::max(along, across));
}

Cost cost_of(const CellCosts& costs, Slot slot, const RobotParams& robot) {
  if (slot == kUnobserved) return {};
  const auto k = static_cast<std::size_t>(slot);
  assert(k < costs.size());
  const double gx = costs.gradient_x[k];
  const double gy = costs.gradient_y[k];
  const double angle = std::atan(std::sqrt(gx * gx + gy * gy));
  return cost_with(costs, k, robot, angle / std::min(robot.max_climb, robot.max_tilt));
}

Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
             const RobotParams& robot, double heading) {
  return at_position(grid, position,
                     [&](Slot slot) { return cost_of(costs, slot, robot, heading); });
}

Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
             const RobotParams& robot) {
  return at_position(grid, position, [&](Slot slot) { return cost_of(costs, slot, robot); });
}

}  // namespace mrpt_terrain
