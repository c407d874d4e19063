// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/scene.h"

#include <gtest/gtest.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText3D.h>

#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "description_builder.h"
#include "mrpt_terrain/view/palette.h"
#include "test_files.h"

namespace mrpt_terrain::view {
namespace {

using mrpt::opengl::CBox;
using mrpt::opengl::COpenGLScene;
using mrpt::opengl::CPointCloudColoured;
using mrpt::opengl::CSetOfObjects;
using mrpt::opengl::CSetOfTriangles;
using mrpt::opengl::CText3D;

/// Two ground cells, a slope of 12 cells and a pothole of one.
struct World {
  World() {
    test::DescriptionBuilder builder(10.0, 10.0, 0.5);
    builder.ground({0, 0}, 0.0F).ground({0, 1}, 0.0F);
    builder.cluster(TerrainClass::kPothole, {15, 2}, {15, 2}, -0.4F, -0.2F);
    builder.cluster(TerrainClass::kSlope, {10, 10}, {12, 13}, 0.1F, 0.6F);
    description = builder.build();
    points = builder.points;
  }
  Description description;
  Points points;
};

/// What is left of a scene after writing and reading it.
COpenGLScene reloaded(const World& world, const SceneOptions& options) {
  const std::string folder = test::empty_test_folder();
  write_scene(folder + "a.3Dscene", world.description, world.points.view(), options);
  EXPECT_FALSE(std::filesystem::exists(folder + "a.3Dscene.part"));
  COpenGLScene scene;
  EXPECT_TRUE(scene.loadFromFile(folder + "a.3Dscene"));
  return scene;
}

CSetOfObjects::Ptr clusters_of(COpenGLScene& scene) {
  return std::dynamic_pointer_cast<CSetOfObjects>(scene.getByName("clusters"));
}

TEST(Scene, HoldsPointsCellsBoxesNumbersGridAndRobot) {
  auto scene = reloaded(World(), {});
  const auto cloud = scene.getByClass<CPointCloudColoured>();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size(), 15U);
  const auto cells = scene.getByClass<CSetOfTriangles>();
  ASSERT_TRUE(cells);
  EXPECT_EQ(cells->getTrianglesCount(), 2U * 15U);
  ASSERT_TRUE(clusters_of(scene));
  EXPECT_EQ(clusters_of(scene)->size(), 4U);
  EXPECT_TRUE(scene.getByName("grid"));
  EXPECT_TRUE(scene.getByName("robot"));
}

TEST(Scene, PointsHaveTheColourOfTheirClass) {
  const World world;
  auto scene = reloaded(world, {});
  const auto cloud = scene.getByClass<CPointCloudColoured>();
  ASSERT_TRUE(cloud);
  for (std::size_t k = 0; k < cloud->size(); ++k) {
    const auto actual = cloud->getPointColor(k);
    const Rgb expected =
        colour_of(world.description.labels.terrain_class[k], world.description.labels.support[k]);
    EXPECT_EQ((Rgb{actual.R, actual.G, actual.B}), expected) << k;
    EXPECT_EQ(cloud->getPoint3Df(k).x, world.points.x[k]);
  }
}

TEST(Scene, BoxesAreTheClustersBounds) {
  auto scene = reloaded(World(), {});
  const auto box = clusters_of(scene)->getByClass<CBox>(0);  // the slope is the larger one
  ASSERT_TRUE(box);
  mrpt::math::TPoint3D low;
  mrpt::math::TPoint3D high;
  box->getBoxCorners(low, high);
  EXPECT_NEAR(low.x, 0.0, 1e-6);
  EXPECT_NEAR(low.y, 0.0, 1e-6);
  EXPECT_NEAR(low.z, 0.1, 1e-6);
  EXPECT_NEAR(high.x, 1.5, 1e-6);
  EXPECT_NEAR(high.y, 2.0, 1e-6);
  EXPECT_NEAR(high.z, 0.6, 1e-6);
  EXPECT_TRUE(box->isWireframe());
  const auto label = clusters_of(scene)->getByClass<CText3D>(0);
  ASSERT_TRUE(label);
  EXPECT_EQ(label->getString(), "1");
  EXPECT_GT(label->getPoseZ(), 0.6);
}

TEST(Scene, TheSurfaceLiesOnTheCells) {
  auto scene = reloaded(World(), {});
  const auto cells = scene.getByClass<CSetOfTriangles>();
  ASSERT_TRUE(cells);
  mrpt::opengl::TTriangle triangle;
  cells->getTriangle(0, triangle);  // of cell (0, 0), mean height 0
  for (std::size_t corner = 0; corner < 3; ++corner) {
    EXPECT_GE(triangle.x(corner), -5.0F);
    EXPECT_LE(triangle.x(corner), -4.5F);
    EXPECT_LE(triangle.y(corner), -4.5F);
    EXPECT_NEAR(triangle.z(corner), -0.02F, 1e-6F);
  }
}

TEST(Scene, OnlyStockClassesSoThatEveryViewerOpensIt) {
  auto scene = reloaded(World(), {});
  scene.visitAllObjects([](const mrpt::opengl::CRenderizable::Ptr& object) {
    EXPECT_EQ(std::string(object->GetRuntimeClass()->className).rfind("mrpt::opengl::", 0), 0U)
        << object->GetRuntimeClass()->className;
  });
}

TEST(Scene, OptionsLimitWhatIsDrawn) {
  SceneOptions options;
  options.cells = false;
  options.max_boxes = 1;
  options.max_labels = 0;
  auto scene = reloaded(World(), options);
  EXPECT_FALSE(scene.getByName("cells"));
  EXPECT_EQ(clusters_of(scene)->size(), 1U);
}

TEST(Scene, PointsThatAreNotFiniteAreLeftOut) {
  World world;
  world.points.z[3] = std::numeric_limits<float>::quiet_NaN();
  world.points.x[4] = std::numeric_limits<float>::infinity();
  auto scene = reloaded(world, {});
  EXPECT_EQ(scene.getByClass<CPointCloudColoured>()->size(), 13U);
}

TEST(Scene, AnEmptyDescriptionIsASceneToo) {
  World world;
  test::DescriptionBuilder builder(10.0, 10.0, 0.5);
  world.description = builder.build();
  world.points.clear();
  auto scene = reloaded(world, {});
  EXPECT_TRUE(scene.getByName("robot"));
}

TEST(Scene, AnUnwritablePlaceIsNamedWithItsReason) {
  const World world;
  const std::string file = test::empty_test_folder() + "missing/a.3Dscene";
  try {
    write_scene(file, world.description, world.points.view());
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file + ": cannot be written: No such file or directory");
  }
}

}  // namespace
}  // namespace mrpt_terrain::view
