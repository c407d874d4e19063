// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mrpt_terrain {

/// Cells that are worked on side by side. Each lane does what a single cell would, operation by
/// operation: the same bits with every width of registers.
inline constexpr std::size_t kCellLanes = 8;

typedef double DoubleLanes __attribute__((vector_size(kCellLanes * sizeof(double))));
/// What a comparison of lanes gives: all bits set or none.
typedef std::int64_t MaskLanes __attribute__((vector_size(kCellLanes * sizeof(std::int64_t))));

typedef float FloatLanes __attribute__((vector_size(kCellLanes * sizeof(float))));
typedef std::int32_t IntLanes __attribute__((vector_size(kCellLanes * sizeof(std::int32_t))));

/// The same in memory, one number per lane.
struct alignas(64) LaneArray {
  double value[kCellLanes] = {};
};

// By reference: passing vectors by value would depend on the instruction set. Inlined always: so
// they become part of functions for several processors.
#define MRPT_TERRAIN_LANES [[gnu::always_inline]] inline

MRPT_TERRAIN_LANES void load(const LaneArray& array, DoubleLanes& lanes) {
  std::memcpy(&lanes, array.value, sizeof(lanes));
}
MRPT_TERRAIN_LANES void store(const DoubleLanes& lanes, LaneArray& array) {
  std::memcpy(array.value, &lanes, sizeof(lanes));
}
/// From `kCellLanes` numbers that follow each other anywhere in memory.
template <class Lanes, class Number>
MRPT_TERRAIN_LANES void load_from(const Number* first, Lanes& lanes) {
  static_assert(sizeof(lanes) == kCellLanes * sizeof(Number));
  std::memcpy(&lanes, first, sizeof(lanes));
}
MRPT_TERRAIN_LANES void take_roots(DoubleLanes& lanes) {
  LaneArray array;
  store(lanes, array);
  for (double& value : array.value) value = std::sqrt(value);
  load(array, lanes);
}

// Comparisons are best written where they select: compilers that do not know the processor yet turn
// those that are kept in a `MaskLanes`, or combined by `&`, into one comparison per lane.
// Conditions of several comparisons are therefore flags, 1 or 0.
MRPT_TERRAIN_LANES void set_flags(DoubleLanes& flags) { flags = DoubleLanes{} + 1.0; }
/// Leaves a flag only where a < b.
MRPT_TERRAIN_LANES void keep_less(const DoubleLanes& a, const DoubleLanes& b, DoubleLanes& flags) {
  const DoubleLanes zero{}, one = zero + 1.0;
  const DoubleLanes less = a < b ? one : zero;
  flags = flags * less;
}
/// Leaves a flag only where a <= b.
MRPT_TERRAIN_LANES void keep_up_to(const DoubleLanes& a, const DoubleLanes& b, DoubleLanes& flags) {
  const DoubleLanes zero{}, one = zero + 1.0;
  const DoubleLanes up_to = a <= b ? one : zero;
  flags = flags * up_to;
}
MRPT_TERRAIN_LANES bool any_flag(const DoubleLanes& flags) {
  double lanes[kCellLanes];
  std::memcpy(lanes, &flags, sizeof(lanes));
  double any = 0.0;
  for (const double lane : lanes) any += lane;
  return any > 0.0;
}

}  // namespace mrpt_terrain
