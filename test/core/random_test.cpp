// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mrpt_terrain {
namespace {

// Literal: the first numbers that the reference implementation of PCG-XSH-RR 64/32 prints in its
// demonstration, pcg32_srandom(42, 54).
TEST(Random, EqualsTheReferenceImplementation) {
  RandomGenerator random(42, 54);
  for (const std::uint32_t expected :
       {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(Random, SameSeedReplaysAndStreamsDiffer) {
  RandomGenerator a(7, 1);
  RandomGenerator b(7, 1);
  RandomGenerator other_stream(7, 2);
  RandomGenerator other_seed(8, 1);
  int same_stream = 0;
  int same_seed = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t value = a.next();
    EXPECT_EQ(value, b.next());
    same_stream += value == other_stream.next() ? 1 : 0;
    same_seed += value == other_seed.next() ? 1 : 0;
  }
  // Two independent sequences of 1000 numbers agree somewhere with probability 1000 / 2^32.
  EXPECT_EQ(same_stream, 0);
  EXPECT_EQ(same_seed, 0);
}

TEST(Random, BelowOneIsZero) {
  RandomGenerator random(1);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(random.below(1), 0U);
}

// Analytic: each of k values has frequency n/k with standard deviation sqrt(n (k-1)) / k; five of
// them are exceeded once in two million draws of a frequency.
TEST(Random, BelowIsEvenlySpread) {
  for (const std::uint32_t k : {2U, 3U, 7U, 10U}) {
    RandomGenerator random(3, k);
    constexpr int kDraws = 70000;
    std::vector<int> count(k, 0);
    for (int i = 0; i < kDraws; ++i) {
      const std::uint32_t value = random.below(k);
      ASSERT_LT(value, k);
      ++count[value];
    }
    const double expected = double{kDraws} / k;
    for (const int c : count) {
      EXPECT_NEAR(c, expected, 5.0 * std::sqrt(expected * (1.0 - 1.0 / k))) << "bound " << k;
    }
  }
}

// A plain product of a 32-bit number with 3/4 of 2^32 would give every third value twice as often.
TEST(Random, BelowHasNoBiasForLargeBounds) {
  RandomGenerator random(5);
  constexpr std::uint32_t kBound = 3U << 30U;
  constexpr int kDraws = 60000;
  std::array<int, 3> residues{};
  for (int i = 0; i < kDraws; ++i) {
    const std::uint32_t value = random.below(kBound);
    ASSERT_LT(value, kBound);
    ++residues[value % 3U];
  }
  for (const int c : residues) EXPECT_NEAR(c, kDraws / 3, 5.0 * std::sqrt(kDraws * 2.0 / 9.0));
}

TEST(Random, UniformIsHalfOpenWithTheMomentsOfTheUnitInterval) {
  RandomGenerator random(9);
  constexpr int kDraws = 100000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  // Variance of u is 1/12, that of u^2 is 4/45.
  EXPECT_NEAR(sum / kDraws, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kDraws));
}

}  // namespace
}  // namespace mrpt_terrain
