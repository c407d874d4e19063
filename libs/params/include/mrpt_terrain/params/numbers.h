// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// \file
/// Numbers as they stand in parameter files: independent of the locale, strict when read, and
/// written so that reading gives the same bits back.
namespace mrpt_terrain::params {

/// What became of a text that should be a number.
enum class NumberStatus : std::uint8_t {
  kOk = 0,
  kNotANumber,       ///< empty, no number at all, or something after it
  kNotFinite,        ///< nan or inf
  kUnrepresentable,  ///< a number beyond what the type can hold
};

/// Reads a whole text as one number; `value` is written only when the status is kOk. A leading plus
/// sign is permitted, blanks are not.
[[nodiscard]] NumberStatus parse(std::string_view text, double& value);
[[nodiscard]] NumberStatus parse(std::string_view text, int& value);
[[nodiscard]] NumberStatus parse(std::string_view text, std::uint64_t& value);
/// Reads degrees, gives radians. The product is taken in long double, because in double many angles
/// in radians have no counterpart in degrees and could not be written and read back.
[[nodiscard]] NumberStatus parse_degrees(std::string_view text, double& radians);

/// Shortest text that `parse` reads back to the same bits; 0.0001 to 1e7 without an exponent.
[[nodiscard]] std::string to_text(double value);
/// Shortest text in degrees that `parse_degrees` reads back to the same bits.
[[nodiscard]] std::string to_text_degrees(double radians);

/// Radians of an angle in degrees: what `parse_degrees` gives for its shortest text.
[[nodiscard]] double radians_of(double degrees);

}  // namespace mrpt_terrain::params
