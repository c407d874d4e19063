// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scans.h"

/// \file
/// Runs of `terrain-rawlog map` and `export`.
namespace mrpt_terrain::test {

using Arguments = std::vector<std::string>;

/// What every map with an OctoMap is saved as, beside the map itself.
inline const std::vector<std::string> kMapForms = {".3Dscene",     ".ot",       ".bt",
                                                   "_classes.png", "_cost.png", "_clusters.csv",
                                                   "_cost.pgm",    "_cost.yaml"};

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Options for maps whose scans are fused, with cells that the OctoMap's voxels fit.
inline const Arguments kRolling = {"--set", "creationOpts.fusion=rolling", "--set",
                                   "creationOpts.cell_size=0.2"};

/// A rawlog that comes with the project.
inline std::string shipped(const std::string& name) {
  return MRPT_TERRAIN_SOURCE_DIR "/rawlogs/" + name;
}

/// `terrain-rawlog map INPUT -o FOLDER/built/map ...`
inline ProgramResult build_map(const std::filesystem::path& folder, const std::string& input,
                               const Arguments& more = {}) {
  return terrain_rawlog(folder,
                        Arguments{"map", input, "-o", (folder / "built" / "map").string()} + more);
}

/// `terrain-rawlog export FILE -o FOLDER/exported/map ...`
inline ProgramResult export_map(const std::filesystem::path& folder, const std::string& file,
                                const Arguments& more = {}) {
  return terrain_rawlog(
      folder, Arguments{"export", file, "-o", (folder / "exported" / "map").string()} + more);
}

}  // namespace mrpt_terrain::test
