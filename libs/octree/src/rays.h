// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cell_code.h"

/// \file
/// Rays made ready for the walk from cell to cell. All numbers come about as in OctoMap, which
/// computes directions and lengths in float and crossings in double: the cells of a ray depend on
/// the last bit.
namespace mrpt_terrain::octree {

using Place = std::array<float, 3>;  ///< metres

/// Cells along the axes: key k covers [k - 2^15, k + 1 - 2^15) * resolution.
struct CellGrid {
  double resolution;  ///< metres
  double cells_per_metre;

  explicit CellGrid(double given_resolution)
      : resolution(given_resolution), cells_per_metre(1.0 / given_resolution) {}

  /// Whether a place lies in the 2^16 cells per axis, and its key.
  [[nodiscard]] bool find_key(const Place& place, CellKey& key) const;
  /// Centre of a cell along an axis, metres.
  [[nodiscard]] double centre(std::uint16_t key) const {
    return (static_cast<double>(int{key} - 32768) + 0.5) * resolution;
  }
};

/// Where rays begin.
struct RayOrigin {
  Place place{};
  CellKey key{};
  CellCode code = 0;               ///< of `key`
  std::array<double, 3> centre{};  ///< of its cell, metres

  RayOrigin() = default;
  RayOrigin(const CellGrid& grid, const Place& at, const CellKey& its_key);
};

/// What is to be done with a ray, as bits.
enum EndFlags : std::uint32_t {
  kFiniteEnd = 1,   ///< its end is finite
  kEndInRange = 2,  ///< in the 2^16 cells per axis
  kShort = 4,       ///< not longer than the range: it occupies the cell that it ends in
  kInRange = 8,     ///< where it ends after it was cut lies in the cells
};

/// Ends of a number of rays of one origin, structure of arrays.
struct EndBatch {
  static constexpr std::size_t kCapacity = 512;
  template <class T>
  using Row = std::array<T, kCapacity>;

  std::size_t size = 0;
  alignas(64) std::array<Row<float>, 3> place;  ///< metres
  // Computed by `measure`, which also cuts rays.
  alignas(64) Row<CellCode> code;        ///< of the cells that the rays end in, if `kInRange`
  alignas(64) Row<std::uint32_t> cells;  ///< steps from the origin's cell to that, likewise
  alignas(64) Row<std::uint32_t> flags;  ///< `EndFlags`
  // Scratch memory of that.
  alignas(64) std::array<Row<std::int32_t>, 3> key;
  alignas(64) Row<double> length;

  void add(const Place& end) {
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis][size] = end[axis];
    ++size;
  }
  [[nodiscard]] Place end(std::size_t k) const { return {place[0][k], place[1][k], place[2][k]}; }
  /// Cuts rays that are longer than the range, as OctoMap does, and finds the cells in which they
  /// end.
  /// \param max_range metres; negative: rays are not cut
  void measure(const RayOrigin& from, const CellGrid& grid, double max_range);
};

/// A number of rays, structure of arrays.
struct RayBatch {
  static constexpr std::size_t kCapacity = 512;
  template <class T>
  using Row = std::array<T, kCapacity>;

  std::size_t size = 0;
  // Given with `add`.
  alignas(64) std::array<Row<float>, 3> origin, end;  ///< metres
  alignas(64) std::array<Row<double>, 3> centre;      ///< of the first cell, metres
  alignas(64) Row<CellCode> first, last;
  Row<std::uint32_t> cells;  ///< steps from the first cell to the last
  // Computed by `prepare`.
  /// Per axis: where along the ray the next border of cells is crossed, and how far apart the
  /// borders are, metres; the greatest double for an axis along which the ray does not move.
  alignas(64) std::array<Row<double>, 3> crossing, spacing;
  alignas(64) Row<double> length;  ///< metres
  /// Per axis: +1, 0 or -1 as bits of that axis in a code.
  alignas(64) std::array<Row<CellCode>, 3> step;

  /// Adds a ray between different cells.
  /// \param steps from the first cell to the last
  void add(const RayOrigin& from, const Place& to, std::uint32_t steps, CellCode to_code) {
    const std::size_t k = size++;
    first[k] = from.code;
    last[k] = to_code;
    cells[k] = steps;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis][k] = from.place[axis];
      end[axis][k] = to[axis];
      centre[axis][k] = from.centre[axis];
    }
  }
  /// Computes what the walk needs of all rays, for cells of `resolution` metres.
  void prepare(double resolution);
};

}  // namespace mrpt_terrain::octree
