// SPDX-License-Identifier: BSD-3-Clause
// How MRPT makes terrain maps from `.ini` files, and how it learns about the class.
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>

#include <ostream>

#include "mrpt_terrain/map/terrain_map.h"
#include "mrpt_terrain/params/ini.h"

MAP_DEFINITION_REGISTER("mrpt_terrain::CTerrainMap,terrainMap", mrpt_terrain::CTerrainMap)

namespace mrpt_terrain {

CTerrainMap::TMapDefinition::TMapDefinition() = default;

void CTerrainMap::TMapDefinition::loadFromConfigFile_map_specific(
    const mrpt::config::CConfigFileBase& source, const std::string& prefix) {
  load_map_params(source, prefix, params);
}

void CTerrainMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  MapParams copy = params;
  out << params::ini_text(map_sections("terrainMap", copy));
}

mrpt::maps::CMetricMap* CTerrainMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  const auto& own = dynamic_cast<const TMapDefinition&>(definition);
  return new CTerrainMap(own.params);
}

void register_map_classes() { mrpt::rtti::registerClass(CLASS_ID(CTerrainMap)); }

}  // namespace mrpt_terrain

MRPT_INITIALIZER(register_all_mrpt_terrain_map) { mrpt_terrain::register_map_classes(); }
