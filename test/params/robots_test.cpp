// SPDX-License-Identifier: BSD-3-Clause
// The robot files of params/robots/, and what is refused in such a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

const std::string kFolder = MRPT_TERRAIN_SOURCE_DIR "/params/robots/";

std::vector<std::string> robot_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A robot whose every value is the default times `factor`.
RobotParams scaled(double factor) {
  RobotParams robot;
  RobotParams::visit_params(robot, [&](double& value, const ParamInfo&) { value *= factor; });
  return robot;
}

RobotParams load(const std::string& file) {
  RobotParams robot;
  load_ini(file, robot);
  return robot;
}

TEST(RobotsTest, ThereAreThreeRobots) {
  EXPECT_EQ(robot_files(), (std::vector<std::string>{kFolder + "car.ini", kFolder + "husky.ini",
                                                     kFolder + "small_rover.ini"}));
}

TEST(RobotsTest, EveryFileGivesEveryParameter) {
  for (const std::string& file : robot_files()) {
    RobotParams a = scaled(1.0);
    RobotParams b = scaled(1.25);
    load_ini(file, a);
    load_ini(file, b);
    EXPECT_EQ(dump_ini(a), dump_ini(b)) << "a key is missing in " << file;
  }
}

TEST(RobotsTest, SmallRoverIsTheDefault) {
  EXPECT_EQ(dump_ini(load(kFolder + "small_rover.ini")), dump_ini(RobotParams()));
}

TEST(RobotsTest, RobotsArePossible) {
  for (const std::string& file : robot_files()) {
    const RobotParams robot = load(file);
    EXPECT_GT(robot.footprint_length, robot.footprint_width) << file;
    EXPECT_GT(robot.height, robot.ground_clearance) << file;
    EXPECT_LT(2.0 * robot.wheel_radius, robot.footprint_length) << file;
    EXPECT_LE(robot.max_step, robot.wheel_radius) << file;
    EXPECT_LE(robot.max_step, robot.ground_clearance) << file;
    EXPECT_LE(robot.max_roughness, robot.max_step) << file;
    EXPECT_LE(robot.max_tilt, robot.max_climb) << file;
  }
}

TEST(RobotsTest, DegreesOfTheFileAreRadiansInMemory) {
  EXPECT_NEAR(load(kFolder + "husky.ini").max_climb, 25.0 * 3.14159265358979 / 180.0, 1e-12);
  EXPECT_NEAR(load(kFolder + "husky.ini").max_tilt, 20.0 * 3.14159265358979 / 180.0, 1e-12);
}

TEST(RobotsTest, TableOfRefusedFiles) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[robot]\nmax_stepp = 0.1\n",
       "[robot] max_stepp = 0.1: unknown key; did you mean "
       "`max_step`?"},
      {"[robt]\nmax_step = 0.1\n", "[robt]: unknown section; did you mean [robot]?"},
      {"[robot]\nmax_step = -1\n",
       "[robot] max_step = -1: must be within [0.001, 5] m (height of a step, up or down, from "
       "which a cell is lethal)"},
      {"[robot]\nmax_climb_deg = 90\n",
       "[robot] max_climb_deg = 90: must be within [1, 80] deg (slope along the heading from which "
       "a cell is lethal)"},
      {"[robot]\nmax_climb = 0.3\n",
       "[robot] max_climb = 0.3: unknown key; did you mean `max_climb_deg`?"},
  };
  for (const auto& [text, message] : cases) {
    const std::string file = write_file("robot.ini", text);
    RobotParams robot;
    EXPECT_EQ(message_of<ParameterError>([&] { load_ini(file, robot); }), file + ": " + message);
    EXPECT_EQ(dump_ini(robot), dump_ini(RobotParams()));
  }
}

}  // namespace
}  // namespace mrpt_terrain::params
