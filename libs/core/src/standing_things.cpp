// SPDX-License-Identifier: BSD-3-Clause
#include "standing_things.h"

#include <algorithm>

#include "slots_around.h"

namespace mrpt_terrain {
namespace {

// Cells with points up to here are low, metres; a piece that something stands in has so many of
// them, and this share.
constexpr float kLow = 0.6F;
constexpr std::size_t kFewestLow = 5;
constexpr float kLowShare = 0.3F;
// What stands out is so many times as high as the median of these.
constexpr float kTimesAsHigh = 2.0F;
// In a lawn, which has so many low cells, of which at most this share are of decks, less stands
// out: what is higher than three quarters of these by this, metres, and by so many times what these
// are higher than the median. Its own border is a step of as much.
constexpr std::size_t kFewestOfLawn = 60;
constexpr float kDeckShare = 0.1F;
constexpr float kClear = 0.1F;
constexpr float kTimesSpread = 2.0F;
// What stands out has so many cells, and, if not in a lawn, this share of them are upright.
constexpr std::size_t kFewestStanding = 2;
constexpr float kUprightShare = 0.5F;
// Its edge belongs to it down to the middle between low cells, or the upper ones of a lawn, and
// those that stand out.
constexpr float kEdge = 0.5F;
// Share of the neighbours in which it ends that are lower by a step.
constexpr float kStepShare = 0.7F;
// A step is this share of what the part rises by above the low cells; stairs have lower ones.
constexpr float kStepOfRise = 0.45F;

// Parts of a piece: cells that are low, cells that were looked at and do not stand, standing ones.
constexpr std::int32_t kLowPart = 0, kRejected = -1, kFirstStanding = 1;

class StandingDivider {
 public:
  explicit StandingDivider(const ThingPieces& pieces)
      : pieces_(pieces),
        step_(static_cast<float>(pieces.params.flat)),
        part_of_(pieces.workspace.part_of) {
    part_of_.assign(pieces.cells.size(), kLowPart);
  }

  bool divide(IndexRange cells) {
    if (cells.size() < kFewestLow + kFewestStanding || !find_heights(cells)) return false;
    find_standing(cells);
    if (borders_.empty()) return false;
    grow();
    look_at_borders();
    return separate(cells);
  }

 private:
  [[nodiscard]] float top(std::int32_t slot) const {
    return high_of(pieces_.cells, static_cast<std::size_t>(slot));
  }
  [[nodiscard]] std::int32_t& part(std::int32_t slot) const {
    return part_of_[static_cast<std::size_t>(slot)];
  }
  template <class F>
  void for_neighbours(std::int32_t slot, F&& f) const {
    const auto number_of = [this](std::int32_t s) {
      return pieces_.workspace.number_of[static_cast<std::size_t>(s)];
    };
    for_slots_around(pieces_.grid, static_cast<std::size_t>(slot), 1, [&](std::size_t near) {
      const auto other = static_cast<std::int32_t>(near);
      if (other != slot && number_of(other) == number_of(slot)) f(other);
    });
  }

  // The median of the low cells and the height from which on a cell stands out; false: none does,
  // or there are few low ones.
  bool find_heights(IndexRange cells) {
    tops_.clear();
    float highest = 0.0F;
    for (const std::int32_t slot : cells) {
      const float height = top(slot);
      highest = std::max(highest, height);
      if (height < kLow) tops_.push_back(height);
    }
    if (highest <= step_ || tops_.size() < kFewestLow ||
        static_cast<float>(tops_.size()) < kLowShare * static_cast<float>(cells.size()))
      return false;
    const auto middle = tops_.begin() + static_cast<std::ptrdiff_t>(tops_.size() / 2);
    std::nth_element(tops_.begin(), middle, tops_.end());
    low_ = *middle;
    standing_ = std::max(kTimesAsHigh * low_, low_ + step_);
    edge_ = low_ + kEdge * (standing_ - low_);
    least_step_ = step_;
    in_lawn_ = may_be_lawn(cells);
    if (in_lawn_) find_heights_in_lawn();
    return highest > standing_;
  }
  [[nodiscard]] bool may_be_lawn(IndexRange cells) const {
    if (tops_.size() < kFewestOfLawn) return false;
    const auto decks = std::count_if(cells.begin(), cells.end(), [this](std::int32_t slot) {
      return top(slot) < kLow && pieces_.cells.deck[static_cast<std::size_t>(slot)] >= 0;
    });
    return static_cast<float>(decks) <= kDeckShare * static_cast<float>(tops_.size());
  }
  // The tops of a lawn differ by less than what stands in it rises by.
  void find_heights_in_lawn() {
    const auto upper = tops_.begin() + static_cast<std::ptrdiff_t>(3 * tops_.size() / 4);
    std::nth_element(tops_.begin(), upper, tops_.end());
    const float standing = *upper + std::max(kClear, kTimesSpread * (*upper - low_));
    in_lawn_ = standing < standing_;
    if (!in_lawn_) return;
    standing_ = standing;
    edge_ = *upper + kEdge * (standing - *upper);
    least_step_ = kClear;
  }

  // Parts of cells that stand out and touch; those that do stand are left in `queue_`.
  void find_standing(IndexRange cells) {
    borders_.clear();
    steps_.clear();
    queue_.clear();
    for (const std::int32_t slot : cells) {
      if (part(slot) != kLowPart || top(slot) <= standing_) continue;
      const std::size_t begin = queue_.size();
      const auto number = kFirstStanding + static_cast<std::int32_t>(borders_.size());
      flood(slot, number);
      if (stands(begin)) {
        borders_.push_back(0);
        steps_.push_back(0);
        continue;
      }
      for (std::size_t k = begin; k < queue_.size(); ++k) part(queue_[k]) = kRejected;
      queue_.resize(begin);
    }
    for (const std::int32_t slot : cells)
      if (part(slot) == kRejected) part(slot) = kLowPart;
  }
  void flood(std::int32_t from, std::int32_t number) {
    part(from) = number;
    queue_.push_back(from);
    for (std::size_t k = queue_.size() - 1; k < queue_.size(); ++k) {
      for_neighbours(queue_[k], [&](std::int32_t other) {
        if (part(other) != kLowPart || top(other) <= standing_) return;
        part(other) = number;
        queue_.push_back(other);
      });
    }
  }
  [[nodiscard]] bool stands(std::size_t begin) const {
    const std::size_t n = queue_.size() - begin;
    if (in_lawn_) return n >= kFewestStanding;
    std::size_t upright = 0;
    for (std::size_t k = begin; k < queue_.size(); ++k) {
      const auto slot = static_cast<std::size_t>(queue_[k]);
      upright += high_of(pieces_.cells, slot) - low_of(pieces_.cells, slot) > step_ ? 1 : 0;
    }
    return n >= kFewestStanding &&
           static_cast<float>(upright) >= kUprightShare * static_cast<float>(n);
  }

  // Gives the edges of standing parts to them, all at the same pace.
  void grow() {
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const std::int32_t slot = queue_[k];
      for_neighbours(slot, [&](std::int32_t other) {
        if (part(other) != kLowPart || top(other) <= edge_) return;
        part(other) = part(slot);
        queue_.push_back(other);
      });
    }
  }

  // How far down the border of each part has to go: a step, and a good part of what it rises by on
  // average, as one of many steps would not.
  void find_steps_down() {
    const std::size_t parts = borders_.size();
    tops_.assign(2 * parts, 0.0F);
    for (const std::int32_t slot : queue_) {
      const auto own = static_cast<std::size_t>(part(slot) - kFirstStanding);
      tops_[own] += top(slot) - low_;
      tops_[parts + own] += 1.0F;
    }
    for (std::size_t k = 0; k < parts; ++k)
      tops_[k] = std::max(least_step_, kStepOfRise * tops_[k] / tops_[parts + k]);
  }

  void look_at_borders() {
    find_steps_down();
    for (const std::int32_t slot : queue_) {
      const auto own = static_cast<std::size_t>(part(slot) - kFirstStanding);
      for_neighbours(slot, [&](std::int32_t other) {
        if (part(other) != kLowPart) return;
        ++borders_[own];
        steps_[own] += top(slot) - top(other) >= tops_[own] ? 1 : 0;
      });
    }
  }
  [[nodiscard]] bool ends_in_step(std::int32_t number) const {
    const auto own = static_cast<std::size_t>(number - kFirstStanding);
    return static_cast<float>(steps_[own]) >= kStepShare * static_cast<float>(borders_[own]);
  }

  // Makes a thing of each standing part that ends in a step, if enough is left.
  bool separate(IndexRange cells) {
    std::size_t left = cells.size();
    for (const std::int32_t slot : queue_) {
      std::int32_t& own = part(slot);
      if (ends_in_step(own)) {
        --left;
      } else {
        own = kLowPart;
      }
    }
    const bool divided = left < cells.size() && left >= kFewestLow;
    if (divided) pieces_.separate(cells, part_of_, borders_.size() + 1);
    for (const std::int32_t slot : cells) part(slot) = kLowPart;
    return divided;
  }

  const ThingPieces& pieces_;
  float step_;
  std::vector<std::int32_t>& part_of_;
  std::vector<std::int32_t>& queue_ = pieces_.workspace.posts;
  std::vector<float>& tops_ = pieces_.workspace.tops;
  // Per standing part: neighbours in which it ends, and those that are lower by a step.
  std::vector<std::int32_t>& borders_ = pieces_.workspace.border_of;
  std::vector<std::int32_t>& steps_ = pieces_.workspace.steps_of;
  float low_ = 0.0F, standing_ = 0.0F, edge_ = 0.0F, least_step_ = 0.0F;
  bool in_lawn_ = false;
};

}  // namespace

bool divide_standing_things(const ThingPieces& pieces) {
  StandingDivider divider(pieces);
  bool divided = false;
  const IndexRows& rows = pieces.workspace.piece_cells;
  for (std::size_t k = 0; k < rows.rows(); ++k) divided = divider.divide(rows.row(k)) || divided;
  return divided;
}

}  // namespace mrpt_terrain
