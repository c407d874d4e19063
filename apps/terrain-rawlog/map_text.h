// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mrpt_terrain/map/terrain_map.h"

/// What a map holds, for people: scans, last pose, cells and their extent, OctoMap, clusters per
/// class. A few lines.
[[nodiscard]] std::string map_text(const mrpt_terrain::CTerrainMap& map);

/// One line that names the files which `saveMetricMapRepresentationToFile` writes of a map.
/// \param first another ending before them, such as ".metricmap"; may be empty
[[nodiscard]] std::string files_text(const mrpt_terrain::CTerrainMap& map,
                                     const std::string& prefix, const std::string& first);
