// SPDX-License-Identifier: BSD-3-Clause
#include "buried_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "beam_walk.h"

namespace mrpt_terrain {
namespace {

// Cells of which the low band has less than this share of the points, or so few, are looked at.
constexpr float kLeastShare = 0.3F;
constexpr float kFewPoints = 2.0F;
// Ground is shown by two points within the band; if not among so many of the lowest points, by
// none.
constexpr std::size_t kLookAt = 6;
// Beams are followed back in steps of a cell, from so far ahead of the point on and up to so far,
// metres, over at most so many steps of which nothing is seen.
constexpr float kOpening = 0.4F, kFarthest = 40.0F;
constexpr int kMostUnseen = 20;
// Ground speaks against a point if the beam is so far below it, metres, in so many steps, and comes
// out where two cells that follow each other differ by no more than a jump.
constexpr float kBelow = 0.12F;
constexpr int kFewestCrossed = 2;
constexpr float kJump = 0.25F;
// Ground at the rim of the blind spot lies so near to z = 0, metres.
constexpr float kNearRobot = 1.0F;
// Height of what no cell shows.
constexpr float kUnseen = std::numeric_limits<float>::max();

class BuriedPoints {
 public:
  BuriedPoints(const BeamOrigins& origins, float band, const GroundSurface& surface,
               GroundSurfaceWorkspace& workspace)
      : origins_(origins), band_(band), surface_(surface), workspace_(workspace) {}

  void find() const {
    const CellPoints& cells = surface_.cells;
    find_seen_heights();
    for (std::size_t slot = 0; slot < cells.occupied(); ++slot) {
      if (!is_doubtful(slot)) continue;
      // Most are ruled out by the middle of the cell, as the beam to it is above the ground.
      const CellPoint& any = cells.points[static_cast<std::size_t>(cells.first[slot])];
      const CellPoint lowest{cells.lattice.centre(cells.cell[slot].row),
                             cells.lattice.centre(cells.cell[slot].column), workspace_.lowest[slot],
                             any.index};
      if (is_buried(lowest)) keep_others(slot);
    }
  }

 private:
  [[nodiscard]] bool is_doubtful(std::size_t slot) const {
    return workspace_.part[slot] < kLeastShare || surface_.ground[slot].points <= kFewPoints;
  }

  // Heights at which cells show ground, if they do.
  void find_seen_heights() const {
    const CellPoints& cells = surface_.cells;
    workspace_.seen.resize(cells.occupied());
    for (std::size_t slot = 0; slot < cells.occupied(); ++slot)
      workspace_.seen[slot] = is_doubtful(slot) ? lowest_shown(slot) : surface_.ground[slot].low;
  }

  // Lower of the lowest two points within the band.
  [[nodiscard]] float lowest_shown(std::size_t slot) const {
    const CellPoints& cells = surface_.cells;
    std::array<float, kLookAt> lowest;
    lowest.fill(kUnseen);
    for (std::int32_t k = cells.first[slot]; k < cells.first[slot + 1]; ++k) {
      const float z = cells.points[static_cast<std::size_t>(k)].z;
      if (!(z < lowest.back())) continue;
      std::size_t at = kLookAt - 1;
      for (; at > 0 && lowest[at - 1] > z; --at) lowest[at] = lowest[at - 1];
      lowest[at] = z;
    }
    for (std::size_t k = 1; k < kLookAt; ++k)
      if (lowest[k] - lowest[k - 1] <= band_) return lowest[k - 1];
    return kUnseen;
  }

  [[nodiscard]] float seen_at(float x, float y) const {
    const std::int32_t cell = surface_.lattice().cell_at(x, y);
    const std::int32_t slot =
        cell < 0 ? -1 : surface_.cells.slot_of[static_cast<std::size_t>(cell)];
    return slot < 0 ? kUnseen : workspace_.seen[static_cast<std::size_t>(slot)];
  }

  [[nodiscard]] bool is_buried(const CellPoint& p) const {
    const auto index = static_cast<std::size_t>(p.index);
    if (!origins_.is_measured(index)) return false;
    const BeamWalk walk{kOpening, surface_.lattice().cell_size, kFarthest};
    int crossed = 0, unseen = 0;
    float before = 0.0F;  // height of the ground that was crossed last
    bool comes_out = false;
    const bool at_sensor = walk_back(p, origins_.of(index), walk, [&](float x, float y, float z) {
      const float seen = seen_at(x, y);
      if (seen == kUnseen) return ++unseen <= kMostUnseen;
      comes_out = z > seen - kBelow;
      if (comes_out) {
        comes_out = std::abs(before - seen) <= kJump;
        return false;
      }
      ++crossed;
      before = seen;
      return true;
    });
    // Into the blind spot: it comes out there.
    if (at_sensor) comes_out = std::abs(before) <= kNearRobot;
    return crossed >= kFewestCrossed && comes_out;
  }

  void keep_others(std::size_t slot) const {
    const CellPoints& cells = surface_.cells;
    BuriedInCells& buried = workspace_.buried;
    const auto first = static_cast<std::int32_t>(buried.kept.size());
    for (std::int32_t k = cells.first[slot]; k < cells.first[slot + 1]; ++k) {
      const CellPoint& p = cells.points[static_cast<std::size_t>(k)];
      if (!is_buried(p)) buried.kept.push_back(p);
    }
    buried.cells.push_back(
        {static_cast<std::int32_t>(slot), first, static_cast<std::int32_t>(buried.kept.size())});
  }

  const BeamOrigins& origins_;
  float band_;
  const GroundSurface& surface_;
  GroundSurfaceWorkspace& workspace_;
};

}  // namespace

void find_buried_points(const BeamOrigins& origins, float band, const GroundSurface& surface,
                        GroundSurfaceWorkspace& workspace) {
  workspace.buried.cells.clear();
  workspace.buried.kept.clear();
  if (origins.known()) BuriedPoints(origins, band, surface, workspace).find();
}

}  // namespace mrpt_terrain
