// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt_terrain/map/map_params.h"

/// Parameters of a terrain map from a definition as MRPT's programs read it
/// (`params/mrpt/terrain_map.ini`: sections `[map_terrainMap_00_...]`), or from a file of `process`
/// (`params/field.ini`: description and input), and from settings after it.
/// Throws params::ParameterError, also for a file without any such section.
/// \param file empty: the defaults; where scans are fused, cells and voxels then have the same size
///   unless `settings` say otherwise
/// \param settings "section.key=value", the section without its prefix
[[nodiscard]] mrpt_terrain::MapParams load_map_settings(const std::string& file,
                                                        const std::vector<std::string>& settings);

/// Changes what 3D views show by settings of the section `renderOpts`; those of other sections are
/// refused. Throws params::ParameterError; `params` is then unchanged.
void change_render_settings(const std::vector<std::string>& settings,
                            mrpt_terrain::MapParams& params);
