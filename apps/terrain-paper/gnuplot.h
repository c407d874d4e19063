// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// Path of the program gnuplot in PATH; empty if there is none.
[[nodiscard]] std::string find_gnuplot();

/// Makes NAME.svg and NAME.png of the script NAME.gp in a folder. They are there as a whole or not
/// at all.
/// \return what went wrong; empty if nothing did
[[nodiscard]] std::string run_gnuplot(const std::string& gnuplot,
                                      const std::filesystem::path& folder, const std::string& name);
