// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mrpt_terrain/map/terrain_map.h"

/// \file
/// Maps in files of their own (`.metricmap`): the serialised MRPT object, gzipped, as
/// `CFileGZInputStream` and `archiveFrom` read it.
namespace mrpt_terrain {

/// Writes a map, as a whole or not at all. The same map makes the same bytes. Throws
/// std::runtime_error "FILE: cannot be written: reason".
void save_map_file(const CTerrainMap& map, const std::string& file);

/// Reads a map, gzipped or not. Throws io::ReadError "FILE: reason" if the file is missing, empty
/// or a folder, holds something else than one terrain map, is cut off or damaged, or of a later
/// version.
[[nodiscard]] CTerrainMap load_map_file(const std::string& file);

/// Whether a file begins as one with a terrain map does. Throws io::ReadError if it cannot be read.
[[nodiscard]] bool is_map_file(const std::string& file);

}  // namespace mrpt_terrain
