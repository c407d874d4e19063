// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/map_params.h"

#include <mrpt/config/CConfigFile.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>

#include "mrpt_terrain/params/document.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"

namespace mrpt_terrain {
namespace {

using params::Field;
using params::Section;

constexpr double kMostCells = 1e8;

/// Keys of `_creationOpts` that MRPT reads by itself (mrpt::maps::TMapGenericParams).
struct GenericParams {
  bool save_as_3d_object = true;
  bool likelihood = true;
  bool insertion = true;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.save_as_3d_object,
          ParamInfo{"enableSaveAs3DObject", "", "", 0, 0, "shows the map in 3D views"});
    visit(self.likelihood,
          ParamInfo{"enableObservationLikelihood", "", "", 0, 0, "has a say in localisation"});
    visit(self.insertion,
          ParamInfo{"enableObservationInsertion", "", "", 0, 0, "takes observations"});
  }
};

template <class Params>
void append_fields(Params& params, Section& section) {
  std::vector<Field> fields = params::fields_of(params);
  section.fields.insert(section.fields.end(), fields.begin(), fields.end());
}

template <class... Params>
Section joined_section(const std::string& name, const char* meaning, Params&... parts) {
  Section section{name, meaning, {}};
  (append_fields(parts, section), ...);
  return section;
}

/// Fields that the map gives a fused grid by itself.
Section fusion_section(const std::string& name, FusionParams& fusion) {
  Section section = joined_section(name, "How scans are fused", fusion);
  const auto is_given = [](const Field& field) {
    return std::string(field.info.key) == "cell_size" ||
           std::string(field.info.key) == "layer_height";
  };
  std::vector<Field>& fields = section.fields;
  fields.erase(std::remove_if(fields.begin(), fields.end(), is_given), fields.end());
  return section;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool starts_with(const std::string& text, const std::string& beginning) {
  return lower_case(text.substr(0, beginning.size())) == lower_case(beginning);
}

/// Beginning of messages: the file, if the configuration is one.
std::string source_of(const mrpt::config::CConfigFileBase& config) {
  const auto* file = dynamic_cast<const mrpt::config::CConfigFile*>(&config);
  return file == nullptr ? "map definition" : file->getAssociatedFile();
}

/// The sections of one map, under the names that `map_sections` gives them.
params::Document document_of(const mrpt::config::CConfigFileBase& config,
                             const std::string& prefix) {
  params::Document document = params::read_ini(config, source_of(config));
  std::vector<params::SectionText> own;
  for (params::SectionText& section : document.sections) {
    if (!starts_with(section.name, prefix + "_")) continue;
    if (lower_case(section.name) == lower_case(prefix + "_insertionOpts")) {
      section.name = prefix + "_insertOpts";
    }
    own.push_back(std::move(section));
  }
  document.sections = std::move(own);
  return document;
}

/// Keys that maps were stored with and that mean nothing any more.
struct RetiredKey {
  const char* section;
  const char* key;
};
constexpr RetiredKey kRetiredKeys[] = {{"decks", "bent"}, {"holes", "rim_sigma"}};

void drop_retired_keys(const std::string& prefix, params::Document& document) {
  for (params::SectionText& section : document.sections) {
    const auto is_retired = [&](const params::KeyText& text) {
      return std::any_of(
          std::begin(kRetiredKeys), std::end(kRetiredKeys), [&](const RetiredKey& retired) {
            return section.name == prefix + "_" + retired.section && text.key == retired.key;
          });
    };
    section.keys.erase(std::remove_if(section.keys.begin(), section.keys.end(), is_retired),
                       section.keys.end());
  }
}

void load(const params::Document& document, const std::string& source, const std::string& prefix,
          MapParams& params) {
  MapParams loaded = params;
  GenericParams generic;
  std::vector<Section> sections = map_sections(prefix, loaded);
  append_fields(generic, sections.front());
  params::assign_all(document, sections);
  check_together(loaded, source + ": [" + prefix + "_...]");
  params = loaded;
}

}  // namespace

FusionParams fusion_of(const MapParams& params) {
  FusionParams fusion = params.fusion;
  fusion.cell_size = params.description.grid.cell_size;
  fusion.layer_height = params.creation.octree_resolution;
  return fusion;
}

std::vector<Section> map_sections(const std::string& prefix, MapParams& params) {
  DescriptionParams& description = params.description;
  std::vector<Section> sections{
      joined_section(prefix + "_creationOpts", "The map itself", params.creation, description.grid),
      joined_section(prefix + "_insertOpts", "How observations enter", params.input, params.octree),
      fusion_section(prefix + "_fusion", params.fusion),
      joined_section(prefix + "_likelihoodOpts", "How well a scan fits", params.likelihood),
      joined_section(prefix + "_renderOpts", "What 3D views show", params.render),
      joined_section(prefix + "_robot", "The robot that costs are for", params.robot)};
  for (Section& stage : params::sections_of(description)) {
    if (stage.name == "grid") continue;  // stands in creationOpts
    stage.name = prefix + "_" + stage.name;
    sections.push_back(std::move(stage));
  }
  return sections;
}

void load_map_params(const mrpt::config::CConfigFileBase& config, const std::string& prefix,
                     MapParams& params) {
  load(document_of(config, prefix), source_of(config), prefix, params);
}

void load_stored_map_params(const mrpt::config::CConfigFileBase& config, const std::string& prefix,
                            MapParams& params) {
  params::Document document = document_of(config, prefix);
  drop_retired_keys(prefix, document);
  load(document, source_of(config), prefix, params);
}

void check_together(const MapParams& params, const std::string& source) {
  std::vector<std::string> problems;
  const auto refuse = [&](bool wrong, const std::string& text) {
    if (wrong) problems.push_back(source + " " + text);
  };
  refuse(params.input.min_range >= params.input.max_range,
         "min_range: must be less than max_range");
  refuse(params.description.classes.slope_min > params.description.classes.slope_max,
         "slope_min_deg: must be at most slope_max_deg");
  refuse(params.octree.prob_miss >= params.octree.prob_hit,
         "octree_prob_miss: must be less than octree_prob_hit");
  const GridParams& grid = params.description.grid;
  const double cells = (grid.length / grid.cell_size) * (grid.width / grid.cell_size);
  refuse(cells > kMostCells, "cell_size: makes more than a hundred million cells");
  const double voxels = grid.cell_size / params.creation.octree_resolution;
  const bool whole = std::abs(voxels - std::round(voxels)) < 1e-6 && voxels > 0.5 && voxels < 64.5;
  refuse(
      params.creation.fusion == Fusion::kRolling && params.creation.octree && !whole,
      "octree_resolution: must go into cell_size 1 to 64 times where scans are fused, so that the "
      "OctoMap can tell which heights of a cell are free");
  refuse(params.octree.protect_ground &&
             !(params.creation.fusion == Fusion::kRolling && params.creation.octree),
         "octree_protect_ground: needs fusion = rolling and an OctoMap: the fused grid knows where "
         "the ground is");
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw params::ParameterError(text);
}

}  // namespace mrpt_terrain
