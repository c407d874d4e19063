// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/decks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "entered_decks.h"
#include "length_of.h"
#include "mrpt_terrain/core/beam_slope.h"
#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Cells of a deck are at most this many cells apart: rings leave gaps.
constexpr int kReach = 3;
// Height that two cells of a deck may differ by besides its slope, metres.
constexpr float kSlack = 0.04F;
// Points up to this far below the highest of a cell are its top, metres.
constexpr float kTopLayer = 0.04F;
// A deck of fewer cells shows no surface.
constexpr std::size_t kFewestCells = 4;
// The surface at a cell is the plane through the layers of the cells of the deck around it: up to
// this many cells away, or this many where there are fewer than kFewestLayers.
constexpr int kNearReach = 1;
constexpr int kFarReach = 2;
constexpr float kFewestLayers = 4.0F;
// Holds the gradient of a plane to zero where layers lie in line, m^2.
constexpr float kHold = 0.002F;
// Points of the side of a slope are this many times as far below its surface: where it bends, its
// own points are below the plane.
constexpr float kSlopeSide = 4.0F;
// Through the cells so far away, no plane fits stairs, even where each ring around one cell meets a
// step of its own. Where a ramp ends or bends, none fits it either; but it has a face, on which
// this share of the cells is even, by this many times the unevenness.
constexpr int kWideReach = 3;
constexpr float kEvenShare = 0.3F;
constexpr float kWideUnevenness = 2.0F;
// Beams that end so many times as far below a surface as points of its side begin have entered it.
constexpr float kDeep = 2.0F;
// Fewest cells with a plane that tell how even a deck is.
constexpr std::size_t kFewestPlanes = 3;
// A ramp rises by more than this over the ground, m/m.
constexpr float kLeastSlope = 0.04F;
// Fewest points of a surface around a cell.
constexpr float kFewestPoints = 8.0F;
// Holds the inclination of a surface to level where a single ring is seen, m^2.
constexpr float kInclinationHold = 0.02F;
// Beams meet no surface at a flatter angle than of this sine: errors of the plane would have a say.
constexpr float kLeastSine = 0.02F;
// Sine for remembered points, as if they had been seen from 5 m by a sensor 0.8 m high.
constexpr float kUnknownSine = 0.16F;
// Where the beams start if that is not known: the sensor of a small robot.
constexpr std::array<float, 3> kUnknownOrigin{0.0F, 0.0F, 1.0F};

// Medians over the cells of a deck, or of one cell.
struct SurfaceFit {
  float bend;   // RMS of the layers around about their plane, metres
  float slope;  // gradient of their heights above the ground
};

/// The search for one deck.
struct DeckSearch {
  const ElevationGrid& grid;
  const GroundSegmentation& ground;
  const FieldCells& cells;
  const DeckParams& params;
  DeckWorkspace& workspace;
  float rise;  ///< greatest difference in height per metre

  [[nodiscard]] const DeckLayer& top(std::size_t slot) const { return workspace.top[slot]; }
  [[nodiscard]] bool connected(std::size_t a, std::size_t b) const {
    const float apart = std::abs(top(a).above - top(b).above);
    if (apart <= kSlack) return true;  // most are, wherever they lie
    return apart <= kSlack + rise * length_of(top(a).x - top(b).x, top(a).y - top(b).y);
  }
  /// Whether ground alone is seen in one of the cells between two.
  [[nodiscard]] bool divided(CellIndex a, CellIndex b) const {
    return any_slot_between(
        grid, a, b, [this](std::size_t slot) { return ground.rule[slot] == GroundRule::kGround; });
  }
};

void choose_candidates(const ElevationGrid& grid, const GroundSegmentation& ground,
                       const DeckParams& params, const FieldCells& cells,
                       DeckWorkspace& workspace) {
  workspace.candidate_cells.clear(grid.geometry);
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    const bool thin = cells.high[slot] - cells.low[slot] <= static_cast<float>(params.thickness) ||
                      cells.high[slot] <= static_cast<float>(params.curb_height);
    const bool candidate = ground.rule[slot] == GroundRule::kHigh && thin;
    workspace.candidate[slot] = candidate ? 1 : 0;
    if (!candidate) continue;
    workspace.candidate_cells.mark(grid.geometry.index_of(grid.cell[slot]));
    workspace.all[slot] = workspace.top[slot] = DeckLayer{};
  }
}

// Mean place and height of the points of every candidate, and of its highest.
void measure_layers(const PointsView& scan, const FieldPoints& points,
                    const PointSlots& point_slots, const FieldCells& cells,
                    DeckWorkspace& workspace) {
  workspace.points.clear();
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    if (point_slots[i] < 0 || points.support[i] != Support::kAbove) continue;
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (workspace.candidate[slot] == 0) continue;
    workspace.points.push_back(static_cast<std::int32_t>(i));
    const float height = points.height[i];
    workspace.all[slot].add(scan.x[i], scan.y[i], scan.z[i], height);
    if (height >= cells.high[slot] - kTopLayer)
      workspace.top[slot].add(scan.x[i], scan.y[i], scan.z[i], height);
  }
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    if (workspace.candidate[slot] == 0) continue;
    workspace.all[slot].finish();
    workspace.top[slot].finish();
  }
}

void collect_members(const DeckSearch& search, std::size_t first) {
  const ElevationGrid& grid = search.grid;
  DeckWorkspace& workspace = search.workspace;
  const auto take = [&](CellIndex cell, std::size_t slot) {
    workspace.candidate[slot] = 0;
    workspace.candidate_cells.unmark(cell);
    workspace.members.push_back(static_cast<std::int32_t>(slot));
  };
  workspace.members.clear();
  take(grid.geometry.index_of(grid.cell[first]), first);
  for (std::size_t next = 0; next < workspace.members.size(); ++next) {
    const auto slot = static_cast<std::size_t>(workspace.members[next]);
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    workspace.candidate_cells.for_marked_around(at, kReach, [&](CellIndex cell) {
      const auto other = static_cast<std::size_t>(grid.slot_within(cell));
      if (search.connected(slot, other) && !search.divided(at, cell)) take(cell, other);
    });
  }
}

void mark_members(const DeckSearch& search, bool marked) {
  const ElevationGrid& grid = search.grid;
  CellBits& bits = search.workspace.member_cells;
  for (const std::int32_t member : search.workspace.members) {
    const CellIndex cell = grid.geometry.index_of(grid.cell[static_cast<std::size_t>(member)]);
    if (marked) {
      bits.mark(cell);
    } else {
      bits.unmark(cell);
    }
  }
}

/// The layers of the cells of a deck around one of them.
struct LayersAround {
  std::array<const DeckLayer*, (2 * kWideReach + 1) * (2 * kWideReach + 1)> layer;
  std::size_t size = 0;

  LayersAround(const DeckSearch& search, const std::vector<DeckLayer>& layers, CellIndex cell,
               int reach) {
    search.workspace.member_cells.for_marked_around(cell, reach, [&](CellIndex other) {
      layer[size++] = &layers[static_cast<std::size_t>(search.grid.slot_within(other))];
    });
  }
  void leave_out_below(const DeckPlane& plane, float side) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < size; ++k) {
      layer[kept] = layer[k];
      kept += layer[k]->z < plane.at(layer[k]->x, layer[k]->y) - side ? 0 : 1;
    }
    size = kept;
  }
  /// About one of them; `height`: which one of their heights.
  [[nodiscard]] HeightSums sums(const DeckLayer& at, float DeckLayer::*height) const {
    HeightSums sums;
    for (std::size_t k = 0; k < size; ++k)
      sums.add(layer[k]->x - at.x, layer[k]->y - at.y, layer[k]->*height - at.*height);
    return sums;
  }
};

// The surface of a deck at one of its cells: a plane through the layers of the cells up to `reach`
// cells away, those of sides left out by a second look.
// \param fit its slope is measured if `sloped`
// \return whether enough layers lie around
bool fit_surface(const DeckSearch& search, const std::vector<DeckLayer>& layers, std::size_t slot,
                 int reach, bool sloped, DeckPlane& plane, SurfaceFit& fit) {
  const DeckLayer& at = layers[slot];
  plane = {at.x, at.y, at.z, 0.0F, 0.0F, 0.0F};
  LayersAround around(search, layers, search.grid.geometry.index_of(search.grid.cell[slot]), reach);
  if (static_cast<float>(around.size) < kFewestLayers) return false;
  float variance = 0.0F;
  const auto fit_through = [&] {
    const SumsPlane through = fit_plane(around.sums(at, &DeckLayer::z), kHold);
    plane = {at.x, at.y, at.z + through.at_centre(), through.gradient_x, through.gradient_y, 0.0F};
    variance = through.variance;
  };
  fit_through();
  const LayersAround all = around;
  around.leave_out_below(plane, static_cast<float>(search.params.side));
  if (static_cast<float>(around.size) < kFewestLayers) around = all;
  if (around.size < all.size) fit_through();
  fit.bend = std::sqrt(variance);
  if (!sloped) return true;
  const SumsPlane over_ground = fit_plane(around.sums(at, &DeckLayer::above), kHold);
  fit.slope = length_of(over_ground.gradient_x, over_ground.gradient_y);
  return true;
}

// The value that a share of others is less than.
float quantile_of(std::vector<float>& values, float share) {
  const float place = share * static_cast<float>(values.size());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

float median_of(std::vector<float>& values) { return quantile_of(values, 0.5F); }

// Fits the planes at the cells of a deck.
// \param[out] fit medians over them; of the slopes only if `sloped`
// \return whether there are enough
bool fit_surfaces(const DeckSearch& search, const std::vector<DeckLayer>& layers, bool sloped,
                  SurfaceFit& fit) {
  DeckWorkspace& workspace = search.workspace;
  workspace.bends.clear();
  workspace.slopes.clear();
  workspace.planes.clear();
  for (const std::int32_t member : workspace.members) {
    const auto slot = static_cast<std::size_t>(member);
    DeckPlane plane;
    SurfaceFit here{};
    if (fit_surface(search, layers, slot, kNearReach, sloped, plane, here) ||
        fit_surface(search, layers, slot, kFarReach, sloped, plane, here)) {
      workspace.bends.push_back(here.bend);
      if (sloped) workspace.slopes.push_back(here.slope);
    }
    workspace.planes.push_back(plane);
  }
  if (workspace.bends.size() < kFewestPlanes) return false;
  fit.bend = median_of(workspace.bends);
  if (sloped) fit.slope = median_of(workspace.slopes);
  return true;
}

enum class DeckKind { kNone, kLevel, kRamp, kTerrace };

// Whether a wheel gets onto a deck, by its size.
DeckKind kind_of(const DeckSearch& search) {
  const DeckParams& params = search.params;
  const std::vector<std::int32_t>& members = search.workspace.members;
  if (members.size() < kFewestCells) return DeckKind::kNone;
  float lowest = 1e9F, highest = -1e9F;
  for (const std::int32_t member : members) {
    lowest = std::min(lowest, search.top(static_cast<std::size_t>(member)).above);
    highest = std::max(highest, search.top(static_cast<std::size_t>(member)).above);
  }
  const double cell = search.grid.geometry.cell_size();
  const CellBox box = cells_around(search.grid, all_of(members), 0.0);
  const double length = cell * std::hypot(box.high.l - box.low.l + 1, box.high.w - box.low.w + 1);
  const double area = static_cast<double>(members.size()) * cell * cell;
  const bool ramp = lowest <= params.foot && highest - lowest >= params.least_rise;
  const bool curb = highest <= params.curb_height && length >= params.curb_length;
  const bool terrace = lowest <= params.terrace_height && area >= params.terrace_area;
  return curb      ? DeckKind::kLevel
         : terrace ? DeckKind::kTerrace
         : ramp    ? DeckKind::kRamp
                   : DeckKind::kNone;
}

// Whether the cells of a deck are even, and their planes. A slope is told by the means of its
// cells, a narrow level by their tops, as its sides are in the same cells.
bool is_even(const DeckSearch& search, DeckKind kind) {
  const DeckWorkspace& workspace = search.workspace;
  const bool level = kind == DeckKind::kLevel, sloped = kind == DeckKind::kRamp;
  SurfaceFit fit{};
  for (const bool by_tops : {level, !level}) {
    if (!fit_surfaces(search, by_tops ? workspace.top : workspace.all, sloped, fit)) continue;
    if (sloped && fit.slope < kLeastSlope) continue;
    if (fit.bend <= static_cast<float>(search.params.unevenness)) return true;
  }
  return false;
}

// Whether a part of a deck is even over more than the next cells, as no part of stairs is.
bool has_wide_part(const DeckSearch& search) {
  DeckWorkspace& workspace = search.workspace;
  for (const auto* layers : {&workspace.all, &workspace.top}) {
    workspace.bends.clear();
    for (const std::int32_t member : workspace.members) {
      DeckPlane plane;
      SurfaceFit here{};
      if (fit_surface(search, *layers, static_cast<std::size_t>(member), kWideReach, false, plane,
                      here))
        workspace.bends.push_back(here.bend);
    }
    if (workspace.bends.empty()) continue;
    const auto limit = kWideUnevenness * static_cast<float>(search.params.unevenness);
    if (quantile_of(workspace.bends, kEvenShare) <= limit) return true;
  }
  return false;
}

// How far below the surface points are of a side. Where a slope bends, its own points are below the
// plane, so that only cells that hold more than it rises in them are taken to hold its side.
float side_of(const DeckSearch& search, DeckKind kind, std::size_t slot, const DeckPlane& plane) {
  const auto side = static_cast<float>(search.params.side);
  const auto diagonal = static_cast<float>(1.414 * search.grid.geometry.cell_size());
  const float rise = diagonal * length_of(plane.gradient_x, plane.gradient_y);
  const bool upright = search.cells.high[slot] - search.cells.low[slot] > rise + 2.0F * side;
  return kind == DeckKind::kLevel || upright ? side : kSlopeSide * side;
}

// Sums of the points on the surfaces of the decks, about the middles of the cells' tops.
void sum_surface_points(const PointsView& scan, const PointSlots& point_slots, std::size_t measured,
                        const FieldCells& cells, const DeckParams& params,
                        DeckWorkspace& workspace) {
  const auto side = static_cast<float>(params.side);
  // Entries of cells without deck are never looked at.
  workspace.sums.resize(cells.size());
  workspace.remembered.resize(measured < point_slots.size() ? cells.size() : 0);
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    if (cells.deck[slot] < 0) continue;
    workspace.sums[slot] = {};
    if (!workspace.remembered.empty()) workspace.remembered[slot] = {};
  }
  for (const std::int32_t point : workspace.points) {
    const auto i = static_cast<std::size_t>(point);
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (cells.deck[slot] < 0) continue;
    const DeckPlane& plane = cells.deck_plane[slot];
    if (scan.z[i] < plane.at(scan.x[i], scan.y[i]) - side) continue;
    (i < measured ? workspace.sums : workspace.remembered)[slot].add(
        scan.x[i] - plane.x, scan.y[i] - plane.y, scan.z[i] - plane.height);
  }
}

// Sums of the points on the surface around a cell of a deck, about its plane's middle.
HeightSums sums_around(const DeckSearch& search, const std::vector<HeightSums>& of_cells,
                       std::size_t slot) {
  const FieldCells& cells = search.cells;
  const DeckPlane& at = cells.deck_plane[slot];
  HeightSums sums;
  for_slots_around(search.grid, slot, kNearReach, [&](std::size_t other) {
    if (cells.deck[other] != cells.deck[slot]) return;
    const DeckPlane& from = cells.deck_plane[other];
    sums.add_shifted(of_cells[other], from.x - at.x, from.y - at.y, from.height - at.height);
  });
  return sums;
}

// How much the points on the surface around a cell scatter along the beams, over what range noise
// and a smooth surface that is grazed by them explain; negative if there are too few. Of one ring
// alone, too: where it enters something loose, such as grass, it is no line.
float scatter_at(const DeckSearch& search, const std::array<float, 3>& origin, std::size_t slot) {
  const DeckPlane& at = search.cells.deck_plane[slot];
  const HeightSums sums = sums_around(search, search.workspace.sums, slot);
  if (sums.n() < kFewestPoints) return -1.0F;
  const SumsPlane plane = fit_plane(sums, kInclinationHold);
  const float x = at.x + plane.mean_x - origin[0];
  const float y = at.y + plane.mean_y - origin[1];
  const float z = at.height + plane.mean_z - origin[2];
  const float range = std::max(std::sqrt(x * x + y * y + z * z), 1e-3F);
  const float length =
      std::sqrt(1.0F + plane.gradient_x * plane.gradient_x + plane.gradient_y * plane.gradient_y);
  const float sine = std::abs(plane.gradient_x * x + plane.gradient_y * y - z) / (range * length);
  const auto noise = static_cast<float>(search.params.beam_sigma);
  const float surface =
      static_cast<float>(search.params.surface_sigma) / std::max(sine, kLeastSine);
  const HeightMoments moments(sums);
  const float along =
      variance_along(moments.variances, moments.covariances, {x / range, y / range, z / range});
  return std::sqrt(along / (noise * noise + surface * surface));
}

// The same for remembered points, of which it is not known from where they were seen.
float remembered_scatter_at(const DeckSearch& search, std::size_t slot) {
  const HeightSums sums = sums_around(search, search.workspace.remembered, slot);
  if (sums.n() < kFewestPoints) return -1.0F;
  const SumsPlane plane = fit_plane(sums, kHold);
  const float length =
      std::sqrt(1.0F + plane.gradient_x * plane.gradient_x + plane.gradient_y * plane.gradient_y);
  const float noise = kUnknownSine * static_cast<float>(search.params.beam_sigma);
  const auto surface = static_cast<float>(search.params.surface_sigma);
  return std::sqrt(plane.variance / (noise * noise + surface * surface)) / length;
}

// Tells decks whose points scatter as those of a surface do (1) from those that scatter more (-1)
// by the median over their cells, where enough cells of a deck say something.
void judge_scatter(DeckWorkspace& workspace) {
  std::sort(workspace.scatter.begin(), workspace.scatter.end());
  for (std::size_t first = 0; first < workspace.scatter.size();) {
    const std::int32_t deck = workspace.scatter[first].first;
    std::size_t last = first;
    while (last < workspace.scatter.size() && workspace.scatter[last].first == deck) ++last;
    const float median = workspace.scatter[first + (last - first) / 2].second;
    if (last - first >= kFewestPlanes)
      workspace.deck_number[static_cast<std::size_t>(deck)] = median <= 1.0F ? 1 : -1;
    first = last;
  }
}

// Drops decks whose points scatter more than those of a surface, of which remembered points have a
// say only where the scan itself shows too little, and those that beams enter; numbers those that
// are left.
void drop_loose_decks(const DeckSearch& search, const std::array<float, 3>& origin,
                      std::int32_t decks, FieldCells& cells) {
  DeckWorkspace& workspace = search.workspace;
  workspace.deck_number.assign(static_cast<std::size_t>(decks), 0);
  const auto judge = [&](auto&& scatter_of) {
    workspace.scatter.clear();
    for (std::size_t slot = 0; slot < cells.size(); ++slot) {
      const std::int32_t deck = cells.deck[slot];
      if (deck < 0 || workspace.deck_number[static_cast<std::size_t>(deck)] != 0) continue;
      const float scatter = scatter_of(slot);
      if (scatter >= 0.0F) workspace.scatter.push_back({deck, scatter});
    }
    judge_scatter(workspace);
  };
  judge([&](std::size_t slot) { return scatter_at(search, origin, slot); });
  if (!workspace.remembered.empty())
    judge([&](std::size_t slot) { return remembered_scatter_at(search, slot); });
  std::int32_t left = 0;
  for (std::size_t k = 0; k < workspace.deck_number.size(); ++k) {
    const bool firm = workspace.deck_number[k] > 0 && !is_entered(workspace.depth_of_deck[k]);
    workspace.deck_number[k] = firm ? left++ : -1;
  }
  for (std::int32_t& deck : cells.deck)
    if (deck >= 0) deck = workspace.deck_number[static_cast<std::size_t>(deck)];
}

}  // namespace

void find_decks(const ScanView& scan, const FieldPoints& points, const PointSlots& point_slots,
                const ElevationGrid& grid, const GroundSegmentation& ground,
                const DeckParams& params, DeckWorkspace& workspace, FieldCells& cells) {
  const std::size_t n = grid.observed();
  workspace.candidate.resize(n);
  workspace.all.resize(n);
  workspace.top.resize(n);
  workspace.member_cells.clear(grid.geometry);
  cells.deck.assign(n, -1);
  cells.deck_plane.resize(n);
  choose_candidates(grid, ground, params, cells, workspace);
  measure_layers(scan.points, points, point_slots, cells, workspace);
  const DeckSearch search{grid,   ground,    cells,
                          params, workspace, static_cast<float>(std::tan(params.max_slope))};
  std::int32_t found = 0;
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (workspace.candidate[slot] == 0) continue;
    collect_members(search, slot);
    const DeckKind kind = kind_of(search);
    if (kind == DeckKind::kNone) continue;
    mark_members(search, true);
    if (is_even(search, kind) && (kind != DeckKind::kRamp || has_wide_part(search))) {
      for (std::size_t k = 0; k < workspace.members.size(); ++k) {
        const auto member = static_cast<std::size_t>(workspace.members[k]);
        cells.deck[member] = found;
        cells.deck_plane[member] = workspace.planes[k];
        cells.deck_plane[member].side = side_of(search, kind, member, workspace.planes[k]);
      }
      ++found;
    }
    mark_members(search, false);
  }
  measure_deck_depths(scan.points, point_slots, scan.origins.measured, grid, cells,
                      kDeep * static_cast<float>(params.side), found, workspace);
  sum_surface_points(scan.points, point_slots, scan.origins.measured, cells, params, workspace);
  // A moving sensor sees a deck from nearly the same place.
  drop_loose_decks(search, scan.origins.known() ? scan.origins.of(0) : kUnknownOrigin, found,
                   cells);
}

}  // namespace mrpt_terrain
