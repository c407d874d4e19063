// SPDX-License-Identifier: BSD-3-Clause
#include "ditch_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mrpt_terrain {
namespace {

// Depth of a ditch below the ground on its sides, metres.
constexpr float kShallowest = 0.12F, kDeepest = 0.8F;
// The sides are looked for so many cells away: 4 m.
constexpr int kReach = 10;
// Ground whose weight and smoothness are less is no side: it may be grass.
constexpr float kLeastWeight = 0.3F, kLeastSmooth = 0.7F;
// Behind its edge, a side goes on over one or two cells. Those, and the other side, may be so much
// higher or lower, metres, and this much more per metre of distance.
constexpr int kBehind = 2;
constexpr float kLevel = 0.06F, kGradient = 0.1F;
// A ditch is at least so deep per metre to the nearer side: valleys are flatter.
constexpr float kSteep = 0.1F;
// Cells up to so many cells away along each axis, 4.8 m, are looked at to tell what is rare: those
// of less than half the depth may be at most this share of those as high as the sides.
constexpr int kAround = 12;
constexpr float kRare = 0.3F;
// As high are those up to this many metres, and this share of the depth, above or below.
constexpr float kAsHigh = 0.1F, kAsHighShare = 0.2F;
// Blocks of cells remember the highest side in them, and how high the lower one of two sides may be
// at most, so that most cells need no closer look.
constexpr int kBlockLevel = 2;
constexpr int kBlocks = 3;

constexpr float kUnknown = std::numeric_limits<float>::max();

// One cell on.
constexpr LatticeCell kAlongRows{0, 1}, kAlongColumns{1, 0};

class DitchFinder {
 public:
  DitchFinder(const GroundSurface& surface, GroundSurfaceWorkspace& workspace)
      : surface_(surface),
        cells_(surface.cells),
        height_(workspace.above_plane),
        tops_(workspace.block_tops),
        sides_(workspace.block_sides),
        side_(surface.lattice().side),
        blocks_(side_ >> kBlockLevel) {
    measure_heights();
    find_tops();
  }

  [[nodiscard]] bool is_in_ditch(std::size_t slot) {
    const LatticeCell at = cells_.cell[slot];
    const float low = height_[slot];
    if (highest_sides(at) < low + kShallowest) return false;
    const float depth =
        std::max(depth_between(at, kAlongRows, low), depth_between(at, kAlongColumns, low));
    return depth >= kShallowest && is_rare(at, low, depth);
  }

 private:
  struct Edge {
    int steps = 0;
    float height = 0.0F;
  };

  // Of the low heights, above the plane near the robot.
  void measure_heights() {
    height_.resize(cells_.occupied());
    for (std::size_t slot = 0; slot < cells_.occupied(); ++slot) {
      const LatticeCell at = cells_.cell[slot];
      const float plane = surface_.gradient_x * surface_.lattice().centre(at.row) +
                          surface_.gradient_y * surface_.lattice().centre(at.column);
      height_[slot] = surface_.ground[slot].low - plane;
    }
  }
  [[nodiscard]] bool is_side(std::size_t slot) const {
    const GroundCell& ground = surface_.ground[slot];
    return ground.weight >= kLeastWeight && ground.smooth >= kLeastSmooth;
  }
  void find_tops() {
    const std::size_t n = static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(blocks_);
    tops_.assign(n, std::numeric_limits<float>::lowest());
    sides_.assign(n, kUnknown);
    for (std::size_t slot = 0; slot < cells_.occupied(); ++slot) {
      if (!is_side(slot)) continue;
      const LatticeCell at = cells_.cell[slot];
      float& top = tops_[block(at.row >> kBlockLevel, at.column >> kBlockLevel)];
      top = std::max(top, height_[slot]);
    }
  }
  [[nodiscard]] std::size_t block(int row, int column) const {
    return static_cast<std::size_t>(row * blocks_ + column);
  }
  [[nodiscard]] float highest_on(int row, int column, LatticeCell step, int sign) const {
    float highest = tops_[block(row, column)];
    for (int k = 1; k <= kBlocks; ++k) {
      const int r = row + sign * k * step.row, c = column + sign * k * step.column;
      if (r < 0 || c < 0 || r >= blocks_ || c >= blocks_) break;
      highest = std::max(highest, tops_[block(r, c)]);
    }
    return highest;
  }
  // How high the lower one of two opposite sides of the cells of a block is at most.
  float highest_sides(LatticeCell at) {
    const int row = at.row >> kBlockLevel, column = at.column >> kBlockLevel;
    float& known = sides_[block(row, column)];
    if (known != kUnknown) return known;
    known = std::numeric_limits<float>::lowest();
    for (const LatticeCell step : {kAlongRows, kAlongColumns}) {
      const float after = highest_on(row, column, step, 1);
      known = std::max(known, std::min(after, highest_on(row, column, step, -1)));
    }
    return known;
  }

  // Slot of a cell that is so many steps away, or -1.
  [[nodiscard]] std::int32_t slot_at(LatticeCell at, LatticeCell step, int steps) const {
    const int row = at.row + steps * step.row, column = at.column + steps * step.column;
    if (row < 0 || column < 0 || row >= side_ || column >= side_) return -1;
    return cells_.slot_of[cells_.number_of({row, column})];
  }
  [[nodiscard]] float permitted(int steps) const {
    return kLevel + kGradient * surface_.lattice().cell_size * static_cast<float>(std::abs(steps));
  }
  // The first side on the way, in steps of +1 or -1; false if there is none.
  bool find_edge(LatticeCell at, LatticeCell step, int sign, float low, Edge& edge) const {
    for (int k = 1; k <= kReach; ++k) {
      const std::int32_t item = slot_at(at, step, sign * k);
      if (item < 0) continue;
      const auto slot = static_cast<std::size_t>(item);
      if (height_[slot] > low + kDeepest) return false;
      if (height_[slot] < low + kShallowest || !is_side(slot)) continue;
      edge = {k, height_[slot]};
      return goes_on(at, step, sign, edge);
    }
    return false;
  }
  [[nodiscard]] bool goes_on(LatticeCell at, LatticeCell step, int sign, const Edge& edge) const {
    int seen = 0;
    for (int k = 1; k <= kBehind; ++k) {
      const std::int32_t slot = slot_at(at, step, sign * (edge.steps + k));
      if (slot < 0) continue;
      if (std::abs(height_[static_cast<std::size_t>(slot)] - edge.height) > permitted(k))
        return false;
      ++seen;
    }
    return seen > 0;
  }
  // How far a cell lies below the line between both sides, 0 if there are none.
  [[nodiscard]] float depth_between(LatticeCell at, LatticeCell step, float low) const {
    Edge after, before;
    if (!find_edge(at, step, 1, low, after) || !find_edge(at, step, -1, low, before)) return 0.0F;
    const int steps = after.steps + before.steps;
    if (std::abs(after.height - before.height) > permitted(steps)) return 0.0F;
    const float line = after.height * static_cast<float>(before.steps) +
                       before.height * static_cast<float>(after.steps);
    const float depth = line / static_cast<float>(steps) - low;
    const int nearer = std::min(after.steps, before.steps);
    const float steep = kSteep * surface_.lattice().cell_size * static_cast<float>(nearer);
    return depth >= steep ? depth : 0.0F;
  }
  [[nodiscard]] bool is_rare(LatticeCell at, float low, float depth) const {
    int as_low = 0, as_high = 0;
    for (int row = -kAround; row <= kAround; ++row) {
      for (int column = -kAround; column <= kAround; ++column) {
        const std::int32_t item = slot_at(at, {row, column}, 1);
        if (item < 0) continue;
        const auto slot = static_cast<std::size_t>(item);
        const float height = height_[slot] - low;
        if (height < 0.5F * depth) {
          ++as_low;
        } else if (std::abs(height - depth) < kAsHigh + kAsHighShare * depth) {
          as_high += surface_.ground[slot].smooth >= kLeastSmooth ? 1 : 0;
        }
      }
    }
    return static_cast<float>(as_low) <= kRare * static_cast<float>(as_high);
  }

  const GroundSurface& surface_;
  const CellPoints& cells_;
  std::vector<float>& height_;  ///< per slot: low height above the plane near the robot
  std::vector<float>& tops_;    ///< per block: highest side
  std::vector<float>& sides_;   ///< per block: `highest_sides`, where asked for
  int side_, blocks_;
};

}  // namespace

void find_ditch_cells(const GroundSurface& surface, GroundSurfaceWorkspace& workspace) {
  DitchFinder finder(surface, workspace);
  const std::size_t n = surface.cells.occupied();
  workspace.in_ditch.resize(n);
  for (std::size_t slot = 0; slot < n; ++slot)
    workspace.in_ditch[slot] = finder.is_in_ditch(slot) ? 1 : 0;
}

}  // namespace mrpt_terrain
