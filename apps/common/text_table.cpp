// SPDX-License-Identifier: BSD-3-Clause
#include "text_table.h"

#include <algorithm>
#include <cstddef>

namespace {

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return left ? text + blanks : blanks + text;
}

std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    text += (k == 0 ? "" : "  ") + padded(cells[k], widths[k], k == 0);
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

bool is_verdict(const std::string& cell) {
  return cell == "better" || cell == "tie" || cell == "worse";
}

}  // namespace

std::string as_text(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.header) widths.push_back(cell.size());
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  std::size_t width = 2 * (widths.size() - 1);
  for (const std::size_t column : widths) width += column;
  std::string text = table.title + "\n" + line(table.header, widths);
  text += std::string(width, '-') + "\n";
  for (const auto& row : table.rows) text += line(row, widths);
  return table.note.empty() ? text : text + table.note + "\n";
}

std::string html_escaped(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}

std::string as_html(const TextTable& table, const std::string& id) {
  std::string html = "<h3 id=\"" + id + "\">" + html_escaped(table.title) + "</h3>\n<table>\n<tr>";
  for (const std::string& cell : table.header) html += "<th>" + html_escaped(cell) + "</th>";
  html += "</tr>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) {
      html += (is_verdict(cell) ? "<td class=\"" + cell + "\">" : "<td>") + html_escaped(cell);
      html += "</td>";
    }
    html += "</tr>\n";
  }
  html += "</table>\n";
  if (!table.note.empty()) html += "<p>" + html_escaped(table.note) + "</p>\n";
  return html;
}
