// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <string>
#include <utility>
#include <vector>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/fields.h"

/// \file
/// Parameters from and to `.ini` files as MRPT reads them (`@define`, `${var}`, `$env{}`, `$eval{}`
/// and a backslash at the end of a line included).
///
/// `Params` is a struct with `visit_sections`; several of them make one file when an outer struct
/// visits the sections of each:
///
///     struct AppParams {
///       DescriptionParams description;
///       io::InputParams input;
///       template <class Self, class Visitor>
///       static void visit_sections(Self& self, Visitor&& visit) {
///         DescriptionParams::visit_sections(self.description, visit);
///         visit(self.input, "input", "How observations become points");
///       }
///     };
///
/// Keys that a file does not give keep their value. Everything else that MRPT's own reader passes
/// over in silence is refused with a ParameterError, and the struct is then unchanged.
namespace mrpt_terrain::params {

/// Reads a file: first the checks for which the text is needed (lines that are neither section nor
/// `key = value`, keys given twice), then MRPT's reader.
[[nodiscard]] Document read_ini(const std::string& file);

/// Reads what an MRPT host has already loaded; MRPT has merged keys given twice by then. Refuses a
/// `CConfigFilePrefixer`, which cannot list what it holds.
[[nodiscard]] Document read_ini(const mrpt::config::CConfigFileBase& config,
                                const std::string& source);

/// One section of the same. Its `sections` are empty if there is none of that name (case ignored).
[[nodiscard]] Document read_ini_section(const mrpt::config::CConfigFileBase& config,
                                        const std::string& source, const std::string& section);

/// Refuses lines that MRPT's reader would pass over or merge; see `read_ini`.
void check_ini_text(const std::string& text, const std::string& source);

/// Text of an `.ini` file with all sections and their keys, each with its meaning in a comment.
[[nodiscard]] std::string ini_text(const std::vector<Section>& sections);

/// Loads a file into a struct with `visit_sections`.
template <class Params>
void load_ini(const std::string& file, Params& params) {
  Params loaded = params;
  assign_all(read_ini(file), sections_of(loaded));
  params = std::move(loaded);
}

/// Loads a configuration in memory into a struct with `visit_sections`.
/// \param source beginning of the messages, such as the name of the file
template <class Params>
void load_ini(const mrpt::config::CConfigFileBase& config, const std::string& source,
              Params& params) {
  Params loaded = params;
  assign_all(read_ini(config, source), sections_of(loaded));
  params = std::move(loaded);
}

/// Loads one section into a struct with `visit_params`, for MRPT hosts that share a file among many
/// readers (`[map_terrainMap_00_insertOpts]`); other sections are not looked at.
/// \return whether there is such a section
template <class Params>
bool load_ini_section(const mrpt::config::CConfigFileBase& config, const std::string& source,
                      const std::string& section, Params& params) {
  const Document document = read_ini_section(config, source, section);
  Params loaded = params;
  assign_all(document, {Section{section, "", fields_of(loaded)}});
  params = std::move(loaded);
  return !document.sections.empty();
}

/// Text of an `.ini` file that gives every parameter; loading it gives the same struct, bit for
/// bit.
template <class Params>
[[nodiscard]] std::string dump_ini(const Params& params) {
  Params copy = params;
  return ini_text(sections_of(copy));
}

}  // namespace mrpt_terrain::params
