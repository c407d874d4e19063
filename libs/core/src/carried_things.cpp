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
constexpr float kParallel = 0.1F;
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
  const float length = std::hypot(a.x - b.x, a.y - b.y);
  return std::abs(a.high - b.high) <= kAsHigh && length >= kShortSide && length <= kLongSide;
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
        if (are_alike(first, second) &&
            (are_opposite(first, second) || are_opposite(second, first)))
          pieces_.unite(first.slot, second.slot);
      }
    }
  }

 private:
  [[nodiscard]] bool is_wall(const ThingPiece& piece) const {
    const float length = piece.end - piece.begin + cell_;
    return piece.high > kWallHeight && length >= kWallLength && length <= kMostWallLength &&
           length >= kSlender * (piece.left - piece.right + cell_);
  }
  static bool are_alike(const ThingPiece& a, const ThingPiece& b) {
    return std::abs(a.high - b.high) <= std::max(kAsHigh, kTopShare * std::max(a.high, b.high)) &&
           std::abs(a.along_x * b.along_y - a.along_y * b.along_x) <= kParallel;
  }
  // Whether both ends of one wall are opposite those of another, or one end, where the rest of the
  // shorter wall may be hidden.
  [[nodiscard]] bool are_opposite(const ThingPiece& a, const ThingPiece& b) const {
    Extent of_b;
    of_b.add(b, {a.x, a.y, a.along_x, a.along_y});
    const float span = std::max(of_b.right - a.left, a.right - of_b.left);
    if (span < kNarrowSpan || span > kWideSpan) return false;
    const bool begins = std::abs(of_b.begin - a.begin) <= kOpposite;
    const bool ends = std::abs(of_b.end - a.end) <= kOpposite;
    if (begins && ends) return true;
    const float across = 0.5F * (of_b.right + of_b.left), top = std::min(a.top, b.top);
    if (begins && of_b.end < a.end) return is_hidden(a, of_b.end, a.end, across, top);
    return ends && of_b.begin > a.begin && is_hidden(a, a.begin, of_b.begin, across, top);
  }
  // Whether no beam has passed where a wall would go on, opposite a part of another one.
  [[nodiscard]] bool is_hidden(const ThingPiece& wall, float begin, float end, float across,
                               float top) const {
    if (beams_ == nullptr) return false;
    for (float s = begin + cell_; s < end; s += cell_)
      if (beams_->have_passed(wall.place(s, across), wall.ground, wall.ground + top)) return false;
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
