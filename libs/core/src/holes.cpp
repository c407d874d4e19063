// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/holes.h"

#include <algorithm>
#include <cmath>

#include "height_plane.h"
#include "mrpt_terrain/core/beam_slope.h"
#include "surface_levels.h"

namespace mrpt_terrain {
namespace {

// The rim is measured against this level of the reference, which is too coarse to enter holes...
constexpr int kBaseLevel = 3;
// ...on cells of this level: three of them, 2.4 m, are averaged.
constexpr int kRimLevel = 1;
// Ground this far below the first mean is no rim, metres.
constexpr float kBelowRim = 0.02F;
// Things that begin at this height above the ground hang, metres.
constexpr float kHanging = 0.5F;
// Walls of a hole end up to this far above its rim, metres.
constexpr float kWallTop = 0.05F;
// Cells around a hole that are looked at: up to this many cells away.
constexpr int kRimReach = 2;

struct RimLattice {
  int side;
  [[nodiscard]] std::size_t at(LatticeCell cell) const {
    return static_cast<std::size_t>((cell.row >> kRimLevel) * side + (cell.column >> kRimLevel));
  }
};

void sum_heights(const GroundSurface& surface, const RimLattice& rim, bool again,
                 HoleWorkspace& workspace) {
  for (RimSums& sums : workspace.sums) sums = {};
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const std::size_t at = rim.at(surface.cells.cell[slot]);
    const float height = workspace.height[slot];
    if (again) {
      const RimSums& mean = workspace.around[at];
      if (mean.weight > 0.0F && height < mean.sum / mean.weight - kBelowRim) continue;
    }
    workspace.sums[at].sum += surface.ground[slot].weight * height;
    workspace.sums[at].weight += surface.ground[slot].weight;
  }
}

void sum_around(const GroundSurface& surface, const RimLattice& rim, HoleWorkspace& workspace) {
  for (RimSums& sums : workspace.around) sums = {};
  for (const LatticeCell cell : surface.cells.cell) {
    const std::size_t at = rim.at(cell);
    if (workspace.around[at].weight > 0.0F) continue;
    const int row = cell.row >> kRimLevel, column = cell.column >> kRimLevel;
    RimSums total;
    for (int i = std::max(row - 1, 0); i <= std::min(row + 1, rim.side - 1); ++i) {
      for (int j = std::max(column - 1, 0); j <= std::min(column + 1, rim.side - 1); ++j) {
        const RimSums& from = workspace.sums[static_cast<std::size_t>(i * rim.side + j)];
        total.sum += from.sum;
        total.weight += from.weight;
      }
    }
    workspace.around[at] = total;
  }
}

// Adds the height of the rim to the base in every cell.
void raise_base_to_rim(const GroundSurface& surface, HoleWorkspace& workspace) {
  const RimLattice rim{surface.lattice().side >> kRimLevel};
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const RimSums& mean = workspace.around[rim.at(surface.cells.cell[slot])];
    workspace.base[slot].height +=
        mean.weight > 0.0F ? mean.sum / mean.weight : workspace.height[slot];
  }
}

// Mean height of the ground above the base level, twice: the second time without what lies low.
void measure_rim(const FieldWorkspace& field, HoleWorkspace& workspace) {
  const GroundSurface& surface = field.surface;
  const SquareLattice& lattice = surface.lattice();
  const RimLattice rim{lattice.side >> kRimLevel};
  const LevelView base = view_of_level(field.surface_workspace, lattice, kBaseLevel);
  workspace.height.resize(surface.ground.size());
  workspace.base.resize(surface.ground.size());
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const LatticeCell cell = surface.cells.cell[slot];
    const LevelView::Linear at = base.at_cell(cell, kBaseLevel);
    workspace.base[slot] = {at.height, at.gradient_x, at.gradient_y};
    workspace.height[slot] = surface.node[surface.cells.number_of(cell)] - at.height;
  }
  const auto size = static_cast<std::size_t>(rim.side) * static_cast<std::size_t>(rim.side);
  workspace.sums.resize(size);
  workspace.around.resize(size);
  for (const bool again : {false, true}) {
    sum_heights(surface, rim, again, workspace);
    sum_around(surface, rim, workspace);
  }
  raise_base_to_rim(surface, workspace);
}

// Height of the rim at a place, or that of the ground where nothing is known of it.
float rim_at(const GroundSurface& surface, const HoleWorkspace& workspace, float x, float y,
             float ground) {
  const SquareLattice& lattice = surface.lattice();
  const std::int32_t number = lattice.cell_at(x, y);
  if (number < 0) return ground;
  const std::int32_t slot = surface.cells.slot_of[static_cast<std::size_t>(number)];
  if (slot < 0) return ground;
  const LatticeCell cell = surface.cells.cell[static_cast<std::size_t>(slot)];
  const RimBase& base = workspace.base[static_cast<std::size_t>(slot)];
  return base.height + base.gradient_x * (x - lattice.centre(cell.row)) +
         base.gradient_y * (y - lattice.centre(cell.column));
}

float depth_of(const FieldCells& cells, std::size_t slot) {
  return cells.rim[slot] - cells.floor[slot];
}

// What stands in a hole stays a thing of its own; what hangs over it does not matter, and points
// above the floor, but not above the rim, are of its walls.
bool holds_thing(const FieldCells& cells, std::size_t slot) {
  if (cells.above[slot] == 0 || cells.low[slot] > kHanging) return false;
  return cells.ground[slot] + cells.high[slot] > cells.rim[slot] + kWallTop;
}

void mark_candidates(const FieldWorkspace& field, const ElevationGrid& grid,
                     const HoleParams& params, HoleWorkspace& workspace, FieldCells& cells) {
  const auto least = static_cast<float>(params.least_depth);
  workspace.candidate.assign(grid.observed(), 0);
  workspace.in_hole.assign(grid.observed(), 0);
  cells.rim.resize(grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
    cells.rim[slot] = rim_at(field.surface, workspace, static_cast<float>(centre.x),
                             static_cast<float>(centre.y), cells.ground[slot]);
    const bool floor = !holds_thing(cells, slot) && cells.on[slot] + cells.below[slot] > 0;
    workspace.candidate[slot] = floor && depth_of(cells, slot) >= least ? 1 : 0;
  }
}

// Calls f with every observed slot up to `reach` cells away from a slot.
template <class F>
void for_slots_around(const ElevationGrid& grid, std::size_t slot, int reach, F&& f) {
  const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
  for (int l = std::max(at.l - reach, 0); l <= std::min(at.l + reach, grid.geometry.cells_l() - 1);
       ++l) {
    for (int w = std::max(at.w - reach, 0);
         w <= std::min(at.w + reach, grid.geometry.cells_w() - 1); ++w) {
      const Slot other =
          grid.slot_of[static_cast<std::size_t>(value_of(grid.geometry.id_of({l, w})))];
      if (other != kUnobserved) f(static_cast<std::size_t>(other));
    }
  }
}

// Takes the candidates that are connected with the first one.
void collect_members(const ElevationGrid& grid, std::size_t first, HoleWorkspace& workspace) {
  workspace.members.assign(1, static_cast<std::int32_t>(first));
  workspace.candidate[first] = 0;
  for (std::size_t next = 0; next < workspace.members.size(); ++next) {
    const auto slot = static_cast<std::size_t>(workspace.members[next]);
    for_slots_around(grid, slot, kRimReach, [&](std::size_t other) {
      if (workspace.candidate[other] == 0) return;
      workspace.candidate[other] = 0;
      workspace.members.push_back(static_cast<std::int32_t>(other));
    });
  }
}

// Brings the points on and below the ground in and around the members together; those in the
// members' own cells are marked.
void collect_points(const FieldWorkspace& field, const ElevationGrid& grid, const CellBox& box,
                    HoleWorkspace& workspace) {
  const GroundSurface& surface = field.surface;
  const SquareLattice& lattice = surface.lattice();
  const double reach = kRimReach * grid.geometry.cell_size() + grid.geometry.cell_size() / 2;
  const Position2 low = grid.geometry.centre_of(box.low), high = grid.geometry.centre_of(box.high);
  const auto index = [&lattice](double metres) {
    const int at = static_cast<int>(std::floor(metres / lattice.cell_size)) + lattice.side / 2;
    return std::clamp(at, 0, lattice.side - 1);
  };
  workspace.points.clear();
  for (int row = index(low.x - reach); row <= index(high.x + reach); ++row) {
    for (int column = index(low.y - reach); column <= index(high.y + reach); ++column) {
      const std::int32_t slot = surface.cells.slot_of[surface.cells.number_of({row, column})];
      if (slot < 0) continue;
      const auto s = static_cast<std::size_t>(slot);
      for (std::int32_t k = surface.cells.first[s]; k < surface.cells.first[s + 1]; ++k) {
        if (field.support[static_cast<std::size_t>(k)] == Support::kAbove) continue;
        const CellPoint& point = surface.cells.points[static_cast<std::size_t>(k)];
        CellIndex cell;
        if (!grid.geometry.cell_at(point.x, point.y, cell)) continue;
        const Slot of = grid.slot_at(cell);
        if (of == kUnobserved) continue;
        workspace.points.push_back(
            {point.x, point.y, point.z, workspace.in_hole[static_cast<std::size_t>(of)] != 0});
      }
    }
  }
}

// Plane z = a x + b y + c through the rim, about the mean of its points.
struct RimPlane {
  double x = 0.0, y = 0.0, z = 0.0, a = 0.0, b = 0.0;
  double sigma = 0.0;
  int points = 0;
  [[nodiscard]] double above(const HolePoint& p) const {
    return z + a * (p.x - x) + b * (p.y - y) - p.z;
  }
};

// Least squares over the rim's points that are not more than `low` below the plane so far.
RimPlane fit_rim(const std::vector<HolePoint>& points, const RimPlane* before, double low) {
  MomentSums sums;
  for (const HolePoint& p : points) {
    if (p.in_hole || (before != nullptr && before->above(p) > low)) continue;
    sums.add(p.x, p.y, p.z);
  }
  const Moments m = moments_from(sums);
  RimPlane rim{m.mean_x, m.mean_y, m.mean_z};
  rim.points = static_cast<int>(m.n);
  HeightPlane plane;
  if (m.n < 6 || !fit_height_plane(m, plane)) return rim;
  rim.a = plane.gradient_x;
  rim.b = plane.gradient_y;
  rim.sigma = std::sqrt(plane.squares / (m.n - 3.0));
  return rim;
}

// Depth that a fifth of the points in the hole exceed.
double depth_below(const RimPlane& rim, HoleWorkspace& workspace) {
  workspace.depths.clear();
  for (const HolePoint& p : workspace.points) {
    if (p.in_hole) workspace.depths.push_back(static_cast<float>(rim.above(p)));
  }
  if (workspace.depths.empty()) return 0.0;
  const auto fifth =
      workspace.depths.begin() + static_cast<std::ptrdiff_t>(workspace.depths.size() * 4 / 5);
  std::nth_element(workspace.depths.begin(), fifth, workspace.depths.end());
  return *fifth;
}

// In how many of the four quarters about the middle of the hole there is rim.
int quarters_of_rim(const std::vector<HolePoint>& points, const RimPlane& rim, double low) {
  double x = 0.0, y = 0.0, n = 0.0;
  for (const HolePoint& p : points) {
    if (!p.in_hole) continue;
    x += p.x;
    y += p.y;
    n += 1.0;
  }
  unsigned seen = 0;
  for (const HolePoint& p : points) {
    if (p.in_hole || std::abs(rim.above(p)) > low) continue;
    seen |= 1U << ((p.x > x / n ? 1U : 0U) + (p.y > y / n ? 2U : 0U));
  }
  return static_cast<int>((seen & 1U) + (seen >> 1U & 1U) + (seen >> 2U & 1U) + (seen >> 3U));
}

// Walls are steep: few of the points lie between the rim and the floor.
bool has_walls(const HoleParams& params, const RimPlane& rim, double depth,
               const std::vector<HolePoint>& points) {
  constexpr double kRim = 0.3, kFloor = 0.65;  // shares of the depth
  int between = 0, deep = 0;
  for (const HolePoint& p : points) {
    const double share = rim.above(p) / depth;
    between += share > kRim && share < kFloor ? 1 : 0;
    deep += share >= kFloor ? 1 : 0;
  }
  return deep >= params.least_points && between <= params.wall_share * deep;
}

bool is_hole(const FieldWorkspace& field, const ElevationGrid& grid, const HoleParams& params,
             HoleWorkspace& workspace) {
  constexpr int kFewestRimPoints = 8;
  constexpr double kRimBand = 0.3;  // share of the depth that the rim may lie low
  const CellBox box = cells_around(grid, all_of(workspace.members), 0.0);
  const int across = 1 + std::min(box.high.l - box.low.l, box.high.w - box.low.w);
  if (grid.geometry.cell_size() * across > params.widest) return false;
  for (const std::int32_t slot : workspace.members)
    workspace.in_hole[static_cast<std::size_t>(slot)] = 1;
  collect_points(field, grid, box, workspace);
  for (const std::int32_t slot : workspace.members)
    workspace.in_hole[static_cast<std::size_t>(slot)] = 0;
  const RimPlane all = fit_rim(workspace.points, nullptr, 0.0);
  const RimPlane rim = fit_rim(workspace.points, &all, params.least_depth);
  if (rim.points < kFewestRimPoints) return false;
  const double depth = depth_below(rim, workspace);
  if (depth < params.mean_depth) return false;
  if (rim.sigma > std::max(params.rim_depth * depth, params.rim_sigma)) return false;
  if (quarters_of_rim(workspace.points, rim, kRimBand * depth) < 3) return false;
  return has_walls(params, rim, depth, workspace.points);
}

}  // namespace

void find_holes(const FieldWorkspace& field, const ElevationGrid& grid, const HoleParams& params,
                HoleWorkspace& workspace, FieldCells& cells, GroundSegmentation& ground) {
  measure_rim(field, workspace);
  mark_candidates(field, grid, params, workspace, cells);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (workspace.candidate[slot] == 0) continue;
    collect_members(grid, slot, workspace);
    if (!is_hole(field, grid, params, workspace)) continue;
    for (const std::int32_t member : workspace.members)
      ground.rule[static_cast<std::size_t>(member)] = GroundRule::kLow;
  }
}

}  // namespace mrpt_terrain
