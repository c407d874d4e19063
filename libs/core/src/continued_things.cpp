// SPDX-License-Identifier: BSD-3-Clause
#include "continued_things.h"

#include <algorithm>
#include <cmath>

#include "length_of.h"
#include "line_extent.h"
#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// A thing is long from this length on, metres, if it is so many times as long as wide.
constexpr float kLong = 1.0F;
constexpr float kSlender = 2.5F;
// A gap is at most as long as the thing, and never longer than this, metres.
constexpr float kWidestGap = 4.0F;
// The tops of the two sides may differ by this share of the higher one.
constexpr float kTopShare = 0.3F;
// Low things, such as curbs, are at most so high and so wide across the line through both, and
// rings are at most so far apart on them, metres; of fewer cells nothing tells that line.
constexpr float kLow = 0.3F, kLowWidth = 0.8F;
constexpr float kRingGap = 4.0F;
constexpr float kFewestCells = 2.0F;
// What lies in the strip of a larger low thing, which is so many times as long as wide: how much of
// the ground it may cover, square metres, by how much it may reach out of the strip to the sides,
// and how far it may be from it, metres; as far as rings are apart if it is raised ground.
constexpr float kStripSlender = 2.0F;
constexpr float kPieceArea = 1.2F;
constexpr float kStripMargin = 0.3F;
constexpr float kStripGap = 1.2F;
constexpr float kFar = 1e9F;

/// Ends of the things on both sides of a gap, along a line.
struct Gap {
  float begin, end;
  [[nodiscard]] float length() const { return end - begin; }
};

class Continuation {
 public:
  Continuation(const ThingPieces& pieces, const PassedBeams& beams)
      : pieces_(pieces),
        beams_(beams),
        level_(static_cast<float>(pieces.params.level)),
        cell_(static_cast<float>(pieces.grid.geometry.cell_size())) {}

  void link_long_things() const {
    for (const ThingPiece& piece : pieces_.all()) {
      const float length = piece.end - piece.begin + cell_;
      const float width = piece.left - piece.right + cell_;
      if (length < kLong || length < kSlender * width) continue;
      const float middle = 0.5F * (piece.left + piece.right);
      const Position2 at = piece.place(0.0F, middle);
      const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y);
      follow(piece, {x, y, piece.along_x, piece.along_y}, piece.end);
      follow(piece, {x, y, -piece.along_x, -piece.along_y}, -piece.begin);
    }
  }

  void link_low_things() const {
    const std::vector<std::int32_t>& low = low_things(kFewestCells);
    const std::vector<ThingPiece>& all = pieces_.all();
    for (std::size_t b = 1; b < low.size(); ++b) {
      const ThingPiece& q = all[static_cast<std::size_t>(low[b])];
      for (std::size_t a = 0; a < b; ++a) {
        const ThingPiece& p = all[static_cast<std::size_t>(low[a])];
        const float dx = q.x - p.x, dy = q.y - p.y;
        const float reach = kRingGap + p.end - p.begin + q.end - q.begin;
        if (dx * dx + dy * dy <= reach * reach && is_interrupted(p, q))
          pieces_.unite(p.slot, q.slot);
      }
    }
  }

  void link_to_strips() const {
    const std::vector<std::int32_t>& low = low_things(1.0F);
    std::vector<std::int32_t>& strips = pieces_.workspace.steps_of;
    strips.clear();
    for (const std::int32_t number : low)
      if (is_strip(pieces_.all()[static_cast<std::size_t>(number)])) strips.push_back(number);
    for (const std::int32_t number : low) {
      const ThingPiece& piece = pieces_.all()[static_cast<std::size_t>(number)];
      if (piece.n * cell_ * cell_ > kPieceArea) continue;
      const float widest = piece.above > 0.0F ? kStripGap : kRingGap;
      const ThingPiece* nearest = nullptr;
      float least = widest;
      for (const std::int32_t other : strips) {
        const ThingPiece& strip = pieces_.all()[static_cast<std::size_t>(other)];
        if (other == number || !is_in_strip(piece, strip, least)) continue;
        const float gap = gap_to(piece, strip, least);
        if (gap > least) continue;
        nearest = &strip;
        least = gap;
      }
      if (nearest != nullptr) pieces_.unite(piece.slot, nearest->slot);
    }
  }

 private:
  // Numbers of the low pieces of so many cells.
  [[nodiscard]] const std::vector<std::int32_t>& low_things(float fewest) const {
    std::vector<std::int32_t>& low = pieces_.workspace.posts;
    low.clear();
    const std::vector<ThingPiece>& all = pieces_.all();
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k].high <= kLow && all[k].n >= fewest) low.push_back(static_cast<std::int32_t>(k));
    return low;
  }

  [[nodiscard]] bool is_strip(const ThingPiece& piece) const {
    const float length = piece.end - piece.begin + cell_;
    return length >= kLong && length >= kStripSlender * (piece.left - piece.right + cell_);
  }

  // Whether a low piece lies in the strip of another one, and is lower.
  [[nodiscard]] bool is_in_strip(const ThingPiece& piece, const ThingPiece& strip,
                                 float widest) const {
    if (piece.n > strip.n || piece.high > strip.high + level_) return false;
    const float right = strip.right - kStripMargin, left = strip.left + kStripMargin;
    // Its middle is in there as well, which is quicker to see.
    const float across = strip.across_of(piece.x, piece.y);
    if (across < right || across > left) return false;
    Extent extent;
    extent.add(piece, {strip.x, strip.y, strip.along_x, strip.along_y});
    return extent.right >= right && extent.left <= left && extent.begin <= strip.end + widest &&
           extent.end >= strip.begin - widest;
  }

  // How far the nearest cell of another piece is from the end of one, at most about `widest`.
  [[nodiscard]] float gap_to(const ThingPiece& piece, const ThingPiece& other, float widest) const {
    const GridGeometry& geometry = pieces_.grid.geometry;
    CellIndex at;
    if (!geometry.cell_at(piece.x, piece.y, at)) return kFar;
    const float half = 0.5F * (piece.end - piece.begin);
    const int reach = static_cast<int>(std::lround((widest + half) / cell_));
    int least = 2 * reach * reach + 1;
    for_slots_around(pieces_.grid, at, reach, [&](std::size_t slot) {
      if (pieces_.of(slot) != &other) return;
      const CellIndex near = geometry.index_of(pieces_.grid.cell[slot]);
      const int dl = near.l - at.l, dw = near.w - at.w;
      least = std::min(least, dl * dl + dw * dw);
    });
    return std::sqrt(static_cast<float>(least)) * cell_ - half;
  }

  // Looks along a long thing, from its end on, for what it goes on with.
  void follow(const ThingPiece& piece, const Line& line, float end) const {
    const float length = piece.end - piece.begin + cell_;
    const float limit = end + std::min(kWidestGap, length);
    for (float s = end + cell_; s <= limit + cell_; s += cell_) {
      bool own = false;
      const ThingPiece* met = nullptr;
      const bool narrow = beams_.between_columns(line.place(end, 0.0F), line.place(s, 0.0F));
      for (const float across : {0.0F, -cell_, cell_}) {
        const Slot seen = slot_at(pieces_.grid, line.place(s, across));
        if (seen == kUnobserved) continue;
        const bool member = pieces_.is_member(static_cast<std::size_t>(seen));
        if (!member && across == 0.0F && !narrow) return;  // the ground is seen there
        if (!member) continue;
        if (pieces_.same_thing(seen, piece.slot)) {
          own = true;
        } else if (met == nullptr) {
          met = pieces_.of(static_cast<std::size_t>(seen));
        }
      }
      const Gap gap{end, s};
      if (!own && (met == nullptr || !goes_on(piece, *met, line, gap) ||
                   (!narrow && !is_closed(piece, *met, line, gap))))
        continue;
      if (!own) pieces_.unite(piece.slot, met->slot);
      end = s;
    }
  }

  [[nodiscard]] bool goes_on(const ThingPiece& piece, const ThingPiece& other, const Line& line,
                             const Gap& gap) const {
    const float higher = std::max(piece.top, other.top);
    if (std::abs(piece.top - other.top) > std::max(level_, kTopShare * higher)) return false;
    // A cell, and what the direction may be off by over the gap.
    const float length = piece.end - piece.begin + cell_;
    const float half =
        0.5F * (piece.left - piece.right) + cell_ + 0.5F * cell_ * gap.length() / length;
    Extent extent;
    extent.add(other, line);
    return extent.right >= -half && extent.left <= half;
  }

  // Whether two low things are parts of one, seen by two rings.
  [[nodiscard]] bool is_interrupted(const ThingPiece& p, const ThingPiece& q) const {
    if (std::abs(p.top - q.top) > std::min(level_, kTopShare * std::max(p.top, q.top)))
      return false;
    const float length = length_of(q.x - p.x, q.y - p.y);
    if (length < cell_) return false;
    const Line line{p.x, p.y, (q.x - p.x) / length, (q.y - p.y) / length};
    Extent first, second;
    first.add(p, line);
    second.add(q, line);
    const float width = std::max(first.left, second.left) - std::min(first.right, second.right);
    const Gap gap{first.end, second.begin};
    if (width > kLowWidth || gap.length() > kRingGap) return false;
    for (float s = gap.begin + cell_; s < gap.end; s += cell_) {
      const Slot seen = slot_at(pieces_.grid, line.place(s, 0.0F));
      if (seen != kUnobserved && !pieces_.is_member(static_cast<std::size_t>(seen))) return false;
    }
    return is_closed(p, q, line, gap);
  }

  // Whether no beam has passed through the gap between two things.
  [[nodiscard]] bool is_closed(const ThingPiece& piece, const ThingPiece& other, const Line& line,
                               const Gap& gap) const {
    const float top = std::min(piece.top, other.top);
    for (float s = gap.begin + cell_; s < gap.end; s += cell_) {
      const float share = (s - gap.begin) / gap.length();
      const float ground = piece.ground + share * (other.ground - piece.ground);
      if (beams_.have_passed(line.place(s, 0.0F), ground, ground + top)) return false;
    }
    return true;
  }

  const ThingPieces& pieces_;
  const PassedBeams& beams_;
  float level_;
  float cell_;
};

}  // namespace

void link_continued_things(const ThingPieces& pieces, const PassedBeams& beams) {
  const Continuation continuation(pieces, beams);
  continuation.link_long_things();
  continuation.link_low_things();
  continuation.link_to_strips();
}

}  // namespace mrpt_terrain
