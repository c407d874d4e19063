// SPDX-License-Identifier: BSD-3-Clause
#include "output_place.h"

#include <filesystem>
#include <stdexcept>

#include "mrpt_terrain/files/whole_file.h"

std::string made_folder(std::string folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw std::runtime_error(folder + ": cannot be made: " +
                             (error ? error.message() : "there is something else of that name"));
  }
  return folder;
}

std::string map_prefix(const std::string& given) {
  const std::filesystem::path path(given);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored) || !path.has_filename()) {
    return (path / "map").string();
  }
  if (path.extension() == ".metricmap") return std::filesystem::path(path).replace_extension();
  return given;
}

void check_writable(const std::string& prefix) {
  const std::filesystem::path folder = std::filesystem::path(prefix).parent_path();
  if (!folder.empty()) made_folder(folder.string());
  mrpt_terrain::files::WholeFile probe(prefix + "_clusters.csv");
  (void)probe.stream();  // the part goes with `probe`
}
