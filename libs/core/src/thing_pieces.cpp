// SPDX-License-Identifier: BSD-3-Clause
#include "thing_pieces.h"

#include <cmath>

namespace mrpt_terrain {

void ThingPiece::add(float px, float py, float reference, float lowest, float highest) {
  const float u = px - first_x, v = py - first_y;
  n += 1.0F;
  x += u;
  y += v;
  xx += u * u;
  xy += u * v;
  yy += v * v;
  ground += reference;
  top += highest;
  low = std::min(low, lowest);
  high = std::max(high, highest);
}

void ThingPiece::finish() {
  const float share = 1.0F / n;
  const float u = x * share, v = y * share;
  const float cxx = xx * share - u * u, cxy = xy * share - u * v, cyy = yy * share - v * v;
  x = first_x + u;
  y = first_y + v;
  ground *= share;
  top *= share;
  // Direction of the greatest eigenvalue of a symmetric 2 x 2 matrix.
  const float angle = 0.5F * std::atan2(2.0F * cxy, cxx - cyy);
  along_x = std::cos(angle);
  along_y = std::sin(angle);
}

void ThingPiece::extend(float px, float py) {
  const float u = along_of(px, py), v = across_of(px, py);
  begin = std::min(begin, u);
  end = std::max(end, u);
  right = std::min(right, v);
  left = std::max(left, v);
}

namespace {

/// Centres of cells, asked for in the order of the slots: rows are counted, not divided for.
class Centres {
 public:
  explicit Centres(const ElevationGrid& grid) : grid_(grid) {}
  void move_to(std::size_t slot) {
    const std::int32_t id = value_of(grid_.cell[slot]), stride = grid_.geometry.stride();
    while (id >= end_) {
      ++row_;
      end_ += stride;
    }
    const Position2 at = grid_.geometry.centre_of({row_, id - end_ + stride - 1});
    x = static_cast<float>(at.x);
    y = static_cast<float>(at.y);
  }
  float x = 0.0F, y = 0.0F;

 private:
  const ElevationGrid& grid_;
  int row_ = -1;
  std::int32_t end_ = grid_.geometry.stride();  ///< first cell of the next row
};

}  // namespace

void ThingPieces::separate(IndexRange slots, const std::vector<std::int32_t>& part_of,
                           std::size_t parts) const {
  std::vector<std::int32_t>& first = workspace.first_of;
  first.assign(parts, -1);
  for (const std::int32_t item : slots) {
    const auto slot = static_cast<std::size_t>(item);
    std::int32_t& root = first[static_cast<std::size_t>(part_of[slot])];
    if (root < 0) root = item;
    workspace.parent[slot] = root;
  }
}

void ThingPieces::list_cells() const {
  IndexRows& rows = workspace.piece_cells;
  const std::vector<std::int32_t>& members = workspace.points_of;
  rows.first.assign(1, 0);
  for (const ThingPiece& piece : workspace.pieces)
    rows.first.push_back(rows.first.back() + static_cast<std::int32_t>(piece.n));
  rows.items.resize(members.size());
  std::vector<std::int32_t>& next = workspace.first_of;
  next.assign(rows.first.begin(), rows.first.end());
  for (const std::int32_t member : members) {
    const std::int32_t number = workspace.number_of[static_cast<std::size_t>(member)];
    rows.items[static_cast<std::size_t>(next[static_cast<std::size_t>(number)]++)] = member;
  }
}

void ThingPieces::find_members() const {
  workspace.number_of.assign(cells.size(), -1);
  std::vector<std::int32_t>& members = workspace.points_of;
  members.resize(cells.size());
  std::size_t count = 0;
  for (std::size_t slot = 0; slot < cells.size(); ++slot) {
    members[count] = static_cast<std::int32_t>(slot);
    count += is_member(slot) ? 1 : 0;
  }
  members.resize(count);
}

void ThingPieces::measure() const {
  std::vector<ThingPiece>& pieces = workspace.pieces;
  pieces.clear();
  const std::vector<std::int32_t>& members = workspace.points_of;
  Centres centres(grid);
  for (const std::int32_t member : members) {
    const auto slot = static_cast<std::size_t>(member);
    // The parent of a cell is an earlier one, or itself.
    const std::int32_t parent = workspace.parent[slot];
    const bool first = parent == static_cast<std::int32_t>(slot);
    centres.move_to(slot);
    if (first) {
      workspace.number_of[slot] = static_cast<std::int32_t>(pieces.size());
      pieces.emplace_back();
      pieces.back().slot = parent;
      pieces.back().first_x = centres.x;
      pieces.back().first_y = centres.y;
    }
    const std::int32_t number = workspace.number_of[static_cast<std::size_t>(parent)];
    workspace.number_of[slot] = number;
    ThingPiece& piece = pieces[static_cast<std::size_t>(number)];
    piece.add(centres.x, centres.y, cells.ground[slot], low_of(cells, slot), high_of(cells, slot));
    piece.above += static_cast<float>(cells.above[slot]);
    piece.raised += static_cast<float>(cells.raised[slot]);
    piece.sharp += static_cast<float>(cells.sharp_edges[slot]);
    piece.edges += static_cast<float>(cells.sharp_edges[slot] + cells.smooth_edges[slot]);
    piece.hangs = piece.hangs || (cells.on[slot] > 0 && hangs(slot));
  }
  for (ThingPiece& piece : pieces) piece.finish();
  Centres again(grid);
  for (const std::int32_t member : members) {
    const auto slot = static_cast<std::size_t>(member);
    again.move_to(slot);
    pieces[static_cast<std::size_t>(workspace.number_of[slot])].extend(again.x, again.y);
  }
}

}  // namespace mrpt_terrain
