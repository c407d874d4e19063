// SPDX-License-Identifier: BSD-3-Clause
#include "ground_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "buried_points.h"
#include "nine_cells.h"
#include "surface_levels.h"

namespace mrpt_terrain {
namespace {

// Points this far above the lowest of their cell are what stands on its ground, metres.
constexpr float kHighPart = 2.0F;
// How much a point over the low band takes from the weight of a cell, in points of the band.
constexpr float kHighPointWeight = 3.0F;
// Mean weight of the cells around, where what is rough is the ground, and where it stands on it.
constexpr float kRoughAround = 0.2F, kSmoothAround = 0.4F;
// Among smooth cells, one that is less firm or solid than this is loose: it scatters by 3.6 cm
// along the beams, or more for a noisy sensor, which is more than range noise.
constexpr float kLoose = 0.6F;
// What cells around add to the scatter of a cell, and degrees of freedom with which its own points
// are enough to tell that it scatters less; two of them go to where its surface lies.
constexpr float kScatterAround = 0.3F;
constexpr float kEnoughFreedoms = 6.0F, kFreedomsOfSurface = 2.0F;
// Rise of what is not loose, metres: the level's own tolerance has the say.
constexpr float kAnyRise = 1e9F;
// Beams that meet the ground at a flatter angle count as if it were this sine: errors of a cell's
// mean plane would have the say.
constexpr float kLeastSine = 0.02F;
// Share of the cells that show firm ground at least, and up to which scatter along the beams noise
// is as expected, as a multiple of the variance at which cells count half; fewer cells do not tell.
constexpr float kQuietShare = 0.3F, kQuietRatio = 0.35F;
constexpr std::size_t kEnoughCells = 50;
constexpr float kSensorHeight = 1.0F;  // metres, where it is not known
// Level on whose cells rough cells are compared with smooth ones around.
constexpr int kRoughLevel = 4;

// Levels that weights are for: those of raw low heights, and the finer ones.
enum class Levels { kCoarse, kFine };

/// The points of a cell.
struct PointsOfCell {
  const CellPoint* first;
  const CellPoint* last;
  float centre_x, centre_y;
};

PointsOfCell points_in(const CellPoints& cells, std::size_t slot) {
  const CellPoint* points = cells.points.data();
  return {points + cells.first[slot], points + cells.first[slot + 1],
          cells.lattice.centre(cells.cell[slot].row),
          cells.lattice.centre(cells.cell[slot].column)};
}

PointsOfCell points_kept(const GroundSurface& surface, const GroundSurfaceWorkspace& workspace,
                         const BuriedInCells::Cell& cell) {
  PointsOfCell points = points_in(surface.cells, static_cast<std::size_t>(cell.slot));
  points.first = workspace.buried.kept.data() + cell.first;
  points.last = workspace.buried.kept.data() + cell.last;
  return points;
}

// A cell without a point that tells of ground.
void forget(std::size_t slot, GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  workspace.part[slot] = 0.0F;
  surface.ground[slot].points = 0.0F;
}

struct LowBand {
  float lowest, mean;
  float points;
  float share;  // of the band's points, those above it counted `kHighPointWeight` times
};

/// Counts points by their height above the lowest. Without branches: which are low cannot be
/// predicted.
struct BandCounts {
  float band;
  float sum = 0.0F, low = 0.0F, high = 0.0F;

  void add(float above) {
    const float in_band = above <= band ? 1.0F : 0.0F;
    low += in_band;
    sum += in_band * above;
    high += (above > band) & (above < kHighPart) ? 1.0F : 0.0F;
  }
  [[nodiscard]] LowBand over(float lowest) const {
    return {lowest, lowest + sum / low, low, low / (low + kHighPointWeight * high)};
  }
};

// (x, y, z, 1).
FourFloats place_of(const CellPoint& point) {
  static_assert(sizeof(CellPoint) == sizeof(FourFloats));
  FourFloats place;
  std::memcpy(&place, &point, sizeof(place));
  place[3] = 1.0F;
  return place;
}

// The low band of a cell, and the sums of its points up to `low_part` above the lowest, about the
// middle of the cell at the height of the lowest.
LowBand measure_points(const PointsOfCell& cell, float band, float low_part, HeightSums& sums) {
  float lowest = std::numeric_limits<float>::max();
  for (const CellPoint* p = cell.first; p != cell.last; ++p) lowest = std::min(lowest, p->z);
  BandCounts counts{band};
  sums = {};
  const FourFloats centre{cell.centre_x, cell.centre_y, lowest, 0.0F};
  const float top = lowest + low_part;
  for (const CellPoint* p = cell.first; p != cell.last; ++p) {
    counts.add(p->z - lowest);
    const float counted = p->z <= top ? 1.0F : 0.0F;
    sums.add_weighted(place_of(*p) - centre, counted);
  }
  return counts.over(lowest);
}

// The low band of a cell, heights taken above a reference that is linear in it.
LowBand measure_above(const PointsOfCell& cell, const LevelView::Linear& reference, float band,
                      float* height) {
  float lowest = std::numeric_limits<float>::max();
  const auto n = static_cast<std::size_t>(cell.last - cell.first);
  for (std::size_t i = 0; i < n; ++i) {
    const CellPoint& p = cell.first[i];
    height[i] = p.z - reference.height - reference.gradient_x * (p.x - cell.centre_x) -
                reference.gradient_y * (p.y - cell.centre_y);
    lowest = std::min(lowest, height[i]);
  }
  BandCounts counts{band};
  for (std::size_t i = 0; i < n; ++i) counts.add(height[i] - lowest);
  return counts.over(lowest);
}

// Variance across the plane of the points, by one over the trace of the inverse covariance: it is
// at most the smallest eigenvalue and at least a third of it, and needs no eigenvalues.
float variance_across(const HeightSums& s) {
  const HeightMoments m(s);
  const float a = m.variances[0], c = m.variances[1], f = m.variances[2];
  const float b = m.covariances[0], d = m.covariances[1], e = m.covariances[2];
  const float ac = a * c - b * b, af = a * f - d * d, cf = c * f - e * e;
  const float determinant = f * ac - d * (d * c - b * e) + e * (d * b - a * e);
  const float minors = ac + af + cf;
  return minors > 0.0F ? std::max(determinant / minors, 0.0F) : 0.0F;
}

// Points of the nine cells about a slot, heights from its own mean.
HeightSums sums_around(const CellPoints& cells, const GroundSurfaceWorkspace& workspace,
                       std::size_t slot) {
  const std::vector<HeightSums>& sums = workspace.sums;
  const std::vector<float>& lowest = workspace.lowest;
  const float z = lowest[slot] + sums[slot].sum[2] / sums[slot].n();
  const float size = cells.lattice.cell_size;
  HeightSums around;
  for_nine_cells(cells, slot, [&](std::int32_t row, std::int32_t column, std::size_t other) {
    around.add_shifted(sums[other], static_cast<float>(row) * size,
                       static_cast<float>(column) * size, lowest[other] - z);
  });
  return around;
}

float squared(float value) { return value * value; }

// Scatter of at least one point about the mean of all.
CellScatter scatter_of(const HeightSums& s) {
  const FourFloats mean = s.sum / s.n();
  CellScatter scatter{s.squares - s.sum * mean,
                      s.products - first_factors(s.sum) * second_factors(mean)};
  scatter.squares[3] = s.n() - 1.0F;
  return scatter;
}

// Variance along a beam, of the points of a cell and, less, those of the cells around, each about
// the mean of its own cell: what lies at other heights or ranges is no scatter. Where the cell's
// own points are enough and scatter less, it is next to something else.
float variance_along_beam(const GroundSurface& surface, const std::vector<CellScatter>& scatter,
                          std::size_t slot, const std::array<float, 3>& beam) {
  const CellScatter& own = scatter[slot];
  CellScatter all{(1.0F - kScatterAround) * own.squares, (1.0F - kScatterAround) * own.products};
  for_nine_cells(surface.cells, slot, [&](std::int32_t, std::int32_t, std::size_t other) {
    all.squares += kScatterAround * scatter[other].squares;
    all.products += kScatterAround * scatter[other].products;
  });
  const auto along = [&beam](const CellScatter& s, float freedoms) {
    return variance_along(s.squares / freedoms, s.products / freedoms, beam);
  };
  if (all.freedoms() <= 0.0F) return 0.0F;
  const float variance = along(all, all.freedoms());
  if (own.freedoms() < kEnoughFreedoms) return variance;
  return std::min(variance, along(own, own.freedoms() - kFreedomsOfSurface));
}

/// How beams meet the ground in a cell.
struct Incidence {
  std::array<float, 3> beam;  ///< to the sensor, of length 1
  float squared_sine;         ///< of the angle between beam and ground
};

Incidence incidence_of(const BeamOrigins& origins, const GroundSurface& surface, std::size_t slot,
                       const HeightSums& around) {
  constexpr float kHold = 0.02F;     // m^2: a ring alone does not tell how the ground is inclined
  constexpr float kNearest = 1e-6F;  // m^2
  const CellPoints& cells = surface.cells;
  std::array<float, 3> sensor{0.0F, 0.0F, kSensorHeight};
  if (origins.known()) {
    const CellPoint& first = cells.points[static_cast<std::size_t>(cells.first[slot])];
    sensor = origins.of(static_cast<std::size_t>(first.index));
  }
  const float dx = sensor[0] - cells.lattice.centre(cells.cell[slot].row);
  const float dy = sensor[1] - cells.lattice.centre(cells.cell[slot].column);
  const float dz = sensor[2] - surface.ground[slot].low;
  const SumsPlane plane = fit_plane(around, kHold);
  const float across = dz - plane.gradient_x * dx - plane.gradient_y * dy;
  const float squared_length = 1.0F + squared(plane.gradient_x) + squared(plane.gradient_y);
  const float squared_range = std::max(squared(dx) + squared(dy) + squared(dz), kNearest);
  const float scale = 1.0F / std::sqrt(squared_range);
  return {{dx * scale, dy * scale, dz * scale},
          std::max(squared(across) / (squared_length * squared_range), squared(kLeastSine))};
}

float smoothness(float variance, float at_half) {
  return 1.0F / (1.0F + squared(variance / at_half));
}

// Noise along the beams of a scan, as a multiple of the variance that is expected, 1 at least:
// where many cells are as quiet as that, and even where grass has most of them, what scatters more
// is loose. A scan whose quietest cells scatter more is that of a noisier sensor.
float noise_along_beams(const GroundSurface& surface, GroundSurfaceWorkspace& workspace) {
  std::vector<float>& ratios = workspace.mixed;
  ratios.clear();
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot)
    if (workspace.scatter[slot].freedoms() >= kEnoughFreedoms)
      ratios.push_back(workspace.solid[slot]);
  if (ratios.size() < kEnoughCells) return 1.0F;
  const auto quiet =
      ratios.begin() + static_cast<std::ptrdiff_t>(kQuietShare * static_cast<float>(ratios.size()));
  std::nth_element(ratios.begin(), quiet, ratios.end());
  return std::max(*quiet / kQuietRatio, 1.0F);
}

void measure_smoothness(const BeamOrigins& origins, const GroundSurfaceParams& params,
                        GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  const float rough = squared(static_cast<float>(params.smooth_sigma));
  const float firm = squared(static_cast<float>(params.firm_sigma));
  const float along_beam = squared(static_cast<float>(params.beam_sigma));
  const float grazed = squared(static_cast<float>(params.grazed_sigma));
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot)
    workspace.scatter[slot] = scatter_of(workspace.sums[slot]);
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const HeightSums around = sums_around(surface.cells, workspace, slot);
    const float variance = variance_across(around);
    const Incidence at = incidence_of(origins, surface, slot, around);
    const float along = variance_along_beam(surface, workspace.scatter, slot, at.beam);
    // Until the noise is known: variances, and what they are to be compared with.
    workspace.even[slot] = variance;
    workspace.firm[slot] = firm + along_beam * at.squared_sine;
    workspace.solid[slot] = along / (along_beam + grazed / at.squared_sine);
  }
  surface.beam_noise = noise_along_beams(surface, workspace);
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const float variance = workspace.even[slot];
    workspace.even[slot] = smoothness(variance, rough);
    workspace.firm[slot] =
        smoothness(variance, std::min(rough, surface.beam_noise * workspace.firm[slot]));
    workspace.solid[slot] = smoothness(workspace.solid[slot], surface.beam_noise);
  }
}

std::size_t coarse_cell(const SquareLattice& lattice, LatticeCell cell) {
  return static_cast<std::size_t>((cell.row >> kRoughLevel) * (lattice.side >> kRoughLevel) +
                                  (cell.column >> kRoughLevel));
}

// Mean weight of the cells in nine coarse cells, in place of the sum in each.
void smooth_shares(int side, GroundSurfaceWorkspace& workspace) {
  std::vector<float>& mean = workspace.mixed;
  mean.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0F);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      float sum = 0.0F, count = 0.0F;
      for (int i = std::max(row - 1, 0); i <= std::min(row + 1, side - 1); ++i) {
        for (int j = std::max(column - 1, 0); j <= std::min(column + 1, side - 1); ++j) {
          const float share = (i == row ? 1.0F : 0.5F) * (j == column ? 1.0F : 0.5F);
          sum += share * workspace.share[static_cast<std::size_t>(i * side + j)];
          count += share * workspace.count[static_cast<std::size_t>(i * side + j)];
        }
      }
      if (count > 0.0F) mean[static_cast<std::size_t>(row * side + column)] = sum / count;
    }
  }
  workspace.share.swap(mean);
}

// Rough cells between smooth ones are things that stand there; where all cells are rough, they are
// the ground. Among smooth ones, scatter along the beams is roughness too, and what has it is grass
// that stands on the ground, or no higher than gravel.
void weigh_against_surroundings(const GroundSurfaceParams& params, Levels levels,
                                GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  constexpr float kLeast = 0.001F;  // keeps cells of no weight from dividing by zero
  const SquareLattice& lattice = surface.lattice();
  const int side = lattice.side >> kRoughLevel;
  const auto size = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  workspace.share.assign(size, 0.0F);
  workspace.count.assign(size, 0.0F);
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const std::size_t at = coarse_cell(lattice, surface.cells.cell[slot]);
    workspace.share[at] += surface.ground[slot].weight;
    workspace.count[at] += 1.0F;
  }
  smooth_shares(side, workspace);
  const auto rough = static_cast<float>(params.rough_weight);
  const auto loose_rise = static_cast<float>(params.loose_rise);
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    GroundCell& ground = surface.ground[slot];
    const float around = workspace.share[coarse_cell(lattice, surface.cells.cell[slot])];
    const float among_smooth =
        std::clamp((around - kRoughAround) / (kSmoothAround - kRoughAround), 0.0F, 1.0F);
    const float even = workspace.even[slot];
    ground.smooth = even + among_smooth * (workspace.firm[slot] - even);
    const float solid = std::min(workspace.solid[slot] / kLoose, 1.0F);
    const bool loose = among_smooth > 0.5F && std::min(ground.smooth / kLoose, solid) < 1.0F;
    ground.most_rise = loose ? loose_rise * solid : kAnyRise;
    // Coarse levels bridge what is loose; on the fine ones it is out of their tolerance.
    const float smooth = levels == Levels::kCoarse ? ground.smooth : even;
    const float weight = squared(workspace.part[slot]) * smooth;
    ground.weight = weight / (weight + rough * around + kLeast);
  }
}

void set_weights(const GroundSurfaceParams& params, Levels levels,
                 GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot)
    surface.ground[slot].weight = squared(workspace.part[slot]) * workspace.firm[slot];
  weigh_against_surroundings(params, levels, workspace, surface);
}

}  // namespace

void measure_ground_cells(const BeamOrigins& origins, const GroundSurfaceParams& params,
                          GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  const CellPoints& cells = surface.cells;
  surface.ground.resize(cells.occupied());
  for (auto* values : {&workspace.part, &workspace.even, &workspace.firm, &workspace.solid})
    values->resize(cells.occupied());
  // The last entries are those of empty cells.
  workspace.lowest.resize(cells.occupied() + 1);
  workspace.sums.resize(cells.occupied() + 1);
  workspace.scatter.resize(cells.occupied() + 1);
  workspace.lowest.back() = 0.0F;
  workspace.sums.back() = {};
  workspace.scatter.back() = {};
  const auto low_band = static_cast<float>(params.low_band);
  const auto low_part = static_cast<float>(params.low_part);
  const auto measure = [&](std::size_t slot, const PointsOfCell& points) {
    const LowBand band = measure_points(points, low_band, low_part, workspace.sums[slot]);
    workspace.lowest[slot] = band.lowest;
    workspace.part[slot] = band.share;
    surface.ground[slot].low = band.mean;
    surface.ground[slot].points = band.points;
  };
  for (std::size_t slot = 0; slot < cells.occupied(); ++slot) measure(slot, points_in(cells, slot));
  find_buried_points(origins, low_band, surface, workspace);
  for (const BuriedInCells::Cell& cell : workspace.buried.cells) {
    const auto slot = static_cast<std::size_t>(cell.slot);
    if (cell.first < cell.last)
      measure(slot, points_kept(surface, workspace, cell));
    else
      forget(slot, workspace, surface);
  }
  measure_smoothness(origins, params, workspace, surface);
  set_weights(params, Levels::kCoarse, workspace, surface);
}

void measure_above_level(const GroundSurfaceParams& params, int level,
                         GroundSurfaceWorkspace& workspace, GroundSurface& surface) {
  const CellPoints& cells = surface.cells;
  const LevelView view = view_of_level(workspace, cells.lattice, level);
  const auto low_band = static_cast<float>(params.low_band);
  surface.height.resize(cells.points.size());
  find_steps(view, cells.lattice, level, workspace.step);
  const LevelStep* step = workspace.step.data();
  const auto measure = [&](std::size_t slot, const PointsOfCell& points, float* height) {
    const LatticeCell cell = cells.cell[slot];
    const LevelView::Linear reference = view.between(step[cell.row], step[cell.column]);
    const LowBand band = measure_above(points, reference, low_band, height);
    workspace.part[slot] = band.share;
    surface.ground[slot].low = reference.height + band.mean;
    surface.ground[slot].points = band.points;
  };
  for (std::size_t slot = 0; slot < cells.occupied(); ++slot)
    measure(slot, points_in(cells, slot), surface.height.data() + cells.first[slot]);
  for (const BuriedInCells::Cell& cell : workspace.buried.cells) {
    const auto slot = static_cast<std::size_t>(cell.slot);
    workspace.mixed.resize(static_cast<std::size_t>(cell.last - cell.first));
    if (cell.first < cell.last)
      measure(slot, points_kept(surface, workspace, cell), workspace.mixed.data());
    else
      forget(slot, workspace, surface);
  }
  set_weights(params, Levels::kFine, workspace, surface);
}

}  // namespace mrpt_terrain
