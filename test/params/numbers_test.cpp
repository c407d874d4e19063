// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace mrpt_terrain::params {
namespace {

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// A small generator, the same on every machine (Vigna's splitmix64).
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15U);
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

double between(double low, double high, std::uint64_t& state) {
  return low + (high - low) * std::ldexp(static_cast<double>(next_random(state) >> 11U), -53);
}

TEST(NumbersTest, LiteralTextsOfDoubles) {
  EXPECT_EQ(to_text(0.05), "0.05");
  EXPECT_EQ(to_text(-0.25), "-0.25");
  EXPECT_EQ(to_text(5.0), "5");
  EXPECT_EQ(to_text(0.0), "0");
  EXPECT_EQ(to_text(0.0004), "0.0004");
  EXPECT_EQ(to_text(1e6), "1000000");
  EXPECT_EQ(to_text(9e15), "9e+15");
  EXPECT_EQ(to_text(0.1 + 0.2), "0.30000000000000004");
}

TEST(NumbersTest, LiteralTextsOfAngles) {
  EXPECT_EQ(to_text_degrees(0.7853981633974483), "45");
  EXPECT_EQ(to_text_degrees(1.2217304763960306), "70");
  EXPECT_EQ(to_text_degrees(radians_of(0.1)), "0.1");
  EXPECT_EQ(to_text_degrees(-radians_of(12.5)), "-12.5");
  EXPECT_EQ(to_text_degrees(0.0), "0");
  EXPECT_EQ(to_text_degrees(radians_of(360.0)), "360");
  EXPECT_EQ(to_text_degrees(radians_of(2e-5)), "2e-05");
}

struct TextCase {
  const char* text;
  NumberStatus as_double;
  NumberStatus as_int;
  NumberStatus as_unsigned;
};

TEST(NumbersTest, TableOfTexts) {
  using S = NumberStatus;
  const TextCase cases[] = {
      {"1", S::kOk, S::kOk, S::kOk},
      {"+1", S::kOk, S::kOk, S::kOk},
      {"-1", S::kOk, S::kOk, S::kUnrepresentable},
      {"1.5", S::kOk, S::kNotANumber, S::kNotANumber},
      {"1e3", S::kOk, S::kNotANumber, S::kNotANumber},
      {"", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"abc", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"0.1x", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"1 2", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {" 1", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"0x10", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"1,5", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"+-1", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"--1", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"+", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"-", S::kNotANumber, S::kNotANumber, S::kNotANumber},
      {"nan", S::kNotFinite, S::kNotANumber, S::kNotANumber},
      {"-inf", S::kNotFinite, S::kNotANumber, S::kNotANumber},
      {"1e999", S::kUnrepresentable, S::kNotANumber, S::kNotANumber},
      {"99999999999", S::kOk, S::kUnrepresentable, S::kOk},
      {"99999999999999999999", S::kOk, S::kUnrepresentable, S::kUnrepresentable},
      {"-99999999999999999999", S::kOk, S::kUnrepresentable, S::kUnrepresentable},
  };
  for (const TextCase& c : cases) {
    double real = 7;
    int whole = 7;
    std::uint64_t natural = 7;
    EXPECT_EQ(parse(c.text, real), c.as_double) << c.text;
    EXPECT_EQ(parse(c.text, whole), c.as_int) << c.text;
    EXPECT_EQ(parse(c.text, natural), c.as_unsigned) << c.text;
    EXPECT_TRUE(c.as_double == S::kOk || real == 7) << c.text;
    EXPECT_TRUE(c.as_int == S::kOk || whole == 7) << c.text;
    EXPECT_TRUE(c.as_unsigned == S::kOk || natural == 7U) << c.text;
  }
}

TEST(NumbersTest, ReadsValues) {
  double real = 0;
  ASSERT_EQ(parse("-2.5e-1", real), NumberStatus::kOk);
  EXPECT_EQ(real, -0.25);
  std::uint64_t natural = 0;
  ASSERT_EQ(parse("18446744073709551615", natural), NumberStatus::kOk);
  EXPECT_EQ(natural, std::numeric_limits<std::uint64_t>::max());
  ASSERT_EQ(parse_degrees("90", real), NumberStatus::kOk);
  EXPECT_EQ(real, std::acos(0.0));
  EXPECT_EQ(parse_degrees("nan", real), NumberStatus::kNotFinite);
  // A long double may hold it where a double cannot.
  EXPECT_EQ(parse_degrees("1e400", real), NumberStatus::kUnrepresentable);
}

TEST(NumbersTest, InvariantDoubleToTextAndBackKeepsAllBits) {
  std::uint64_t state = 1;
  for (int k = 0; k < 20000; ++k) {
    const double value = k % 2 == 0 ? between(-100.0, 100.0, state)
                                    : std::ldexp(between(-2.0, 2.0, state),
                                                 static_cast<int>(next_random(state) % 1200) - 600);
    double read = 0;
    ASSERT_EQ(parse(to_text(value), read), NumberStatus::kOk) << to_text(value);
    ASSERT_EQ(bits_of(read), bits_of(value)) << to_text(value);
  }
}

TEST(NumbersTest, InvariantAngleToDegreesAndBackKeepsAllBits) {
  std::uint64_t state = 2;
  for (int k = 0; k < 20000; ++k) {
    const double radians = between(-3.2, 3.2, state);
    double read = 0;
    ASSERT_EQ(parse_degrees(to_text_degrees(radians), read), NumberStatus::kOk);
    ASSERT_EQ(bits_of(read), bits_of(radians)) << to_text_degrees(radians);
  }
}

TEST(NumbersTest, OracleShortDegreesStayShort) {
  for (int tenths = -3600; tenths <= 3600; ++tenths) {
    const double degrees = tenths / 10.0;
    EXPECT_EQ(to_text_degrees(radians_of(degrees)), to_text(degrees));
  }
}

}  // namespace
}  // namespace mrpt_terrain::params
