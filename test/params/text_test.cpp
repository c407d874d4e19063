// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/params/src/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mrpt_terrain::params {
namespace {

TEST(TextTest, LowerCaseTouchesAsciiLettersOnly) {
  EXPECT_EQ(lower_case("T_Diff [0.1] \xC3\x84"), "t_diff [0.1] \xC3\x84");
}

TEST(TextTest, TrimmedRemovesBlanksAtBothEnds) {
  EXPECT_EQ(trimmed(" \t a b \r"), "a b");
  EXPECT_EQ(trimmed("   "), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(TextTest, WithoutCommentKnowsThreeForms) {
  EXPECT_EQ(without_comment("0.1 // c"), "0.1");
  EXPECT_EQ(without_comment("0.1 ; c"), "0.1");
  EXPECT_EQ(without_comment("0.1\t# c // d"), "0.1");
  EXPECT_EQ(without_comment("// c"), "");
  EXPECT_EQ(without_comment("; c"), "");
}

TEST(TextTest, WithoutCommentWantsABlankBefore) {
  EXPECT_EQ(without_comment("http://x;y#z"), "http://x;y#z");
  EXPECT_EQ(without_comment("a / b"), "a / b");
}

TEST(TextTest, NearestFindsTypingErrors) {
  const std::vector<std::string> keys = {"t_diff", "t_high", "t_low", "kernel", "slope_max_deg"};
  EXPECT_EQ(nearest("t_dif", keys), "t_diff");
  EXPECT_EQ(nearest("t_idff", keys), "t_diff");
  EXPECT_EQ(nearest("T_HIHG", keys), "t_high");
  EXPECT_EQ(nearest("kernal", keys), "kernel");
  EXPECT_EQ(nearest("slope_max", keys), "slope_max_deg");
  EXPECT_EQ(nearest("max_iterations", keys), "");
  EXPECT_EQ(nearest("zz", {"ab"}), "");
  EXPECT_EQ(nearest("", keys), "");
}

TEST(TextTest, FirstMessageLeavesOutTheCallStack) {
  EXPECT_EQ(first_message("==== MRPT exception ====\nMessage:  No such thing\nLocation: x.cpp:1\n"),
            "No such thing");
  EXPECT_EQ(first_message("plain"), "plain");
}

TEST(TextTest, JoinedPutsSeparatorsBetween) {
  EXPECT_EQ(joined(std::vector<std::string>{"a", "b", "c"}, ", "), "a, b, c");
  EXPECT_EQ(joined(std::vector<std::string>{}, ", "), "");
}

}  // namespace
}  // namespace mrpt_terrain::params
