// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Makes a folder, and those above it, if it is missing; returns its name. Throws
/// std::runtime_error "FOLDER: cannot be made: reason".
std::string made_folder(std::string folder);

/// The beginning of the names of a map's files from what the user gave: `FOLDER/map` for a folder
/// (one that exists, or a name that ends in "/"), else the text without ".metricmap" at its end.
[[nodiscard]] std::string map_prefix(const std::string& given);

/// Finds out before any work is done whether files can be written that begin with `prefix`; makes
/// the folder if it is missing. Throws std::runtime_error "FILE: cannot be written: reason".
void check_writable(const std::string& prefix);
