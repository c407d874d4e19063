// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mrpt_terrain::params {

/// Where the files that come with this project may be.
struct DataFolderPlaces {
  std::optional<std::string> environment;   ///< value of MRPT_TERRAIN_DATA_DIR, if it is set
  std::filesystem::path executable_folder;  ///< of the running program; empty if unknown
  std::filesystem::path library_folder;     ///< of the library or program that holds this code
  std::filesystem::path source_folder;      ///< of the sources this library was built from
};

/// The places of the running program.
[[nodiscard]] DataFolderPlaces data_folder_places();

/// The folder that holds `params/`: MRPT_TERRAIN_DATA_DIR if it is set (and then nothing else),
/// otherwise `../share/mrpt_terrain` beside the program's folder (an installed program), otherwise
/// the same beside the library's folder or the one above it (an installed plug-in in a program of
/// others, in lib or lib/x86_64-linux-gnu), otherwise the source folder. Throws std::runtime_error
/// with all that was tried.
[[nodiscard]] std::filesystem::path find_data_folder(
    const DataFolderPlaces& places = data_folder_places());

}  // namespace mrpt_terrain::params
