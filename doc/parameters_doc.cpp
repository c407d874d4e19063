// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Writes doc/parameters.md (to the file named on the command line) from the field lists of the
/// parameter structs, so that the document cannot disagree with the program.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "app_params.h"
#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/params/documentation.h"

namespace {

constexpr const char* kIntroduction = R"(# Parameters

Generated from the field lists in the headers by `terrain-parameters-doc`; CONTRIBUTING.md says how to
make it again. A parameter file is an `.ini` file with the sections below; keys that it does not give
keep their default, and unknown keys, values out of range and values that cannot be read are refused.
`terrain-rawlog --print-default-config` prints a file with all of them, `params/` has some to start
from. "In the paper": the symbol in Meng, Cao et al. 2018. Keys that end in `_deg` are degrees.

)";

constexpr const char* kRobots = R"(
# Robots

A robot has a file of its own, with one section; `params/robots/` has some to start from, and
[costs.md](costs.md) says how the limits become costs. The defaults are those of `small_rover.ini`.

)";

constexpr const char* kMaps = R"(
# Terrain maps in MRPT's programs

Sections of a map's definition in the `.ini` file of an MRPT program ([mrpt-programs.md](mrpt-programs.md)); `map` stands for the
name of the map set's section, `00` for the number of the map. A map also takes the sections of the stages above, named
`map_terrainMap_00_ground` and so on.

)";

/// The sections of a map that are not those of the stages.
std::vector<mrpt_terrain::params::Section> own_sections(mrpt_terrain::MapParams& params) {
  const std::string prefix = "map_terrainMap_00";
  std::vector<mrpt_terrain::params::Section> own;
  const auto stages = mrpt_terrain::params::sections_of(params.description);
  for (auto& section : mrpt_terrain::map_sections(prefix, params)) {
    const bool is_stage = std::any_of(stages.begin(), stages.end(), [&](const auto& stage) {
      return section.name == prefix + "_" + stage.name;
    });
    if (!is_stage && section.name != prefix + "_robot") own.push_back(std::move(section));
  }
  return own;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: terrain-parameters-doc FILE\n";
    return EXIT_FAILURE;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << kIntroduction << mrpt_terrain::params::markdown_table(AppParams{}) << kRobots
       << mrpt_terrain::params::markdown_table(mrpt_terrain::RobotParams{});
  mrpt_terrain::MapParams map;
  file << kMaps << mrpt_terrain::params::markdown_text(own_sections(map));
  file.close();
  if (!file) {
    std::cerr << argv[1] << ": cannot be written\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
