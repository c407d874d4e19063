// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt_terrain/params/fields.h"

namespace mrpt_terrain::params {

/// Markdown: a heading and a table for each section, with a column for symbols of the paper where
/// one of its keys has one.
[[nodiscard]] std::string markdown_text(const std::vector<Section>& sections);

/// Markdown tables of a struct with `visit_sections`: a heading per section, and per parameter its
/// key, symbol in the paper, value in `params` (the default, if that was default-constructed),
/// permitted values and meaning. Ends with a line break.
template <class Params>
[[nodiscard]] std::string markdown_table(const Params& params) {
  Params copy = params;
  return markdown_text(sections_of(copy));
}

}  // namespace mrpt_terrain::params
