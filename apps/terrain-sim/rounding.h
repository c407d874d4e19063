// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

/// \file
/// What is written is rounded to steps far below what a sensor measures and far above the last bit
/// of a double: sines and cosines may differ in that bit between processors, files must not.

inline constexpr double kPositionStep = 1e-5;     ///< metres, of poses
inline constexpr double kAngleStep = 1e-7;        ///< radians, and parts of quaternions
inline constexpr double kPlanarRangeStep = 1e-4;  ///< metres

/// The nearest multiple of a step; never -0.
[[nodiscard]] inline double rounded(double value, double step) {
  return std::round(value / step) * step + 0.0;
}

/// Coordinate of a point, a multiple of 2^-13 m: the last bits of the float are then zero, which
/// shrinks the compressed file.
[[nodiscard]] inline float rounded_coordinate(float metres) {
  return std::round(metres * 8192.0F) / 8192.0F + 0.0F;
}
