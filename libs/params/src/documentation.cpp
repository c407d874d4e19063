// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/documentation.h"

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

std::string row(const Field& field) {
  const std::string symbol = field.info.symbol;
  const std::string unit = field.info.unit;
  const std::string value = text_of(field) + (unit.empty() ? "" : " " + unit);
  return "| `" + std::string(field.info.key) + "` | " + cell(symbol) + " | " + cell(value) + " | " +
         cell(permitted_text(field)) + " | " + cell(field.info.meaning) + " |\n";
}

}  // namespace

std::string markdown_text(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    if (!text.empty()) text += "\n";
    text += "## [" + section.name + "]\n\n" + section.meaning + ".\n\n";
    text += "| key | in the paper | default | permitted | meaning |\n";
    text += "|---|---|---|---|---|\n";
    for (const Field& field : section.fields) text += row(field);
  }
  return text;
}

}  // namespace mrpt_terrain::params
