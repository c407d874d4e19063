// SPDX-License-Identifier: BSD-3-Clause
#include "surface_levels.h"

#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr int kTop = kSurfaceLevels - 1;
// Corrections per level: the second sees which heights are within reach of the first. The finest
// level gains nothing by it.
constexpr int corrections(int level) { return level == 0 ? 1 : 2; }
// A cell that is seen by many others counts as this many at most.
constexpr float kMostCells = 4.0F;
// On coarser levels, whose tolerance is wide, a single point may be wild, and does not count more
// for lying low.
constexpr int kFineLevel = 2;
// Weight of a height below the reference is at least this share of that of a perfect cell: what is
// low limits the ground, however rough it is.
constexpr float kLeastBelow = 0.1F;
// From this level on, of 3.2 m, all that is near a place may be one ring on a bush. Cells beside
// something tall lift these levels by less than rough ground may, and count for less where they
// do. If they are ground after all, finer levels follow it.
constexpr int kCoarseLevel = 3;
constexpr float kBesideTallBend = 0.75F;  // of `rough_bend`
constexpr float kBesideTallWeight = 0.2F;

int side_of(const SquareLattice& lattice, int level) { return lattice.side >> level; }

// One row of the finer level, from rows of the coarser level: `near` is the one it lies in.
MRPT_TERRAIN_WIDE_REGISTERS
void refine_row(const float* near, const float* far, int n, float* mixed, float* row) {
  for (int j = 0; j < n; ++j) mixed[j] = 0.75F * near[j] + 0.25F * far[j];
  row[0] = mixed[0];
  row[2 * n - 1] = mixed[n - 1];
  for (int j = 0; j + 1 < n; ++j) {
    row[2 * j + 1] = 0.75F * mixed[j] + 0.25F * mixed[j + 1];
    row[2 * j + 2] = 0.25F * mixed[j] + 0.75F * mixed[j + 1];
  }
}

void refine_all(const std::vector<float>& coarse, int n, std::vector<float>& mixed,
                std::vector<float>& fine) {
  fine.resize(static_cast<std::size_t>(4) * static_cast<std::size_t>(n) *
              static_cast<std::size_t>(n));
  mixed.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < 2 * n; ++i) {
    const int near = i / 2;
    const int far = std::min(std::max(i % 2 == 0 ? near - 1 : near + 1, 0), n - 1);
    refine_row(coarse.data() + static_cast<std::ptrdiff_t>(near) * n,
               coarse.data() + static_cast<std::ptrdiff_t>(far) * n, n, mixed.data(),
               fine.data() + static_cast<std::ptrdiff_t>(i) * 2 * n);
  }
}

// Weighted differences between low heights and the level, per cell of the level.
void sum_differences(const GroundSurfaceParams& params, int level,
                     GroundSurfaceWorkspace& workspace, const GroundSurface& surface) {
  const SquareLattice& lattice = surface.lattice();
  const LevelView view = view_of_level(workspace, lattice, level);
  const auto tolerance = static_cast<float>(params.tolerance);
  const float bend = static_cast<float>(params.bend) * view.cell_size;
  const auto rough_bend = static_cast<float>(params.rough_bend);
  const float below = -static_cast<float>(params.dip) * (tolerance + bend);
  const auto low_weight = static_cast<float>(params.low_weight);
  const LevelStep* step = workspace.step.data();
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const GroundCell& ground = surface.ground[slot];
    const LatticeCell cell = surface.cells.cell[slot];
    const float reference = level == 0 ? view.height[surface.cells.number_of(cell)]
                                       : view.between(step[cell.row], step[cell.column]).height;
    const float difference = ground.low - reference;
    const bool doubtful = level >= kCoarseLevel && workspace.beside_tall[slot] != 0;
    // What rises and is smooth is a hill, what rises and is rough may be a bush.
    const float rise =
        doubtful ? kBesideTallBend * rough_bend : rough_bend + (1.0F - rough_bend) * ground.smooth;
    const float above = tolerance + bend * rise;
    if (!(difference <= above && difference >= below)) continue;
    const bool limits = difference < 0.0F && (ground.points > 1.0F || level <= kFineLevel);
    const float weight = limits ? low_weight * std::max(ground.weight, kLeastBelow)
                                : ground.weight * (doubtful ? kBesideTallWeight : 1.0F);
    const std::int32_t at = (cell.row >> level) * view.side + (cell.column >> level);
    LevelSums& sums = workspace.level_sums[static_cast<std::size_t>(at)];
    if (sums.cell_weight == 0.0F) workspace.touched.push_back(at);
    sums.cell_sum += weight * difference;
    sums.cell_weight += weight;
  }
}

// Spreads the sums of a cell over the nine about it.
void spread(std::int32_t at, int side, float sum, float weight, GroundSurfaceWorkspace& workspace) {
  const int row = at / side, column = at % side;
  for (int i = std::max(row - 1, 0); i <= std::min(row + 1, side - 1); ++i) {
    for (int j = std::max(column - 1, 0); j <= std::min(column + 1, side - 1); ++j) {
      const float share = (i == row ? 1.0F : 0.5F) * (j == column ? 1.0F : 0.5F);
      LevelSums& to = workspace.level_sums[static_cast<std::size_t>(i * side + j)];
      to.sum += share * sum;
      to.weight += share * weight;
    }
  }
}

// Adds the mean differences to the level and leaves all sums zero.
void apply_differences(float hold, int side, GroundSurfaceWorkspace& workspace,
                       std::vector<float>& level) {
  for (const std::int32_t at : workspace.touched) {
    LevelSums& from = workspace.level_sums[static_cast<std::size_t>(at)];
    const float scale = std::min(from.cell_weight, kMostCells) / from.cell_weight;
    spread(at, side, scale * from.cell_sum, scale * from.cell_weight, workspace);
    from.cell_sum = from.cell_weight = 0.0F;
  }
  for (const std::int32_t at : workspace.touched) {
    const int row = at / side, column = at % side;
    for (int i = std::max(row - 1, 0); i <= std::min(row + 1, side - 1); ++i) {
      for (int j = std::max(column - 1, 0); j <= std::min(column + 1, side - 1); ++j) {
        const auto to = static_cast<std::size_t>(i * side + j);
        LevelSums& sums = workspace.level_sums[to];
        if (sums.weight == 0.0F) continue;
        level[to] += sums.sum / (sums.weight + hold);
        sums.sum = sums.weight = 0.0F;
      }
    }
  }
  workspace.touched.clear();
}

}  // namespace

LevelView view_of_level(const GroundSurfaceWorkspace& workspace, const SquareLattice& lattice,
                        int level) {
  return {workspace.level[static_cast<std::size_t>(level)].data(), side_of(lattice, level),
          lattice.cell_size * static_cast<float>(1 << level)};
}

void start_levels(const GroundSurface& surface, GroundSurfaceWorkspace& workspace) {
  const SquareLattice& lattice = surface.lattice();
  workspace.level_sums.resize(lattice.size());
  const SquareLattice top{side_of(lattice, kTop),
                          lattice.cell_size * static_cast<float>(1 << kTop)};
  std::vector<float>& height = workspace.level[kTop];
  height.resize(top.size());
  for (std::int32_t i = 0; i < top.side; ++i) {
    for (std::int32_t j = 0; j < top.side; ++j) {
      height[static_cast<std::size_t>(i * top.side + j)] =
          surface.gradient_x * top.centre(i) + surface.gradient_y * top.centre(j) + surface.offset;
    }
  }
}

void refine_level(const GroundSurfaceParams& params, int level, GroundSurfaceWorkspace& workspace,
                  const GroundSurface& surface) {
  const auto k = static_cast<std::size_t>(level);
  refine_all(workspace.level[k + 1], side_of(surface.lattice(), level + 1), workspace.mixed,
             workspace.level[k]);
  correct_level(params, level, workspace, surface);
}

void correct_level(const GroundSurfaceParams& params, int level, GroundSurfaceWorkspace& workspace,
                   const GroundSurface& surface) {
  const LevelView view = view_of_level(workspace, surface.lattice(), level);
  workspace.step.resize(static_cast<std::size_t>(surface.lattice().side));
  for (std::int32_t index = 0; index < surface.lattice().side; ++index)
    workspace.step[static_cast<std::size_t>(index)] = view.step_of(index, level);
  for (int pass = 0; pass < corrections(level); ++pass) {
    sum_differences(params, level, workspace, surface);
    apply_differences(static_cast<float>(params.hold), side_of(surface.lattice(), level), workspace,
                      workspace.level[static_cast<std::size_t>(level)]);
  }
}

}  // namespace mrpt_terrain
