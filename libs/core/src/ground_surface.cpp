// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_surface.h"

#include <algorithm>
#include <cmath>

#include "ditch_cells.h"
#include "ground_cells.h"
#include "length_of.h"
#include "mrpt_terrain/core/random.h"
#include "surface_levels.h"
#include "tall_things.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

// Finest level that lowest points of cells are good enough for; below it, heights are taken above
// the level, so that slopes do not count as low points.
constexpr int kRawLevel = 3;
static_assert(kRawLevel == kCoarseLevel, "cells are heard once for each of the two kinds");

// Search for the plane near the robot.
constexpr float kPlaneRange = 20.0F;       // metres
constexpr float kPlaneTolerance = 0.1F;    // metres
constexpr float kPlaneGrowth = 0.01F;      // more tolerance per metre of range
constexpr float kPlaneLeastWeight = 0.2F;  // of cells that take part
constexpr float kLeastBase = 4.0F;         // m^2: twice the area of a triple's triangle
constexpr std::size_t kMostCandidates = 800;
constexpr std::size_t kFewestCandidates = 10;
constexpr int kHypotheses = 200;

SquareLattice lattice_of(const GroundSurfaceParams& params) {
  // A multiple of the coarsest level's cells, twice of which lie on each side of the robot at
  // least.
  constexpr int kStep = 2 << (kSurfaceLevels - 1);
  const double cells = 2.0 * params.reach / params.cell_size;
  const int steps = std::max(2, static_cast<int>(std::ceil(cells / kStep)));
  return {steps * kStep, static_cast<float>(params.cell_size)};
}

void add_candidates(const GroundSurface& surface, float least_weight,
                    GroundSurfaceWorkspace& workspace) {
  workspace.candidate_x.clear();
  workspace.candidate_y.clear();
  workspace.candidate_z.clear();
  const SquareLattice& lattice = surface.lattice();
  for (std::size_t slot = 0; slot < surface.ground.size(); ++slot) {
    const float x = lattice.centre(surface.cells.cell[slot].row);
    const float y = lattice.centre(surface.cells.cell[slot].column);
    if (surface.ground[slot].weight < least_weight) continue;
    if (least_weight > 0.0F && x * x + y * y > kPlaneRange * kPlaneRange) continue;
    workspace.candidate_x.push_back(x);
    workspace.candidate_y.push_back(y);
    workspace.candidate_z.push_back(surface.ground[slot].low);
  }
}

// Keeps every n-th candidate, so that a plane costs the same in all scans.
void thin_out(GroundSurfaceWorkspace& workspace) {
  const std::size_t n = workspace.candidate_x.size();
  const std::size_t step = (n + kMostCandidates - 1) / kMostCandidates;
  if (step < 2) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; i += step, ++kept) {
    workspace.candidate_x[kept] = workspace.candidate_x[i];
    workspace.candidate_y[kept] = workspace.candidate_y[i];
    workspace.candidate_z[kept] = workspace.candidate_z[i];
  }
  for (auto* values : {&workspace.candidate_x, &workspace.candidate_y, &workspace.candidate_z})
    values->resize(kept);
}

struct GroundHypothesis {
  float gradient_x = 0.0F, gradient_y = 0.0F, offset = 0.0F;
};

// Cells on the plane less cells below it: the ground has little below it.
MRPT_TERRAIN_WIDE_REGISTERS
int score_of(const GroundHypothesis& plane, const float* x, const float* y, const float* z,
             const float* tolerance, std::size_t n) {
  int score = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float height = z[i] - plane.gradient_x * x[i] - plane.gradient_y * y[i] - plane.offset;
    const int on = height < tolerance[i] ? 1 : 0;
    const int below = height <= -tolerance[i] ? 2 : 0;
    score += on - below;
  }
  return score;
}

bool plane_through(const GroundSurfaceWorkspace& workspace, std::size_t i, std::size_t j,
                   std::size_t k, GroundHypothesis& plane) {
  const std::vector<float>&x = workspace.candidate_x, &y = workspace.candidate_y,
        &z = workspace.candidate_z;
  const float ax = x[j] - x[i], ay = y[j] - y[i], az = z[j] - z[i];
  const float bx = x[k] - x[i], by = y[k] - y[i], bz = z[k] - z[i];
  const float base = ax * by - ay * bx;
  if (std::abs(base) < kLeastBase) return false;
  plane.gradient_x = (az * by - ay * bz) / base;
  plane.gradient_y = (ax * bz - az * bx) / base;
  plane.offset = z[i] - plane.gradient_x * x[i] - plane.gradient_y * y[i];
  return true;
}

bool is_permitted(const GroundHypothesis& plane, const GroundSurfaceParams& params) {
  const double steepest = std::tan(params.max_tilt);
  const double gradient = length_of(plane.gradient_x, plane.gradient_y);
  return gradient <= steepest && std::abs(plane.offset) <= params.max_offset;
}

void find_plane(const GroundSurfaceParams& params, GroundSurfaceWorkspace& workspace,
                GroundSurface& surface) {
  surface.gradient_x = surface.gradient_y = surface.offset = 0.0F;
  add_candidates(surface, kPlaneLeastWeight, workspace);
  if (workspace.candidate_x.size() < kFewestCandidates) add_candidates(surface, 0.0F, workspace);
  thin_out(workspace);
  const std::size_t n = workspace.candidate_x.size();
  if (n < 3) return;
  workspace.mixed.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    workspace.mixed[i] = kPlaneTolerance + kPlaneGrowth * length_of(workspace.candidate_x[i],
                                                                    workspace.candidate_y[i]);
  }
  const auto score = [&workspace, n](const GroundHypothesis& plane) {
    return score_of(plane, workspace.candidate_x.data(), workspace.candidate_y.data(),
                    workspace.candidate_z.data(), workspace.mixed.data(), n);
  };
  RandomGenerator random(1);
  GroundHypothesis best;
  int best_score = score(best);
  for (int trial = 0; trial < kHypotheses; ++trial) {
    const auto count = static_cast<std::uint32_t>(n);
    const std::size_t i = random.below(count), j = random.below(count), k = random.below(count);
    GroundHypothesis plane;
    if (!plane_through(workspace, i, j, k, plane) || !is_permitted(plane, params)) continue;
    const int votes = score(plane);
    if (votes <= best_score) continue;
    best_score = votes;
    best = plane;
  }
  surface.gradient_x = best.gradient_x;
  surface.gradient_y = best.gradient_y;
  surface.offset = best.offset;
}

// Points whose heights are measured together.
constexpr std::size_t kTogether = 64;

// Heights of up to `kTogether` points above a level: loops of one kind of work each, most of which
// compilers do for many points at once.
MRPT_TERRAIN_WIDE_REGISTERS
void measure_heights(const CellPoint* points, std::size_t n, const LevelView level, float* height) {
  const float per_metre = 1.0F / level.cell_size;
  const float half = 0.5F * static_cast<float>(level.side) - 0.5F;
  std::array<LevelStep, kTogether> row, column;
  std::array<LevelView::Corners, kTogether> corners;
  for (std::size_t i = 0; i < n; ++i) {
    row[i] = level.step_at(points[i].x * per_metre + half);
    column[i] = level.step_at(points[i].y * per_metre + half);
  }
  for (std::size_t i = 0; i < n; ++i) corners[i] = level.corners_of(row[i], column[i]);
  for (std::size_t i = 0; i < n; ++i)
    height[i] = points[i].z - level.between(corners[i], row[i], column[i]).height;
}

void measure_heights(GroundSurface& surface) {
  const CellPoints& cells = surface.cells;
  const std::size_t n = cells.points.size();
  const LevelView finest = view_of(surface);
  surface.height.resize(n);
  for (std::size_t first = 0; first < n; first += kTogether) {
    measure_heights(cells.points.data() + first, std::min(kTogether, n - first), finest,
                    surface.height.data() + first);
  }
}

}  // namespace

float GroundSurface::height_at(float x, float y) const { return view_of(*this).at(x, y).height; }

void find_ground_surface(const ScanView& scan, const GroundSurfaceParams& params,
                         GroundSurfaceWorkspace& workspace, GroundSurface& result) {
  sort_into_cells(scan.points, lattice_of(params), workspace.sort, result.cells);
  measure_ground_cells(scan.origins, params, workspace, result);
  find_plane(params, workspace, result);
  find_tall_things(result, workspace);
  find_ditch_cells(result, workspace);
  start_levels(result, workspace);
  hear_cells(result, kSurfaceLevels - 1, workspace);
  correct_level(params, kSurfaceLevels - 1, workspace, result);
  for (int level = kSurfaceLevels - 2; level >= kRawLevel; --level) {
    refine_level(params, level, workspace, result);
  }
  measure_above_level(params, kRawLevel, workspace, result);
  hear_cells(result, kRawLevel - 1, workspace);
  for (int level = kRawLevel - 1; level >= 0; --level) {
    refine_level(params, level, workspace, result);
  }
  result.node.swap(workspace.level[0]);
  measure_heights(result);
}

}  // namespace mrpt_terrain
