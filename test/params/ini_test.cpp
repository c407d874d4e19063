// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/ini.h"

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/config/CConfigFilePrefixer.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "example_params.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

using mrpt::config::CConfigFileMemory;
using test_params::Colour;
using test_params::Drawing;
using test_params::Shape;
using test_params::Studio;

Drawing load_text(const std::string& text) {
  Drawing drawing;
  load_ini(write_file("x.ini", text), drawing);
  return drawing;
}

/// What a file is refused with, the folder of the file left out.
std::string refusal_of(const std::string& text) {
  const std::string file = write_file("x.ini", text);
  std::string message = message_of<ParameterError>([&] {
    Drawing drawing;
    load_ini(file, drawing);
  });
  for (auto at = message.find(file); at != std::string::npos; at = message.find(file)) {
    message.replace(at, file.size(), "x.ini");
  }
  return message;
}

/// Every double of a struct as its bits, so that a comparison sees what `==` does not.
template <class Params>
std::vector<std::uint64_t> bits_of(const Params& params) {
  Params copy = params;
  std::vector<std::uint64_t> bits;
  for (const Section& section : sections_of(copy)) {
    for (const Field& field : section.fields) {
      if (const auto* value = std::get_if<double*>(&field.value)) {
        bits.emplace_back();
        std::memcpy(&bits.back(), *value, sizeof(double));
      }
    }
  }
  return bits;
}

/// Moves every number to another permitted value, every choice to another one.
template <class Params>
Params scrambled(const Params& params, double share) {
  Params result = params;
  for (const Section& section : sections_of(result)) {
    for (const Field& field : section.fields) {
      const double inside = field.info.min + share * (field.info.max - field.info.min);
      if (const auto* value = std::get_if<double*>(&field.value)) {
        const bool degrees = std::string(field.info.unit) == "deg";
        **value = degrees ? inside * std::acos(-1.0) / 180.0 : inside;
      } else if (const auto* whole = std::get_if<int*>(&field.value)) {
        **whole = static_cast<int>(inside);
      } else if (const auto* natural = std::get_if<std::uint64_t*>(&field.value)) {
        **natural = static_cast<std::uint64_t>(inside);
      } else if (const auto* choice = std::get_if<bool*>(&field.value)) {
        **choice = !**choice;
      } else if (const auto* enumerator = std::get_if<EnumField>(&field.value)) {
        EXPECT_TRUE(enumerator->assign(enumerator->value, enumerator->names.back()));
      }
    }
  }
  return result;
}

TEST(IniTest, LoadsAFileAndKeepsDefaultsOfMissingKeys) {
  const Drawing drawing = load_text("[shape]\nsize = 2\nangle_deg = 90\n[paper]\nweight=100\n");
  EXPECT_EQ(drawing.shape.size, 2.0);
  EXPECT_EQ(drawing.shape.angle, std::acos(0.0));
  EXPECT_EQ(drawing.shape.count, 3);
  EXPECT_EQ(drawing.paper.weight, 100.0);
}

TEST(IniTest, EmptyFileKeepsAllDefaults) {
  EXPECT_EQ(dump_ini(load_text("")), dump_ini(Drawing()));
  EXPECT_EQ(dump_ini(load_text("[shape]\n; nothing\n")), dump_ini(Drawing()));
}

TEST(IniTest, ReadsCommentsOfAllForms) {
  const Drawing drawing = load_text(
      "# one\n; two\n// three\n  # four\n[shape]  // the shape\r\nsize = 2 // metres\r\n"
      "count = 7 ; shapes\nseed = 5 # any\nfilled=no\t// not\ncolour = dark_green // = red\n");
  EXPECT_EQ(drawing.shape.size, 2.0);
  EXPECT_EQ(drawing.shape.count, 7);
  EXPECT_EQ(drawing.shape.seed, 5U);
  EXPECT_FALSE(drawing.shape.filled);
  EXPECT_EQ(drawing.shape.colour, Colour::kDarkGreen);
}

TEST(IniTest, ReadsWhatMrptExpands) {
  const Drawing drawing =
      load_text("@define N 7\n[ shape ]\ncount = ${N}\nsize = $eval{1+1}\nseed = 1\\\n23\n");
  EXPECT_EQ(drawing.shape.count, 7);
  EXPECT_EQ(drawing.shape.size, 2.0);
  EXPECT_EQ(drawing.shape.seed, 123U);
}

TEST(IniTest, MessageNamesFileSectionKeyValueRangeAndMeaning) {
  EXPECT_EQ(refusal_of("[shape]\nsize = -3\n"),
            "x.ini: [shape] size = -3: must be within [0.25, 10] m (edge of the shape)");
  const std::string file = write_file("x.ini", "[slope]\ninlier_distance = -3\n");
  DescriptionParams params;
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini(file, params); }),
            file +
                ": [slope] inlier_distance = -3: must be within [0.0001, 1] m (point-to-plane "
                "distance of an inlier)");
}

TEST(IniTest, TableOfRefusedFiles) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[shape]\nsze = 2\n", "x.ini: [shape] sze = 2: unknown key; did you mean `size`?"},
      {"[shaep]\nsize = 2\n", "x.ini: [shaep]: unknown section; did you mean [shape]?"},
      {"[shape]\nsize = \n", "x.ini: [shape] size = : has no value (edge of the shape)"},
      {"[shape]\nsize = // 2\n", "x.ini: [shape] size = : has no value (edge of the shape)"},
      {"[shape]\ncount = 1.5\n",
       "x.ini: [shape] count = 1.5: is not a whole number; must be within [1, 100] (number of "
       "shapes)"},
      {"[shape]\ncount = \"3\"\n",
       "x.ini: [shape] count = \"3\": is not a whole number; must be within [1, 100] (number of "
       "shapes)"},
      {"size = 2\n", "x.ini: size = 2: stands outside of any [section]"},
      {"[shape]\nsize 2\n", "x.ini:2: `size 2`: is neither [section] nor key = value"},
      {"[shape]\n\n= 2\n", "x.ini:3: `= 2`: is neither [section] nor key = value"},
      {"[shape\nsize = 2\n", "x.ini:1: `[shape`: the ] of the section is missing"},
      {"[shape ; x\n]\nsize = 2\n", "x.ini:1: `[shape ; x`: the ] of the section is missing"},
      {"[shape] size = 2\n", "x.ini:1: `[shape] size = 2`: only a comment may follow the section"},
      {"[shape]\nsize = 2\ncount = 3\nSize = 4 // again\n",
       "x.ini:4: [shape] Size = 4: is given twice, first in line 2"},
      {"[shape]\nsize = 2\n[paper]\n[SHAPE]\nsize = 2\n",
       "x.ini:5: [SHAPE] size = 2: is given twice, first in line 2"},
      {"[shape]\nseed = 1\\\n2\nsize = 1\nsize = 2\n",
       "x.ini:5: [shape] size = 2: is given twice, first in line 4"},
      {"[shape]\nsize = <<<END\n2\nEND\n", "x.ini:3: `2`: is neither [section] nor key = value"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(refusal_of(text), message) << text;
}

TEST(IniTest, UndefinedVariableIsRefusedWithTheFile) {
  const std::string message = refusal_of("[shape]\nsize = ${S}\n");
  EXPECT_EQ(message.substr(0, 7), "x.ini: ");
  EXPECT_NE(message.find("${S}"), std::string::npos) << message;
}

TEST(IniTest, LongGarbageIsShortened) {
  const std::string message = refusal_of(std::string(5000, 'x'));
  EXPECT_LT(message.size(), 150U);
}

TEST(IniTest, MissingFileIsRefused) {
  const std::string file = (fresh_folder() / "none.ini").string();
  Drawing drawing;
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini(file, drawing); }),
            file + ": cannot be read: No such file or directory");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(IniTest, StructIsUnchangedAfterARefusal) {
  const std::string file = write_file("x.ini", "[shape]\nsize = 2\ncount = 0\n");
  Drawing drawing;
  EXPECT_THROW(load_ini(file, drawing), ParameterError);
  EXPECT_EQ(dump_ini(drawing), dump_ini(Drawing()));
}

TEST(IniTest, LoadsFromMemoryWithTheNameOfTheSource) {
  Drawing drawing;
  load_ini(CConfigFileMemory(std::string("[shape]\nsize = 2 ; x\n")), "host.ini", drawing);
  EXPECT_EQ(drawing.shape.size, 2.0);
  const CConfigFileMemory wrong(std::string("[shape]\ncolour = blue\n"));
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini(wrong, "host.ini", drawing); }),
            "host.ini: [shape] colour = blue: must be one of red, dark_green (colour of the "
            "shape)");
}

TEST(IniTest, StructsOfSectionsComposeIntoOneFile) {
  Studio studio;
  const CConfigFileMemory all(std::string("[shape]\nsize = 2\n[wall]\nweight = 300\n"));
  load_ini(all, "studio.ini", studio);
  EXPECT_EQ(studio.drawing.shape.size, 2.0);
  EXPECT_EQ(studio.wall.weight, 300.0);
  Drawing drawing;
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini(all, "studio.ini", drawing); }),
            "studio.ini: [wall]: unknown section; there are [shape], [paper]");
}

TEST(IniTest, LoadsOneSectionOfASharedFile) {
  const CConfigFileMemory host(std::string(
      "[robot]\nname = x\n[map_terrainMap_00_insertOpts]\nsize = 2\n[bad]\nsize = 99\n"));
  Shape shape;
  EXPECT_TRUE(load_ini_section(host, "host.ini", "map_terrainMap_00_insertOpts", shape));
  EXPECT_EQ(shape.size, 2.0);
  EXPECT_FALSE(load_ini_section(host, "host.ini", "map_terrainMap_01_insertOpts", shape));
  EXPECT_EQ(shape.size, 2.0);
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini_section(host, "host.ini", "bad", shape); }),
            "host.ini: [bad] size = 99: must be within [0.25, 10] m (edge of the shape)");
  EXPECT_EQ(message_of<ParameterError>([&] { load_ini_section(host, "host.ini", "robot", shape); }),
            "host.ini: [robot] name = x: unknown key; there are size, angle_deg, count, seed, "
            "filled, colour");
}

TEST(IniTest, PrefixerIsRefusedBecauseItCannotListKeys) {
  CConfigFileMemory host(std::string("[map_shape]\nsize = 2\n"));
  const mrpt::config::CConfigFilePrefixer prefixer(host, "map_", "");
  Shape shape;
  EXPECT_EQ(
      message_of<ParameterError>([&] { load_ini_section(prefixer, "host.ini", "shape", shape); }),
      "host.ini: cannot be read through a CConfigFilePrefixer; give the file itself and the "
      "whole name of the section");
}

TEST(IniTest, LiteralDump) {
  EXPECT_EQ(dump_ini(Drawing()),
            "# What is drawn\n"
            "[shape]\n"
            "# edge of the shape (S: [0.25, 10] m)\n"
            "size = 0.5\n"
            "# tilt of the shape (alpha: [-90, 90] deg)\n"
            "angle_deg = 45\n"
            "# number of shapes ([1, 100])\n"
            "count = 3\n"
            "# seed of the random numbers ([0, 9e+15])\n"
            "seed = 1\n"
            "# whether the shape is filled (true or false)\n"
            "filled = true\n"
            "# colour of the shape (one of red, dark_green)\n"
            "colour = red\n"
            "\n"
            "# What it is drawn on\n"
            "[paper]\n"
            "# weight of the paper ([1, 1000] g/m^2)\n"
            "weight = 80\n");
}

TEST(IniTest, InvariantDumpThenLoadIsTheIdentityBitForBit) {
  for (int k = 0; k < 200; ++k) {
    const double share = 0.0049 * k + 0.001 / 3.0;
    const DescriptionParams params = scrambled(DescriptionParams(), share);
    const std::string file = write_file("x.ini", dump_ini(params));
    DescriptionParams loaded;
    load_ini(file, loaded);
    ASSERT_EQ(bits_of(loaded), bits_of(params)) << "share " << share;
    ASSERT_EQ(dump_ini(loaded), dump_ini(params)) << "share " << share;
  }
}

TEST(IniTest, OracleMrptReadsTheSameNumbersFromADump) {
  const CConfigFileMemory config(dump_ini(DescriptionParams()));
  const DescriptionParams params;
  EXPECT_EQ(config.read_double("grid", "cell_size", -1, true), params.grid.cell_size);
  EXPECT_EQ(config.read_int("slope", "max_iterations", -1, true), params.slope.max_iterations);
  EXPECT_EQ(config.read_bool("classes", "all_features", true, true), params.classes.all_features);
  EXPECT_EQ(config.read_string("ground", "kernel", "", true), "mean_difference");
}

/// Loads a file of params/ over values that are all different from the defaults.
DescriptionParams load_over_scrambled(const std::string& name) {
  DescriptionParams params = scrambled(DescriptionParams(), 1.0 / 3.0);
  load_ini(std::string(MRPT_TERRAIN_SOURCE_DIR "/params/") + name, params);
  return params;
}

TEST(IniTest, PaperIniGivesEveryDefault) {
  EXPECT_EQ(dump_ini(load_over_scrambled("paper.ini")), dump_ini(DescriptionParams()));
}

TEST(IniTest, PaperIniHasThePublishedValues) {
  const DescriptionParams params = load_over_scrambled("paper.ini");
  EXPECT_EQ(std::tuple(params.grid.length, params.grid.width, params.grid.cell_size),
            std::tuple(5.0, 5.0, 0.05));
  EXPECT_EQ(params.grid.max_height, 1.5);
  EXPECT_EQ(std::tuple(params.ground.t_diff, params.ground.t_high, params.ground.t_low),
            std::tuple(0.05, 0.05, -0.05));
  EXPECT_EQ(std::tuple(params.classes.t_pos, params.classes.t_neg), std::tuple(0.05, -0.05));
  EXPECT_EQ(params.clusters.t_c, 5);
  EXPECT_EQ(params.ground.kernel, GroundKernel::kMeanDifference);
  EXPECT_FALSE(params.roughness.perfect_plane_is_rough);
}

TEST(IniTest, PaperOutdoorIniGivesEveryParameterAndOnlyScalesTheMap) {
  const DescriptionParams params = load_over_scrambled("paper_outdoor.ini");
  EXPECT_EQ(params.grid.cell_size, 0.2);
  EXPECT_EQ(params.ground.t_diff, 0.2);
  DescriptionParams same = DescriptionParams();
  load_ini(MRPT_TERRAIN_SOURCE_DIR "/params/paper_outdoor.ini", same);
  EXPECT_EQ(dump_ini(params), dump_ini(same)) << "a key is missing in paper_outdoor.ini";
}

TEST(IniTest, FieldIniGivesEveryParameterAndChoosesFieldMode) {
  const DescriptionParams params = load_over_scrambled("field.ini");
  EXPECT_EQ(params.description.mode, DescriptionMode::kField);
  DescriptionParams same = DescriptionParams();
  load_ini(MRPT_TERRAIN_SOURCE_DIR "/params/field.ini", same);
  EXPECT_EQ(dump_ini(params), dump_ini(same)) << "a key is missing in field.ini";
}

}  // namespace
}  // namespace mrpt_terrain::params
