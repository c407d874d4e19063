// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/documentation.h"

#include <gtest/gtest.h>

#include <string>

#include "example_params.h"
#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain::params {
namespace {

TEST(DocumentationTest, LiteralTable) {
  EXPECT_EQ(markdown_table(test_params::Drawing()),
            "## [shape]\n\n"
            "What is drawn.\n\n"
            "| key | in the paper | default | permitted | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `size` | S | 0.5 m | [0.25, 10] m | edge of the shape |\n"
            "| `angle_deg` | alpha | 45 deg | [-90, 90] deg | tilt of the shape |\n"
            "| `count` |  | 3 | [1, 100] | number of shapes |\n"
            "| `seed` |  | 1 | [0, 9e+15] | seed of the random numbers |\n"
            "| `filled` |  | true | true or false | whether the shape is filled |\n"
            "| `colour` |  | red | red, dark_green | colour of the shape |\n\n"
            "## [paper]\n\n"
            "What it is drawn on.\n\n"
            "| key | default | permitted | meaning |\n"
            "|---|---|---|---|\n"
            "| `weight` | 80 g/m^2 | [1, 1000] g/m^2 | weight of the paper |\n");
}

TEST(DocumentationTest, BarsInTextsDoNotEndTheCell) {
  double value = 1.0;
  const Section section{"s", "S", {{ParamInfo{"k", "|z|", "", 0, 2, "a | b"}, &value}}};
  EXPECT_NE(markdown_text({section}).find("| `k` | \\|z\\| | 1 | [0, 2] | a \\| b |\n"),
            std::string::npos);
}

TEST(DocumentationTest, EveryParameterOfTheDescriptionHasARow) {
  DescriptionParams params;
  const std::string text = markdown_table(params);
  for (const Section& section : sections_of(params)) {
    EXPECT_NE(text.find("## [" + section.name + "]\n"), std::string::npos);
    for (const Field& field : section.fields) {
      EXPECT_NE(text.find("\n| `" + std::string(field.info.key) + "` |"), std::string::npos)
          << field.info.key;
    }
  }
}

}  // namespace
}  // namespace mrpt_terrain::params
