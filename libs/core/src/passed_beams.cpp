// SPDX-License-Identifier: BSD-3-Clause
#include "passed_beams.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "thing_pieces.h"

namespace mrpt_terrain {
namespace {

// Beams are followed so far behind a place; over level ground no farther than where they would have
// to come down, and this much more, metres.
constexpr float kBehind = 12.0F;
constexpr float kUneven = 2.0F;
// How far below the top of a thing a beam has to be to have passed where it would stand, metres.
constexpr float kMargin = 0.03F;
// Things with a gap of less than this across the beams may be one: noise, metres, and two columns
// of a sensor with 0.35 deg between them, radians.
constexpr float kNoise = 0.05F;
constexpr float kColumns = 0.012F;

/// Centre of a part of a cell, in parts from the first corner of the cell that it is counted from.
struct Part {
  int l = 0, w = 0;
};

/// The parts of two cells that are nearest to each other; of equal distances, the first.
struct NearestParts {
  Part a, b;

  // \param offset_l, offset_w from the first cell to the second, cells
  NearestParts(std::uint16_t of_a, std::uint16_t of_b, int offset_l, int offset_w) {
    constexpr int kParts = FieldCells::kParts;
    int least = 1 << 30;
    for (int i = 0; i < kParts * kParts; ++i) {
      if ((of_a >> i & 1) == 0) continue;
      for (int k = 0; k < kParts * kParts; ++k) {
        if ((of_b >> k & 1) == 0) continue;
        const Part from{i / kParts, i % kParts};
        const Part to{kParts * offset_l + k / kParts, kParts * offset_w + k % kParts};
        const int dl = to.l - from.l, dw = to.w - from.w;
        if (dl * dl + dw * dw >= least) continue;
        least = dl * dl + dw * dw;
        a = from;
        b = to;
      }
    }
  }
};

}  // namespace

PassedBeams::PassedBeams(const ElevationGrid& grid, const FieldCells& cells,
                         const std::array<float, 3>& sensor)
    : grid_(grid),
      cells_(cells),
      sensor_(sensor),
      cell_(static_cast<float>(grid.geometry.cell_size())) {}

Slot PassedBeams::slot_at(double x, double y) const {
  CellIndex cell;
  return grid_.geometry.cell_at(x, y, cell) ? grid_.slot_at(cell) : kUnobserved;
}

bool PassedBeams::have_passed(const Position2& at, float ground, float top) const {
  const float dx = static_cast<float>(at.x) - sensor_[0];
  const float dy = static_cast<float>(at.y) - sensor_[1];
  const float range = std::hypot(dx, dy);
  if (range < cell_) return false;
  float last = kBehind;
  if (sensor_[2] > top)
    last = std::min(last, range * (top - ground) / (sensor_[2] - top) + kUneven);
  for (float d = cell_; d <= last; d += cell_) {
    const float share = (range + d) / range;
    const Slot slot = slot_at(static_cast<double>(sensor_[0] + share * dx),
                              static_cast<double>(sensor_[1] + share * dy));
    if (slot == kUnobserved) continue;
    const auto s = static_cast<std::size_t>(slot);
    const bool floor = cells_.on[s] + cells_.below[s] > 0;
    const float low = floor ? cells_.floor[s] : cells_.ground[s] + cells_.low[s];
    // The point lies anywhere in its cell.
    const float fall = (low - sensor_[2]) / (range + d);
    if (sensor_[2] + fall * range < top - kMargin - std::abs(fall) * cell_) return true;
  }
  return false;
}

bool PassedBeams::divide(std::size_t slot_a, std::size_t slot_b) const {
  if (cells_.parts.empty()) return false;
  const std::uint16_t of_a = cells_.parts[slot_a], of_b = cells_.parts[slot_b];
  if (of_a == 0 || of_b == 0) return false;
  const CellIndex a = grid_.geometry.index_of(grid_.cell[slot_a]);
  const CellIndex b = grid_.geometry.index_of(grid_.cell[slot_b]);
  const NearestParts nearest(of_a, of_b, b.l - a.l, b.w - a.w);
  const double part = grid_.geometry.cell_size() / FieldCells::kParts;
  const double dx = part * (nearest.b.l - nearest.a.l), dy = part * (nearest.b.w - nearest.a.w);
  const Position2 centre = grid_.geometry.centre_of(a);
  const double corner = 0.5 * (part - grid_.geometry.cell_size());
  const Position2 middle{centre.x + corner + part * nearest.a.l + 0.5 * dx,
                         centre.y + corner + part * nearest.a.w + 0.5 * dy};
  const double to_x = middle.x - static_cast<double>(sensor_[0]);
  const double to_y = middle.y - static_cast<double>(sensor_[1]);
  const double range = std::hypot(to_x, to_y);
  // Points lie anywhere in their parts.
  const double across = std::abs(dx * to_y - dy * to_x) / range - part;
  if (!(across >= static_cast<double>(kNoise) + static_cast<double>(kColumns) * range))
    return false;
  const float ground = cells_.ground[slot_a];
  const float top = std::min(high_of(cells_, slot_a), high_of(cells_, slot_b));
  return have_passed(middle, ground, ground + top);
}

}  // namespace mrpt_terrain
