// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/yaml.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "example_params.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

using mrpt::containers::yaml;
using test_params::Colour;
using test_params::Drawing;
using test_params::Shape;

Drawing load_text(const std::string& text) {
  Drawing drawing;
  load_yaml(write_file("x.yaml", text), drawing);
  return drawing;
}

std::string refusal_of(const std::string& text) {
  const std::string file = write_file("x.yaml", text);
  std::string message = message_of<ParameterError>([&] {
    Drawing drawing;
    load_yaml(file, drawing);
  });
  for (auto at = message.find(file); at != std::string::npos; at = message.find(file)) {
    message.replace(at, file.size(), "x.yaml");
  }
  return message;
}

TEST(YamlTest, LoadsAFileAndKeepsDefaultsOfMissingKeys) {
  const Drawing drawing = load_text(
      "%YAML 1.2\n---\n# a drawing\nshape:  # this\n  size: 2   # metres\n  angle_deg: 45\n"
      "  filled: no\n\n  colour: 'dark_green'\npaper:\n  weight: 1.5e2\n");
  EXPECT_EQ(drawing.shape.size, 2.0);
  EXPECT_EQ(drawing.shape.angle, Shape().angle);
  EXPECT_FALSE(drawing.shape.filled);
  EXPECT_EQ(drawing.shape.colour, Colour::kDarkGreen);
  EXPECT_EQ(drawing.shape.count, 3);
  EXPECT_EQ(drawing.paper.weight, 150.0);
}

TEST(YamlTest, EmptyFileKeepsAllDefaults) {
  EXPECT_EQ(dump_ini(load_text("")), dump_ini(Drawing()));
  EXPECT_EQ(dump_ini(load_text("# nothing\n")), dump_ini(Drawing()));
}

TEST(YamlTest, TableOfRefusedFiles) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"shape:\n  size: -3\n",
       "x.yaml: [shape] size = -3: must be within [0.25, 10] m (edge of the shape)"},
      {"shape:\n  sice: 1\n", "x.yaml: [shape] sice = 1: unknown key; did you mean `size`?"},
      {"shpe:\n  size: 1\n", "x.yaml: [shpe]: unknown section; did you mean [shape]?"},
      {"shape:\n  size: ~\n",
       "x.yaml: [shape] size = ~: is not a number; must be within [0.25, 10] m (edge of the "
       "shape)"},
      {"shape:\n  size:\n", "x.yaml:2: [shape] size = : has no value"},
      {"shape:\npaper:\n  weight: 80\n", "x.yaml: [shape]: has no keys; leave the section out"},
      {"shape:\n", "x.yaml: [shape]: has no keys; leave the section out"},
      {"shape:\n  count: 1.0\n",
       "x.yaml: [shape] count = 1.0: is not a whole number; must be within [1, 100] (number of "
       "shapes)"},
      {"shape:\n  size: .inf\n",
       "x.yaml: [shape] size = .inf: is not a number; must be within [0.25, 10] m (edge of the "
       "shape)"},
      {"shape:\n  size: 1\n  Size: 2\n",
       "x.yaml:3: [shape] Size = 2: is given twice, first in line 2"},
      {"shape:\n  size: 1\nshape:\n  count: 2\n",
       "x.yaml:3: [shape]: is given twice, first in line 1"},
      {"size: 1\n",
       "x.yaml:1: stands outside of any section; write `section:` and below it `  size: 1`"},
      {"  size: 1\n", "x.yaml:1: [] size = 1: stands outside of any section"},
      {"shape: {size: 1\n",
       "x.yaml:1: stands outside of any section; write `section:` and below it `  shape: {size: "
       "1`"},
      {"shape:\n  size: [1, 2]\n", "x.yaml:2: [shape] size = [1, 2]: must be a single value"},
      {"shape:\n  size 1\n", "x.yaml:2: is neither `section:` nor `key: value`"},
      {"shape:\n\tsize: 1\n", "x.yaml:2: a tab cannot indent YAML"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(refusal_of(text), message) << text;
}

TEST(YamlTest, StructIsUnchangedAfterARefusal) {
  const std::string file = write_file("x.yaml", "shape:\n  size: 2\n  count: 0\n");
  Drawing drawing;
  EXPECT_THROW(load_yaml(file, drawing), ParameterError);
  EXPECT_EQ(dump_ini(drawing), dump_ini(Drawing()));
}

TEST(YamlTest, LoadsATreeInMemoryWithoutRoundingItsNumbers) {
  yaml root;
  root["shape"]["size"] = 1.0 / 3.0;
  root["shape"]["count"] = 7;
  root["shape"]["filled"] = false;
  root["shape"]["colour"] = "dark_green";
  Drawing drawing;
  load_yaml(root, "tree", drawing);
  EXPECT_EQ(drawing.shape.size, 1.0 / 3.0);
  EXPECT_EQ(drawing.shape.count, 7);
  EXPECT_FALSE(drawing.shape.filled);
  EXPECT_EQ(drawing.shape.colour, Colour::kDarkGreen);
}

TEST(YamlTest, TreesOfOtherShapeAreRefused) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[1, 2]", "tree: must be a map of sections"},
      {"shape: 3", "tree: [shape]: must be a map of keys and values"},
      {"shape: [1]", "tree: [shape]: must be a map of keys and values"},
      {"{shape: {size: [1]}}", "tree: [shape] size: must be a single value, not a sequence"},
  };
  for (const auto& [text, message] : cases) {
    const yaml root = yaml::FromText(text);
    Drawing drawing;
    EXPECT_EQ(message_of<ParameterError>([&] { load_yaml(root, "tree", drawing); }), message);
  }
}

TEST(YamlTest, LoadsOneMapAsASection) {
  const yaml keys = yaml::FromText("{size: 2, count: 4}");
  Shape shape;
  load_yaml_section(keys, "scene.yaml", "rocks", shape);
  EXPECT_EQ(shape.size, 2.0);
  EXPECT_EQ(shape.count, 4);
  const yaml wrong = yaml::FromText("{size: 20}");
  EXPECT_EQ(
      message_of<ParameterError>([&] { load_yaml_section(wrong, "scene.yaml", "rocks", shape); }),
      "scene.yaml: [rocks] size = 20: must be within [0.25, 10] m (edge of the shape)");
}

TEST(YamlTest, OracleYamlAndIniGiveTheSameStruct) {
  const Drawing from_yaml =
      load_text("shape:\n  size: 0.3\n  angle_deg: 12.3\n  seed: 99\npaper:\n  weight: 77.7\n");
  Drawing from_ini;
  load_ini(write_file("x.ini", "[shape]\nsize=0.3\nangle_deg=12.3\nseed=99\n[paper]\nweight=77.7"),
           from_ini);
  EXPECT_EQ(dump_ini(from_yaml), dump_ini(from_ini));
  EXPECT_NE(dump_ini(from_yaml), dump_ini(Drawing()));
}

}  // namespace
}  // namespace mrpt_terrain::params
