// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/param_info.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <type_traits>

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain {
namespace {

constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Calls check(section, key, info, value) for every parameter of the description.
template <class Params, class Check>
void for_each_parameter(Params& params, Check&& check) {
  Params::visit_sections(params, [&](auto& section, const char* name, const char*) {
    std::decay_t<decltype(section)>::visit_params(
        section, [&](auto& value, const ParamInfo& info) { check(name, info, value); });
  });
}

TEST(ParamInfo, KeysAreUniqueWithinASectionWhenCaseIsIgnored) {
  DescriptionParams params;
  std::set<std::string> seen;
  for_each_parameter(params, [&](const std::string& section, const ParamInfo& info, auto&) {
    EXPECT_TRUE(seen.insert(section + "/" + lower_case(info.key)).second) << section << info.key;
  });
  EXPECT_EQ(seen.size(), 104U);
}

TEST(ParamInfo, EveryParameterHasAMeaningWithoutFullStop) {
  DescriptionParams params;
  for_each_parameter(params, [](const char* section, const ParamInfo& info, auto&) {
    const std::string meaning = info.meaning;
    ASSERT_FALSE(meaning.empty()) << section << "." << info.key;
    EXPECT_NE(meaning.back(), '.') << section << "." << info.key;
  });
}

TEST(ParamInfo, DefaultsLieWithinTheirRanges) {
  const DescriptionParams params;
  for_each_parameter(params, [](const char* section, const ParamInfo& info, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (!std::is_same_v<Value, bool> && std::is_arithmetic_v<Value>) {
      const bool degrees = std::string(info.unit) == "deg";
      const double in_file = static_cast<double>(value) * (degrees ? kDegreesPerRadian : 1.0);
      EXPECT_GE(in_file, info.min) << section << "." << info.key;
      EXPECT_LE(in_file, info.max) << section << "." << info.key;
    }
  });
}

TEST(ParamInfo, KeysOfAnglesEndInDeg) {
  DescriptionParams params;
  for_each_parameter(params, [](const char* section, const ParamInfo& info, auto&) {
    const std::string key = info.key;
    const bool ends_in_deg = key.size() > 4 && key.substr(key.size() - 4) == "_deg";
    EXPECT_EQ(ends_in_deg, std::string(info.unit) == "deg") << section << "." << key;
  });
}

template <class Enum>
void expect_unique_names() {
  std::set<std::string> names;
  std::set<Enum> values;
  for (const auto& entry : enum_names(Enum{})) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_TRUE(values.insert(entry.value).second) << entry.name;
    EXPECT_STREQ(name_of(entry.value), entry.name);
  }
}

TEST(ParamInfo, NamesOfEnumeratorsAreUnique) {
  expect_unique_names<FeatureStatus>();
  expect_unique_names<Support>();
  expect_unique_names<UnknownReason>();
  expect_unique_names<TerrainClass>();
  expect_unique_names<GroundKernel>();
  expect_unique_names<Stage>();
}

TEST(ParamInfo, AValueOutsideTheListHasNoName) {
  EXPECT_STREQ(name_of(static_cast<TerrainClass>(200)), "?");
}

// Literal: the values that the paper gives.
TEST(PaperReading, ValuesGivenByThePaperAreTheDefaults) {
  const DescriptionParams params;
  EXPECT_EQ(params.grid.max_height, 1.5);
  EXPECT_EQ(params.grid.length, 5.0);
  EXPECT_EQ(params.grid.width, 5.0);
  EXPECT_EQ(params.grid.cell_size, 0.05);
  EXPECT_EQ(params.ground.t_diff, 0.05);
  EXPECT_EQ(params.ground.t_high, 0.05);
  EXPECT_EQ(params.ground.t_low, -0.05);
  EXPECT_EQ(params.classes.t_pos, 0.05);
  EXPECT_EQ(params.classes.t_neg, -0.05);
}

// Row "T_ratio, T_L, T_S, T_q, T_Inlier, MaxIterations": the defaults lie within the ranges from
// which the table of readings starts.
TEST(PaperReading, ValuesNotGivenByThePaperStartWithinTheirRanges) {
  const DescriptionParams params;
  EXPECT_GE(params.roughness.t_ratio, 20.0);
  EXPECT_LE(params.roughness.t_ratio, 50.0);
  EXPECT_EQ(params.roughness.t_l, 0.01);
  EXPECT_EQ(params.roughness.t_s, 4e-4);
  EXPECT_GE(params.slope.inlier_distance, 0.005);
  EXPECT_LE(params.slope.inlier_distance, 0.02);
  EXPECT_GE(params.slope.inlier_share, 0.9);
  EXPECT_LE(params.slope.inlier_share, 0.99);
  EXPECT_EQ(params.slope.max_iterations, 1000);
  EXPECT_EQ(params.clusters.t_c, 5);
}

}  // namespace
}  // namespace mrpt_terrain
