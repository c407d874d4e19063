// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mrpt_terrain/sim/ground_surface.h"
#include "mrpt_terrain/sim/world.h"

namespace mrpt_terrain::sim {
namespace {

namespace fs = std::filesystem;

std::string folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const fs::path path = fs::temp_directory_path() / ("mrpt_terrain_" + name);
  fs::create_directories(path);
  return path.string();
}

std::string written(const std::string& text, const std::string& name = "scene.yaml") {
  const std::string file = folder() + "/" + name;
  std::ofstream(file) << text;
  return file;
}

std::string complaint_about_file(const std::string& file) {
  try {
    (void)load_scene(file);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no complaint";
}
std::string complaint(const std::string& text) { return complaint_about_file(written(text)); }

TEST(SceneFile, EverythingIsRead) {
  const SceneFile file = load_scene(
      written("name: yard\n"
              "ground: {form: fractal, length: 30, slope_deg: 5, material: soil}\n"
              "solids:\n"
              "  - {type: ramp, id: 7, x: 2, y: -1, yaw_deg: 90, angle_deg: 10, way_down: true}\n"
              "  - {type: pothole, form: ellipse, depth: 0.2, class: other}\n"
              "sensor: vlp16\n"
              "vehicle: {sensor_z: 1.2, sensor_pitch_deg: 3}\n"
              "path: {speed: 2, waypoints: [[0, 0], [3.5, -1]]}\n"));
  EXPECT_EQ(file.scene.name, "yard");
  EXPECT_EQ(file.scene.ground.form, GroundForm::kFractal);
  EXPECT_EQ(file.scene.ground.length, 30.0);
  EXPECT_EQ(file.scene.ground.material, Material::kSoil);
  EXPECT_NEAR(file.scene.ground.slope, 0.0872664626, 1e-9);
  ASSERT_EQ(file.scene.solids.size(), 2U);
  const Ramp& ramp = std::get<Ramp>(file.scene.solids[0].shape);
  EXPECT_NEAR(ramp.angle, 0.1745329252, 1e-9);
  EXPECT_TRUE(ramp.way_down);
  EXPECT_EQ(file.scene.solids[0].placement.id, 7);
  EXPECT_NEAR(file.scene.solids[0].placement.yaw, 1.5707963268, 1e-9);
  EXPECT_EQ(std::get<Pothole>(file.scene.solids[1].shape).form, RimForm::kEllipse);
  EXPECT_EQ(file.scene.solids[1].placement.terrain_class, TerrainClass::kOther);
  EXPECT_EQ(file.sensor, "vlp16");
  EXPECT_EQ(file.vehicle.sensor_z, 1.2);
  ASSERT_EQ(file.path.waypoints.size(), 2U);
  EXPECT_EQ(file.path.waypoints[1], Eigen::Vector2d(3.5, -1.0));
  EXPECT_EQ(file.path.speed, 2.0);
}

TEST(SceneFile, SolidsWithoutNumberGetFreeOnes) {
  const SceneFile file =
      load_scene(written("solids: [{type: box}, {type: box, id: 1}, {type: wall}]\n"));
  EXPECT_EQ(file.scene.solids[0].placement.id, 2);
  EXPECT_EQ(file.scene.solids[1].placement.id, 1);
  EXPECT_EQ(file.scene.solids[2].placement.id, 3);
}

TEST(SceneFile, HeightMapsAreFoundBesideTheScene) {
  written("0 0 0\n0 1 0\n0 0 0\n", "hill.txt");
  const SceneFile file =
      load_scene(written("ground: {form: height_map, length: 4, width: 4, file: hill.txt}\n"));
  const GroundSurface ground(file.scene.ground);
  EXPECT_NEAR(ground.height(0.0, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(ground.height(1.0, 0.0), 0.5, 1e-12);
  EXPECT_NEAR(ground.height(-2.0, 2.0), 0.0, 1e-12);
}

struct Mistake {
  const char* name;
  const char* text;
  const char* complaint;
};
class SceneMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, IsRefusedWithFileLineAndRule) {
  const std::string message = complaint(GetParam().text);
  EXPECT_NE(message.find("scene.yaml"), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().complaint), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    SceneFile, SceneMistake,
    ::testing::Values(
        Mistake{"UnknownSolid", "solids:\n  - {type: bock}\n",
                ":2: solids[0] type = bock: must be one of ramp, box"},
        Mistake{"NoType", "solids:\n  - {x: 1}\n",
                ":2: solids[0]: must be a map with the key type"},
        Mistake{"NegativeSize", "solids:\n  - {type: box, height: -3}\n",
                ":2: [solids[0] box] height = -3: must be within [0.005, 100] m"},
        Mistake{"MisspeltKey", "ground: {lenght: 10}\n", "did you mean `length`?"},
        Mistake{"NoNumber", "solids: [{type: box, x: left}]\n", "x = left"},
        Mistake{"KeyTwice", "solids:\n  - {type: box, x: 1, x: 2}\n", ":2: x: given twice"},
        Mistake{"SectionTwice", "ground: {x: 1}\nground: {x: 2}\n", ":2: ground: given twice"},
        Mistake{"SyntaxError", "solids:\n  - {type: box\n  - x\n", "scene.yaml:4: end of map"},
        Mistake{"Empty", "# nothing\n", "is empty"}, Mistake{"NoMap", "- 1\n", "must be a map"},
        Mistake{"UnknownSection", "vehikle: {}\n", "vehikle: unknown key; known are name, ground"},
        Mistake{"SolidsNoList", "solids: {type: box}\n", "solids: must be a list"},
        Mistake{"ListForANumber", "vehicle: {track: [1]}\n", "track: must be a single value"},
        Mistake{"HalfAWaypoint", "path:\n  waypoints: [[0, 0], [1]]\n",
                ":2: [path] waypoints: every one must be two numbers"},
        Mistake{"SpeedOutOfRange", "path: {speed: 0}\n", "speed = 0: must be within"},
        Mistake{"IdTwice", "solids: [{type: box, id: 3}, {type: wall, id: 3}]\n",
                "id = 3: must be unique"},
        Mistake{"NoHeightMap", "ground: {form: height_map, file: none.txt}\n",
                "file = none.txt: there is no such file"},
        Mistake{"HeightMapWithoutFile", "ground: {form: height_map}\n", "needs file"},
        Mistake{"FileWithoutHeightMap", "ground: {file: scene.yaml}\n", "needs form: height_map"}),
    [](const auto& test) { return test.param.name; });

TEST(SceneFile, AllMistakesAreNamedAtOnceOneALine) {
  const std::string message =
      complaint("ground: {lenght: 10}\nsolids:\n  - {type: bock}\n  - {type: box, width: -1}\n");
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 2) << message;
}

TEST(SceneFile, MissingFilesAndFoldersAreRefused) {
  EXPECT_NE(complaint_about_file("none.yaml").find("none.yaml: does not exist"), std::string::npos);
  EXPECT_NE(complaint_about_file(folder()).find("is not a file"), std::string::npos);
}

TEST(SceneFile, ShippedScenesLoadAndCanBeBuilt) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(MRPT_TERRAIN_SOURCE_DIR "/params/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenes;
    const SceneFile file = load_scene(entry.path().string());
    EXPECT_FALSE(file.scene.name.empty()) << entry.path();
    EXPECT_FALSE(file.sensor.empty()) << entry.path();
    const World world = build_world(file.scene);
    EXPECT_EQ(world.solids.size(), file.scene.solids.size() + 1) << entry.path();
  }
  EXPECT_GE(scenes, 14);
}

}  // namespace
}  // namespace mrpt_terrain::sim
