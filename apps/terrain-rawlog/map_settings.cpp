// SPDX-License-Identifier: BSD-3-Clause
#include "map_settings.h"

#include <mrpt/config/CConfigFile.h>

#include <algorithm>
#include <cctype>

#include "app_params.h"
#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "mrpt_terrain/params/set.h"

namespace {

using namespace mrpt_terrain;

const std::string kPrefix = "map_terrainMap_00";

// MRPT's reader takes no account of case.
bool is_same(const std::string& a, const std::string& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
           return std::tolower(static_cast<unsigned char>(x)) ==
                  std::tolower(static_cast<unsigned char>(y));
         });
}

bool is_of_the_map(const params::SectionText& section) {
  const std::string beginning = kPrefix + "_";
  return section.name.size() > beginning.size() &&
         is_same(section.name.substr(0, beginning.size()), beginning);
}

// Whether a file is one of `process`, such as params/field.ini: it has a section of its parameters.
bool is_of_process(const params::Document& document) {
  AppParams known;
  const std::vector<params::Section> sections = params::sections_of(known);
  return std::any_of(
      document.sections.begin(), document.sections.end(), [&](const params::SectionText& text) {
        return std::any_of(sections.begin(), sections.end(), [&](const params::Section& section) {
          return is_same(text.name, section.name);
        });
      });
}

/// What a file says about the map.
enum class FileKind { kNone, kDefinition, kProcess };

FileKind load_file(const std::string& file, MapParams& params) {
  if (file.empty()) return FileKind::kNone;
  const params::Document document = params::read_ini(file);  // refuses what MRPT would pass over
  if (std::any_of(document.sections.begin(), document.sections.end(), is_of_the_map)) {
    load_map_params(mrpt::config::CConfigFile(file), kPrefix, params);
    return FileKind::kDefinition;
  }
  if (!is_of_process(document)) {
    throw params::ParameterError(
        file + ": defines no terrain map: there is no section [" + kPrefix +
        "_creationOpts] or the like; params/mrpt/terrain_map.ini is an example");
  }
  const AppParams of_process = load_params(file, {});
  params.description = of_process.description;
  params.input = of_process.input;
  return FileKind::kProcess;
}

// The sections of a map under their short names, such as `creationOpts`.
std::vector<params::Section> short_sections(MapParams& params) {
  std::vector<params::Section> sections = map_sections("", params);
  for (params::Section& section : sections) section.name.erase(0, 1);
  return sections;
}

// Whether a setting is about this key of a map's definition.
bool is_set(const std::string& key, const std::vector<std::string>& settings) {
  return std::any_of(settings.begin(), settings.end(), [&key](const std::string& setting) {
    for (const params::SectionText& section : params::read_assignment(setting, "--set").sections) {
      for (const params::KeyText& text : section.keys) {
        if (is_same(text.key, key)) return true;
      }
    }
    return false;
  });
}

// The defaults are those of the paper's single scans, whose cells are smaller than the voxels.
// Fused scans need voxels that fit the cells: what was not asked for follows.
void fit_voxels(const std::vector<std::string>& settings, MapParams& params) {
  if (params.creation.fusion != Fusion::kRolling || !params.creation.octree) return;
  double& cell = params.description.grid.cell_size;
  double& voxel = params.creation.octree_resolution;
  if (!is_set("cell_size", settings)) {
    cell = voxel;
  } else if (!is_set("octree_resolution", settings)) {
    voxel = cell;
  }
}

}  // namespace

MapParams load_map_settings(const std::string& file, const std::vector<std::string>& settings) {
  MapParams result;
  const FileKind kind = load_file(file, result);
  const std::vector<params::Section> sections = short_sections(result);
  for (const std::string& setting : settings) {
    params::assign_all(params::read_assignment(setting, "--set"), sections);
  }
  if (kind == FileKind::kNone) fit_voxels(settings, result);
  // A file of `process` knows nothing of voxels.
  if (kind == FileKind::kProcess && result.creation.fusion == Fusion::kRolling &&
      !is_set("octree_resolution", settings))
    result.creation.octree_resolution = result.description.grid.cell_size;
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
