// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// A table of texts, printed aligned or as HTML.
struct TextTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< as long as the header
  std::string note;                            ///< below the table; may be empty
};

/// Columns two blanks apart, the first one flush left and the others flush right.
[[nodiscard]] std::string as_text(const TextTable& table);

/// An h3, a table and a paragraph; cells that hold a verdict have its name as class.
/// \param id of the h3, for links
[[nodiscard]] std::string as_html(const TextTable& table, const std::string& id);

/// The text with the characters that mean something in HTML replaced.
[[nodiscard]] std::string html_escaped(const std::string& text);
