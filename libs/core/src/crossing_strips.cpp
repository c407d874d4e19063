// SPDX-License-Identifier: BSD-3-Clause
#include "crossing_strips.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mrpt_terrain {
namespace {

// What consists of strips is at most so high, metres, has so many cells and this share of sharp
// edges, ...
constexpr float kLow = 0.35F;
constexpr float kFewestCells = 12.0F;
constexpr float kSharpShare = 0.6F;
// ... lies in a rectangle of at least this length and width, metres, of which its cells fill at
// most this share, and ground is seen in so many cells of it per cell of the piece.
constexpr float kShortest = 1.5F, kNarrowest = 1.0F;
constexpr float kFilled = 0.5F;
constexpr float kGround = 0.5F;
// Strips are at most so wide (centres of cells), at least so long, with gaps of at most kGap cells,
// metres; there are at most so many, and of the cells this share may be left over: kerbs go on
// behind gaps, and rings cross them. Less of it may lie beside a strip, as it does in areas.
constexpr float kWidth = 0.5F;
constexpr float kLength = 1.25F;
constexpr std::int32_t kGap = 3;
constexpr std::int32_t kMostStrips = 3;
constexpr float kLeftOver = 0.3F;
constexpr float kLeftBeside = 0.15F;
// Directions that are tried, and by how many of them two strips differ that are not side by side.
constexpr int kDirections = 90;
constexpr int kSameDirection = 14;
// Strips side by side are at least so far apart, metres, along this share of one of them: kerbs may
// meet at an end. Nearer, they are one strip, if that is no wider than this (centres of cells), or
// else an area.
constexpr float kApart = 0.35F;
constexpr float kApartShare = 0.5F;
constexpr float kWidest = 1.0F;
// Bins across a strip, per cell.
constexpr float kBinsPerCell = 2.0F;

/// A straight run of cells.
struct Strip {
  std::int32_t occupied = 0;  ///< bins along it that hold cells
  std::int32_t cells = 0;
  int direction = 0;
  std::int32_t window = 0;          ///< first bin across
  std::int32_t begin = 0, end = 0;  ///< bins along it

  [[nodiscard]] bool is_better_than(const Strip& other) const {
    return occupied != other.occupied ? occupied > other.occupied : cells > other.cells;
  }
};

/// Directions from 0 to 180 deg.
struct Directions {
  std::array<float, kDirections> x, y;
  Directions() {
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double angle = M_PI * static_cast<double>(k) / kDirections;
      x[k] = static_cast<float>(std::cos(angle));
      y[k] = static_cast<float>(std::sin(angle));
    }
  }
};

class StripDivider {
 public:
  explicit StripDivider(const ThingPieces& pieces)
      : pieces_(pieces),
        scratch_(pieces.workspace.strips),
        cell_(static_cast<float>(pieces.grid.geometry.cell_size())),
        fewest_(static_cast<std::int32_t>(std::ceil(kLength / cell_))),
        window_(static_cast<std::int32_t>(std::lround(kWidth * kBinsPerCell / cell_))) {
    pieces.workspace.part_of.assign(pieces.cells.size(), 0);
  }

  bool divide(IndexRange slots, const ThingPiece& piece) {
    if (!may_have_strips(slots, piece) || was_divided(slots, piece)) return false;
    place(slots);
    if (!find_strips() || !give_rest_to_nearest()) return false;
    for (std::size_t k = 0; k < slots.size(); ++k) part_of(slots.begin()[k]) = scratch_.strip_of[k];
    pieces_.separate(slots, pieces_.workspace.part_of, static_cast<std::size_t>(strips_));
    for (const std::int32_t slot : slots) part_of(slot) = 0;
    return true;
  }

 private:
  [[nodiscard]] std::int32_t& part_of(std::int32_t slot) const {
    return pieces_.workspace.part_of[static_cast<std::size_t>(slot)];
  }

  [[nodiscard]] bool may_have_strips(IndexRange slots, const ThingPiece& piece) const {
    const float length = piece.end - piece.begin + cell_;
    const float width = piece.left - piece.right + cell_;
    return piece.n >= kFewestCells && piece.high <= kLow && length >= kShortest &&
           width >= kNarrowest && piece.n * cell_ * cell_ <= kFilled * length * width &&
           piece.sharp > 0.0F && piece.sharp >= kSharpShare * piece.edges &&
           static_cast<float>(ground_cells(slots, piece)) >= kGround * piece.n;
  }

  [[nodiscard]] bool was_divided(IndexRange slots, const ThingPiece& piece) const {
    return std::any_of(slots.begin(), slots.end(), [&](std::int32_t slot) {
      return root_of(pieces_.workspace.parent, slot) != piece.slot;
    });
  }
  // Cells with ground and nothing else in the rectangle of a piece.
  [[nodiscard]] std::int32_t ground_cells(IndexRange slots, const ThingPiece& piece) const {
    const GridGeometry& geometry = pieces_.grid.geometry;
    CellIndex low = geometry.index_of(pieces_.grid.cell[static_cast<std::size_t>(*slots.begin())]);
    CellIndex high = low;
    for (const std::int32_t slot : slots) {
      const CellIndex at = geometry.index_of(pieces_.grid.cell[static_cast<std::size_t>(slot)]);
      low = {std::min(low.l, at.l), std::min(low.w, at.w)};
      high = {std::max(high.l, at.l), std::max(high.w, at.w)};
    }
    std::int32_t count = 0;
    for (int l = low.l; l <= high.l; ++l) {
      for (int w = low.w; w <= high.w; ++w) {
        const Slot slot = pieces_.grid.slot_at({l, w});
        if (slot == kUnobserved || pieces_.is_member(static_cast<std::size_t>(slot))) continue;
        const Position2 at = geometry.centre_of({l, w});
        count += piece.holds(static_cast<float>(at.x), static_cast<float>(at.y)) ? 1 : 0;
      }
    }
    return count;
  }

  void place(IndexRange slots) {
    scratch_.x.clear();
    scratch_.y.clear();
    for (const std::int32_t slot : slots) {
      const Position2 at = pieces_.grid.geometry.centre_of(
          pieces_.grid.geometry.index_of(pieces_.grid.cell[static_cast<std::size_t>(slot)]));
      scratch_.x.push_back(static_cast<float>(at.x));
      scratch_.y.push_back(static_cast<float>(at.y));
    }
    scratch_.strip_of.assign(slots.size(), -1);
  }

  // Takes the longest strip, then the longest of what is left, and so on.
  bool find_strips() {
    strips_ = 0;
    auto left = static_cast<float>(scratch_.x.size());
    const float most_left = kLeftOver * left;
    while (strips_ < kMostStrips) {
      Strip best;
      for (int k = 0; k < kDirections; ++k) look_along(k, best);
      if (best.occupied < fewest_) break;
      take(best);
      left -= static_cast<float>(best.cells);
      const std::int32_t beside = strip_beside(best);
      if (beside != strips_) {
        if (!add_to(beside)) return false;
        continue;
      }
      direction_of_[static_cast<std::size_t>(strips_)] = best.direction;
      ++strips_;
    }
    return strips_ >= 2 && left <= most_left;
  }

  // Bins of the cells that are in no strip yet, along and across a direction.
  void project(int direction) {
    const float ux = directions_.x[static_cast<std::size_t>(direction)];
    const float uy = directions_.y[static_cast<std::size_t>(direction)];
    float least_along = 1e9F, least_across = 1e9F;
    const std::size_t n = scratch_.x.size();
    scratch_.u.resize(n);
    scratch_.v.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      scratch_.u[k] = scratch_.x[k] * ux + scratch_.y[k] * uy;
      scratch_.v[k] = scratch_.y[k] * ux - scratch_.x[k] * uy;
      if (scratch_.strip_of[k] >= 0) continue;
      least_along = std::min(least_along, scratch_.u[k]);
      least_across = std::min(least_across, scratch_.v[k]);
    }
    scratch_.along.assign(n, -1);
    scratch_.across.assign(n, -1);
    along_bins_ = across_bins_ = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (scratch_.strip_of[k] >= 0) continue;
      // Half a thousandth of a cell, as many lie on the edge between two bins.
      const float edge = 0.0005F;
      scratch_.along[k] = static_cast<std::int32_t>((scratch_.u[k] - least_along) / cell_ + edge);
      scratch_.across[k] =
          static_cast<std::int32_t>((scratch_.v[k] - least_across) * kBinsPerCell / cell_ + edge);
      along_bins_ = std::max(along_bins_, scratch_.along[k] + 1);
      across_bins_ = std::max(across_bins_, scratch_.across[k] + 1);
    }
  }

  void look_along(int direction, Strip& best) {
    project(direction);
    // Cells by their bin across.
    scratch_.first.assign(static_cast<std::size_t>(across_bins_) + 1, 0);
    for (const std::int32_t bin : scratch_.across)
      if (bin >= 0) ++scratch_.first[static_cast<std::size_t>(bin) + 1];
    for (std::size_t b = 1; b < scratch_.first.size(); ++b)
      scratch_.first[b] += scratch_.first[b - 1];
    scratch_.order.resize(static_cast<std::size_t>(scratch_.first.back()));
    scratch_.next.assign(scratch_.first.begin(), scratch_.first.end());
    for (std::size_t k = 0; k < scratch_.across.size(); ++k) {
      if (scratch_.across[k] < 0) continue;
      std::int32_t& next = scratch_.next[static_cast<std::size_t>(scratch_.across[k])];
      scratch_.order[static_cast<std::size_t>(next++)] = scratch_.along[k];
    }
    for (std::int32_t window = 0; window < std::max(1, across_bins_ - window_ + 1); ++window) {
      // No more bins along it hold cells than it has cells.
      if (cells_in(window) < std::max(best.occupied, fewest_)) continue;
      Strip strip = longest_run(window);
      strip.direction = direction;
      strip.window = window;
      if (strip.is_better_than(best)) best = strip;
    }
  }
  [[nodiscard]] std::int32_t end_of(std::int32_t window) const {
    return scratch_.first[static_cast<std::size_t>(std::min(window + window_, across_bins_))];
  }
  [[nodiscard]] std::int32_t cells_in(std::int32_t window) const {
    return end_of(window) - scratch_.first[static_cast<std::size_t>(window)];
  }
  [[nodiscard]] Strip longest_run(std::int32_t window) const {
    scratch_.count.assign(static_cast<std::size_t>(along_bins_), 0);
    for (std::int32_t k = scratch_.first[static_cast<std::size_t>(window)]; k < end_of(window); ++k)
      ++scratch_.count[static_cast<std::size_t>(scratch_.order[static_cast<std::size_t>(k)])];
    Strip best, run;
    for (std::int32_t bin = 0; bin < along_bins_; ++bin) {
      const std::int32_t cells = scratch_.count[static_cast<std::size_t>(bin)];
      if (cells == 0) continue;
      if (run.occupied == 0 || bin - run.end > kGap) {
        run = Strip{};
        run.begin = bin;
      }
      ++run.occupied;
      run.cells += cells;
      run.end = bin + 1;
      if (run.is_better_than(best)) best = run;
    }
    return best;
  }

  // Marks the cells of a strip.
  void take(const Strip& strip) {
    project(strip.direction);
    for (std::size_t k = 0; k < scratch_.along.size(); ++k) {
      if (scratch_.across[k] >= strip.window && scratch_.across[k] < strip.window + window_ &&
          scratch_.along[k] >= strip.begin && scratch_.along[k] < strip.end)
        scratch_.strip_of[k] = strips_;
    }
  }

  // The strip to which the one that was taken last lies side by side; else that one itself.
  [[nodiscard]] std::int32_t strip_beside(const Strip& strip) const {
    for (std::int32_t other = 0; other < strips_; ++other) {
      const int turn = std::abs(strip.direction - direction_of_[static_cast<std::size_t>(other)]);
      if (std::min(turn, kDirections - turn) >= kSameDirection) continue;
      const auto most = kApartShare * static_cast<float>(strip.cells);
      if (static_cast<float>(cells_beside(strips_, other)) > most) return other;
    }
    return strips_;
  }
  // Cells of a strip that are near one of another.
  [[nodiscard]] std::int32_t cells_beside(std::int32_t strip, std::int32_t other) const {
    std::int32_t count = 0;
    for (std::size_t a = 0; a < scratch_.x.size(); ++a) {
      if (scratch_.strip_of[a] != strip) continue;
      bool near = false;
      for (std::size_t b = 0; b < scratch_.x.size() && !near; ++b)
        near = scratch_.strip_of[b] == other && square_distance(a, b) < kApart * kApart;
      count += near ? 1 : 0;
    }
    return count;
  }
  // Gives the cells of the strip that was taken last to another; false: both are too wide for one.
  bool add_to(std::int32_t strip) {
    const auto direction = static_cast<std::size_t>(direction_of_[static_cast<std::size_t>(strip)]);
    float right = 1e9F, left = -1e9F;
    for (std::size_t k = 0; k < scratch_.x.size(); ++k) {
      if (scratch_.strip_of[k] == strips_) scratch_.strip_of[k] = strip;
      if (scratch_.strip_of[k] != strip) continue;
      const float across =
          scratch_.y[k] * directions_.x[direction] - scratch_.x[k] * directions_.y[direction];
      right = std::min(right, across);
      left = std::max(left, across);
    }
    return left - right <= kWidest;
  }
  [[nodiscard]] float square_distance(std::size_t a, std::size_t b) const {
    const float dx = scratch_.x[a] - scratch_.x[b], dy = scratch_.y[a] - scratch_.y[b];
    return dx * dx + dy * dy;
  }

  // Gives what is left over to the nearest strips; false: too much of it lies beside one.
  bool give_rest_to_nearest() {
    std::int32_t beside = 0;
    std::vector<std::int32_t>& nearest = scratch_.along;
    nearest = scratch_.strip_of;
    for (std::size_t a = 0; a < nearest.size(); ++a) {
      if (scratch_.strip_of[a] >= 0) continue;
      float least = 1e9F;
      for (std::size_t b = 0; b < nearest.size(); ++b) {
        const float square = square_distance(a, b);
        if (scratch_.strip_of[b] < 0 || square >= least) continue;
        least = square;
        nearest[a] = scratch_.strip_of[b];
      }
      beside += least < kApart * kApart ? 1 : 0;
    }
    scratch_.strip_of.swap(nearest);
    return static_cast<float>(beside) <= kLeftBeside * static_cast<float>(nearest.size());
  }

  const ThingPieces& pieces_;
  StripWorkspace& scratch_;
  float cell_;
  std::int32_t fewest_;  ///< bins along a strip
  std::int32_t window_;  ///< bins across a strip
  std::int32_t strips_ = 0;
  std::int32_t along_bins_ = 0, across_bins_ = 0;
  std::array<int, kMostStrips> direction_of_{};
  Directions directions_;
};

}  // namespace

bool divide_crossing_strips(const ThingPieces& pieces) {
  StripDivider divider(pieces);
  bool divided = false;
  const IndexRows& rows = pieces.workspace.piece_cells;
  for (std::size_t k = 0; k < rows.rows(); ++k)
    divided = divider.divide(rows.row(k), pieces.all()[k]) || divided;
  return divided;
}

}  // namespace mrpt_terrain
