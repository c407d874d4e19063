// SPDX-License-Identifier: BSD-3-Clause
#include "wall_columns.h"

#include <algorithm>
#include <cmath>

#include "length_of.h"
#include "line_extent.h"

namespace mrpt_terrain {
namespace {

// Walls are at least so high; tops of pieces of one may differ by so much or by this share of the
// higher one; metres.
constexpr float kHigh = 0.8F;
constexpr float kAsHigh = 0.15F;
constexpr float kTopShare = 0.3F;
// Columns that follow each other are at most so far apart, metres, and lie in a strip so wide
// (centres of cells).
constexpr float kGap = 1.5F;
constexpr float kWidth = 0.4F;

class ColumnLinker {
 public:
  ColumnLinker(const ThingPieces& pieces, const PassedBeams& beams)
      : pieces_(pieces),
        beams_(beams),
        cell_(static_cast<float>(pieces.grid.geometry.cell_size())) {}

  [[nodiscard]] bool link() const {
    bool linked = false;
    std::vector<std::int32_t>& upright = pieces_.workspace.posts;
    upright.clear();
    const auto flat = static_cast<float>(pieces_.params.flat);
    for (std::size_t k = 0; k < pieces_.all().size(); ++k) {
      const ThingPiece& p = pieces_.all()[k];
      if (p.high > kHigh && p.high - p.low > flat && p.left - p.right <= kWidth)
        upright.push_back(static_cast<std::int32_t>(k));
    }
    for (const std::int32_t middle : upright) linked = link_through(upright, middle) || linked;
    return linked;
  }

 private:
  [[nodiscard]] const ThingPiece& piece(std::int32_t number) const {
    return pieces_.all()[static_cast<std::size_t>(number)];
  }

  bool link_through(const std::vector<std::int32_t>& upright, std::int32_t middle) const {
    const ThingPiece& q = piece(middle);
    std::vector<std::int32_t>& near = pieces_.workspace.steps_of;
    near.clear();
    bool linked = false;
    for (const std::int32_t other : upright)
      if (other != middle && follow_each_other(piece(other), q)) near.push_back(other);
    for (std::size_t b = 1; b < near.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        if (!are_in_row(piece(near[a]), q, piece(near[b]))) continue;
        for (const std::int32_t end : {near[a], near[b]}) pieces_.unite(q.slot, piece(end).slot);
        linked = true;
      }
    }
    return linked;
  }

  // Whether two pieces are as high, near, and no beam can have passed between them.
  [[nodiscard]] bool follow_each_other(const ThingPiece& p, const ThingPiece& q) const {
    if (std::abs(p.high - q.high) > std::max(kAsHigh, kTopShare * std::max(p.high, q.high)))
      return false;
    const float dx = q.x - p.x, dy = q.y - p.y;
    const float length = length_of(dx, dy);
    if (length < cell_ || length > kGap + p.end - p.begin + q.end - q.begin) return false;
    const Line line{p.x, p.y, dx / length, dy / length};
    Extent first, second;
    first.add(p, line);
    second.add(q, line);
    return second.begin - first.end <= kGap &&
           beams_.between_columns(line.place(first.end, 0.0F), line.place(second.begin, 0.0F));
  }

  // Whether two pieces lie on both sides of a third one, along a line.
  [[nodiscard]] bool are_in_row(const ThingPiece& p, const ThingPiece& q,
                                const ThingPiece& r) const {
    const float dx = r.x - p.x, dy = r.y - p.y;
    const float length = length_of(dx, dy);
    if (length < cell_) return false;
    const Line line{p.x, p.y, dx / length, dy / length};
    Extent all;
    for (const ThingPiece* each : {&p, &q, &r}) all.add(*each, line);
    const float middle = line.along_of({q.x, q.y});
    return all.left - all.right <= kWidth && middle > 0.0F && middle < length;
  }

  const ThingPieces& pieces_;
  const PassedBeams& beams_;
  float cell_;
};

}  // namespace

bool link_wall_columns(const ThingPieces& pieces, const PassedBeams& beams) {
  return ColumnLinker(pieces, beams).link();
}

}  // namespace mrpt_terrain
