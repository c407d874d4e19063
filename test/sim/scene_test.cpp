// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/scene.h"

#include <gtest/gtest.h>

namespace mrpt_terrain::sim {
namespace {

TEST(Scene, ShapesHaveTheirUsualClass) {
  EXPECT_EQ(usual_class(Ramp{}), TerrainClass::kSlope);
  EXPECT_EQ(usual_class(Pothole{}), TerrainClass::kPothole);
  EXPECT_EQ(usual_class(Ditch{}), TerrainClass::kPothole);
  EXPECT_EQ(usual_class(Grass{}), TerrainClass::kOther);
  EXPECT_EQ(usual_class(Wall{}), TerrainClass::kObstacle);
}

TEST(Scene, TypesAreNamedAsInFiles) {
  EXPECT_STREQ(type_of(Box{}), "box");
  EXPECT_STREQ(type_of(Person{}), "person");
}

}  // namespace
}  // namespace mrpt_terrain::sim
