// SPDX-License-Identifier: BSD-3-Clause
#include "stray_points.h"

#include <algorithm>
#include <cmath>

#include "beam_walk.h"
#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Low cells up to this many cells apart are looked at together.
constexpr int kApart = 2;
// Beams are followed back in steps of a cell of the reference, metres...
constexpr float kStep = 0.4F;
// ...from so far ahead of the point on, where an opening would be, up to so far.
constexpr float kOpening = 0.6F, kFarthest = 60.0F;
// ...until they are above the ground but for so much, metres.
constexpr float kAboveGround = 0.05F;
// Met so often, and at least at every third step, the ground speaks against a point.
constexpr int kFewestCrossed = 3, kSteps = 3;
// Low heights of cells that are ground: so near to the reference, metres.
constexpr float kOnGround = 0.2F;

bool is_stray(const HoleInput& input, const CellPoint& p) {
  const GroundSurface& surface = input.field.surface;
  int crossed = 0, steps = 0;
  walk_back(p, input.origins.of(static_cast<std::size_t>(p.index)), {kOpening, kStep, kFarthest},
            [&](float x, float y, float z) {
              const float ground = surface.height_at(x, y);
              if (z > ground - kAboveGround) return false;
              ++steps;
              const std::int32_t cell = surface.lattice().cell_at(x, y);
              const std::int32_t slot =
                  cell < 0 ? -1 : surface.cells.slot_of[static_cast<std::size_t>(cell)];
              if (slot < 0) return true;
              const float low = surface.ground[static_cast<std::size_t>(slot)].low;
              if (std::abs(low - ground) < kOnGround) ++crossed;
              return true;
            });
  return crossed >= kFewestCrossed && kSteps * crossed >= steps;
}

/// Points below the ground in a group of cells.
struct LowPoints {
  int all = 0, stray = 0;
};

// Marks stray points; per slot, how many points below the ground there are, and how many are stray.
void mark_stray(const HoleInput& input, HoleWorkspace& workspace) {
  std::fill(workspace.deep.begin(), workspace.deep.end(), 0);
  workspace.stray.assign(input.field.points.support.size(), 0);
  if (!input.origins.known()) return;
  const GroundSurface& surface = input.field.surface;
  for (std::size_t k = 0; k < input.field.support.size(); ++k) {
    if (input.field.support[k] != Support::kBelow) continue;
    const CellPoint& p = surface.cells.points[k];
    if (!input.origins.is_measured(static_cast<std::size_t>(p.index))) continue;
    CellIndex cell;
    if (!input.grid.geometry.cell_at(p.x, p.y, cell)) continue;
    const Slot slot = input.grid.slot_at(cell);
    if (slot == kUnobserved || !is_stray(input, p)) continue;
    workspace.stray[static_cast<std::size_t>(p.index)] = 1;
    ++workspace.deep[static_cast<std::size_t>(slot)];
  }
}

}  // namespace

void take_back_stray_cells(const HoleInput& input, int least_points, const FieldCells& cells,
                           HoleWorkspace& workspace, GroundSegmentation& ground) {
  const std::size_t n = input.grid.observed();
  workspace.deep.resize(n);
  workspace.all.assign(n, 0);
  mark_stray(input, workspace);
  for (std::size_t first = 0; first < n; ++first) {
    if (ground.rule[first] != GroundRule::kLow || workspace.all[first] != 0) continue;
    workspace.members.assign(1, static_cast<std::int32_t>(first));
    workspace.all[first] = 1;
    LowPoints points;
    for (std::size_t next = 0; next < workspace.members.size(); ++next) {
      const auto slot = static_cast<std::size_t>(workspace.members[next]);
      points.all += cells.below[slot];
      points.stray += workspace.deep[slot];
      for_slots_around(input.grid, slot, kApart, [&](std::size_t near) {
        if (ground.rule[near] != GroundRule::kLow || workspace.all[near] != 0) return;
        workspace.all[near] = 1;
        workspace.members.push_back(static_cast<std::int32_t>(near));
      });
    }
    if (points.all >= least_points && 2 * points.stray < points.all) continue;
    for (const std::int32_t slot : workspace.members)
      ground.rule[static_cast<std::size_t>(slot)] = GroundRule::kGround;
  }
}

}  // namespace mrpt_terrain
