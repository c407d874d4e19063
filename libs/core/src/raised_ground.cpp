// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/raised_ground.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lanes.h"
#include "surface_levels.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

// The first guess is this level of the reference, cells of 6.4 m.
constexpr int kGuessLevel = 4;
// Steps of asymmetric least squares, with the distance above the plane from which points count
// less; then steps of Tukey's biweight.
constexpr float kCauchyScales[] = {0.4F, 0.2F, 0.1F, 0.05F, 0.03F};
constexpr float kBelow = 30.0F;
constexpr int kTukeySteps = 5;
constexpr float kTukeyLimit = 4.0F;  // standard deviations
constexpr float kFirstSigma = 0.015F;
// The guess of the gradient counts like so many samples 1 m away.
constexpr double kPrior = 0.5;
// An edge is looked for within so many cells; ground beside it lies at most so high, as a share of
// the raised cell's height.
constexpr int kEdgeReach = 2;
constexpr float kSharp = 0.5F;
// What is higher above the reference is not looked at: the reference is never so far too low.
constexpr float kMostLevel = 0.5F;
// Fewer samples, or fewer that count, are no plane.
constexpr std::size_t kFewestSamples = 8;
constexpr double kLeastShare = 0.25;

// More than this many say no more: every other is left out, or two of three...
constexpr std::size_t kMostSamples = 64;

struct Blocks {
  const GridGeometry& geometry;
  int cells;  ///< along a side of a block
  int rows, columns;
  Divisor by_cells;

  Blocks(const GridGeometry& of, double side)
      : geometry(of),
        cells(std::max(1, static_cast<int>(std::lround(side / of.cell_size())))),
        rows((of.cells_l() + cells - 1) / cells),
        columns((of.cells_w() + cells - 1) / cells),
        by_cells(cells) {}
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  [[nodiscard]] std::size_t of(CellIndex cell) const {
    return at(by_cells.quotient_of(cell.l), by_cells.quotient_of(cell.w));
  }
};

void find_blocks(const ElevationGrid& grid, const Blocks& blocks,
                 std::vector<std::int32_t>& block) {
  block.resize(grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot)
    block[slot] = static_cast<std::int32_t>(blocks.of(grid.geometry.index_of(grid.cell[slot])));
}

// Counting sort of the cells' mean points.
void sort_samples(const FieldWorkspace& field, const GroundSegmentation& ground,
                  const Blocks& blocks, RaisedGroundWorkspace& workspace) {
  const std::vector<FieldCellSums>& sums = field.sums;
  const auto is_sample = [&](std::size_t slot) {
    return sums[slot].on > 0 && ground.rule[slot] != GroundRule::kLow;
  };
  workspace.first.assign(blocks.size() + 1, 0);
  for (std::size_t slot = 0; slot < sums.size(); ++slot) {
    if (is_sample(slot)) ++workspace.first[static_cast<std::size_t>(workspace.block[slot]) + 1];
  }
  for (std::size_t b = 1; b < workspace.first.size(); ++b)
    workspace.first[b] += workspace.first[b - 1];
  workspace.samples.resize(static_cast<std::size_t>(workspace.first.back()));
  for (std::size_t slot = 0; slot < sums.size(); ++slot) {
    if (!is_sample(slot)) continue;
    std::int32_t& next = workspace.first[static_cast<std::size_t>(workspace.block[slot])];
    workspace.samples[static_cast<std::size_t>(next++)] = sums[slot].mean_on_ground();
  }
  for (std::size_t b = workspace.first.size() - 1; b > 0; --b)
    workspace.first[b] = workspace.first[b - 1];
  workspace.first[0] = 0;
}

// Samples of three by three blocks about the plane's centre, and one of no weight for every lane
// that is left over.
void collect_window(const Blocks& blocks, int row, int column, const GroundAround& plane,
                    RaisedGroundWorkspace& workspace) {
  GroundWindow& window = workspace.window;
  const int first_row = std::max(row - 1, 0), last_row = std::min(row + 1, blocks.rows - 1);
  // The blocks of a row lie one behind the other.
  const auto begin = [&](int i) {
    return static_cast<std::size_t>(workspace.first[blocks.at(i, std::max(column - 1, 0))]);
  };
  const auto end = [&](int i) {
    const int last = std::min(column + 1, blocks.columns - 1);
    return static_cast<std::size_t>(workspace.first[blocks.at(i, last) + 1]);
  };
  std::size_t samples = 0;
  for (int i = first_row; i <= last_row; ++i) samples += end(i) - begin(i);
  const std::size_t stride = samples / kMostSamples + 1;
  std::size_t skip = 0, next = 0;
  window.resize(kMostSamples + kCellLanes);
  for (int i = first_row; i <= last_row; ++i) {
    std::size_t k = begin(i) + skip;
    for (; k < end(i); k += stride) {
      const GroundSample& sample = workspace.samples[k];
      window.set(next++, sample.x - plane.centre_x, sample.y - plane.centre_y, sample.z, 1.0F);
    }
    skip = k - end(i);
  }
  window.samples = next;
  while (next % kCellLanes != 0) window.set(next++, 0.0F, 0.0F, plane.height, 0.0F);
  window.resize(next);
}

/// Weighted sums for a plane, about its present height.
struct PlaneSums {
  float w = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, z = 0, uz = 0, vz = 0, squares = 0;
};

struct PlaneLanes {
  FloatLanes w = {}, u = {}, v = {}, uu = {}, uv = {}, vv = {}, z = {}, uz = {}, vz = {};
  FloatLanes squares = {};
};

MRPT_TERRAIN_LANES void load_samples(const GroundWindow& window, std::size_t i,
                                     const GroundAround& plane, FloatLanes& u, FloatLanes& v,
                                     FloatLanes& z, FloatLanes& use, FloatLanes& residual) {
  load_from(window.u.data() + i, u);
  load_from(window.v.data() + i, v);
  load_from(window.z.data() + i, z);
  load_from(window.use.data() + i, use);
  z = z - plane.height;
  residual = z - plane.gradient_x * u - plane.gradient_y * v;
}

MRPT_TERRAIN_LANES void add_samples(const FloatLanes& w, const FloatLanes& u, const FloatLanes& v,
                                    const FloatLanes& z, const FloatLanes& residual,
                                    PlaneLanes& sums) {
  const FloatLanes wu = w * u, wv = w * v;
  sums.w += w;
  sums.u += wu;
  sums.v += wv;
  sums.uu += wu * u;
  sums.uv += wu * v;
  sums.vv += wv * v;
  sums.z += w * z;
  sums.uz += wu * z;
  sums.vz += wv * z;
  sums.squares += w * residual * residual;
}

MRPT_TERRAIN_LANES float total(const FloatLanes& lanes) {
  float value[kCellLanes];
  std::memcpy(value, &lanes, sizeof(value));
  float sum = 0.0F;
  for (const float lane : value) sum += lane;
  return sum;
}

MRPT_TERRAIN_LANES void add_up(const PlaneLanes& lanes, PlaneSums& sums) {
  sums = {total(lanes.w),  total(lanes.u), total(lanes.v),  total(lanes.uu), total(lanes.uv),
          total(lanes.vv), total(lanes.z), total(lanes.uz), total(lanes.vz), total(lanes.squares)};
}

// Asymmetric least squares: what lies far above counts little, what lies below kBelow times.
MRPT_TERRAIN_WIDE_REGISTERS
void sum_asymmetric(const GroundWindow& window, const GroundAround& plane, float scale,
                    PlaneSums& sums) {
  PlaneLanes lanes;
  const float share = 1.0F / (scale * scale);
  for (std::size_t i = 0; i < window.u.size(); i += kCellLanes) {
    FloatLanes u, v, z, use, residual;
    load_samples(window, i, plane, u, v, z, use, residual);
    const FloatLanes above = 1.0F / (1.0F + share * residual * residual);
    const FloatLanes below = use * 0.0F + kBelow;
    const FloatLanes w = use * (residual < 0.0F ? below : above);
    add_samples(w, u, v, z, residual, lanes);
  }
  add_up(lanes, sums);
}

// Tukey's biweight.
MRPT_TERRAIN_WIDE_REGISTERS
void sum_biweight(const GroundWindow& window, const GroundAround& plane, float limit,
                  PlaneSums& sums) {
  PlaneLanes lanes;
  const float per_square = 1.0F / (limit * limit);
  for (std::size_t i = 0; i < window.u.size(); i += kCellLanes) {
    FloatLanes u, v, z, use, residual;
    load_samples(window, i, plane, u, v, z, use, residual);
    const FloatLanes share = 1.0F - per_square * residual * residual;
    const FloatLanes none = use * 0.0F;
    const FloatLanes w = use * (share > 0.0F ? share * share : none);
    add_samples(w, u, v, z, residual, lanes);
  }
  add_up(lanes, sums);
}

/// Symmetric 3 x 3 matrix: rows of the upper triangle.
struct Symmetric3 {
  double xx, xy, xz, yy, yz, zz;

  [[nodiscard]] Symmetric3 inverse() const {
    const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
    const double scale = 1.0 / (xx * a + xy * b + xz * c);
    return {a * scale,
            b * scale,
            c * scale,
            (xx * zz - xz * xz) * scale,
            (xy * xz - xx * yz) * scale,
            (xx * yy - xy * xy) * scale};
  }
};

// One step of least squares, the gradient held to that of the guess.
// \return covariance of height and gradient over the variance of a sample
Symmetric3 take_step(const PlaneSums& s, float guess_x, float guess_y, GroundAround& plane) {
  const Symmetric3 inverse =
      Symmetric3{s.w, s.u, s.v, s.uu + kPrior, s.uv, s.vv + kPrior}.inverse();
  const double z = s.z, x = s.uz + kPrior * guess_x, y = s.vz + kPrior * guess_y;
  plane.height += static_cast<float>(inverse.xx * z + inverse.xy * x + inverse.xz * y);
  plane.gradient_x = static_cast<float>(inverse.xy * z + inverse.yy * x + inverse.yz * y);
  plane.gradient_y = static_cast<float>(inverse.xz * z + inverse.yz * x + inverse.zz * y);
  return inverse;
}

void fit_plane(const GroundWindow& window, const RaisedGroundParams& params, GroundAround& plane) {
  const float guess_x = plane.gradient_x, guess_y = plane.gradient_y;
  PlaneSums sums;
  for (const float scale : kCauchyScales) {
    sum_asymmetric(window, plane, scale, sums);
    take_step(sums, guess_x, guess_y, plane);
  }
  const auto least = static_cast<float>(params.sigma_min);
  plane.sigma = std::max(kFirstSigma, least);
  Symmetric3 spread{};
  for (int k = 0; k < kTukeySteps; ++k) {
    sum_biweight(window, plane, kTukeyLimit * plane.sigma, sums);
    if (sums.w < kLeastShare * static_cast<double>(window.samples)) return;
    spread = take_step(sums, guess_x, guess_y, plane);
    plane.sigma = std::max(std::sqrt(sums.squares / sums.w) * 1.1F, least);
  }
  if (plane.sigma > static_cast<float>(params.sigma_max)) return;
  int k = 0;
  for (const double value : {spread.xx, spread.xy, spread.xz, spread.yy, spread.yz, spread.zz})
    plane.spread[k++] = static_cast<float>(value);
  plane.known = true;
}

void fit_planes(const FieldWorkspace& field, const Blocks& blocks, const RaisedGroundParams& params,
                RaisedGroundWorkspace& workspace) {
  const LevelView guess =
      view_of_level(field.surface_workspace, field.surface.lattice(), kGuessLevel);
  workspace.around.assign(blocks.size(), {});
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      const std::size_t at = blocks.at(row, column);
      if (workspace.first[at] == workspace.first[at + 1]) continue;
      const int half = blocks.cells / 2;
      const Position2 centre = blocks.geometry.centre_of(
          {std::min(row * blocks.cells + half, blocks.geometry.cells_l() - 1),
           std::min(column * blocks.cells + half, blocks.geometry.cells_w() - 1)});
      GroundAround& plane = workspace.around[at];
      plane.centre_x = static_cast<float>(centre.x);
      plane.centre_y = static_cast<float>(centre.y);
      const LevelView::Linear first = guess.at(plane.centre_x, plane.centre_y);
      plane.height = first.height;
      plane.gradient_x = first.gradient_x;
      plane.gradient_y = first.gradient_y;
      collect_window(blocks, row, column, plane, workspace);
      if (workspace.window.samples >= kFewestSamples) fit_plane(workspace.window, params, plane);
    }
  }
}

// Looks in four directions for the first observed cell within two cells.
void look_at_edges(const ElevationGrid& grid, const FieldWorkspace& field,
                   const GroundSegmentation& ground, const RaisedGroundWorkspace& workspace,
                   FieldCells& cells) {
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (cells.raised[slot] == 0) continue;
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    const GroundAround& plane = workspace.around[static_cast<std::size_t>(workspace.block[slot])];
    const float height = 0.5F * (cells.raised_low[slot] + cells.raised_high[slot]);
    for (const CellIndex direction :
         {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
      Slot other = kUnobserved;
      for (int k = 1; k <= kEdgeReach && other == kUnobserved; ++k)
        other = grid.slot_at({at.l + k * direction.l, at.w + k * direction.w});
      if (other == kUnobserved) continue;
      const auto o = static_cast<std::size_t>(other);
      if (!ground.is_ground(o) || cells.raised[o] > 0 || cells.on[o] == 0) continue;
      const GroundSample mean = field.sums[o].mean_on_ground();
      const float beside = mean.z - plane.height_at(mean.x, mean.y);
      ++(beside < kSharp * height ? cells.sharp_edges : cells.smooth_edges)[slot];
    }
  }
}

// Non-ground cells that are no higher than the plane around.
void find_level_cells(const ElevationGrid& grid, const GroundSegmentation& ground,
                      const RaisedGroundWorkspace& workspace, float least, FieldCells& cells) {
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (ground.rule[slot] != GroundRule::kHigh || cells.high[slot] > kMostLevel) continue;
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    const GroundAround& plane = workspace.around[static_cast<std::size_t>(workspace.block[slot])];
    if (!plane.known) continue;
    const Position2 centre = grid.geometry.centre_of(at);
    const float around =
        plane.height_at(static_cast<float>(centre.x), static_cast<float>(centre.y));
    cells.level[slot] = grid.h_max[slot] < around + least ? 1 : 0;
  }
}

}  // namespace

void find_raised_ground(const PointsView& points, const FieldWorkspace& field,
                        const ElevationGrid& grid, const GroundSegmentation& ground,
                        const PointSlots& point_slots, const RaisedGroundParams& params,
                        RaisedGroundWorkspace& workspace, FieldCells& cells) {
  const std::size_t n = grid.observed();
  cells.raised.assign(n, 0);
  cells.raised_low.assign(n, 0.0F);
  cells.raised_high.assign(n, 0.0F);
  cells.sharp_edges.assign(n, 0);
  cells.smooth_edges.assign(n, 0);
  cells.level.assign(n, 0);
  workspace.height.assign(points.size, 0.0F);
  if (field.surface.height.empty()) return;
  const Blocks blocks(grid.geometry, params.block);
  find_blocks(grid, blocks, workspace.block);
  sort_samples(field, ground, blocks, workspace);
  fit_planes(field, blocks, params, workspace);
  const auto least = static_cast<float>(params.least_height);
  const auto sigmas = static_cast<float>(params.sigmas);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (point_slots[i] < 0 || field.points.support[i] != Support::kGround) continue;
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (ground.rule[slot] == GroundRule::kLow) continue;
    const GroundAround& plane = workspace.around[static_cast<std::size_t>(workspace.block[slot])];
    if (!plane.known) continue;
    const float height = points.z[i] - plane.height_at(points.x[i], points.y[i]);
    if (height < least) continue;
    const float sigma = plane.sigma * std::sqrt(1.0F + plane.leverage_at(points.x[i], points.y[i]));
    if (height < least + sigmas * sigma) continue;
    workspace.height[i] = height;
    cells.raised_low[slot] =
        cells.raised[slot] == 0 ? height : std::min(cells.raised_low[slot], height);
    cells.raised_high[slot] = std::max(cells.raised_high[slot], height);
    ++cells.raised[slot];
  }
  look_at_edges(grid, field, ground, workspace, cells);
  find_level_cells(grid, ground, workspace, least, cells);
}

const GroundAround* ground_around(const GridGeometry& geometry, const RaisedGroundParams& params,
                                  const RaisedGroundWorkspace& workspace, double x, double y) {
  CellIndex cell;
  if (workspace.around.empty() || !geometry.cell_at(x, y, cell)) return nullptr;
  return &workspace.around[Blocks(geometry, params.block).of(cell)];
}

}  // namespace mrpt_terrain
