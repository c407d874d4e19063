// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "mrpt_terrain/eval/pothole_score.h"
#include "mrpt_terrain/eval/support_score.h"

/// \file
/// Names of bins and numbers as cells of tables.

/// "97.25" for 0.9725; "-" for NaN.
[[nodiscard]] std::string percent(double share);
[[nodiscard]] std::string percent(const mrpt_terrain::eval::Share& share);
/// A number with decimals; "-" for NaN.
[[nodiscard]] std::string number(double value, int decimals);
[[nodiscard]] std::string count(std::size_t value);

/// "0-10", "10-20", ..., ">40".
[[nodiscard]] std::vector<std::string> distance_names();
[[nodiscard]] std::vector<std::string> height_names();
[[nodiscard]] std::vector<std::string> hole_distance_names();
/// Names of terrain classes by their number.
[[nodiscard]] std::vector<std::string> class_names();
