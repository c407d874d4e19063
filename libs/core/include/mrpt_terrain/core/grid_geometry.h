// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace mrpt_terrain {

/// Integer coordinates of a cell as in the paper: `l` counts along x, `w` along y, both from 0.
struct CellIndex {
  int l = 0;
  int w = 0;

  friend bool operator==(CellIndex a, CellIndex b) { return a.l == b.l && a.w == b.w; }
  friend bool operator!=(CellIndex a, CellIndex b) { return !(a == b); }
};

/// Position in the horizontal plane, metres.
struct Position2 {
  double x = 0.0;
  double y = 0.0;
};

/// Position of a cell in the arrays that cover the whole grid. A type of its own, so that it is
/// confused neither with metres nor with the number of an observed cell.
enum class CellId : std::int32_t {};

[[nodiscard]] constexpr std::int32_t value_of(CellId id) { return static_cast<std::int32_t>(id); }

/// Divides whole numbers from 0 to 2^31 - 1 by one that stays the same, by a multiplication: exact,
/// and several times as fast as a division.
class Divisor {
 public:
  Divisor() = default;
  /// \param divisor > 0
  explicit Divisor(std::int32_t divisor) {
    // The factor exceeds 2^shift / divisor by 1 at most; what that adds to a quotient is less than
    // 2^31 / 2^shift, and so than 1 / divisor.
    while ((std::int64_t{1} << (shift_ - 31)) < divisor) ++shift_;
    factor_ = (std::uint64_t{1} << shift_) / static_cast<std::uint64_t>(divisor) + 1;
  }
  [[nodiscard]] std::int32_t quotient_of(std::int32_t number) const {
    return static_cast<std::int32_t>(static_cast<std::uint64_t>(number) * factor_ >> shift_);
  }

 private:
  unsigned shift_ = 31;
  std::uint64_t factor_ = (std::uint64_t{1} << 31) + 1;
};

/// Where the cells lie: the only place that converts between metres and cells.
///
/// The grid covers [-length/2, length/2) x [-width/2, width/2) about the frame's origin, divided
/// into cells of side `cell_size`; ranges are half open (Meng, Cao et al. 2018, section "Elevation
/// grid map"). Where a side is no multiple of `cell_size`, the last cells are whole and reach
/// beyond it. Arrays over the grid carry a frame of one never-observed cell on all four sides, so
/// that the eight neighbours of every cell exist: `array_size()` entries, addressed by `CellId`.
class GridGeometry {
 public:
  GridGeometry() = default;

  /// \param length extent along x, metres, > 0
  /// \param width extent along y, metres, > 0
  /// \param cell_size side of a cell, metres, > 0; the number of cells is the quotient rounded up
  GridGeometry(double length, double width, double cell_size);

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double cell_size() const { return cell_size_; }
  /// Number of cells along x.
  [[nodiscard]] int cells_l() const { return cells_l_; }
  /// Number of cells along y.
  [[nodiscard]] int cells_w() const { return cells_w_; }
  /// Cells per row of the arrays: `cells_w()` and the two cells of the frame.
  [[nodiscard]] int stride() const { return cells_w_ + 2; }
  /// Length of an array over the grid, frame included.
  [[nodiscard]] std::int32_t array_size() const { return (cells_l_ + 2) * stride(); }

  /// Cell that holds (x, y): l = floor((x + L/2) / c), w = floor((y + W/2) / c). Writes `cell` and
  /// returns true if it lies in the grid; returns false, also for NaN, otherwise.
  [[nodiscard]] bool cell_at(double x, double y, CellIndex& cell) const {
    const double l = (x + half_length_) * cells_per_metre_;
    const double w = (y + half_width_) * cells_per_metre_;
    // Written so that NaN fails; the cast truncates, which is floor for what passes.
    if (!(l >= 0.0 && l < cells_l_ && w >= 0.0 && w < cells_w_)) return false;
    cell = {static_cast<int>(l), static_cast<int>(w)};
    return true;
  }

  /// The cell that holds (x, y) as the number of its `CellId`, -1 where `cell_at` returns false or
  /// not `wanted`. Without branches, so that compilers work on many places at once.
  [[nodiscard]] std::int32_t number_at(double x, double y, bool wanted) const {
    const double l = (x + half_length_) * cells_per_metre_;
    const double w = (y + half_width_) * cells_per_metre_;
    const bool inside = (l >= 0.0) & (l < cells_l_) & (w >= 0.0) & (w < cells_w_) & wanted;
    const int row = static_cast<int>(inside ? l : 0.0), column = static_cast<int>(inside ? w : 0.0);
    return inside ? (row + 1) * stride() + column + 1 : -1;
  }

  [[nodiscard]] bool contains(CellIndex cell) const {
    // Negative numbers are large ones without sign.
    return static_cast<unsigned>(cell.l) < static_cast<unsigned>(cells_l_) &&
           static_cast<unsigned>(cell.w) < static_cast<unsigned>(cells_w_);
  }
  /// Centre of a cell, metres.
  [[nodiscard]] Position2 centre_of(CellIndex cell) const {
    return {(cell.l + 0.5) * cell_size_ - half_length_, (cell.w + 0.5) * cell_size_ - half_width_};
  }

  [[nodiscard]] CellId id_of(CellIndex cell) const {
    return CellId{(cell.l + 1) * stride() + cell.w + 1};
  }
  [[nodiscard]] CellIndex index_of(CellId id) const {
    const std::int32_t row = by_stride_.quotient_of(value_of(id));
    return {row - 1, value_of(id) - row * stride() - 1};
  }

  /// Distance of the edges from the origin, metres.
  [[nodiscard]] double half_length() const { return half_length_; }
  [[nodiscard]] double half_width() const { return half_width_; }

  friend bool operator==(const GridGeometry& a, const GridGeometry& b) {
    return a.length_ == b.length_ && a.width_ == b.width_ && a.cell_size_ == b.cell_size_;
  }
  friend bool operator!=(const GridGeometry& a, const GridGeometry& b) { return !(a == b); }

 private:
  double length_ = 0.0;
  double width_ = 0.0;
  double cell_size_ = 0.0;
  double half_length_ = 0.0;
  double half_width_ = 0.0;
  double cells_per_metre_ = 0.0;
  int cells_l_ = 0;
  int cells_w_ = 0;
  Divisor by_stride_{2};
};

}  // namespace mrpt_terrain
