// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hole_rim.h"
#include "hole_rings.h"
#include "hole_shares.h"
#include "mrpt_terrain/core/beam_slope.h"
#include "slots_around.h"
#include "stray_points.h"
#include "surface_levels.h"
#include "wide_registers.h"

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
// A cell at the edge of a hole holds points of its rim and of its floor: it may be a hole, though
// no cell of floor is there, if it lies so deep on average and its lowest point so deep, over the
// depth that a cell of floor needs.
constexpr float kEdgeMean = 0.5F, kEdgeLowest = 2.0F;
// Cells of one hole are up to this many cells apart.
constexpr int kApart = 2;
// The rim is looked for up to this far from the cells of a hole, metres.
constexpr double kRimReach = 0.9;
// Towards the sensor, rings leave the rim this many depths over the tangent of their fall ahead of
// the floor, with some reserve; at most so far, metres.
constexpr double kAheadDepths = 2.0, kFarthestAhead = 2.5;
// A cell next to a hole is part of it if this share of its points is at least half as deep.
constexpr double kDeepShare = 0.4;
// How far one looks for the surroundings of a hole, metres...
constexpr double kSurroundings = 1.2;
// ...of which the nearer ones are compared with the surface through the rim.
constexpr double kSurfaceReach = 1.01;
// Surroundings this much deeper or higher than the rim are none, over the depth.
constexpr double kLowerAround = 0.5, kHigherAround = 0.5;
// There is rim in a direction if so many of the cells that look out there see it...
constexpr double kSideShare = 0.3;
// So many looks out of a small hole may meet no rim, but cells at its walls, if two rings show it.
constexpr double kFewOthers = 2.0;
// ...and of the four pairs of opposite directions, so many have it on both sides: rim on one side
// alone may be a step.
constexpr int kFewestOpposite = 2;
// One pair will do where this share of the floor lies in traces of several rings that have walls at
// both ends.
constexpr double kBothEnds = 0.8;
// Walls: traces of at least so many points on average, and so many points in all.
constexpr double kLeastTrace = 1.5;
constexpr int kLeastWalled = 4;

// Low ground that is no hole as a whole may have one in it. Parts of it are looked at that lie
// deeper by this share of the least depth each time, as long as they stand out by the depth of a
// hole.
constexpr double kDeeperStep = 1.0 / 3.0;
// A part of a cell with cells of the whole on all sides makes so many.
constexpr std::size_t kFewestAsWhole = 9;

struct RimLattice {
  int side;
  [[nodiscard]] std::size_t at(LatticeCell cell) const {
    return static_cast<std::size_t>((cell.row >> kRimLevel) * side + (cell.column >> kRimLevel));
  }
};

void sum_heights(const GroundSurface& surface, const RimLattice& rim, bool again,
                 HoleWorkspace& workspace) {
  for (const LatticeCell cell : surface.cells.cell) workspace.sums[rim.at(cell)] = {};
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const std::size_t at = rim.at(surface.cells.cell[slot]);
    const float height = workspace.height[slot];
    if (again) {
      const RimMean& mean = workspace.around[at];
      if (mean.weight > 0.0F && height < mean.height - kBelowRim) continue;
    }
    workspace.sums[at].sum += surface.ground[slot].weight * height;
    workspace.sums[at].weight += surface.ground[slot].weight;
  }
}

void sum_around(const GroundSurface& surface, const RimLattice& rim, HoleWorkspace& workspace) {
  for (const LatticeCell cell : surface.cells.cell) workspace.around[rim.at(cell)] = {};
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
    if (total.weight > 0.0F) workspace.around[at] = {total.sum / total.weight, total.weight};
  }
}

// Adds the height of the rim to the base in every cell.
void raise_base_to_rim(const GroundSurface& surface, HoleWorkspace& workspace) {
  const RimLattice rim{surface.lattice().side >> kRimLevel};
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const RimMean& mean = workspace.around[rim.at(surface.cells.cell[slot])];
    workspace.base[slot].height += mean.weight > 0.0F ? mean.height : workspace.height[slot];
  }
  // Cells without slots are zero always.
  for (const LatticeCell cell : surface.cells.cell) workspace.sums[rim.at(cell)] = {};
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

/// The height of the rim. Holds copies and addresses, which compilers keep in registers.
struct RimView {
  SquareLattice lattice;
  const std::int32_t* slot_of;
  const LatticeCell* cell;
  const RimBase* base;

  /// At a place, or that of the ground where nothing is known of it.
  [[nodiscard]] float at(float x, float y, float ground) const {
    const std::int32_t number = lattice.cell_at(x, y);
    if (number < 0 || slot_of[number] < 0) return ground;
    const LatticeCell in = cell[slot_of[number]];
    const RimBase& from = base[slot_of[number]];
    return from.height + from.gradient_x * (x - lattice.centre(in.row)) +
           from.gradient_y * (y - lattice.centre(in.column));
  }
};

float depth_of(const FieldCells& cells, std::size_t slot) {
  return cells.rim[slot] - cells.floor[slot];
}

// What stands in a hole stays a thing of its own; what hangs over it does not matter, and points
// above the floor, but not above the rim, are of its walls.
bool holds_thing(const FieldCells& cells, std::size_t slot) {
  if (cells.above[slot] == 0 || cells.low[slot] > kHanging) return false;
  return cells.ground[slot] + cells.high[slot] > cells.rim[slot] + kWallTop;
}

void mark_candidates(const HoleInput& input, const HoleParams& params, HoleWorkspace& workspace,
                     FieldCells& cells) {
  const ElevationGrid& grid = input.grid;
  const auto least = static_cast<float>(params.least_depth);
  for (auto* candidates : {&workspace.floor, &workspace.edges, &workspace.deeper})
    candidates->clear(grid.geometry);
  workspace.zone.assign(grid.observed(), HoleZone::kFar);
  workspace.deep.assign(grid.observed(), 0);
  workspace.all.assign(grid.observed(), 0);
  cells.rim.resize(grid.observed());
  const CellPoints& surface = input.field.surface.cells;
  const RimView rim{surface.lattice, surface.slot_of.data(), surface.cell.data(),
                    workspace.base.data()};
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    const Position2 centre = grid.geometry.centre_of(at);
    cells.rim[slot] =
        rim.at(static_cast<float>(centre.x), static_cast<float>(centre.y), cells.ground[slot]);
    const float depth = depth_of(cells, slot);
    if (!(depth >= kEdgeMean * least)) continue;  // most cells, and quick to see
    const bool edge = cells.rim[slot] - grid.h_min[slot] >= kEdgeLowest * least;
    const bool floor = !holds_thing(cells, slot) && cells.on[slot] + cells.below[slot] > 0;
    if (floor && (edge || depth >= least))
      (depth >= least ? workspace.floor : workspace.edges).add(slot, at);
  }
}

CellIndex cell_of(const ElevationGrid& grid, std::int32_t slot) {
  return grid.geometry.index_of(grid.cell[static_cast<std::size_t>(slot)]);
}

// Takes the candidates that are connected with the first one.
void collect_members(const ElevationGrid& grid, std::int32_t first, CellBits& candidates,
                     std::vector<std::int32_t>& members) {
  members.assign(1, first);
  candidates.unmark(cell_of(grid, first));
  for (std::size_t next = 0; next < members.size(); ++next) {
    candidates.for_marked_around(cell_of(grid, members[next]), kApart, [&](CellIndex other) {
      candidates.unmark(other);
      members.push_back(grid.slot_within(other));
    });
  }
}

// What belongs to a hole and its edges is no other one; nor is what lies beside low cells that have
// been looked at and are none: the foot of a kerb has such edges all along.
void leave_out(const ElevationGrid& grid, HoleWorkspace& workspace) {
  CellBits& edges = workspace.edges.left;
  for (const std::int32_t member : workspace.members) {
    const CellIndex at = cell_of(grid, member);
    workspace.floor.left.unmark(at);
    workspace.deeper.left.unmark(at);
    edges.for_marked_around(at, kApart, [&edges](CellIndex near) { edges.unmark(near); });
  }
}

/// One hole while it is looked at.
struct HoleCase {
  const HoleInput& input;
  const HoleParams& params;
  FieldCells& cells;
  HoleWorkspace& workspace;
  bool is_part;  // of low ground that is no hole as a whole
  RimSurface rim;
  double depth = 0.0;
  unsigned sides = 0;          // bit per direction (row by row): rim is seen there
  int others = 0, around = 0;  // looks that meet no rim, and all that meet something
  double closed = 0.0;         // share of rim in what is seen around
  double seen = 0.0;           // share of what is seen around

  [[nodiscard]] const ElevationGrid& grid() const { return input.grid; }
  [[nodiscard]] CellBox box() const {
    return cells_around(input.grid, all_of(workspace.members), 0.0);
  }
};

bool is_too_wide(const HoleCase& hole) {
  const CellBox box = hole.box();
  const int across = 1 + std::min(box.high.l - box.low.l, box.high.w - box.low.w);
  return hole.grid().geometry.cell_size() * across > hole.params.widest;
}

void set_zone(HoleZone zone, std::size_t slot, HoleWorkspace& workspace) {
  if (workspace.zone[slot] == HoleZone::kFar)
    workspace.zoned.push_back(static_cast<std::int32_t>(slot));
  workspace.zone[slot] = zone;
}

// Marks the members from one on, and what is next to them.
void mark_zones(HoleCase& hole, std::size_t first = 0) {
  HoleWorkspace& workspace = hole.workspace;
  const auto begin = workspace.members.begin() + static_cast<std::ptrdiff_t>(first);
  std::for_each(begin, workspace.members.end(), [&workspace](std::int32_t slot) {
    set_zone(HoleZone::kFloor, static_cast<std::size_t>(slot), workspace);
  });
  std::for_each(begin, workspace.members.end(), [&](std::int32_t slot) {
    for_slots_around(hole.grid(), static_cast<std::size_t>(slot), 1,
                     [&workspace](std::size_t near) {
                       if (workspace.zone[near] == HoleZone::kFar)
                         set_zone(HoleZone::kNear, near, workspace);
                     });
  });
}

void clear_zones(HoleWorkspace& workspace) {
  for (const std::int32_t slot : workspace.zoned)
    workspace.zone[static_cast<std::size_t>(slot)] = HoleZone::kFar;
  workspace.zoned.clear();
}

/// A rectangle in metres, and its part towards the sensor.
struct HoleWindow {
  Position2 low, high;
  double ahead_x = 0.0, ahead_y = 0.0;
  [[nodiscard]] bool contains(double x, double y) const {
    return (x >= low.x) & (x <= high.x) & (y >= low.y) & (y <= high.y);
  }
};

HoleWindow window_around(const HoleCase& hole) {
  const CellBox box = hole.box();
  const GridGeometry& geometry = hole.grid().geometry;
  const double reach = kRimReach + geometry.cell_size() / 2;
  const Position2 low = geometry.centre_of(box.low), high = geometry.centre_of(box.high);
  HoleWindow window{{low.x - reach, low.y - reach}, {high.x + reach, high.y + reach}};
  if (!hole.input.origins.known()) return window;
  constexpr double kLeastFall = 0.02, kLeastRange = 0.1;
  float deepest = 0.0F;
  for (const std::int32_t slot : hole.workspace.members)
    deepest = std::max(deepest, depth_of(hole.cells, static_cast<std::size_t>(slot)));
  const auto& origin = hole.input.origins.of(0);
  const double dx = origin[0] - 0.5 * (low.x + high.x), dy = origin[1] - 0.5 * (low.y + high.y);
  const double range = std::max(std::hypot(dx, dy), kLeastRange);
  const auto first = static_cast<std::size_t>(hole.workspace.members.front());
  const double fall = std::max((origin[2] - hole.cells.rim[first]) / range, kLeastFall);
  const double ahead = std::min({kAheadDepths * deepest / fall, kFarthestAhead, range});
  window.ahead_x = dx / range * ahead;
  window.ahead_y = dy / range * ahead;
  return window;
}

/// Points of the surface, by their places in the order of its cells.
struct PlaceRange {
  std::size_t first = 0, last = 0;  // the last one is behind
};

// Adds those of some points of the surface that are of the rim, the walls and the floor, or else
// those that are farther away.
void add_points(HoleCase& hole, const HoleWindow& window, bool far, PlaceRange places) {
  const GroundSurface& surface = hole.input.field.surface;
  const ElevationGrid& grid = hole.grid();
  HoleWorkspace& workspace = hole.workspace;
  // Chosen without branches: which points are in the window cannot be predicted.
  workspace.places.resize(std::max(workspace.places.size(), places.last - places.first));
  std::size_t chosen = 0;
  for (std::size_t k = places.first; k < places.last; ++k) {
    const CellPoint& p = surface.cells.points[k];
    workspace.places[chosen] = k;
    const bool above = hole.input.field.support[k] == Support::kAbove;
    // The window holds all cells of the floor and those next to them.
    chosen += (!above & (window.contains(p.x, p.y) != far)) ? 1U : 0U;
  }
  for (std::size_t n = 0; n < chosen; ++n) {
    const CellPoint& p = surface.cells.points[workspace.places[n]];
    const std::int32_t id = grid.geometry.number_at(p.x, p.y, true);
    const Slot of = id < 0 ? kUnobserved : grid.slot_of[static_cast<std::size_t>(id)];
    if (of == kUnobserved) continue;
    HoleZone zone = workspace.zone[static_cast<std::size_t>(of)];
    if (zone == HoleZone::kFar && !far) zone = HoleZone::kRim;
    // Field by field: a point that is made first and then copied takes longer than all else here.
    HolePoint& point = workspace.points.emplace_back();
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    point.index = p.index;
    point.slot = of;
    point.depth = hole.cells.rim[static_cast<std::size_t>(of)] - p.z;
    point.zone = zone;
  }
}

// The points of some columns of a row of the lattice: they lie one behind the other.
PlaceRange places_in_row(const CellPoints& cells, int row, int first_column, int last_column) {
  const auto slot_at = [&](int column) { return cells.slot_of[cells.number_of({row, column})]; };
  while (first_column <= last_column && slot_at(first_column) < 0) ++first_column;
  if (first_column > last_column) return {};
  while (slot_at(last_column) < 0) --last_column;
  const auto first = static_cast<std::size_t>(slot_at(first_column));
  const auto last = static_cast<std::size_t>(slot_at(last_column));
  return {static_cast<std::size_t>(cells.first[first]),
          static_cast<std::size_t>(cells.first[last + 1])};
}

void add_points_between(HoleCase& hole, const HoleWindow& window, bool far, Position2 low,
                        Position2 high) {
  const CellPoints& cells = hole.input.field.surface.cells;
  const SquareLattice& lattice = cells.lattice;
  const auto index = [&lattice](double metres) {
    const int at = static_cast<int>(std::floor(metres / lattice.cell_size)) + lattice.side / 2;
    return std::clamp(at, 0, lattice.side - 1);
  };
  const int first_column = index(low.y), last_column = index(high.y);
  for (int row = index(low.x); row <= index(high.x); ++row)
    add_points(hole, window, far, places_in_row(cells, row, first_column, last_column));
}

// Brings the points on and below the ground in and around the members together. Their depths are
// those below the rim of their cells.
void collect_points(HoleCase& hole, const HoleWindow& window) {
  hole.workspace.points.clear();
  add_points_between(hole, window, false, window.low, window.high);
}

// Adds those towards the sensor, which only rings need.
void collect_points_ahead(HoleCase& hole, const HoleWindow& window) {
  const Position2 low{window.low.x + std::min(window.ahead_x, 0.0),
                      window.low.y + std::min(window.ahead_y, 0.0)};
  const Position2 high{window.high.x + std::max(window.ahead_x, 0.0),
                       window.high.y + std::max(window.ahead_y, 0.0)};
  add_points_between(hole, window, true, low, high);
}

// Points that are worked on together.
constexpr std::size_t kTogether = 64;

/// Heights of the rim at the places of some points: a loop of one kind of work, which compilers do
/// for many points at once.
struct RimHeights {
  std::array<double, kTogether> x, y;
  std::array<float, kTogether> height;
};

MRPT_TERRAIN_WIDE_REGISTERS
void measure_heights(const RimSurface& surface, std::size_t size, RimHeights& batch) {
  const RimSurface rim = surface;
  for (std::size_t i = 0; i < size; ++i)
    batch.height[i] = static_cast<float>(rim.height_at(batch.x[i], batch.y[i]));
}

// Measures how far the points lie below the rim.
void measure_point_depths(const RimSurface& rim, std::vector<HolePoint>& points) {
  RimHeights batch;
  for (std::size_t first = 0; first < points.size(); first += kTogether) {
    const std::size_t size = std::min(kTogether, points.size() - first);
    for (std::size_t i = 0; i < size; ++i) {
      batch.x[i] = points[first + i].x;
      batch.y[i] = points[first + i].y;
    }
    measure_heights(rim, size, batch);
    for (std::size_t i = 0; i < size; ++i)
      points[first + i].depth = batch.height[i] - points[first + i].z;
  }
}

// The cells of the members.
RimArea area_of(const HoleCase& hole) {
  const CellBox box = hole.box();
  const GridGeometry& geometry = hole.grid().geometry;
  return {geometry.centre_of(box.low), geometry.centre_of(box.high), geometry.cell_size() / 2};
}

// Fits the rim, and measures the depth that a fifth of the floor's points exceed.
bool measure_depth(HoleCase& hole) {
  if (!fit_rim(hole.workspace.points, area_of(hole), hole.params.least_depth,
               hole.input.origins.known(), hole.workspace.rim_points, hole.rim))
    return false;
  measure_point_depths(hole.rim, hole.workspace.points);
  // Of the floor: deep ones, and how many are not.
  std::vector<float>& depths = hole.workspace.values;
  depths.clear();
  std::size_t shallow = 0;
  for (const HolePoint& p : hole.workspace.points) {
    if (p.zone != HoleZone::kFloor) continue;
    if (static_cast<double>(p.depth) >= hole.params.mean_depth) {
      depths.push_back(p.depth);
    } else {
      ++shallow;
    }
  }
  // Four fifths of all are less deep.
  const std::size_t less = (depths.size() + shallow) * 4 / 5;
  if (less < shallow || depths.empty()) return false;
  const auto fifth = depths.begin() + static_cast<std::ptrdiff_t>(less - shallow);
  std::nth_element(depths.begin(), fifth, depths.end());
  hole.depth = *fifth;
  return true;
}

// Adds the cells next to the members that hold mostly deep points, and those next to these.
// \return whether there are any
bool grow(HoleCase& hole) {
  const ElevationGrid& grid = hole.grid();
  HoleWorkspace& workspace = hole.workspace;
  for (const HolePoint& p : workspace.points) {
    const auto slot = static_cast<std::size_t>(p.slot);
    ++workspace.all[slot];
    if (p.depth >= 0.5 * hole.depth) ++workspace.deep[slot];
  }
  const std::size_t members = workspace.members.size();
  for (std::size_t next = 0; next < workspace.members.size(); ++next) {
    const auto slot = static_cast<std::size_t>(workspace.members[next]);
    for_slots_around(grid, slot, 1, [&](std::size_t near) {
      if (workspace.zone[near] == HoleZone::kFloor || workspace.deep[near] == 0) return;
      if (workspace.deep[near] < kDeepShare * workspace.all[near]) return;
      if (holds_thing(hole.cells, near)) return;
      set_zone(HoleZone::kFloor, near, workspace);
      workspace.members.push_back(static_cast<std::int32_t>(near));
    });
  }
  for (const HolePoint& p : workspace.points) {
    const auto slot = static_cast<std::size_t>(p.slot);
    workspace.deep[slot] = workspace.all[slot] = 0;
  }
  if (workspace.members.size() == members) return false;
  mark_zones(hole, members);
  for (HolePoint& p : workspace.points) {
    const HoleZone zone = workspace.zone[static_cast<std::size_t>(p.slot)];
    p.zone = zone == HoleZone::kFar ? HoleZone::kRim : zone;
  }
  return true;
}

/// What is met first on the way out of a hole.
enum class Surrounding : std::uint8_t { kHole, kUnseen, kRim, kOther };

Surrounding look_out(const HoleCase& hole, CellIndex at, int step_l, int step_w) {
  const ElevationGrid& grid = hole.grid();
  const double cell_size = grid.geometry.cell_size();
  const int farthest = static_cast<int>(kSurroundings / cell_size + 0.5);
  for (int n = 1; n <= farthest; ++n) {
    const CellIndex cell{at.l + n * step_l, at.w + n * step_w};
    const Slot slot = grid.slot_at(cell);
    if (slot == kUnobserved) continue;
    const auto s = static_cast<std::size_t>(slot);
    if (hole.workspace.zone[s] == HoleZone::kFloor) return Surrounding::kHole;
    if (hole.cells.on[s] + hole.cells.below[s] == 0) {
      // What lies behind things is not seen. Edges of deep holes are above the reference, too.
      if (hole.cells.ground[s] + hole.cells.high[s] > hole.cells.rim[s] + kWallTop)
        return Surrounding::kUnseen;
      continue;
    }
    const Position2 centre = grid.geometry.centre_of(cell);
    const double rim =
        n * cell_size < kSurfaceReach ? hole.rim.height_at(centre.x, centre.y) : hole.cells.rim[s];
    const double share = (rim - hole.cells.floor[s]) / hole.depth;
    // Next to the hole may be its wall.
    if (n == 1 && share > kRimShare && share < 1.0 + kRimShare) continue;
    return share > kLowerAround || share < -kHigherAround ? Surrounding::kOther : Surrounding::kRim;
  }
  return Surrounding::kUnseen;
}

// Of the four pairs of opposite directions, those in which rim is seen on both sides.
int opposite_sides(unsigned sides) {
  int pairs = 0;
  for (unsigned direction = 0; direction < 4; ++direction) {
    const unsigned both = 1U << direction | 1U << (8U - direction);
    pairs += (sides & both) == both ? 1 : 0;
  }
  return pairs;
}

void look_around(HoleCase& hole) {
  int all_rim = 0, all_other = 0, all_unseen = 0;
  hole.sides = 0;
  for (unsigned direction = 0; direction < 9; ++direction) {
    const int l = static_cast<int>(direction) / 3 - 1, w = static_cast<int>(direction) % 3 - 1;
    if (l == 0 && w == 0) continue;
    int rim = 0, other = 0, unseen = 0;
    for (const std::int32_t slot : hole.workspace.members) {
      const CellId cell = hole.grid().cell[static_cast<std::size_t>(slot)];
      const Surrounding met = look_out(hole, hole.grid().geometry.index_of(cell), l, w);
      rim += met == Surrounding::kRim ? 1 : 0;
      other += met == Surrounding::kOther ? 1 : 0;
      unseen += met == Surrounding::kUnseen ? 1 : 0;
    }
    if (rim > 0 && rim >= kSideShare * (rim + other + unseen)) hole.sides |= 1U << direction;
    all_rim += rim;
    all_other += other;
    all_unseen += unseen;
  }
  const int seen = all_rim + all_other;
  hole.others = all_other;
  hole.around = seen;
  hole.closed = static_cast<double>(all_rim) / std::max(seen, 1);
  hole.seen = static_cast<double>(seen) / std::max(seen + all_unseen, 1);
}

/// Points of a hole and its walls, by depth.
struct HoleCounts {
  int between = 0, floor = 0;
  int measured = 0;  // on the floor, by a beam that is known
};

HoleCounts count_points(const HoleCase& hole) {
  HoleCounts counts;
  for (const HolePoint& p : hole.workspace.points) {
    if (p.zone != HoleZone::kFloor && p.zone != HoleZone::kNear) continue;
    const double share = p.depth / hole.depth;
    counts.between += share > kRimShare && share < kFloorShare ? 1 : 0;
    counts.floor += share >= kFloorShare ? 1 : 0;
    const bool measured = hole.input.origins.is_measured(static_cast<std::size_t>(p.index));
    counts.measured += share >= kFloorShare && measured ? 1 : 0;
  }
  return counts;
}

// Rings tell walls where beams are known and enough of them end on the floor.
bool rings_tell(const HoleCase& hole, const HoleCounts& counts) {
  return hole.input.origins.known() && counts.measured >= hole.params.least_points;
}

// Whether rings show rim on both sides of the floor, as directions do: several traces of several
// rings end at walls at both ends.
bool show_both_sides(const RingEvidence& rings, const HoleCounts& counts) {
  return rings.rings >= 2 && rings.traces >= 2 && rings.strictly >= kBothEnds * counts.measured;
}

// Whether all that is seen around is higher, and rings show it on both sides: more than the low
// places of rolling ground, and the foot of a kerb, have to show.
bool stands_out(const HoleCase& hole, const HoleCounts& counts, const RingEvidence& rings) {
  return hole.others == 0 && show_both_sides(rings, counts);
}

// Whether the floor ends at walls, and the rim is even enough for what shows it.
bool has_walls(HoleCase& hole, const HoleWindow& window, const HoleCounts& counts,
               RingEvidence& rings) {
  const HoleParams& params = hole.params;
  if (!rings_tell(hole, counts)) {
    return counts.between <= params.wall_share * counts.floor &&
           hole.rim.sigma <= params.rim_depth * hole.depth;
  }
  collect_points_ahead(hole, window);
  rings = follow_rings(hole.workspace.points, hole.input.origins, hole.depth, hole.workspace);
  const bool even = hole.rim.sigma <= params.rim_depth * hole.depth;
  if (even && rings.strictly >= kLeastWalled) count_oblique(rings);
  const double uneven =
      std::sqrt(std::max(0.0, hole.rim.sigma * hole.rim.sigma - rings.noise * rings.noise));
  if (uneven > params.uneven_depth * hole.depth && !stands_out(hole, counts, rings)) return false;
  if (rings.walled < kLeastWalled || rings.walled < kLeastTrace * rings.traces) return false;
  if (rings.walled < params.walled * counts.measured) return false;
  if (rings.rings >= 2) return true;
  return even && rings.strictly >= kLeastWalled;
}

HoleDescription describe_hole(const HoleCase& hole, const HoleCounts& counts,
                              const RingEvidence& rings) {
  const GridGeometry& geometry = hole.grid().geometry;
  MomentSums sums;
  for (const std::int32_t slot : hole.workspace.members) {
    const Position2 centre =
        geometry.centre_of(geometry.index_of(hole.grid().cell[static_cast<std::size_t>(slot)]));
    sums.add(centre.x, centre.y, 0.0);
  }
  const Moments m = moments_from(sums);
  // Variances along the axes of the cells; a rectangle of length l has l^2 / 12.
  const double cell = geometry.cell_size() * geometry.cell_size() / 12.0;
  const double xx = m.m_xx / m.n + cell, yy = m.m_yy / m.n + cell, xy = m.m_xy / m.n;
  const double middle = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
  HoleDescription result;
  result.length = std::sqrt(12.0 * (middle + apart));
  result.width = std::sqrt(12.0 * std::max(middle - apart, 0.0));
  result.depth = hole.depth;
  result.points = counts.floor;
  result.rings = rings.rings;
  const double walled =
      rings_tell(hole, counts)
          ? std::min(1.0, static_cast<double>(rings.walled) / std::max(counts.measured, 1))
          : hole.params.walled;
  const double even = 1.0 - hole.rim.sigma / hole.depth;
  result.confidence = hole.closed * hole.seen * walled * std::max(even, 0.0);
  result.slot = *std::min_element(hole.workspace.members.begin(), hole.workspace.members.end());
  double x = 0.0, y = 0.0, n = 0.0;
  for (const HolePoint& p : hole.workspace.points) {
    if (p.zone != HoleZone::kFloor || p.depth < kFloorShare * hole.depth) continue;
    x += p.x;
    y += p.y;
    n += 1.0;
  }
  result.centre = {x / n, y / n};
  return result;
}

// Slots are sorted by the cells' numbers.
void add_cells(const ElevationGrid& grid, std::vector<std::int32_t>& members,
               IndexRows& hole_cells) {
  std::sort(members.begin(), members.end());
  for (const std::int32_t member : members)
    hole_cells.items.push_back(value_of(grid.cell[static_cast<std::size_t>(member)]));
  hole_cells.first.push_back(static_cast<std::int32_t>(hole_cells.items.size()));
}

// Whether the members, and cells next to them that hold deep points and may become some, have too
// few points for a floor.
bool has_few_points(const HoleCase& hole) {
  const ElevationGrid& grid = hole.grid();
  const FieldCells& cells = hole.cells;
  const auto least = static_cast<float>(kEdgeMean * hole.params.least_depth);
  std::int32_t points = 0;
  for (const std::int32_t slot : hole.workspace.zoned) {
    const auto s = static_cast<std::size_t>(slot);
    const bool deep = cells.rim[s] - grid.h_min[s] >= least;
    if (deep || hole.workspace.zone[s] == HoleZone::kFloor) points += cells.on[s] + cells.below[s];
  }
  return points < hole.params.least_points;
}

// So many looks may meet no rim.
double most_others(const HoleCase& hole) { return (1.0 - hole.params.closed) * hole.around; }

// Finds floor, rim, depth and what is around.
// \return false if the members as a whole are no hole: too wide, too shallow, the rim too uneven,
// or ground around as low
bool measure_hole(HoleCase& hole, HoleWindow& window) {
  if (is_too_wide(hole)) return false;
  mark_zones(hole);
  if (has_few_points(hole)) return false;
  window = window_around(hole);
  collect_points(hole, window);
  if (!measure_depth(hole)) return false;
  // What has not grown would have the same rim and depth.
  if (grow(hole) && (is_too_wide(hole) || !measure_depth(hole))) return false;
  if (hole.rim.sigma > hole.params.rings_depth * hole.depth) return false;
  look_around(hole);
  return hole.others <= std::max(kFewOthers, most_others(hole));
}

// Whether what has been measured is seen well enough, and has walls.
bool is_hole(HoleCase& hole, const HoleWindow& window, HoleDescription& description) {
  const HoleCounts counts = count_points(hole);
  if (counts.floor < hole.params.least_points) return false;
  if (hole.is_part && hole.others > 0) return false;
  const int opposite = opposite_sides(hole.sides);
  if (hole.seen < hole.params.seen || opposite == 0) return false;
  RingEvidence rings;
  if (!has_walls(hole, window, counts, rings)) return false;
  if (opposite < kFewestOpposite && !show_both_sides(rings, counts)) return false;
  if (rings.rings < 2 && hole.others > most_others(hole)) return false;
  if (hole.is_part && !stands_out(hole, counts, rings)) return false;
  description = describe_hole(hole, counts, rings);
  return true;
}

/// All that the search changes.
struct HoleSearch {
  const HoleInput& input;
  const HoleParams& params;
  HoleWorkspace& workspace;
  FieldCells& cells;
  GroundSegmentation& ground;
  std::vector<HoleDescription>& holes;
  IndexRows& hole_cells;
};

// Makes those of the first members candidates again that lie deeper than the bar, if one of them
// does by the depth of a hole.
bool mark_deeper(const HoleSearch& search, std::size_t members, double bar) {
  if (members < kFewestAsWhole) return false;
  HoleWorkspace& workspace = search.workspace;
  const auto last = workspace.members.begin() + static_cast<std::ptrdiff_t>(members);
  const auto depth = [&search](std::int32_t member) {
    return depth_of(search.cells, static_cast<std::size_t>(member));
  };
  const double deepest = bar + search.params.mean_depth;
  if (std::none_of(workspace.members.begin(), last,
                   [&](std::int32_t member) { return depth(member) >= deepest; }))
    return false;
  std::for_each(workspace.members.begin(), last, [&](std::int32_t member) {
    if (depth(member) >= bar)
      workspace.deeper.add(static_cast<std::size_t>(member), cell_of(search.input.grid, member));
  });
  return true;
}

void add_hole(HoleSearch& search, const HoleDescription& description) {
  search.holes.push_back(description);
  for (const std::int32_t member : search.workspace.members)
    search.ground.rule[static_cast<std::size_t>(member)] = GroundRule::kLow;
  add_cells(search.input.grid, search.workspace.members, search.hole_cells);
}

// Looks at candidates, cells at least `bar` below the rim.
// \return whether there are deeper parts of what is no hole as a whole
bool look_at_candidates(HoleSearch& search, HoleCandidates& candidates, double bar) {
  HoleWorkspace& workspace = search.workspace;
  const ElevationGrid& grid = search.input.grid;
  const double deeper = bar + kDeeperStep * search.params.least_depth;
  bool any_deeper = false;
  for (const std::int32_t slot : candidates.slots) {
    if (!candidates.left.is_marked(cell_of(grid, slot))) continue;
    collect_members(grid, slot, candidates.left, workspace.members);
    const std::size_t members = workspace.members.size();
    HoleCase hole{
        search.input, search.params, search.cells, workspace, bar > search.params.least_depth, {}};
    HoleWindow window;
    HoleDescription description;
    const bool measured = measure_hole(hole, window);
    const bool found = measured && is_hole(hole, window, description);
    clear_zones(workspace);
    leave_out(grid, workspace);
    if (found) add_hole(search, description);
    if (!measured && &candidates == &workspace.floor)
      any_deeper |= mark_deeper(search, members, deeper);
  }
  return any_deeper;
}

// The cells that are to be looked at again become the candidates, in the order of their slots.
void go_deeper(const GridGeometry& geometry, HoleWorkspace& workspace) {
  std::swap(workspace.floor, workspace.deeper);
  std::sort(workspace.floor.slots.begin(), workspace.floor.slots.end());
  workspace.deeper.clear(geometry);
}

}  // namespace

void find_holes(const HoleInput& input, const HoleParams& params, HoleWorkspace& workspace,
                FieldCells& cells, GroundSegmentation& ground, std::vector<HoleDescription>& holes,
                IndexRows& hole_cells) {
  holes.clear();
  clear_rows(hole_cells);
  take_back_stray_cells(input, params.least_points, cells, workspace, ground);
  measure_rim(input.field, workspace);
  mark_candidates(input, params, workspace, cells);
  HoleSearch search{input, params, workspace, cells, ground, holes, hole_cells};
  for (double bar = params.least_depth; look_at_candidates(search, workspace.floor, bar);
       bar += kDeeperStep * params.least_depth)
    go_deeper(input.grid.geometry, workspace);
  look_at_candidates(search, workspace.edges, params.least_depth);
}

}  // namespace mrpt_terrain
