// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/documentation.h"

#include <algorithm>

namespace mrpt_terrain::params {
namespace {

/// A bar would end the cell of the table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string row(const Field& field, bool with_symbols) {
  const std::string unit = field.info.unit;
  const std::string value = text_of(field) + (unit.empty() ? "" : " " + unit);
  const std::string symbol = with_symbols ? " | " + cell(field.info.symbol) : "";
  return "| `" + std::string(field.info.key) + "`" + symbol + " | " + cell(value) + " | " +
         cell(permitted_text(field)) + " | " + cell(field.info.meaning) + " |\n";
}

std::string table(const Section& section) {
  const auto has_symbol = [](const Field& field) { return *field.info.symbol != '\0'; };
  const bool with_symbols = std::any_of(section.fields.begin(), section.fields.end(), has_symbol);
  std::string text = with_symbols ? "| key | in the paper | default | permitted | meaning |\n"
                                    "|---|---|---|---|---|\n"
                                  : "| key | default | permitted | meaning |\n|---|---|---|---|\n";
  for (const Field& field : section.fields) text += row(field, with_symbols);
  return text;
}

}  // namespace

std::string markdown_text(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    if (!text.empty()) text += "\n";
    text += "## [" + section.name + "]\n\n" + section.meaning + ".\n\n" + table(section);
  }
  return text;
}

}  // namespace mrpt_terrain::params
