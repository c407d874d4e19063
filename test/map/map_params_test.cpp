// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/map_params.h"

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include "mrpt_terrain/map/terrain_map.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using testing::config_of;

std::string refusal_of(const std::string& text) {
  MapParams params;
  try {
    load_map_params(config_of(text), "map_terrainMap_00", params);
  } catch (const params::ParameterError& error) {
    return error.what();
  }
  return "";
}

TEST(MapParams, AreReadFromTheSectionsOfOneMap) {
  MapParams params;
  load_map_params(config_of("[map]\nterrainMap_count = 1\nanything = 1\n"
                            "[map_terrainMap_00_creationOpts]\nlength = 20\nwidth = 12\n"
                            "cell_size = 0.25\noctree_resolution = 0.15\n"
                            "enableObservationLikelihood = false\n"
                            "[map_terrainMap_00_insertOpts]\nmin_range = 0.9\n"
                            "octree_max_range = 15\n"
                            "[map_terrainMap_00_likelihoodOpts]\ndecimation = 3\n"
                            "[map_terrainMap_00_renderOpts]\ncolouring = cost\noctree = true\n"
                            "[map_terrainMap_00_ground]\nt_diff = 0.2\n"
                            "[map_terrainMap_00_robot]\nmax_step = 0.3\n"
                            "[map_terrainMap_01_creationOpts]\nlength = 99\n"
                            "[map_pointsMap_00_insertOpts]\nnonsense = 1\n"),
                  "map_terrainMap_00", params);
  EXPECT_EQ(params.description.grid.length, 20.0);
  EXPECT_EQ(params.description.grid.width, 12.0);
  EXPECT_EQ(params.description.grid.cell_size, 0.25);
  EXPECT_EQ(params.creation.octree_resolution, 0.15);
  EXPECT_EQ(params.input.min_range, 0.9);
  EXPECT_EQ(params.octree.max_range, 15.0);
  EXPECT_EQ(params.likelihood.decimation, 3);
  EXPECT_EQ(params.render.colouring, CellColouring::kCost);
  EXPECT_TRUE(params.render.octree);
  EXPECT_EQ(params.description.ground.t_diff, 0.2);
  EXPECT_EQ(params.robot.max_step, 0.3);
}

TEST(MapParams, InsertionOptsAndOtherCaseMeanTheSame) {
  MapParams params;
  load_map_params(config_of("[MAP_TERRAINMAP_00_InsertionOpts]\nMin_Range = 0.7\n"),
                  "map_terrainMap_00", params);
  EXPECT_EQ(params.input.min_range, 0.7);
}

TEST(MapParams, WhatIsWrongIsNamed) {
  EXPECT_EQ(refusal_of("[map_terrainMap_00_creationOpts]\nlenght = 20\n"),
            "map definition: [map_terrainMap_00_creationOpts] lenght = 20: unknown key; did you "
            "mean `length`?");
  EXPECT_NE(refusal_of("[map_terrainMap_00_insertOps]\nmin_range = 1\n").find("insertOpts"),
            std::string::npos);
  EXPECT_NE(refusal_of("[map_terrainMap_00_creationOpts]\ncell_size = -1\n").find("[0.01, 10] m"),
            std::string::npos);
  EXPECT_NE(refusal_of("[map_terrainMap_00_creationOpts]\nfusion = both\n").find("scan"),
            std::string::npos);
  EXPECT_NE(refusal_of("[map_terrainMap_00_insertOpts]\nmin_range = 9\nmax_range = 8\n")
                .find("min_range: must be less than max_range"),
            std::string::npos);
}

TEST(MapParams, OneCountMakesOneMap) {
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(config_of("[map]\nterrainMap_count = 1\npointsMap_count = 1\n"
                                           "[map_terrainMap_00_creationOpts]\nlength = 20\n"),
                                 "map");
  EXPECT_EQ(definitions.size(), 2U);
  mrpt::maps::CMultiMetricMap maps(definitions);
  EXPECT_EQ(maps.countMapsByClass<CTerrainMap>(), 1U);
  EXPECT_EQ(maps.countMapsByClass<mrpt::maps::CSimplePointsMap>(), 1U);
  EXPECT_EQ(maps.mapByClass<CTerrainMap>()->params().description.grid.length, 20.0);
}

TEST(MapParams, GenericOptionsReachTheMap) {
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(config_of("[map]\nmrpt_terrain::CTerrainMap_count = 1\n"
                                           "[map_mrpt_terrain::CTerrainMap_00_creationOpts]\n"
                                           "enableObservationInsertion = false\n"),
                                 "map");
  mrpt::maps::CMultiMetricMap maps(definitions);
  ASSERT_EQ(maps.countMapsByClass<CTerrainMap>(), 1U);
  EXPECT_FALSE(maps.mapByClass<CTerrainMap>()->genericMapParams.enableObservationInsertion);
}

TEST(MapParams, TheShippedFileIsRead) {
  const mrpt::config::CConfigFile file(MRPT_TERRAIN_SOURCE_DIR "/params/mrpt/terrain_map.ini");
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(file, "map");
  mrpt::maps::CMultiMetricMap maps(definitions);
  ASSERT_EQ(maps.countMapsByClass<CTerrainMap>(), 1U);
  EXPECT_EQ(maps.mapByClass<CTerrainMap>()->params().description.grid.length, 60.0);
}

// The ready file for field mode says the same as that of terrain-rawlog process, which has reasons.
TEST(MapParams, TheReadyFileForFieldModeIsThatOfProcess) {
  const mrpt::config::CConfigFile file(MRPT_TERRAIN_SOURCE_DIR
                                       "/params/mrpt/terrain_map_field.ini");
  MapParams map;
  load_map_params(file, "map_terrainMap_00", map);
  EXPECT_EQ(map.creation.fusion, Fusion::kRolling);
  DescriptionParams process;
  params::load_ini(MRPT_TERRAIN_SOURCE_DIR "/params/field.ini", process);
  EXPECT_EQ(map.description.grid.cell_size, process.grid.cell_size);
  EXPECT_EQ(map.description.grid.max_height, process.grid.max_height);
  process.grid = map.description.grid;  // a map of 60 m is enough
  process.ground = map.description.ground;
  process.clusters = map.description.clusters;  // of no effect in field mode
  EXPECT_EQ(params::ini_text(params::sections_of(map.description)),
            params::ini_text(params::sections_of(process)));
}

}  // namespace
}  // namespace mrpt_terrain
