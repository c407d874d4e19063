// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "example_params.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

using test_params::Colour;
using test_params::Drawing;
using test_params::Shape;
using test_params::Studio;

/// Assigns one field by its key; "" if it worked.
std::string assign_key(Shape& shape, const std::string& key, const std::string& text) {
  for (const Field& field : fields_of(shape)) {
    if (key == field.info.key) return assign(field, text).value_or("");
  }
  return "no such key";
}

TEST(FieldsTest, AssignReadsEveryType) {
  Shape shape;
  EXPECT_EQ(assign_key(shape, "size", "2.5"), "");
  EXPECT_EQ(assign_key(shape, "angle_deg", "-90"), "");
  EXPECT_EQ(assign_key(shape, "count", "100"), "");
  EXPECT_EQ(assign_key(shape, "seed", "8999999999999999"), "");
  EXPECT_EQ(assign_key(shape, "filled", "no"), "");
  EXPECT_EQ(assign_key(shape, "colour", "dark_green"), "");
  EXPECT_EQ(shape.size, 2.5);
  EXPECT_EQ(shape.angle, -std::acos(0.0));
  EXPECT_EQ(shape.count, 100);
  EXPECT_EQ(shape.seed, 8999999999999999U);
  EXPECT_FALSE(shape.filled);
  EXPECT_EQ(shape.colour, Colour::kDarkGreen);
}

TEST(FieldsTest, AssignReadsTheWordsOfBool) {
  for (const char* word : {"true", "yes", "on", "1", "True", "YES"}) {
    Shape shape;
    shape.filled = false;
    EXPECT_EQ(assign_key(shape, "filled", word), "") << word;
    EXPECT_TRUE(shape.filled) << word;
  }
  for (const char* word : {"false", "no", "off", "0", "Off"}) {
    Shape shape;
    EXPECT_EQ(assign_key(shape, "filled", word), "") << word;
    EXPECT_FALSE(shape.filled) << word;
  }
}

TEST(FieldsTest, TableOfRefusedTexts) {
  const std::string size = "must be within [0.25, 10] m (edge of the shape)";
  const std::string angle = "must be within [-90, 90] deg (tilt of the shape)";
  const std::string count = "must be within [1, 100] (number of shapes)";
  const std::string seed = "must be within [0, 9e+15] (seed of the random numbers)";
  const std::string colour = "must be one of red, dark_green (colour of the shape)";
  const std::string filled = "must be true or false (whether the shape is filled)";
  const std::vector<std::array<std::string, 3>> cases = {
      {"size", "0.2499999", size},
      {"size", "10.000001", size},
      {"size", "-1", size},
      {"size", "1e999", size},
      {"size", "abc", "is not a number; " + size},
      {"size", "0.5x", "is not a number; " + size},
      {"size", "nan", "is not a finite number; " + size},
      {"size", "inf", "is not a finite number; " + size},
      {"size", "", "has no value (edge of the shape)"},
      {"angle_deg", "90.001", angle},
      {"angle_deg", "45 deg", "is not a number; " + angle},
      {"count", "0", count},
      {"count", "101", count},
      {"count", "1.5", "is not a whole number; " + count},
      {"count", "1e1", "is not a whole number; " + count},
      {"count", "99999999999", count},
      {"seed", "-1", seed},
      {"seed", "9000000000000001", seed},
      {"seed", "99999999999999999999", seed},
      {"filled", "2", filled},
      {"filled", "maybe", filled},
      {"colour", "green", colour},
      {"colour", "Red", colour},
      {"colour", "0", colour},
  };
  for (const auto& [key, text, problem] : cases) {
    Shape shape;
    EXPECT_EQ(assign_key(shape, key, text), problem) << key << " = " << text;
    EXPECT_EQ(shape.size, 0.5);
    EXPECT_EQ(shape.angle, Shape().angle);
    EXPECT_EQ(shape.count, 3);
    EXPECT_EQ(shape.seed, 1U);
    EXPECT_TRUE(shape.filled);
    EXPECT_EQ(shape.colour, Colour::kRed);
  }
}

TEST(FieldsTest, BoundsThemselvesArePermitted) {
  for (const char* text : {"0.25", "10"}) {
    Shape shape;
    EXPECT_EQ(assign_key(shape, "size", text), "") << text;
    EXPECT_NO_THROW(check_fields("x", {Section{"shape", "", fields_of(shape)}}));
  }
  for (const char* text : {"-90", "90"}) {
    Shape shape;
    EXPECT_EQ(assign_key(shape, "angle_deg", text), "") << text;
    EXPECT_NO_THROW(check_fields("x", {Section{"shape", "", fields_of(shape)}}));
  }
}

TEST(FieldsTest, TextOfEveryType) {
  Shape shape;
  std::vector<std::string> texts;
  for (const Field& field : fields_of(shape)) texts.push_back(text_of(field));
  EXPECT_EQ(texts, (std::vector<std::string>{"0.5", "45", "3", "1", "true", "red"}));
}

TEST(FieldsTest, SectionsOfNestedStructsComeInOrder) {
  Studio studio;
  std::vector<std::string> names;
  for (const Section& section : sections_of(studio)) names.push_back(section.name);
  EXPECT_EQ(names, (std::vector<std::string>{"shape", "paper", "wall"}));
}

TEST(FieldsTest, CheckAcceptsDefaults) {
  EXPECT_NO_THROW(check(Drawing{}));
  EXPECT_NO_THROW(check(DescriptionParams{}));
}

TEST(FieldsTest, CheckNamesEveryBadValueInMemory) {
  Drawing drawing;
  drawing.shape.size = std::numeric_limits<double>::quiet_NaN();
  drawing.shape.angle = 2.0;
  drawing.shape.colour = static_cast<Colour>(7);
  drawing.paper.weight = 0.0;
  const std::string message = message_of<ParameterError>([&] { check(drawing); });
  EXPECT_EQ(message,
            "parameters: [shape] size = nan: must be within [0.25, 10] m (edge of the shape)\n"
            "parameters: [shape] angle_deg = 114.59155902616464: must be within [-90, 90] deg "
            "(tilt of the shape)\n"
            "parameters: [shape] colour = ?: must be one of red, dark_green (colour of the shape)\n"
            "parameters: [paper] weight = 0: must be within [1, 1000] g/m^2 (weight of the paper)");
}

TEST(FieldsTest, DescriptionParamsHaveKeysThatDifferByMoreThanCase) {
  DescriptionParams params;
  for (const Section& section : sections_of(params)) {
    std::vector<std::string> keys;
    for (const Field& field : section.fields) {
      std::string key = field.info.key;
      for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      EXPECT_EQ(std::count(keys.begin(), keys.end(), key), 0) << section.name << " " << key;
      const bool in_degrees = std::string(field.info.unit) == "deg";
      const bool says_degrees = key.size() > 4 && key.substr(key.size() - 4) == "_deg";
      EXPECT_EQ(in_degrees, says_degrees) << section.name << " " << key;
      keys.push_back(key);
    }
    EXPECT_FALSE(keys.empty()) << section.name;
  }
}

}  // namespace
}  // namespace mrpt_terrain::params
