// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

/// Waypoints from the option --path: "x,y; x,y; ..." in metres, or the name of a text file with a
/// waypoint "x y" or "x,y" in each line (`#` starts a comment). Throws std::invalid_argument
/// "--path: ..." or "FILE:LINE: ...", and where a file cannot be read.
[[nodiscard]] std::vector<Eigen::Vector2d> parse_path(const std::string& text);
