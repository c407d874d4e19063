// SPDX-License-Identifier: BSD-3-Clause
#include "text.h"

#include <algorithm>
#include <cstddef>

namespace mrpt_terrain::params {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

bool comment_starts_at(std::string_view text, std::size_t k) {
  return text[k] == ';' || text[k] == '#' || text.substr(k, 2) == "//";
}

/// Optimal string alignment distance: insertions, deletions, replacements, swaps of neighbours.
std::size_t typing_errors(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

bool one_begins_with_the_other(std::string_view a, std::string_view b) {
  const std::size_t n = std::min(a.size(), b.size());
  return n >= 3 && a.substr(0, n) == b.substr(0, n);
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view without_comment(std::string_view text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (comment_starts_at(text, k) && (k == 0 || is_blank(text[k - 1]))) {
      return trimmed(text.substr(0, k));
    }
  }
  return trimmed(text);
}

std::string nearest(const std::string& text, const std::vector<std::string>& candidates) {
  const std::string typed = lower_case(text);
  std::string best;
  std::size_t best_errors = std::max<std::size_t>(2, typed.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::string known = lower_case(candidate);
    std::size_t errors = typing_errors(typed, known);
    // A name of two letters is two errors away from any other.
    if (errors >= std::max(typed.size(), known.size())) continue;
    if (one_begins_with_the_other(typed, known)) errors = std::min<std::size_t>(errors, 2);
    if (errors >= best_errors) continue;
    best = candidate;
    best_errors = errors;
  }
  return best;
}

std::string first_message(std::string_view what) {
  constexpr std::string_view kLabel = "Message:";
  const std::size_t label = what.find(kLabel);
  if (label != std::string_view::npos) what.remove_prefix(label + kLabel.size());
  return std::string(trimmed(what.substr(0, what.find('\n'))));
}

}  // namespace mrpt_terrain::params
