// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/data_files.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace mrpt_terrain::params {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "MRPT_TERRAIN_DATA_DIR";

bool holds_params(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "params", ignored);
}

// The folder of the file that this function was loaded from: the program, or a library that has it
// inside. Empty if that is not known.
fs::path own_folder() {
  const auto here = reinterpret_cast<std::uintptr_t>(&own_folder);
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    // begin-end rights offset device inode file
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::string word, file;
    if (!(words >> std::hex >> begin >> dash >> end) || here < begin || here >= end) continue;
    if (!(words >> word >> word >> word >> word >> std::ws) || !std::getline(words, file)) break;
    return fs::path(file).parent_path();
  }
  return {};
}

}  // namespace

DataFolderPlaces data_folder_places() {
  DataFolderPlaces places;
  if (const char* variable = std::getenv(kVariable)) places.environment = variable;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.executable_folder = program.parent_path();
  places.library_folder = own_folder();
  places.source_folder = MRPT_TERRAIN_SOURCE_FOLDER;
  return places;
}

fs::path find_data_folder(const DataFolderPlaces& places) {
  if (places.environment) {
    if (holds_params(*places.environment)) return *places.environment;
    throw std::runtime_error(std::string(kVariable) + " = " + *places.environment +
                             ": must name a folder that holds params/");
  }
  std::vector<fs::path> candidates;
  if (!places.executable_folder.empty()) {
    candidates.push_back(places.executable_folder.parent_path() / "share" / "mrpt_terrain");
  }
  if (!places.library_folder.empty()) {
    const fs::path above = places.library_folder.parent_path();
    candidates.push_back(above / "share" / "mrpt_terrain");
    candidates.push_back(above.parent_path() / "share" / "mrpt_terrain");
  }
  candidates.push_back(places.source_folder);
  std::string tried;
  for (const fs::path& candidate : candidates) {
    if (holds_params(candidate)) return candidate;
    tried += "\n  " + candidate.string();
  }
  throw std::runtime_error("The data files of mrpt_terrain were not found; set " +
                           std::string(kVariable) +
                           " to the folder that holds params/. Tried:" + tried);
}

}  // namespace mrpt_terrain::params
