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

/// The same of numbers whose squares are in range, such as places in metres: up to a rounding, what
/// `std::hypot` gives.
[[nodiscard]] inline double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace mrpt_terrain
