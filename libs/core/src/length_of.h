// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace mrpt_terrain {

/// Length of a vector: what `std::hypot` gives for floats, without the call. A square of a float is
/// exact in double and out of range of neither.
[[nodiscard]] inline float length_of(float x, float y) {
  const auto u = static_cast<double>(x), v = static_cast<double>(y);
  return static_cast<float>(std::sqrt(u * u + v * v));
}

}  // namespace mrpt_terrain
