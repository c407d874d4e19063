// SPDX-License-Identifier: BSD-3-Clause
#include "carried_things.h"

#include <algorithm>
#include <cmath>

#include "line_extent.h"
#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Legs are at most so wide (centres of cells), and at most so far from what is seen of that which
// they carry, metres; those that are nearly as high may be farther away. A column of points on a
// wall that carries a deck is one, too.
constexpr float kLegWidth = 0.3F;
constexpr double kLegReach = 0.8, kHighLegReach = 1.0;
// Parts of what hangs, seen by a ring here and one there, are at most so far apart, metres.
constexpr double kHangingGap = 0.6;
// Three or four legs are at most so high; sides of their rectangle, by how much their heights may
// differ, by how much the fourth may be off, metres; cosine of the angle between two sides.
constexpr float kLegHeight = 1.5F;
constexpr float kShortSide = 0.4F, kLongSide = 2.0F;
constexpr float kAsHigh = 0.15F;
constexpr float kCorner = 0.25F;
constexpr float kSquare = 0.2F;
// Two walls that carry a deck: so high, so long (longer ones line corridors and streets), so many
// times as long as wide, so far apart, and their ends at most so far from opposite, metres; sine of
// the angle between them, and by which share their heights may differ: the top ring ends lower on
// the nearer one.
constexpr float kWallHeight = 0.8F;
constexpr float kWallLength = 1.5F, kMostWallLength = 6.0F, kSlender = 2.5F;
constexpr float kNarrowSpan = 1.5F, kWideSpan = 5.0F;
constexpr float kOpposite = 0.3F;
constexpr float kParallel = 0.2F;
constexpr float kTopShare = 0.3F;

bool is_post(const ThingPiece& piece, const FieldClusterParams& params) {
  return piece.end - piece.begin <= kLegWidth && piece.left - piece.right <= kLegWidth &&
         piece.high > static_cast<float>(params.step) &&
         piece.high - piece.low > static_cast<float>(params.flat);
}

int cells_within(const GridGeometry& geometry, double distance) {
  return static_cast<int>(std::lround(distance / geometry.cell_size()));
}

void link_to_hanging(const ThingPieces& pieces, const ThingPiece& leg) {
  const GridGeometry& geometry = pieces.grid.geometry;
  const int near = cells_within(geometry, kLegReach);
  const auto level = static_cast<float>(pieces.params.level);
  const auto step = static_cast<float>(pieces.params.step);
  const auto flat = static_cast<float>(pieces.params.flat);
  const auto foot = static_cast<std::size_t>(leg.slot);
  const CellIndex at = geometry.index_of(pieces.grid.cell[foot]);
  for_slots_around(
      pieces.grid, foot, cells_within(geometry, kHighLegReach), [&](std::size_t other) {
        const ThingPiece* carried = pieces.of(other);
        if (carried == nullptr || carried == &leg || !carried->hangs || !pieces.hangs(other))
          return;
        if (leg.high > pieces.cells.high[other] + level ||
            leg.high < pieces.cells.low[other] - step)
          return;
        const CellIndex top = geometry.index_of(pieces.grid.cell[other]);
        const int apart = std::max(std::abs(top.l - at.l), std::abs(top.w - at.w));
        if (apart > near && carried->high > leg.high + flat) return;
        pieces.unite(leg.slot, carried->slot);
      });
}

void link_hanging(const ThingPieces& pieces) {
  const GridGeometry& geometry = pieces.grid.geometry;
  const auto level = static_cast<float>(pieces.params.level);
  const int reach = cells_within(geometry, kHangingGap);
  CellBits& hanging = pieces.workspace.raised;
  hanging.clear(geometry);
  for (const std::int32_t member : pieces.workspace.points_of) {
    const auto slot = static_cast<std::size_t>(member);
    const ThingPiece* piece = pieces.of(slot);
    if (!piece->hangs || !pieces.hangs(slot)) continue;
    const CellIndex at = geometry.index_of(pieces.grid.cell[slot]);
    hanging.for_marked_before(at, reach, [&](CellIndex near) {
      const Slot other = pieces.grid.slot_at(near);
      const auto beside = static_cast<std::size_t>(other);
      if (pieces.of(beside) == piece) return;
      if (std::abs(pieces.cells.high[beside] - pieces.cells.high[slot]) <= level)
        pieces.unite(member, other);
    });
    hanging.mark(at);
  }
}

bool is_side(const ThingPiece& a, const ThingPiece& b) {
  if (std::abs(a.high - b.high) > kAsHigh) return false;  // most posts, and quick to see
  const float length = std::hypot(a.x - b.x, a.y - b.y);
  return length >= kShortSide && length <= kLongSide;
}

bool is_right_angle(const ThingPiece& corner, const ThingPiece& a, const ThingPiece& b) {
  const float ux = a.x - corner.x, uy = a.y - corner.y;
  const float vx = b.x - corner.x, vy = b.y - corner.y;
  return std::abs(ux * vx + uy * vy) <= kSquare * std::hypot(ux, uy) * std::hypot(vx, vy);
}

// Whether a post is the fourth corner of a rectangle.
bool is_opposite(const ThingPiece& corner, const ThingPiece& a, const ThingPiece& b,
                 const ThingPiece& opposite) {
  return std::abs(corner.high - opposite.high) <= kAsHigh &&
         std::hypot(opposite.x - a.x - b.x + corner.x, opposite.y - a.y - b.y + corner.y) <=
             kCorner;
}

void link_rectangles(const ThingPieces& pieces) {
  std::vector<std::int32_t>& posts = pieces.workspace.posts;
  const auto piece = [&pieces](std::int32_t number) -> const ThingPiece& {
    return pieces.all()[static_cast<std::size_t>(number)];
  };
  posts.erase(std::remove_if(posts.begin(), posts.end(),
                             [&](std::int32_t post) { return piece(post).high >= kLegHeight; }),
              posts.end());
  for (const std::int32_t corner : posts) {
    const ThingPiece& c = piece(corner);
    for (std::size_t i = 0; i < posts.size(); ++i) {
      const ThingPiece& a = piece(posts[i]);
      if (!is_side(c, a)) continue;
      for (std::size_t k = i + 1; k < posts.size(); ++k) {
        const ThingPiece& b = piece(posts[k]);
        if (!is_side(c, b) || !is_right_angle(c, a, b)) continue;
        // The fourth leg may be hidden.
        if (std::abs(a.high - b.high) <= kAsHigh)
          for (const ThingPiece* leg : {&a, &b}) pieces.unite(c.slot, leg->slot);
        for (const std::int32_t opposite : posts) {
          const ThingPiece& d = piece(opposite);
          if (opposite == corner || !is_opposite(c, a, b, d)) continue;
          for (const ThingPiece* leg : {&a, &b, &d}) pieces.unite(c.slot, leg->slot);
        }
      }
    }
  }
}

/// Looks for walls opposite each other.
class AbutmentLinker {
 public:
  AbutmentLinker(const ThingPieces& pieces, const PassedBeams* beams)
      : pieces_(pieces),
        beams_(beams),
        cell_(static_cast<float>(pieces.grid.geometry.cell_size())) {}

  void link() const {
    std::vector<std::int32_t>& walls = pieces_.workspace.posts;
    walls.clear();
    for (std::size_t k = 0; k < pieces_.all().size(); ++k)
      if (is_wall(pieces_.all()[k])) walls.push_back(static_cast<std::int32_t>(k));
    for (std::size_t b = 1; b < walls.size(); ++b) {
      const ThingPiece& second = pieces_.all()[static_cast<std::size_t>(walls[b])];
      for (std::size_t a = 0; a < b; ++a) {
        const ThingPiece& first = pieces_.all()[static_cast<std::size_t>(walls[a])];
        if (!are_alike(first, second)) continue;
        const Line line = line_between(first, second);
        const Wall one{first, line}, other{second, line};
        if (are_opposite(one, other) || are_opposite(other, one))
          pieces_.unite(first.slot, second.slot);
      }
    }
  }

 private:
  /// A wall along the line between two.
  struct Wall {
    Wall(const ThingPiece& p, const Line& along) : piece(p), line(along) { extent.add(p, along); }
    [[nodiscard]] float middle() const { return 0.5F * (extent.right + extent.left); }
    const ThingPiece& piece;
    const Line& line;
    Extent extent;
  };

  [[nodiscard]] bool is_wall(const ThingPiece& piece) const {
    const float length = piece.end - piece.begin + cell_;
    return piece.high > kWallHeight && length >= kWallLength && length <= kMostWallLength &&
           length >= kSlender * (piece.left - piece.right + cell_);
  }
  static bool are_alike(const ThingPiece& a, const ThingPiece& b) {
    return std::abs(a.high - b.high) <= std::max(kAsHigh, kTopShare * std::max(a.high, b.high)) &&
           std::abs(a.along_x * b.along_y - a.along_y * b.along_x) <= kParallel;
  }
  // Along both walls. Of each, the side that faces the other one is seen, and the same end: this
  // turns their own directions against each other, a short wall's more than a long one's.
  static Line line_between(const ThingPiece& a, const ThingPiece& b) {
    const float length_a = a.end - a.begin, length_b = b.end - b.begin;
    const float same = a.along_x * b.along_x + a.along_y * b.along_y < 0.0F ? -1.0F : 1.0F;
    const float weight_a = length_a * length_a, weight_b = same * length_b * length_b;
    const float x = weight_a * a.along_x + weight_b * b.along_x;
    const float y = weight_a * a.along_y + weight_b * b.along_y;
    const float length = std::hypot(x, y);
    return {a.x, a.y, x / length, y / length};
  }
  // Whether both ends of one wall are opposite those of another, or one end, where the rest of the
  // shorter wall may be hidden.
  [[nodiscard]] bool are_opposite(const Wall& a, const Wall& b) const {
    const Extent &of_a = a.extent, &of_b = b.extent;
    const float span = std::max(of_b.right - of_a.left, of_a.right - of_b.left);
    if (span < kNarrowSpan || span > kWideSpan) return false;
    const bool begins = std::abs(of_b.begin - of_a.begin) <= kOpposite;
    const bool ends = std::abs(of_b.end - of_a.end) <= kOpposite;
    if (begins && ends) return true;
    const float top = std::min(a.piece.top, b.piece.top);
    if (begins && of_b.end < of_a.end) return is_hidden(a, b, of_b.end, of_a.end, top);
    return ends && of_b.begin > of_a.begin && is_hidden(a, b, of_a.begin, of_b.begin, top);
  }
  // Whether no beam has passed where wall `b` would go on, opposite a part of `a`.
  [[nodiscard]] bool is_hidden(const Wall& a, const Wall& b, float begin, float end,
                               float top) const {
    if (beams_ == nullptr) return false;
    for (float s = begin + cell_; s < end; s += cell_)
      if (beams_->have_passed(a.line.place(s, b.middle()), a.piece.ground, a.piece.ground + top))
        return false;
    return true;
  }

  const ThingPieces& pieces_;
  const PassedBeams* beams_;
  float cell_;
};

}  // namespace

void link_carried_things(const ThingPieces& pieces) {
  std::vector<std::int32_t>& posts = pieces.workspace.posts;
  posts.clear();
  for (std::size_t k = 0; k < pieces.all().size(); ++k)
    if (is_post(pieces.all()[k], pieces.params)) posts.push_back(static_cast<std::int32_t>(k));
  for (const std::int32_t post : posts)
    link_to_hanging(pieces, pieces.all()[static_cast<std::size_t>(post)]);
  link_hanging(pieces);
  link_rectangles(pieces);
}

void link_abutments(const ThingPieces& pieces, const PassedBeams* beams) {
  AbutmentLinker(pieces, beams).link();
}

}  // namespace mrpt_terrain
