// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/text.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace mrpt_terrain::view {
namespace {

TEST(Text, FixedRoundsAndHasNoNegativeZero) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");  // exactly half way: to even
  EXPECT_EQ(fixed(-0.35, 3), "-0.350");
  EXPECT_EQ(fixed(-0.0004, 2), "0.00");
  EXPECT_EQ(fixed(12.6, 0), "13");
}

TEST(Text, NumbersThatAreNoneAreEmpty) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fixed(nan, 2), "");
  EXPECT_EQ(fixed(-infinity, 2), "");
  EXPECT_EQ(shortest(nan), "");
  EXPECT_EQ(shortest(infinity), "");
  EXPECT_EQ(shortest(std::numeric_limits<float>::quiet_NaN()), "");
  EXPECT_EQ(time_text(nan), "");
}

TEST(Text, ShortestReadsBackAsTheSameNumber) {
  for (const double value : {0.0, 0.1, -0.1, 1.0 / 3.0, 1317042136.08, 4e-4, 1e-9, -2.5e300,
                             std::numeric_limits<double>::denorm_min()}) {
    EXPECT_EQ(std::strtod(shortest(value).c_str(), nullptr), value) << shortest(value);
  }
  EXPECT_EQ(shortest(0.15F), "0.15");  // not the digits of the double beside it
  EXPECT_EQ(shortest(4e-4), "0.0004");
  EXPECT_EQ(shortest(100.0), "100");
}

TEST(Text, GroupsOfThreeDigits) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(12345678), "12 345 678");
}

TEST(Text, TimesOfTheUnixEpochAreDates) {
  EXPECT_EQ(time_text(1317042136.08), "2011-09-26 13:02:16.080 UTC");
  EXPECT_EQ(time_text(1709164800.0), "2024-02-29 00:00:00.000 UTC");
  EXPECT_EQ(time_text(4107542399.9996), "2100-03-01 00:00:00.000 UTC");
  EXPECT_EQ(time_text(12.3456), "t = 12.346 s");
  EXPECT_EQ(time_text(-1.0), "t = -1.000 s");
}

TEST(Text, PrintableKeepsUtf8AndReplacesTheRest) {
  EXPECT_EQ(printable("Straße 走 😀.rawlog"), "Straße 走 😀.rawlog");
  EXPECT_EQ(printable("a\xFF"
                      "b\n\xC3"),
            "a?b??");
  EXPECT_EQ(printable("\xC0\xAF"), "??");            // overlong '/'
  EXPECT_EQ(printable("\xED\xA0\x80"), "???");       // a surrogate
  EXPECT_EQ(printable("\xE2\x82"), "??");            // cut off
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "????");  // beyond U+10FFFF
}

TEST(Text, BaseNames) {
  EXPECT_EQ(base_name("/a/b/c.rawlog"), "c.rawlog");
  EXPECT_EQ(base_name("c.rawlog"), "c.rawlog");
  EXPECT_EQ(base_name("/a/velodyne/"), "velodyne");
  EXPECT_EQ(base_name("/"), "/");
  EXPECT_EQ(base_name(""), "");
}

TEST(Text, RoundSteps) {
  EXPECT_DOUBLE_EQ(round_step(1.0), 1.0);
  EXPECT_DOUBLE_EQ(round_step(1.01), 2.0);
  EXPECT_DOUBLE_EQ(round_step(3.0), 5.0);
  EXPECT_DOUBLE_EQ(round_step(7.0), 10.0);
  EXPECT_DOUBLE_EQ(round_step(0.021), 0.05);
  EXPECT_DOUBLE_EQ(round_step(0.2), 0.2);
  EXPECT_EQ(decimals_of(0.05), 2);
  EXPECT_EQ(decimals_of(0.1), 1);
  EXPECT_EQ(decimals_of(20.0), 0);
}

}  // namespace
}  // namespace mrpt_terrain::view
