// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/costs.h"

#include <algorithm>
#include <array>
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

// Whether `a` is known better than `b`: by the variance over the number of cells that tell it.
bool is_better(const LocalPlane& a, const LocalPlane& b) {
  return a.roughness * a.roughness * static_cast<float>(b.cells) <
         b.roughness * b.roughness * static_cast<float>(a.cells);
}

// The window whose plane is known best of those that contain the cell. Windows with fewer cells
// than its own are left out, because few points lie on a plane by chance.
Slot best_window(const ElevationGrid& grid, int reach, std::size_t slot,
                 const std::vector<LocalPlane>& planes) {
  const CellIndex centre = grid.geometry.index_of(grid.cell[slot]);
  const LocalPlane& own = planes[slot];
  Slot best = own.status == FeatureStatus::kOk ? static_cast<Slot>(slot) : kUnobserved;
  for (int dl = -reach; dl <= reach; dl += reach) {
    for (int dw = -reach; dw <= reach; dw += reach) {
      const Slot other = grid.slot_at({centre.l + dl, centre.w + dw});
      if (other == kUnobserved) continue;
      const LocalPlane& plane = planes[static_cast<std::size_t>(other)];
      if (plane.status != FeatureStatus::kOk || plane.cells < own.cells) continue;
      if (best == kUnobserved || is_better(plane, planes[static_cast<std::size_t>(best)])) {
        best = other;
      }
    }
  }
  return best;
}

// A cell, or one of its eight neighbours.
struct Nearby {
  Slot slot = kUnobserved;
  const LocalPlane* surface = nullptr;  // null if it has none
  double height = 0.0;                  // of the surface, carried on to the cell, metres
};

// A cell and what is around it. Neighbours that lie opposite each other add up to 8.
struct Surroundings {
  Place here;
  std::array<Nearby, 9> nearby;
  double noise;  // least roughness of the surfaces, metres

  [[nodiscard]] const Nearby& self() const { return nearby[4]; }
};

Surroundings surroundings_of(const Ground& ground, std::size_t slot) {
  Surroundings result;
  result.here = mean_of(ground.grid, slot);
  const std::int32_t stride = ground.grid.geometry.stride();
  float least = std::numeric_limits<float>::infinity();
  for (std::int32_t k = 0; k < 9; ++k) {
    const std::int32_t id = value_of(ground.grid.cell[slot]) + (k / 3 - 1) * stride + k % 3 - 1;
    Nearby& nearby = result.nearby[static_cast<std::size_t>(k)];
    nearby.slot = ground.grid.slot_of[static_cast<std::size_t>(id)];
    if (nearby.slot == kUnobserved) continue;
    const Slot window = ground.surface[static_cast<std::size_t>(nearby.slot)];
    if (window == kUnobserved) continue;
    nearby.surface = &ground.planes[static_cast<std::size_t>(window)];
    nearby.height = nearby.surface->height_at(result.here.x, result.here.y);
    least = std::min(least, nearby.surface->roughness);
  }
  result.noise = std::isfinite(least) ? double{least} : 0.0;
  return result;
}

// By how much more two cells without surfaces differ in height than the robot can climb.
double unclimbable_rise(const Ground& ground, const Place& here, Slot other) {
  if (other == kUnobserved) return 0.0;
  const Place there = mean_of(ground.grid, static_cast<std::size_t>(other));
  const double dx = there.x - here.x;
  const double dy = there.y - here.y;
  return std::abs(there.z - here.z) - ground.max_gradient * std::sqrt(dx * dx + dy * dy);
}

// Difference between two heights carried on to the cell and the cell's own, which noise may have
// moved by `tolerance`.
double spread_of(double before, double behind, double own, double tolerance) {
  const auto [low, high] = std::minmax(before, behind);
  return std::max({high - low, high - own - tolerance, own - low - tolerance});
}

// The cell's own extent in height beyond what slope and noise explain.
double step_within(const Ground& ground, std::size_t slot, const Surroundings& around) {
  constexpr double kNoiseExtent = 6.0;  // plus and minus three standard deviations
  const LocalPlane* own = around.self().surface;
  double gradient = std::sqrt(2.0) * ground.max_gradient;
  if (own != nullptr) {
    const double sum = std::abs(own->gradient_x) + std::abs(own->gradient_y);
    gradient = std::min(gradient, sum);
  }
  const double by_slope = gradient * ground.grid.geometry.cell_size();
  return ground.grid.h_diff(slot) - by_slope - kNoiseExtent * around.noise;
}

// Step of the cell; see the header.
double step_at(const Ground& ground, std::size_t slot, const Surroundings& around) {
  constexpr double kSurelyNoise = 2.0;  // standard deviations of a mean height
  const double tolerance = kSurelyNoise * around.noise / std::sqrt(ground.grid.sums[slot].n);
  double step = std::max(0.0, step_within(ground, slot, around));
  for (std::size_t k = 0; k < 4; ++k) {
    const Nearby* before = &around.nearby[k];
    const Nearby* behind = &around.nearby[8 - k];
    if (before->surface == nullptr && around.self().surface != nullptr) before = &around.self();
    if (behind->surface == nullptr && around.self().surface != nullptr) behind = &around.self();
    if (before->surface == nullptr) std::swap(before, behind);
    if (before->surface == nullptr) {
      step = std::max({step, unclimbable_rise(ground, around.here, before->slot),
                       unclimbable_rise(ground, around.here, behind->slot)});
      continue;
    }
    const double other = behind->surface != nullptr ? behind->height : before->height;
    step = std::max(step, spread_of(before->height, other, around.here.z, tolerance));
  }
  return step;
}

// The surface that slope and roughness are told from: the cell's own, or, where those before and
// behind it are apart by more than their roughness explains, the smoothest of the three. The cell
// then holds the edge of a step, and a plane across it would call the step a slope.
const LocalPlane* told_surface(const Surroundings& around) {
  constexpr double kApart = 4.0;  // standard deviations
  const LocalPlane* best = around.self().surface;
  for (std::size_t k = 0; k < 4; ++k) {
    const Nearby& before = around.nearby[k];
    const Nearby& behind = around.nearby[8 - k];
    if (before.surface == nullptr || behind.surface == nullptr) continue;
    const auto [smooth, rough] = std::minmax(
        before.surface, behind.surface,
        [](const LocalPlane* a, const LocalPlane* b) { return a->roughness < b->roughness; });
    const bool apart = std::abs(before.height - behind.height) > kApart * double{rough->roughness};
    if (apart && (best == nullptr || smooth->roughness < best->roughness)) best = smooth;
  }
  return best;
}

void measure(const Ground& ground, std::size_t slot, CellCosts& costs) {
  const Surroundings around = surroundings_of(ground, slot);
  costs.step[slot] = static_cast<float>(step_at(ground, slot, around));
  const LocalPlane* surface = told_surface(around);
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
  const double cells = std::round(0.5 * robot.footprint_width / cell_size);
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
