// SPDX-License-Identifier: BSD-3-Clause
#include "map_settings.h"

#include <mrpt/config/CConfigFile.h>

#include <algorithm>
#include <cctype>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "mrpt_terrain/params/set.h"

namespace {

using namespace mrpt_terrain;

const std::string kPrefix = "map_terrainMap_00";

// MRPT's reader takes no account of case.
bool is_of_the_map(const params::SectionText& section) {
  const std::string beginning = kPrefix + "_";
  return section.name.size() > beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), section.name.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) ==
                  std::tolower(static_cast<unsigned char>(b));
         });
}

void load_definition(const std::string& file, MapParams& params) {
  const params::Document document = params::read_ini(file);  // refuses what MRPT would pass over
  if (std::none_of(document.sections.begin(), document.sections.end(), is_of_the_map)) {
    throw params::ParameterError(
        file + ": defines no terrain map: there is no section [" + kPrefix +
        "_creationOpts] or the like; params/mrpt/terrain_map.ini is an example");
  }
  load_map_params(mrpt::config::CConfigFile(file), kPrefix, params);
}

// The sections of a map under their short names, such as `creationOpts`.
std::vector<params::Section> short_sections(MapParams& params) {
  std::vector<params::Section> sections = map_sections("", params);
  for (params::Section& section : sections) section.name.erase(0, 1);
  return sections;
}

}  // namespace

MapParams load_map_settings(const std::string& file, const std::vector<std::string>& settings) {
  MapParams result;
  if (!file.empty()) load_definition(file, result);
  const std::vector<params::Section> sections = short_sections(result);
  for (const std::string& setting : settings) {
    params::assign_all(params::read_assignment(setting, "--set"), sections);
  }
  check_together(result, "--set:");
  return result;
}

void change_render_settings(const std::vector<std::string>& settings, MapParams& params) {
  MapParams changed = params;
  std::vector<params::Section> sections = short_sections(changed);
  const auto is_other = [](const params::Section& section) { return section.name != "renderOpts"; };
  sections.erase(std::remove_if(sections.begin(), sections.end(), is_other), sections.end());
  for (const std::string& setting : settings) {
    params::assign_all(params::read_assignment(setting, "--set"), sections);
  }
  params = changed;
}
