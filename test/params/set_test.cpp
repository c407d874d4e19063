// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/set.h"

#include <gtest/gtest.h>

#include <string>

#include "example_params.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

using test_params::Drawing;

TEST(SetTest, SetsOneParameter) {
  DescriptionParams params;
  set(params, "ground.t_diff=0.15");
  set(params, " classes.slope_max_deg = 30 ");
  DescriptionParams expected;
  expected.ground.t_diff = 0.15;
  expected.classes.slope_max = 0.5235987755982989;  // pi / 6
  EXPECT_EQ(dump_ini(params), dump_ini(expected));
}

TEST(SetTest, RefusesAsAFileWould) {
  Drawing drawing;
  EXPECT_EQ(message_of<ParameterError>([&] { set(drawing, "shape.size=99"); }),
            "command line: [shape] size = 99: must be within [0.25, 10] m (edge of the shape)");
  EXPECT_EQ(message_of<ParameterError>([&] { set(drawing, "shape.sise=9", "--set"); }),
            "--set: [shape] sise = 9: unknown key; did you mean `size`?");
  EXPECT_EQ(message_of<ParameterError>([&] { set(drawing, "shap.size=9"); }),
            "command line: [shap]: unknown section; did you mean [shape]?");
  EXPECT_EQ(message_of<ParameterError>([&] { set(drawing, "shape.size="); }),
            "command line: [shape] size = : has no value (edge of the shape)");
  EXPECT_EQ(dump_ini(drawing), dump_ini(Drawing()));
}

TEST(SetTest, RefusesOtherForms) {
  for (const char* text : {"", "=", "shape", "shape.size", "size=1", ".size=1", "shape.=1"}) {
    Drawing drawing;
    EXPECT_EQ(message_of<ParameterError>([&] { set(drawing, text); }),
              std::string("command line: `") + text + "` must be written section.key=value");
  }
}

}  // namespace
}  // namespace mrpt_terrain::params
