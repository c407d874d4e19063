// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/containers/yaml.h>

#include <string>
#include <utility>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/fields.h"

/// \file
/// Parameters from YAML, with the same rules and messages as for `.ini` (params/ini.h):
///
///     ground:
///       t_diff: 0.05   # metres
///     slope:
///       max_iterations: 1000
namespace mrpt_terrain::params {

/// Reads a file. It must be written as above, a line for each section and key: MRPT's YAML reader
/// takes the last of two equal keys and what came before a syntax error, both in silence, so the
/// text is compared with what the reader made of it.
[[nodiscard]] Document read_yaml(const std::string& file);

/// Reads a map of sections in memory.
[[nodiscard]] Document read_yaml(const mrpt::containers::yaml& root, const std::string& source);

/// Reads one map of keys and values, as the section of that name.
[[nodiscard]] Document read_yaml_section(const mrpt::containers::yaml& keys,
                                         const std::string& source, const std::string& section);

/// Refuses text that is not sections with keys and values, one a line, and keys given twice.
void check_yaml_text(const std::string& text, const std::string& source);

/// Loads a file into a struct with `visit_sections`.
template <class Params>
void load_yaml(const std::string& file, Params& params) {
  Params loaded = params;
  assign_all(read_yaml(file), sections_of(loaded));
  params = std::move(loaded);
}

/// Loads a map of sections in memory into a struct with `visit_sections`.
template <class Params>
void load_yaml(const mrpt::containers::yaml& root, const std::string& source, Params& params) {
  Params loaded = params;
  assign_all(read_yaml(root, source), sections_of(loaded));
  params = std::move(loaded);
}

/// Loads one map of keys and values into a struct with `visit_params`.
/// \param section what the messages call it
template <class Params>
void load_yaml_section(const mrpt::containers::yaml& keys, const std::string& source,
                       const std::string& section, Params& params) {
  Params loaded = params;
  assign_all(read_yaml_section(keys, source, section), {Section{section, "", fields_of(loaded)}});
  params = std::move(loaded);
}

}  // namespace mrpt_terrain::params
