// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// \file
/// Numbers, times and names as text; the same on every machine, whatever its locale.
namespace mrpt_terrain::view {

/// A number with a fixed count of decimals ("-0.350"); never "-0.00". Empty for NaN and infinity.
[[nodiscard]] std::string fixed(double value, int decimals);

/// The shortest text that reads back as the same number. Empty for NaN and infinity.
[[nodiscard]] std::string shortest(double value);
[[nodiscard]] std::string shortest(float value);

/// A count with thin groups of three digits: "121 342".
[[nodiscard]] std::string grouped(std::size_t count);

/// A time stamp for people: "2011-09-26 13:02:25.964 UTC" for seconds since the Unix epoch. Small
/// stamps (before 1973, as in data sets that count from their start) become "t = 12.345 s".
[[nodiscard]] std::string time_text(double stamp);

/// The text with every byte that is not part of valid UTF-8, and every control character, replaced
/// by '?': names of files may hold anything.
[[nodiscard]] std::string printable(std::string_view text);

/// Name of a file without its folders.
[[nodiscard]] std::string base_name(std::string_view path);

/// The smallest of 1, 2, 5 times a power of ten that is >= `least`.
/// \param least > 0
[[nodiscard]] double round_step(double least);

/// Decimals that a multiple of `step` (see `round_step`) needs.
[[nodiscard]] int decimals_of(double step);

}  // namespace mrpt_terrain::view
