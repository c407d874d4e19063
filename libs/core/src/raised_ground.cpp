// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/raised_ground.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "surface_levels.h"

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
constexpr float kPrior = 0.5F;
// An edge is looked for within so many cells; ground beside it lies at most so high, as a share of
// the raised cell's height.
constexpr int kEdgeReach = 2;
constexpr float kSharp = 0.5F;
// Fewer samples, or fewer that count, are no plane.
constexpr std::size_t kFewestSamples = 8;
// More than this many say no more: every other is left out, or two of three...
constexpr std::size_t kMostSamples = 64;
constexpr float kLeastShare = 0.25F;

struct Blocks {
  const GridGeometry& geometry;
  int cells;  ///< along a side of a block
  int rows, columns;

  Blocks(const GridGeometry& of, double side)
      : geometry(of),
        cells(std::max(1, static_cast<int>(std::lround(side / of.cell_size())))),
        rows((of.cells_l() + cells - 1) / cells),
        columns((of.cells_w() + cells - 1) / cells) {}
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  [[nodiscard]] std::size_t of(CellIndex cell) const { return at(cell.l / cells, cell.w / cells); }
};

void sum_ground(const PointsView& points, const FieldPoints& field, const PointSlots& point_slots,
                std::size_t slots, std::vector<RaisedGroundWorkspace::Sums>& sums) {
  sums.assign(slots, {});
  for (std::size_t i = 0; i < points.size; ++i) {
    if (point_slots[i] < 0 || field.support[i] != Support::kGround) continue;
    RaisedGroundWorkspace::Sums& to = sums[static_cast<std::size_t>(point_slots[i])];
    to.x += points.x[i];
    to.y += points.y[i];
    to.z += points.z[i];
    to.n += 1.0F;
  }
}

// Counting sort of the cells' mean points.
void sort_samples(const ElevationGrid& grid, const GroundSegmentation& ground, const Blocks& blocks,
                  RaisedGroundWorkspace& workspace) {
  const auto is_sample = [&](std::size_t slot) {
    return workspace.sums[slot].n > 0.0F && ground.rule[slot] != GroundRule::kLow;
  };
  workspace.first.assign(blocks.size() + 1, 0);
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (is_sample(slot)) ++workspace.first[blocks.of(grid.geometry.index_of(grid.cell[slot])) + 1];
  }
  for (std::size_t b = 1; b < workspace.first.size(); ++b)
    workspace.first[b] += workspace.first[b - 1];
  workspace.samples.resize(static_cast<std::size_t>(workspace.first.back()));
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (!is_sample(slot)) continue;
    const RaisedGroundWorkspace::Sums& from = workspace.sums[slot];
    std::int32_t& next = workspace.first[blocks.of(grid.geometry.index_of(grid.cell[slot]))];
    workspace.samples[static_cast<std::size_t>(next++)] = {from.x / from.n, from.y / from.n,
                                                           from.z / from.n};
  }
  for (std::size_t b = workspace.first.size() - 1; b > 0; --b)
    workspace.first[b] = workspace.first[b - 1];
  workspace.first[0] = 0;
}

void collect_window(const Blocks& blocks, int row, int column, RaisedGroundWorkspace& workspace) {
  workspace.window.clear();
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
  std::size_t skip = 0;
  for (int i = first_row; i <= last_row; ++i) {
    std::size_t k = begin(i) + skip;
    for (; k < end(i); k += stride) workspace.window.push_back(workspace.samples[k]);
    skip = k - end(i);
  }
}

/// Weighted least squares of the plane with the prior on its gradient.
struct PlaneSystem {
  float w = 0.0F, u = 0.0F, v = 0.0F, uu = 0.0F, uv = 0.0F, vv = 0.0F;  ///< sums of weight
  float z = 0.0F, uz = 0.0F, vz = 0.0F;
  float squares = 0.0F;  ///< of the residuals, m^2

  [[nodiscard]] Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d result;
    result << w, u, v, u, uu + kPrior, uv, v, uv, vv + kPrior;
    return result;
  }
};

// Heights are about the plane so far, which solves for its change.
template <class Weight>
PlaneSystem step(const std::vector<GroundSample>& samples, const Eigen::Vector2f& gradient,
                 GroundAround& plane, Weight&& weight) {
  PlaneSystem system;
  for (const GroundSample& sample : samples) {
    const float u = sample.x - plane.centre_x, v = sample.y - plane.centre_y;
    const float z = sample.z - (plane.height + plane.gradient_x * u + plane.gradient_y * v);
    const float w = weight(z);
    system.w += w;
    system.u += w * u;
    system.v += w * v;
    system.uu += w * u * u;
    system.uv += w * u * v;
    system.vv += w * v * v;
    system.z += w * z;
    system.uz += w * u * z;
    system.vz += w * v * z;
    system.squares += w * z * z;
  }
  if (system.w <= 0.0F) return system;
  const Eigen::Vector3d right(system.z, system.uz + kPrior * (gradient.x() - plane.gradient_x),
                              system.vz + kPrior * (gradient.y() - plane.gradient_y));
  const Eigen::Vector3f change = (system.matrix().inverse() * right).cast<float>();
  plane.height += change.x();
  plane.gradient_x += change.y();
  plane.gradient_y += change.z();
  return system;
}

void fit_plane(const std::vector<GroundSample>& samples, const RaisedGroundParams& params,
               GroundAround& plane) {
  const Eigen::Vector2f gradient(plane.gradient_x, plane.gradient_y);
  for (const float scale : kCauchyScales) {
    step(samples, gradient, plane,
         [scale](float r) { return r < 0.0F ? kBelow : 1.0F / (1.0F + r * r / (scale * scale)); });
  }
  const auto least = static_cast<float>(params.sigma_min);
  plane.sigma = std::max(kFirstSigma, least);
  PlaneSystem system;
  for (int k = 0; k < kTukeySteps; ++k) {
    const float limit = kTukeyLimit * plane.sigma;
    system = step(samples, gradient, plane, [limit](float r) {
      const float share = 1.0F - r * r / (limit * limit);
      return share > 0.0F ? share * share : 0.0F;
    });
    if (system.w < kLeastShare * static_cast<float>(samples.size())) return;
    plane.sigma = std::max(1.1F * std::sqrt(system.squares / system.w), least);
  }
  if (plane.sigma > static_cast<float>(params.sigma_max)) return;
  const Eigen::Matrix3d spread = system.matrix().inverse();
  int k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) plane.spread[k++] = static_cast<float>(spread(i, j));
  }
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
      collect_window(blocks, row, column, workspace);
      if (workspace.window.size() < kFewestSamples) continue;
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
      fit_plane(workspace.window, params, plane);
    }
  }
}

// Looks in four directions for the first observed cell within two cells.
void look_at_edges(const ElevationGrid& grid, const GroundSegmentation& ground,
                   const Blocks& blocks, const RaisedGroundWorkspace& workspace,
                   FieldCells& cells) {
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    if (cells.raised[slot] == 0) continue;
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    const GroundAround& plane = workspace.around[blocks.of(at)];
    const float height = 0.5F * (cells.raised_low[slot] + cells.raised_high[slot]);
    for (const CellIndex direction :
         {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
      Slot other = kUnobserved;
      for (int k = 1; k <= kEdgeReach && other == kUnobserved; ++k)
        other = grid.slot_at({at.l + k * direction.l, at.w + k * direction.w});
      if (other == kUnobserved) continue;
      const auto o = static_cast<std::size_t>(other);
      const RaisedGroundWorkspace::Sums& sums = workspace.sums[o];
      if (!ground.is_ground(o) || cells.raised[o] > 0 || sums.n == 0.0F) continue;
      const float beside = (sums.z / sums.n) - plane.height_at(sums.x / sums.n, sums.y / sums.n);
      ++(beside < kSharp * height ? cells.sharp_edges : cells.smooth_edges)[slot];
    }
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
  workspace.height.assign(points.size, 0.0F);
  if (field.surface.height.empty()) return;
  const Blocks blocks(grid.geometry, params.block);
  sum_ground(points, field.points, point_slots, n, workspace.sums);
  sort_samples(grid, ground, blocks, workspace);
  fit_planes(field, blocks, params, workspace);
  const auto least = static_cast<float>(params.least_height);
  const auto sigmas = static_cast<float>(params.sigmas);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (point_slots[i] < 0 || field.points.support[i] != Support::kGround) continue;
    const auto slot = static_cast<std::size_t>(point_slots[i]);
    if (ground.rule[slot] == GroundRule::kLow) continue;
    const GroundAround& plane =
        workspace.around[blocks.of(grid.geometry.index_of(grid.cell[slot]))];
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
  look_at_edges(grid, ground, blocks, workspace, cells);
}

const GroundAround* ground_around(const GridGeometry& geometry, const RaisedGroundParams& params,
                                  const RaisedGroundWorkspace& workspace, double x, double y) {
  CellIndex cell;
  if (workspace.around.empty() || !geometry.cell_at(x, y, cell)) return nullptr;
  return &workspace.around[Blocks(geometry, params.block).of(cell)];
}

}  // namespace mrpt_terrain
