// SPDX-License-Identifier: BSD-3-Clause
#include "passed_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "length_of.h"
#include "slots_around.h"
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
constexpr double kNoise = 0.05;
constexpr double kColumns = 0.012;

constexpr int kParts = FieldCells::kParts;

// The parts of a cell on a board of two by two cells, a byte per row of parts.
std::uint64_t on_board(std::uint16_t parts, bool lower, bool right) {
  std::uint64_t board = 0;
  for (int l = 0; l < kParts; ++l) {
    const std::uint64_t row = parts >> (kParts * l) & 0xFU;
    board |= row << (8 * (lower ? kParts + l : l) + (right ? kParts : 0));
  }
  return board;
}

// Whether parts of two cells that touch do so as well, if only at corners.
bool parts_touch(std::uint16_t of_a, std::uint16_t of_b, CellIndex offset) {
  static_assert(kParts == 4, "a board has 64 parts");
  const std::uint64_t a = on_board(of_a, offset.l < 0, offset.w < 0);
  const std::uint64_t b = on_board(of_b, offset.l > 0, offset.w > 0);
  constexpr std::uint64_t kFirstColumn = 0x0101010101010101U;
  std::uint64_t around = a | (a << 1 & ~kFirstColumn) | (a >> 1 & ~(kFirstColumn << 7));
  around |= around << 8 | around >> 8;
  return (around & b) != 0;
}

/// The parts of a cell that are marked, one after the other.
struct MarkedParts {
  std::array<CellIndex, kParts * kParts> part;
  std::size_t size = 0;

  MarkedParts(std::uint16_t marks, CellIndex offset) {
    for (int k = 0; k < kParts * kParts; ++k) {
      part[size] = {kParts * offset.l + k / kParts, kParts * offset.w + k % kParts};
      size += marks >> k & 1U;
    }
  }
  [[nodiscard]] const CellIndex* begin() const { return part.data(); }
  [[nodiscard]] const CellIndex* end() const { return part.data() + size; }
};

/// The parts of two cells that are nearest to each other; of equal distances, the first. Counted
/// from the first part of the first cell.
struct NearestParts {
  CellIndex a, b;

  NearestParts(std::uint16_t of_a, std::uint16_t of_b, CellIndex offset) {
    const MarkedParts all_a(of_a, {0, 0}), all_b(of_b, offset);
    int least = 1 << 30;
    for (const CellIndex from : all_a) {
      for (const CellIndex to : all_b) {
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

bool PassedBeams::have_passed(const Position2& at, float ground, float top) const {
  const float dx = static_cast<float>(at.x) - sensor_[0];
  const float dy = static_cast<float>(at.y) - sensor_[1];
  const float range = length_of(dx, dy);
  if (range < cell_) return false;
  float last = kBehind;
  if (sensor_[2] > top)
    last = std::min(last, range * (top - ground) / (sensor_[2] - top) + kUneven);
  for (float d = cell_; d <= last; d += cell_) {
    const float share = (range + d) / range;
    const Slot slot = slot_at(grid_, {static_cast<double>(sensor_[0] + share * dx),
                                      static_cast<double>(sensor_[1] + share * dy)});
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

bool PassedBeams::between_columns(const Position2& begin, const Position2& end) const {
  const double x = begin.x - static_cast<double>(sensor_[0]);
  const double y = begin.y - static_cast<double>(sensor_[1]);
  const double range = length_of(x, y);
  return std::abs((end.x - begin.x) * y - (end.y - begin.y) * x) <
         range * (kNoise + kColumns * range);
}

bool PassedBeams::divide(std::size_t slot_a, std::size_t slot_b) const {
  if (cells_.parts.empty()) return false;
  const std::uint16_t of_a = cells_.parts[slot_a], of_b = cells_.parts[slot_b];
  if (of_a == 0 || of_b == 0) return false;
  const CellIndex a = grid_.geometry.index_of(grid_.cell[slot_a]);
  const CellIndex b = grid_.geometry.index_of(grid_.cell[slot_b]);
  const CellIndex offset{b.l - a.l, b.w - a.w};
  const bool touching = std::abs(offset.l) <= 1 && std::abs(offset.w) <= 1;
  if (touching && parts_touch(of_a, of_b, offset)) return false;
  const Position2 centre = grid_.geometry.centre_of(a);
  const double beam_x = centre.x - static_cast<double>(sensor_[0]);
  const double beam_y = centre.y - static_cast<double>(sensor_[1]);
  const double range = length_of(beam_x, beam_y);
  const auto across = [&](double x, double y) { return std::abs(x * beam_y - y * beam_x) / range; };
  const double cell = grid_.geometry.cell_size(), part = cell / kParts;
  // Points lie anywhere in their parts.
  const double least = kNoise + kColumns * range + part;
  // Most of what is asked for: parts lie up to 0.375 of a cell off its centre along each axis.
  if (!(across(cell * offset.l, cell * offset.w) + 1.07 * cell >= least)) return false;
  const NearestParts nearest(of_a, of_b, offset);
  const double dx = part * (nearest.b.l - nearest.a.l), dy = part * (nearest.b.w - nearest.a.w);
  if (!(across(dx, dy) >= least)) return false;
  const double first = 0.5 * (part - cell);
  const Position2 middle{centre.x + first + part * nearest.a.l + 0.5 * dx,
                         centre.y + first + part * nearest.a.w + 0.5 * dy};
  const float ground = cells_.ground[slot_a];
  const float top = std::min(high_of(cells_, slot_a), high_of(cells_, slot_b));
  return have_passed(middle, ground, ground + top);
}

}  // namespace mrpt_terrain
