// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// \file
/// Small helpers on text, private to this library.
namespace mrpt_terrain::params {

/// ASCII letters in lower case; section names and keys are compared this way, as MRPT's reader
/// does.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Without blanks, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Without a trailing comment: `//`, `;` or `#` at the beginning or after a blank.
[[nodiscard]] std::string_view without_comment(std::string_view text);

/// The candidate that a person may have meant: fewest typing errors (letters wrong, missing, extra
/// or swapped), or one text beginning with the other. Empty if none is near.
[[nodiscard]] std::string nearest(const std::string& text,
                                  const std::vector<std::string>& candidates);

/// What went wrong out of the text of an MRPT exception, without its call stack.
[[nodiscard]] std::string first_message(std::string_view what);

/// The texts with a separator between them.
template <class Text>
[[nodiscard]] std::string joined(const std::vector<Text>& texts, std::string_view separator) {
  std::string result;
  for (const Text& text : texts) {
    if (!result.empty()) result += separator;
    result += text;
  }
  return result;
}

}  // namespace mrpt_terrain::params
