// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/costs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "lanes.h"
#include "measure_ground.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

// Cells whose numbers begin the arrays below: that of the cells without points.
constexpr std::size_t place_of(Slot slot) { return static_cast<std::size_t>(slot + 1); }

// Whether `a` is known better than `b`: by the variance over the number of cells that tell it.
bool is_better(const WindowQuality& a, const WindowQuality& b) {
  return a.variance * b.cells < b.variance * a.cells;
}

void find_qualities(const std::vector<LocalPlane>& planes, std::vector<WindowQuality>& qualities) {
  qualities.resize(planes.size() + 1);
  qualities[place_of(kUnobserved)] = WindowQuality{};
  for (std::size_t slot = 0; slot < planes.size(); ++slot) {
    const LocalPlane& plane = planes[slot];
    WindowQuality& quality = qualities[slot + 1];
    quality = WindowQuality{};
    if (plane.status != FeatureStatus::kOk) continue;
    quality.variance = plane.roughness * plane.roughness;
    quality.cells = static_cast<float>(plane.cells);
  }
}

// The cells a window's reach away to the sides and corners of a cell, row by row.
class WindowsAround {
 public:
  WindowsAround(const ElevationGrid& grid, int reach)
      : grid_(grid), reach_(reach), row_(reach * grid.geometry.stride()) {}

  // Calls visit(slot) for nine cells; kUnobserved also for those outside the grid.
  template <class Visit>
  void for_each(std::size_t slot, Visit&& visit) const {
    const CellId id = grid_.cell[slot];
    const CellIndex centre = grid_.geometry.index_of(id);
    const bool has[3] = {centre.w >= reach_, true, centre.w + reach_ < grid_.geometry.cells_w()};
    for (std::int32_t l = -1; l <= 1; ++l) {
      const std::int32_t row = centre.l + l * reach_;
      if (row < 0 || row >= grid_.geometry.cells_l()) continue;
      const std::int32_t middle = value_of(id) + l * row_;
      for (std::int32_t w = -1; w <= 1; ++w) {
        // The frame, which is never observed, in place of cells outside.
        const std::int32_t at = has[w + 1] ? middle + w * reach_ : 0;
        visit(grid_.slot_of[static_cast<std::size_t>(at)]);
      }
    }
  }

 private:
  const ElevationGrid& grid_;
  std::int32_t reach_;
  std::int32_t row_;
};

// The window whose plane is known best of those that contain the cell. Windows with fewer cells
// than its own are left out, because few points lie on a plane by chance. Without branches: which
// window is best is hard to predict.
Slot best_window(const WindowsAround& windows, std::size_t slot, std::int32_t own_cells,
                 const std::vector<WindowQuality>& qualities) {
  const auto least_cells = static_cast<float>(own_cells);
  WindowQuality quality{std::numeric_limits<float>::infinity(), 1.0F};  // worse than any
  Slot best = kUnobserved;
  const auto compare = [&](Slot other) {
    const WindowQuality& candidate = qualities[place_of(other)];
    const bool takes =
        (candidate.cells >= least_cells) & static_cast<int>(is_better(candidate, quality));
    best = takes ? other : best;
    quality.variance = takes ? candidate.variance : quality.variance;
    quality.cells = takes ? candidate.cells : quality.cells;
  };
  compare(static_cast<Slot>(slot));
  windows.for_each(slot, compare);
  return best;
}

// Where cells follow each other in a row of the grid, so do those around them: they are looked up
// once for all of `kCellLanes` cells, and compared side by side.
// Skipped cells are in no row.
void find_cells_in_row(const ElevationGrid& grid, const CellSelection& selection,
                       std::vector<std::uint8_t>& in_row) {
  const std::size_t size = grid.observed();
  in_row.resize(size);
  for (std::size_t slot = size; slot > 0; --slot) {
    const bool goes_on =
        slot < size && value_of(grid.cell[slot]) == value_of(grid.cell[slot - 1]) + 1;
    const std::size_t length = goes_on ? in_row[slot] + std::size_t{1} : 1;
    in_row[slot - 1] = selection.is_skipped(slot - 1)
                           ? std::uint8_t{0}
                           : static_cast<std::uint8_t>(std::min(length, kCellLanes));
  }
}

// Windows about cells that follow each other, and those at their sides.
struct WindowRow {
  static constexpr std::size_t kLength = kCellLanes + 2 * kMaxReach;
  Slot slot[kLength];
  float variance[kLength], cells[kLength];
};

void look_up(const ElevationGrid& grid, std::int32_t first,
             const std::vector<WindowQuality>& qualities, std::size_t length, WindowRow& row) {
  for (std::size_t k = 0; k < length; ++k) {
    row.slot[k] = grid.slot_of[static_cast<std::size_t>(first) + k];
    const WindowQuality& quality = qualities[place_of(row.slot[k])];
    row.variance[k] = quality.variance;
    row.cells[k] = quality.cells;
  }
}

// Best windows so far.
struct BestLanes {
  FloatLanes variance, cells;
  IntLanes slot;
};
// As `compare` in `best_window`, from a place of a row on.
MRPT_TERRAIN_LANES void compare(const WindowRow& row, std::size_t at, const FloatLanes& least_cells,
                                BestLanes& best) {
  FloatLanes variance, cells;
  IntLanes slot;
  load_from(row.variance + at, variance);
  load_from(row.cells + at, cells);
  load_from(row.slot + at, slot);
  const IntLanes takes = (cells >= least_cells) & (variance * best.cells < best.variance * cells);
  best.slot = takes ? slot : best.slot;
  best.variance = takes ? variance : best.variance;
  best.cells = takes ? cells : best.cells;
}

MRPT_TERRAIN_WIDE_REGISTERS
void find_best_windows(const WindowRow (&rows)[3], std::size_t reach, const float* own_cells,
                       Slot* found) {
  FloatLanes least_cells;
  load_from(own_cells, least_cells);
  const FloatLanes zero{};
  const IntLanes none{};
  BestLanes best{zero + std::numeric_limits<float>::infinity(), zero + 1.0F, none + kUnobserved};
  compare(rows[1], reach, least_cells, best);
  for (const WindowRow& row : rows) {
    for (std::size_t w = 0; w < 3; ++w) compare(row, w * reach, least_cells, best);
  }
  std::memcpy(found, &best.slot, sizeof(best.slot));
}

// `best_window` of cells that follow each other. False if their windows reach beyond the sides.
bool best_windows_of_row(const ElevationGrid& grid, int reach, std::size_t slot,
                         const CostWorkspace& workspace, Slot* found) {
  const auto n = static_cast<int>(kCellLanes);
  const CellIndex centre = grid.geometry.index_of(grid.cell[slot]);
  if (centre.w < reach || centre.w + n - 1 + reach >= grid.geometry.cells_w()) return false;
  if (centre.l < reach || centre.l + reach >= grid.geometry.cells_l()) return false;
  const auto length = static_cast<std::size_t>(n + 2 * reach);
  WindowRow rows[3];
  for (std::int32_t l = 0; l < 3; ++l) {
    const std::int32_t first =
        value_of(grid.cell[slot]) - reach + (l - 1) * reach * grid.geometry.stride();
    look_up(grid, first, workspace.qualities, length, rows[l]);
  }
  float own_cells[kCellLanes];
  for (std::size_t k = 0; k < kCellLanes; ++k) {
    own_cells[k] = static_cast<float>(workspace.planes[slot + k].cells);
  }
  find_best_windows(rows, static_cast<std::size_t>(reach), own_cells, found);
  return true;
}

CellSurface surface_of(const std::vector<LocalPlane>& planes, Slot window) {
  if (window == kUnobserved) return {};
  const LocalPlane& plane = planes[static_cast<std::size_t>(window)];
  return {plane.x, plane.y, plane.z, plane.gradient_x, plane.gradient_y, plane.roughness, 1.0F};
}

void find_surfaces(const ElevationGrid& grid, const CellSelection& selection, int reach,
                   CostWorkspace& workspace) {
  find_qualities(workspace.planes, workspace.qualities);
  find_cells_in_row(grid, selection, workspace.in_row);
  workspace.surfaces.resize(grid.observed() + 1);
  workspace.surfaces[place_of(kUnobserved)] = CellSurface{};
  const WindowsAround windows(grid, reach);
  Slot best[kCellLanes];
  for (std::size_t slot = 0, count = 0; slot < grid.observed(); slot += count) {
    const bool together = workspace.in_row[slot] == kCellLanes &&
                          best_windows_of_row(grid, reach, slot, workspace, best);
    count = together ? kCellLanes : 1;
    if (workspace.in_row[slot] == 0) {
      best[0] = kUnobserved;
    } else if (!together) {
      best[0] = best_window(windows, slot, workspace.planes[slot].cells, workspace.qualities);
    }
    for (std::size_t k = 0; k < count; ++k) {
      workspace.surfaces[slot + k + 1] = surface_of(workspace.planes, best[k]);
    }
  }
}

// What the stages below share of one call.
struct Ground {
  const ElevationGrid& grid;
  const std::vector<MomentSums>& sums;
  const std::vector<float>* extent;  // per slot: highest less lowest point; null: the grid's
  const std::vector<CellSurface>& surfaces;
  double max_gradient;  // tan(max_climb)

  [[nodiscard]] bool has_points(std::size_t slot) const { return sums[slot].n > 0.0; }
};

// Mean of the points of a cell, metres.
struct Place {
  double x, y, z;
};
// Without points, the place of the cell's surface in its middle.
Place mean_of(const Ground& ground, std::size_t slot) {
  const MomentSums& sums = ground.sums[slot];
  if (!(sums.n > 0.0)) {
    const GridGeometry& geometry = ground.grid.geometry;
    const Position2 centre = geometry.centre_of(geometry.index_of(ground.grid.cell[slot]));
    return {centre.x, centre.y, ground.surfaces[slot + 1].height_at(centre.x, centre.y)};
  }
  const double share = 1.0 / sums.n;
  return {sums.x * share, sums.y * share, sums.z * share};
}

constexpr std::size_t kNearby = 9;  // a cell and its neighbours; opposite ones add up to 8
constexpr std::size_t kSelf = 4;

// Cells side by side, with what is around them.
struct CellsAround {
  Slot slot[kNearby][kCellLanes] = {};
  LaneArray known[kNearby];      // 1 or 0: there is a surface
  LaneArray height[kNearby];     // of the surface, carried on to the cell, metres
  LaneArray roughness[kNearby];  // of the surface; infinite without
  LaneArray mean_z, points, h_diff;
  LaneArray steepness;                 // |gradient_x| + |gradient_y| of the cell's own surface
  LaneArray step, told;                // what comes out; told: which of the nearby, or -1
  std::int64_t lone[kCellLanes] = {};  // not 0: in some direction no surface tells the step
  LaneArray x, y;                      // mean of the points, metres
};

void set_own(const Ground& ground, std::size_t slot, const Place& here, std::size_t lane,
             CellsAround& cells) {
  const CellSurface& own = ground.surfaces[slot + 1];
  cells.mean_z.value[lane] = here.z;
  // The height of a cell without points says nothing: its tolerance is without bounds.
  constexpr double kNoPoints = 1e-12;
  cells.points.value[lane] = std::max(ground.sums[slot].n, kNoPoints);
  cells.h_diff.value[lane] =
      double{ground.extent == nullptr ? ground.grid.h_diff(slot) : (*ground.extent)[slot]};
  cells.steepness.value[lane] = double{std::abs(own.gradient_x) + std::abs(own.gradient_y)};
}

void set_lane(const Ground& ground, std::size_t slot, std::size_t lane, CellsAround& cells) {
  const Place here = mean_of(ground, slot);
  const std::int32_t stride = ground.grid.geometry.stride();
  for (std::size_t k = 0; k < kNearby; ++k) {
    const auto n = static_cast<std::int32_t>(k);
    const std::int32_t id = value_of(ground.grid.cell[slot]) + (n / 3 - 1) * stride + n % 3 - 1;
    const Slot nearby = ground.grid.slot_of[static_cast<std::size_t>(id)];
    const CellSurface& surface = ground.surfaces[place_of(nearby)];
    cells.slot[k][lane] = nearby;
    cells.known[k].value[lane] = double{surface.known};
    cells.height[k].value[lane] = surface.height_at(here.x, here.y);
    cells.roughness[k].value[lane] = double{surface.roughness};
  }
  set_own(ground, slot, here, lane, cells);
}

// Surfaces of cells that follow each other, and of one more at either end.
struct SurfaceRow {
  static constexpr std::size_t kLength = kCellLanes + 2;
  Slot slot[kLength];
  double x[kLength], y[kLength], z[kLength], gradient_x[kLength], gradient_y[kLength];
  double roughness[kLength], known[kLength];
};

void look_up(const Ground& ground, std::int32_t first, SurfaceRow& row) {
  for (std::size_t k = 0; k < SurfaceRow::kLength; ++k) {
    row.slot[k] = ground.grid.slot_of[static_cast<std::size_t>(first) + k];
    const CellSurface& surface = ground.surfaces[place_of(row.slot[k])];
    row.x[k] = surface.x;
    row.y[k] = surface.y;
    row.z[k] = surface.z;
    row.gradient_x[k] = double{surface.gradient_x};
    row.gradient_y[k] = double{surface.gradient_y};
    row.roughness[k] = double{surface.roughness};
    row.known[k] = double{surface.known};
  }
}

// What `set_lane` says about the nearby cells of one row: `at` cells from the first one on.
MRPT_TERRAIN_LANES void set_nearby(const SurfaceRow& row, std::size_t at, std::size_t k,
                                   CellsAround& cells) {
  DoubleLanes px, py, x, y, z, gradient_x, gradient_y;
  load(cells.x, px);
  load(cells.y, py);
  load_from(row.x + at, x);
  load_from(row.y + at, y);
  load_from(row.z + at, z);
  load_from(row.gradient_x + at, gradient_x);
  load_from(row.gradient_y + at, gradient_y);
  store(z + gradient_x * (px - x) + gradient_y * (py - y), cells.height[k]);
  std::memcpy(cells.slot[k], row.slot + at, sizeof(cells.slot[k]));
  std::memcpy(cells.known[k].value, row.known + at, sizeof(cells.known[k].value));
  std::memcpy(cells.roughness[k].value, row.roughness + at, sizeof(cells.roughness[k].value));
}

MRPT_TERRAIN_WIDE_REGISTERS
void set_all_nearby(const SurfaceRow (&rows)[3], CellsAround& cells) {
  for (std::size_t k = 0; k < kNearby; ++k) set_nearby(rows[k / 3], k % 3, k, cells);
}

// `set_lane` of cells that follow each other, the first of which has `slot`.
void set_lanes_of_row(const Ground& ground, std::size_t slot, CellsAround& cells) {
  for (std::size_t lane = 0; lane < kCellLanes; ++lane) {
    const Place here = mean_of(ground, slot + lane);
    cells.x.value[lane] = here.x;
    cells.y.value[lane] = here.y;
    set_own(ground, slot + lane, here, lane, cells);
  }
  SurfaceRow rows[3];
  for (std::int32_t l = 0; l < 3; ++l) {
    const std::int32_t stride = ground.grid.geometry.stride();
    look_up(ground, value_of(ground.grid.cell[slot]) + (l - 1) * stride - 1, rows[l]);
  }
  set_all_nearby(rows, cells);
}

// Sets up to `kCellLanes` cells from slot `next` on, which moves on behind them; returns how many.
// \param slots where they are
std::size_t set_lanes(const Ground& ground, const std::vector<std::uint8_t>& in_row,
                      std::size_t& next, CellsAround& cells, std::size_t* slots) {
  if (in_row[next] == kCellLanes) {
    set_lanes_of_row(ground, next, cells);
    for (std::size_t lane = 0; lane < kCellLanes; ++lane) slots[lane] = next++;
    return kCellLanes;
  }
  std::size_t count = 0;
  for (; count < kCellLanes && next < in_row.size(); ++next) {
    if (in_row[next] == kCellLanes) break;
    if (in_row[next] == 0) continue;  // skipped
    set_lane(ground, next, count, cells);
    slots[count++] = next;
  }
  return count;
}

// What is nearby, in registers.
struct NearbyLanes {
  DoubleLanes known;  // flags
  DoubleLanes height, roughness;
};
MRPT_TERRAIN_LANES void load(const CellsAround& cells, std::size_t k, NearbyLanes& nearby) {
  load(cells.known[k], nearby.known);
  load(cells.height[k], nearby.height);
  load(cells.roughness[k], nearby.roughness);
}

// Least roughness of the surfaces, metres; 0 without any.
MRPT_TERRAIN_LANES void find_noise(const CellsAround& cells, DoubleLanes& noise) {
  const DoubleLanes zero{};
  const DoubleLanes infinite = zero + std::numeric_limits<double>::infinity();
  noise = infinite;
  for (const LaneArray& roughness : cells.roughness) {
    DoubleLanes next;
    load(roughness, next);
    noise = next < noise ? next : noise;
  }
  noise = noise < infinite ? noise : zero;
}

// The cell's own extent in height beyond what slope and noise explain.
MRPT_TERRAIN_LANES void find_step_within(const CellsAround& cells, double max_gradient,
                                         double cell_size, const NearbyLanes& self,
                                         const DoubleLanes& noise, DoubleLanes& step) {
  constexpr double kNoiseExtent = 6.0;  // plus and minus three standard deviations
  const DoubleLanes zero{};
  DoubleLanes h_diff, steepness;
  load(cells.h_diff, h_diff);
  load(cells.steepness, steepness);
  const DoubleLanes most = zero + std::sqrt(2.0) * max_gradient;
  DoubleLanes takes = self.known;
  keep_less(steepness, most, takes);
  const DoubleLanes gradient = takes > zero ? steepness : most;
  step = h_diff - gradient * cell_size - kNoiseExtent * noise;
  step = step > zero ? step : zero;
}

// Difference between two heights carried on to the cell and the cell's own, which noise may have
// moved by `tolerance`: counts in `step` where it is greater and `counts`.
MRPT_TERRAIN_LANES void raise_to_spread(const DoubleLanes& before, const DoubleLanes& behind,
                                        const DoubleLanes& own, const DoubleLanes& tolerance,
                                        const DoubleLanes& counts, DoubleLanes& step) {
  const DoubleLanes zero{};
  const DoubleLanes high = before < behind ? behind : before;
  const DoubleLanes low = before < behind ? before : behind;
  const DoubleLanes apart = high - low;
  const DoubleLanes below = high - own - tolerance;
  const DoubleLanes above = own - low - tolerance;
  DoubleLanes spread = apart < below ? below : apart;
  spread = spread < above ? above : spread;
  DoubleLanes raises = counts;
  keep_less(step, spread, raises);
  step = raises > zero ? spread : step;
}

// The surface that slope and roughness are told from: the cell's own, or, where those before and
// behind it are apart by more than their roughness explains, the smoothest of the three. The cell
// then holds the edge of a step, and a plane across it would call the step a slope.
struct ToldLanes {
  DoubleLanes which, roughness;
};
MRPT_TERRAIN_LANES void tell_smoothest(const NearbyLanes& before, const NearbyLanes& behind,
                                       std::size_t k, ToldLanes& told) {
  constexpr double kApart = 4.0;  // standard deviations
  const DoubleLanes zero{};
  const DoubleLanes &a = before.roughness, &b = behind.roughness;
  const DoubleLanes smooth = b < a ? b : a;
  const DoubleLanes rough = b < a ? a : b;
  const DoubleLanes rise = before.height - behind.height;
  const DoubleLanes size = rise < zero ? -rise : rise;
  DoubleLanes takes = before.known * behind.known;
  keep_less(kApart * rough, size, takes);
  keep_less(smooth, told.roughness, takes);
  const DoubleLanes which =
      b < a ? zero + static_cast<double>(kNearby - 1 - k) : zero + static_cast<double>(k);
  told.which = takes > zero ? which : told.which;
  told.roughness = takes > zero ? smooth : told.roughness;
}

// Step of the cells and the surface that is told; see the header.
MRPT_TERRAIN_WIDE_REGISTERS
void measure_lanes(double max_gradient, double cell_size, CellsAround& cells) {
  constexpr double kSurelyNoise = 2.0;  // standard deviations of a mean height
  const DoubleLanes zero{};
  NearbyLanes self;
  load(cells, kSelf, self);
  DoubleLanes noise, mean_z, points, step;
  find_noise(cells, noise);
  load(cells.mean_z, mean_z);
  load(cells.points, points);
  take_roots(points);
  const DoubleLanes tolerance = kSurelyNoise * noise / points;
  find_step_within(cells, max_gradient, cell_size, self, noise, step);
  ToldLanes told{self.known > zero ? zero + static_cast<double>(kSelf) : zero - 1.0,
                 self.roughness};
  DoubleLanes told_by_any;
  set_flags(told_by_any);
  for (std::size_t k = 0; k < kSelf; ++k) {
    NearbyLanes before, behind;
    load(cells, k, before);
    load(cells, kNearby - 1 - k, behind);
    tell_smoothest(before, behind, k, told);
    // Where one has no surface, the cell's own stands in, or else the other.
    const DoubleLanes other = before.known > zero ? before.height : behind.height;
    const DoubleLanes stand_in = self.known > zero ? self.height : other;
    const DoubleLanes any_known = self.known + before.known + behind.known;
    const DoubleLanes any = any_known > zero ? zero + 1.0 : zero;
    told_by_any = told_by_any * any;
    raise_to_spread(before.known > zero ? before.height : stand_in,
                    behind.known > zero ? behind.height : stand_in, mean_z, tolerance, any, step);
  }
  store(step, cells.step);
  store(told.which, cells.told);
  const MaskLanes lone = told_by_any == zero;
  std::memcpy(cells.lone, &lone, sizeof(lone));
}

// By how much more two cells without surfaces differ in height than the robot can climb.
double unclimbable_rise(const Ground& ground, const Place& here, Slot other) {
  if (other == kUnobserved || !ground.has_points(static_cast<std::size_t>(other))) return 0.0;
  const Place there = mean_of(ground, static_cast<std::size_t>(other));
  const double dx = there.x - here.x;
  const double dy = there.y - here.y;
  return std::abs(there.z - here.z) - ground.max_gradient * std::sqrt(dx * dx + dy * dy);
}

// Step of a cell in the directions in which no surface tells it.
double lone_step(const Ground& ground, const CellsAround& cells, std::size_t lane,
                 std::size_t slot) {
  if (!ground.has_points(slot)) return 0.0;
  const Place here = mean_of(ground, slot);
  double step = 0.0;
  for (std::size_t k = 0; k < kSelf; ++k) {
    const std::size_t behind = kNearby - 1 - k;
    if (cells.known[k].value[lane] > 0.0 || cells.known[behind].value[lane] > 0.0) continue;
    step = std::max({step, unclimbable_rise(ground, here, cells.slot[k][lane]),
                     unclimbable_rise(ground, here, cells.slot[behind][lane])});
  }
  return step;
}

void write_lane(const Ground& ground, const CellsAround& cells, std::size_t lane, std::size_t slot,
                const std::vector<LocalPlane>& planes, CellCosts& costs) {
  double step = cells.step.value[lane];
  if (cells.lone[lane] != 0) step = std::max(step, lone_step(ground, cells, lane, slot));
  costs.step[slot] = static_cast<float>(step);
  const auto told = static_cast<std::ptrdiff_t>(cells.told.value[lane]);
  if (told < 0) {
    costs.gradient_x[slot] = costs.gradient_y[slot] = costs.roughness[slot] = 0.0F;
    costs.status[slot] = planes[slot].status;
    return;
  }
  const CellSurface& surface =
      ground.surfaces[place_of(cells.slot[static_cast<std::size_t>(told)][lane])];
  costs.gradient_x[slot] = surface.gradient_x;
  costs.gradient_y[slot] = surface.gradient_y;
  costs.roughness[slot] = surface.roughness;
  costs.status[slot] = FeatureStatus::kOk;
}

void write_skipped(const std::vector<std::uint8_t>& skipped, CellCosts& costs) {
  for (std::size_t slot = 0; slot < skipped.size(); ++slot) {
    if (skipped[slot] == 0) continue;
    costs.gradient_x[slot] = costs.gradient_y[slot] = 0.0F;
    costs.step[slot] = costs.roughness[slot] = 0.0F;
    costs.status[slot] = FeatureStatus::kTooFewPoints;
  }
}

// Parts that descriptions of field mode have; those of holes are for the way across one.
template <class Across>
void add_field_parts(const CellCosts& costs, std::size_t slot, const RobotParams& robot,
                     Across&& across, CostParts& parts) {
  // What is not sure enough costs, but does not stop the robot.
  const auto believed = [&robot](double part, double confidence) {
    if (confidence >= robot.least_confidence) return part;
    return std::min(1.0, part) * confidence / robot.least_confidence;
  };
  constexpr double kMostDoubt = 0.9;
  const auto limit = static_cast<float>(robot.max_step);
  const float low = std::min(limit, std::max(static_cast<float>(robot.ground_clearance), 1e-3F));
  parts.obstacle =
      believed(double{costs.obstacle[slot] / low}, static_cast<double>(costs.likely[slot]));
  parts.doubt = std::min(kMostDoubt, double{costs.doubt[slot] / limit});
  parts.unknown = cost_of_unseen(costs.ground[slot], robot).parts.unknown;
  if (costs.hole[slot] < 0) return;
  const HoleExtent& hole = costs.holes[static_cast<std::size_t>(costs.hole[slot])];
  const double drop = wheel_drop(static_cast<double>(hole.depth), across(hole), robot.wheel_radius);
  parts.pothole = believed(drop / robot.max_step, static_cast<double>(hole.confidence));
}

// Cost from a slope part that is already known.
// \param across way across a hole, metres
template <class Across>
Cost cost_with(const CellCosts& costs, std::size_t slot, const RobotParams& robot, double slope,
               Across&& across) {
  Cost result;
  // Limits as floats: a step that equals the limit in the file is equal here too.
  result.parts.step = double{costs.step[slot] / static_cast<float>(robot.max_step)};
  const bool known = costs.status[slot] == FeatureStatus::kOk;
  if (known) {
    result.parts.slope = slope;
    result.parts.roughness =
        double{costs.roughness[slot] / static_cast<float>(robot.max_roughness)};
  }
  if (costs.has(CostPart::kObstacle)) add_field_parts(costs, slot, robot, across, result.parts);
  const double largest = result.parts.largest();
  result.cost = std::min(1.0, largest);
  if (largest >= 1.0) {
    result.status = CostStatus::kLethal;
  } else {
    result.status = known ? CostStatus::kOk : CostStatus::kUnknown;
  }
  return result;
}

Cost outside() {
  Cost cost;
  cost.status = CostStatus::kOutside;
  return cost;
}

bool is_missing(const CellCosts& costs, CellId cell) {
  return std::binary_search(costs.missing.begin(), costs.missing.end(), value_of(cell));
}

Cost no_ground() {
  Cost cost;
  cost.status = CostStatus::kLethal;
  cost.cost = cost.parts.pothole = 1.0;
  return cost;
}

// Calls `cost` with the slot of a cell that has one.
template <class CostOfSlot>
Cost cost_in(const ElevationGrid& grid, const CellCosts& costs, CellIndex cell,
             const RobotParams& robot, CostOfSlot&& cost) {
  const Slot slot = grid.slot_at(cell);
  if (slot == kUnobserved && is_missing(costs, grid.geometry.id_of(cell))) return no_ground();
  if (slot != kUnobserved || costs.unseen.empty()) return cost(slot);
  return cost_of_unseen(costs.unseen[static_cast<std::size_t>(value_of(grid.geometry.id_of(cell)))],
                        robot);
}

// The same at a position.
template <class CostOfSlot>
Cost at_position(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
                 const RobotParams& robot, CostOfSlot&& cost) {
  CellIndex cell;
  if (!grid.geometry.cell_at(position.x, position.y, cell)) return outside();
  return cost_in(grid, costs, cell, robot, cost);
}

/// The robot from above.
struct FootprintBox {
  Position2 centre;
  double c, s;                     // of the heading
  double half_length, half_width;  // metres

  // Half extents along the axes of the grid.
  [[nodiscard]] double reach_x() const {
    return half_length * std::abs(c) + half_width * std::abs(s);
  }
  [[nodiscard]] double reach_y() const {
    return half_length * std::abs(s) + half_width * std::abs(c);
  }
  // Whether a square that lies within the reach along x and y is touched: it must not lie beyond
  // one of the four sides either (separating axes).
  [[nodiscard]] bool touches(Position2 square, double half_side) const {
    const double dx = square.x - centre.x, dy = square.y - centre.y;
    const double reach = half_side * (std::abs(c) + std::abs(s));
    return std::abs(c * dx + s * dy) < half_length + reach &&
           std::abs(c * dy - s * dx) < half_width + reach;
  }
};

int rank_of(CostStatus status) {
  constexpr std::array<int, 4> kRank{0, 3, 1, 2};  // ok, lethal, unknown, outside
  return kRank[static_cast<std::size_t>(status)];
}

void raise_to(const Cost& other, Cost& worst) {
  if (rank_of(other.status) > rank_of(worst.status)) worst.status = other.status;
  worst.cost = std::max(worst.cost, other.cost);
  CostParts& parts = worst.parts;
  parts.slope = std::max(parts.slope, other.parts.slope);
  parts.step = std::max(parts.step, other.parts.step);
  parts.roughness = std::max(parts.roughness, other.parts.roughness);
  parts.obstacle = std::max(parts.obstacle, other.parts.obstacle);
  parts.pothole = std::max(parts.pothole, other.parts.pothole);
  parts.unknown = std::max(parts.unknown, other.parts.unknown);
  parts.doubt = std::max(parts.doubt, other.parts.doubt);
}

}  // namespace

int window_reach(const RobotParams& robot, double cell_size) {
  const double cells = std::round(0.5 * robot.footprint_width / cell_size);
  return static_cast<int>(std::clamp(cells, 1.0, double{kMaxReach}));
}

void measure_ground(const GroundPoints& points, const RobotParams& robot, CostWorkspace& workspace,
                    CellCosts& costs) {
  const ElevationGrid& grid = points.grid;
  const std::size_t size = grid.observed();
  const int reach = window_reach(robot, grid.geometry.cell_size());
  fit_local_planes(grid, points.cells, reach, workspace.planes);
  find_surfaces(grid, points.cells, reach, workspace);
  costs.gradient_x.resize(size);
  costs.gradient_y.resize(size);
  costs.step.resize(size);
  costs.roughness.resize(size);
  costs.status.resize(size);
  const Ground ground{grid, points.cells.sums, points.extent, workspace.surfaces,
                      std::tan(robot.max_climb)};
  if (points.cells.skipped != nullptr) write_skipped(*points.cells.skipped, costs);
  CellsAround cells;
  std::size_t slots[kCellLanes];
  for (std::size_t next = 0; next < size;) {
    const std::size_t count = set_lanes(ground, workspace.in_row, next, cells, slots);
    measure_lanes(ground.max_gradient, grid.geometry.cell_size(), cells);
    for (std::size_t lane = 0; lane < count; ++lane) {
      write_lane(ground, cells, lane, slots[lane], workspace.planes, costs);
    }
  }
}

void clear_field_parts(CellCosts& costs) {
  costs.obstacle.clear();
  costs.likely.clear();
  costs.hole.clear();
  costs.doubt.clear();
  costs.ground.clear();
  costs.holes.clear();
  costs.missing.clear();
  costs.unseen.clear();
}

void compute_cell_costs(const ElevationGrid& grid, const RobotParams& robot,
                        CostWorkspace& workspace, CellCosts& costs) {
  clear_field_parts(costs);
  measure_ground({grid, {grid.sums}}, robot, workspace, costs);
}

double CostParts::of(CostPart part) const {
  switch (part) {
    case CostPart::kSlope:
      return slope;
    case CostPart::kStep:
      return step;
    case CostPart::kRoughness:
      return roughness;
    case CostPart::kObstacle:
      return obstacle;
    case CostPart::kPothole:
      return pothole;
    case CostPart::kUnknown:
      return unknown;
    case CostPart::kDoubt:
      return doubt;
  }
  return 0.0;
}

double CostParts::largest() const {
  return std::max({slope, step, roughness, obstacle, pothole, unknown, doubt});
}

double HoleExtent::extent_along(double heading) const {
  const double turn = heading - static_cast<double>(yaw);
  const auto long_side = static_cast<double>(length), short_side = static_cast<double>(width);
  if (!(short_side > 0.0)) return 0.0;
  return 1.0 / std::hypot(std::cos(turn) / long_side, std::sin(turn) / short_side);
}

double wheel_drop(double depth, double extent, double wheel_radius) {
  const double half = 0.5 * extent;
  if (half >= wheel_radius) return depth;
  const double sag = wheel_radius - std::sqrt(wheel_radius * wheel_radius - half * half);
  return std::min(depth, sag);
}

Cost cost_of_unseen(UnseenReason reason, const RobotParams& robot) {
  Cost cost;
  switch (reason) {
    case UnseenReason::kSeen:
      break;
    case UnseenReason::kOutOfView:
      cost.parts.unknown = robot.cost_out_of_view;
      break;
    case UnseenReason::kOccluded:
      cost.parts.unknown = robot.cost_occluded;
      break;
    case UnseenReason::kNoReturn:
      cost.parts.unknown = robot.cost_no_return;
      break;
  }
  cost.cost = cost.parts.unknown;
  return cost;
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
  return cost_with(costs, k, robot, std::max(along, across),
                   [heading](const HoleExtent& hole) { return hole.extent_along(heading); });
}

Cost cost_of(const CellCosts& costs, Slot slot, const RobotParams& robot) {
  if (slot == kUnobserved) return {};
  const auto k = static_cast<std::size_t>(slot);
  assert(k < costs.size());
  const double gx = costs.gradient_x[k];
  const double gy = costs.gradient_y[k];
  const double angle = std::atan(std::sqrt(gx * gx + gy * gy));
  return cost_with(costs, k, robot, angle / std::min(robot.max_climb, robot.max_tilt),
                   [](const HoleExtent& hole) { return static_cast<double>(hole.length); });
}

Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
             const RobotParams& robot, double heading) {
  return at_position(grid, costs, position, robot,
                     [&](Slot slot) { return cost_of(costs, slot, robot, heading); });
}

Cost cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
             const RobotParams& robot) {
  return at_position(grid, costs, position, robot,
                     [&](Slot slot) { return cost_of(costs, slot, robot); });
}

Cost footprint_cost_at(const ElevationGrid& grid, const CellCosts& costs, Position2 position,
                       const RobotParams& robot, double heading) {
  CellIndex centre;
  if (!grid.geometry.cell_at(position.x, position.y, centre)) return outside();
  const FootprintBox box{position, std::cos(heading), std::sin(heading),
                         0.5 * robot.footprint_length, 0.5 * robot.footprint_width};
  const double cell = grid.geometry.cell_size();
  const auto first = [cell](double low, double edge) {
    return static_cast<int>(std::floor((low + edge) / cell));
  };
  const double half_l = grid.geometry.half_length(), half_w = grid.geometry.half_width();
  const double rx = box.reach_x(), ry = box.reach_y();
  Cost worst;
  worst.status = CostStatus::kOk;
  for (int l = first(position.x - rx, half_l); l <= first(position.x + rx, half_l); ++l) {
    for (int w = first(position.y - ry, half_w); w <= first(position.y + ry, half_w); ++w) {
      const CellIndex at{l, w};
      if (!box.touches(grid.geometry.centre_of(at), 0.5 * cell)) continue;
      raise_to(grid.geometry.contains(at)
                   ? cost_in(grid, costs, at, robot,
                             [&](Slot slot) { return cost_of(costs, slot, robot, heading); })
                   : outside(),
               worst);
    }
  }
  return worst;
}

}  // namespace mrpt_terrain
