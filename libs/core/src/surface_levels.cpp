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
// Of cells beside something tall, on levels from `kCoarseLevel` on.
constexpr float kBesideTallBend = 0.75F;  // of `rough_bend`
constexpr float kBesideTallWeight = 0.2F;

// A height, metres, that is above all levels: out of tolerance.
constexpr float kUnheard = 1e9F;

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

// The sums have a frame of one cell on all four sides, so that the eight cells around every cell
// exist. What is spread into the frame is forgotten.
std::int32_t stride_of(std::int32_t side) { return side + 2; }

/// How the low height of a cell counts on a level.
struct LevelRule {
  float tolerance, bend;     // above the level; bend is that of one of its cells
  float rough;               // share of `bend` where it is roughest
  float below;               // the lowest difference that counts
  float low_weight;          // of differences below the level, over those above
  float fewest_low;          // points from which on that is so
  float beside_tall;         // share of `bend` beside something tall
  float weight_beside_tall;  // of differences above the level there

  LevelRule(const GroundSurfaceParams& params, int level, float cell_size)
      : tolerance(static_cast<float>(params.tolerance)),
        bend(static_cast<float>(params.bend) * cell_size),
        rough(static_cast<float>(params.rough_bend)),
        below(-static_cast<float>(params.dip) * (tolerance + bend)),
        low_weight(static_cast<float>(params.low_weight)),
        fewest_low(level <= kFineLevel ? 0.0F : 2.0F),
        beside_tall(kBesideTallBend * rough),
        weight_beside_tall(kBesideTallWeight) {}
};

// How far the low heights lie above a level, per slot.
void measure_differences(const GroundSurface& surface, const LevelView& view, int level,
                         GroundSurfaceWorkspace& workspace) {
  const std::size_t n = surface.ground.size();
  const LatticeCell* cell = surface.cells.cell.data();
  const LevelStep* step = workspace.step.data();
  const float* low = workspace.heard.low.data();
  float* difference = workspace.difference.data();
  if (level == 0) {
    for (std::size_t slot = 0; slot < n; ++slot)
      difference[slot] = low[slot] - view.height[surface.cells.number_of(cell[slot])];
    return;
  }
  for (std::size_t slot = 0; slot < n; ++slot) {
    difference[slot] =
        low[slot] - view.between(step[cell[slot].row], step[cell[slot].column]).height;
  }
}

// Weights of the differences, 0 out of tolerance. One selection after the other: branches could not
// be predicted, and so compilers work on many cells at once.
MRPT_TERRAIN_WIDE_REGISTERS
void weigh_differences(const LevelRule rule, const HeardCells& heard, const float* difference,
                       std::size_t n, float* weight) {
  const float* points = heard.points.data();
  const float* smooth = heard.smooth.data();
  const float* own = heard.weight.data();
  const float* most_rise = heard.most_rise.data();
  const float* tall = heard.doubtful.data();
  for (std::size_t slot = 0; slot < n; ++slot) {
    const float d = difference[slot], w = own[slot];
    // What rises and is smooth is a hill, what rises and is rough may be a bush.
    const float hill = rule.rough + (1.0F - rule.rough) * smooth[slot];
    const float rise = tall[slot] > 0.0F ? rule.beside_tall : hill;
    const float above = std::min(rule.tolerance + rule.bend * rise, most_rise[slot]);
    const float high = tall[slot] > 0.0F ? w * rule.weight_beside_tall : w;
    const float low = rule.low_weight * (w < kLeastBelow ? kLeastBelow : w);
    const float low_or_high = points[slot] >= rule.fewest_low ? low : high;
    float value = d < 0.0F ? low_or_high : high;
    value = d <= above ? value : 0.0F;
    value = d >= rule.below ? value : 0.0F;
    weight[slot] = value;
  }
}

// Sums the weighted differences up, per cell of the level.
void sum_differences(int level, std::int32_t side, const GroundSurface& surface,
                     GroundSurfaceWorkspace& workspace) {
  const std::size_t n = surface.ground.size();
  const std::int32_t stride = stride_of(side);
  const LatticeCell* cell = surface.cells.cell.data();
  const float* difference = workspace.difference.data();
  const float* weight = workspace.weight.data();
  WeightedSum* sums = workspace.cell_sums.data();
  std::int32_t* touched = workspace.touched.data();
  std::size_t count = 0;
  const auto place_of = [&](std::size_t slot) {
    return ((cell[slot].row >> level) + 1) * stride + (cell[slot].column >> level) + 1;
  };
  for (std::size_t slot = 0; slot < n;) {
    // Those that follow each other in a cell of the level are summed up in registers.
    const std::int32_t at = place_of(slot);
    const WeightedSum before = sums[at];
    WeightedSum sum = before;
    do {
      sum.sum += weight[slot] * difference[slot];
      sum.weight += weight[slot];
      ++slot;
    } while (level >= kCoarseLevel && slot < n && place_of(slot) == at);
    sums[at] = sum;
    touched[count] = at;
    count += (before.weight == 0.0F) & (sum.weight > 0.0F) ? 1U : 0U;
  }
  workspace.touched_cells = count;
}

// Spreads a sum over the nine cells about one.
void spread(float value, std::ptrdiff_t stride, float* about) {
  const float half = 0.5F * value, quarter = 0.25F * value;
  float* before = about - stride;
  float* behind = about + stride;
  before[-1] += quarter;
  before[0] += half;
  before[1] += quarter;
  about[-1] += half;
  about[0] += value;
  about[1] += half;
  behind[-1] += quarter;
  behind[0] += half;
  behind[1] += quarter;
}

// Adds the mean differences to a part of a row of the level and leaves their sums zero.
MRPT_TERRAIN_WIDE_REGISTERS
void add_means(float* sum, float* weight, int n, float hold, float* level) {
  for (int i = 0; i < n; ++i) {
    level[i] += sum[i] / (weight[i] + hold);
    sum[i] = 0.0F;
    weight[i] = 0.0F;
  }
}

// Forgets what was spread beyond the edges.
void clear_frame(std::int32_t side, float* sums) {
  const std::int32_t stride = stride_of(side);
  std::fill_n(sums, stride, 0.0F);
  std::fill_n(sums + static_cast<std::ptrdiff_t>(stride - 1) * stride, stride, 0.0F);
  for (std::ptrdiff_t row = 1; row <= side; ++row)
    sums[row * stride] = sums[row * stride + stride - 1] = 0.0F;
}

// Adds the mean differences to the level and leaves all sums zero.
void apply_differences(float hold, std::int32_t side, GroundSurfaceWorkspace& workspace,
                       std::vector<float>& level) {
  const std::int32_t stride = stride_of(side);
  float* sum = workspace.spread_sum.data();
  float* weight = workspace.spread_weight.data();
  // Of every row of the sums, from where to where there are any.
  std::vector<ColumnRange>& ranges = workspace.ranges;
  ranges.assign(static_cast<std::size_t>(stride), {side, -1});
  for (std::size_t k = 0; k < workspace.touched_cells; ++k) {
    const std::int32_t at = workspace.touched[k];
    WeightedSum& from = workspace.cell_sums[static_cast<std::size_t>(at)];
    const float scale = std::min(from.weight, kMostCells) / from.weight;
    spread(scale * from.sum, stride, sum + at);
    spread(scale * from.weight, stride, weight + at);
    from = {};
    ranges[static_cast<std::size_t>(at / stride)].include(at % stride - 1);
  }
  for (std::int32_t row = 0; row < side; ++row) {
    // Sums are spread over the rows and columns beside.
    ColumnRange range = ranges[static_cast<std::size_t>(row + 1)];
    range.include(ranges[static_cast<std::size_t>(row)]);
    range.include(ranges[static_cast<std::size_t>(row + 2)]);
    if (range.last < range.first) continue;
    const std::int32_t first = std::max(range.first - 1, 0);
    const std::int32_t last = std::min(range.last + 1, side - 1);
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row + 1) * stride + first + 1;
    add_means(sum + at, weight + at, last - first + 1, hold,
              level.data() + static_cast<std::ptrdiff_t>(row) * side + first);
  }
  clear_frame(side, sum);
  clear_frame(side, weight);
}

}  // namespace

LevelView view_of_level(const GroundSurfaceWorkspace& workspace, const SquareLattice& lattice,
                        int level) {
  return {workspace.level[static_cast<std::size_t>(level)].data(), side_of(lattice, level),
          lattice.cell_size * static_cast<float>(1 << level)};
}

void hear_cells(const GroundSurface& surface, int level, GroundSurfaceWorkspace& workspace) {
  const std::size_t n = surface.ground.size();
  HeardCells& heard = workspace.heard;
  for (auto* values : {&heard.low, &heard.points, &heard.smooth, &heard.weight, &heard.most_rise,
                       &heard.doubtful, &workspace.difference, &workspace.weight})
    values->resize(n);
  workspace.touched.resize(n + 1);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const GroundCell& ground = surface.ground[slot];
    heard.low[slot] =
        workspace.in_ditch[slot] != 0 || ground.points == 0.0F ? kUnheard : ground.low;
    heard.points[slot] = ground.points;
    heard.smooth[slot] = ground.smooth;
    heard.weight[slot] = ground.weight;
    heard.most_rise[slot] = ground.most_rise;
    heard.doubtful[slot] = level >= kCoarseLevel && workspace.beside_tall[slot] != 0 ? 1.0F : 0.0F;
  }
}

void find_steps(const LevelView& view, const SquareLattice& lattice, int level,
                std::vector<LevelStep>& step) {
  step.resize(static_cast<std::size_t>(lattice.side));
  for (std::int32_t index = 0; index < lattice.side; ++index)
    step[static_cast<std::size_t>(index)] = view.step_of(index, level);
}

void start_levels(const GroundSurface& surface, GroundSurfaceWorkspace& workspace) {
  const SquareLattice& lattice = surface.lattice();
  const auto stride = static_cast<std::size_t>(stride_of(lattice.side));
  workspace.cell_sums.resize(stride * stride);
  for (auto* sums : {&workspace.spread_sum, &workspace.spread_weight})
    sums->resize(stride * stride);
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
  find_steps(view, surface.lattice(), level, workspace.step);
  for (int pass = 0; pass < corrections(level); ++pass) {
    measure_differences(surface, view, level, workspace);
    weigh_differences(LevelRule(params, level, view.cell_size), workspace.heard,
                      workspace.difference.data(), surface.ground.size(), workspace.weight.data());
    sum_differences(level, view.side, surface, workspace);
    apply_differences(static_cast<float>(params.hold), view.side, workspace,
                      workspace.level[static_cast<std::size_t>(level)]);
  }
}

}  // namespace mrpt_terrain
