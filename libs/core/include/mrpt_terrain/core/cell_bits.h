// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"

namespace mrpt_terrain {

/// A bit for every cell of a grid: finds the few marked cells among the many around a cell with one
/// look per row.
class CellBits {
 public:
  /// Forgets all marks; allocates only for larger grids.
  void clear(const GridGeometry& geometry) {
    cells_l_ = geometry.cells_l();
    cells_w_ = geometry.cells_w();
    // One word more than needed: `bits_from` reads two.
    words_ = static_cast<std::size_t>(cells_w_) / 64 + 2;
    bits_.assign(static_cast<std::size_t>(cells_l_) * words_, 0);
  }
  void mark(CellIndex cell) { word_of(cell) |= bit_of(cell); }
  void unmark(CellIndex cell) { word_of(cell) &= ~bit_of(cell); }

  [[nodiscard]] bool is_marked(CellIndex cell) const {
    return (bits_[row_of(cell.l) + static_cast<std::size_t>(cell.w) / 64] & bit_of(cell)) != 0;
  }

  /// Calls f with every marked cell up to `reach` cells away along each axis, row by row. It may
  /// unmark the cell that it is called with.
  template <class F>
  void for_marked_around(CellIndex at, int reach, F&& f) const {
    for_marked_in_rows(at, reach, at.l + reach, f);
  }
  /// The same without the rows behind, for cells that are marked row by row.
  template <class F>
  void for_marked_before(CellIndex at, int reach, F&& f) const {
    for_marked_in_rows(at, reach, at.l, f);
  }

 private:
  template <class F>
  void for_marked_in_rows(CellIndex at, int reach, int last_l, F& f) const {
    const int first_w = std::max(at.w - reach, 0);
    const int last_w = std::min(at.w + reach, cells_w_ - 1);
    for (int l = std::max(at.l - reach, 0); l <= std::min(last_l, cells_l_ - 1); ++l) {
      for (int w = first_w; w <= last_w; w += 64) {
        std::uint64_t bits =
            bits_from({l, w}) & (~std::uint64_t{0} >> (63 - std::min(last_w - w, 63)));
        for (; bits != 0; bits &= bits - 1) f(CellIndex{l, w + lowest(bits)});
      }
    }
  }
  [[nodiscard]] std::size_t row_of(int l) const { return static_cast<std::size_t>(l) * words_; }
  [[nodiscard]] std::uint64_t& word_of(CellIndex cell) {
    return bits_[row_of(cell.l) + static_cast<std::size_t>(cell.w) / 64];
  }
  // The bits of the 64 cells from one on.
  [[nodiscard]] std::uint64_t bits_from(CellIndex cell) const {
    const std::uint64_t* words = &bits_[row_of(cell.l) + static_cast<std::size_t>(cell.w) / 64];
    const auto shift = static_cast<unsigned>(cell.w) % 64;
    // Shifted in two steps, as 64 at once would do nothing.
    return words[0] >> shift | words[1] << 1 << (63 - shift);
  }
  [[nodiscard]] static int lowest(std::uint64_t bits) {
#if defined(__GNUC__)
    return __builtin_ctzll(bits);
#else
    int place = 0;
    for (; (bits & 1) == 0; bits >>= 1) ++place;
    return place;
#endif
  }
  [[nodiscard]] static std::uint64_t bit_of(CellIndex cell) {
    return std::uint64_t{1} << (static_cast<unsigned>(cell.w) % 64);
  }

  int cells_l_ = 0, cells_w_ = 0;
  std::size_t words_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace mrpt_terrain
