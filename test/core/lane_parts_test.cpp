// SPDX-License-Identifier: BSD-3-Clause
#include "lane_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using Eight = std::array<double, kCellLanes>;

/// Results of every operation, one behind the other.
struct Results {
  Eight sum, difference, product, scaled, dropped, taken;
  double total = 0.0;
};

template <class Lanes>
void compute(const Eight& a, const Eight& b, Results& results) {
  const Lanes x = Lanes::from(a.data()), y = Lanes::from(b.data());
  (x + y).copy_to(results.sum.data());
  (x - y).copy_to(results.difference.data());
  (x * y).copy_to(results.product.data());
  (1.5 * x).copy_to(results.scaled.data());
  Lanes kept = x;
  kept.drop_where_less(x, y);
  kept.copy_to(results.dropped.data());
  kept = x;
  kept.take_where_less(x, y, Lanes::of(7.0));
  kept.copy_to(results.taken.data());
  results.total = (x + y).total();
}

void compute_one_by_one(const Eight& a, const Eight& b, Results& results) {
  for (std::size_t k = 0; k < kCellLanes; ++k) {
    results.sum[k] = a[k] + b[k];
    results.difference[k] = a[k] - b[k];
    results.product[k] = a[k] * b[k];
    results.scaled[k] = 1.5 * a[k];
    results.dropped[k] = a[k] < b[k] ? 0.0 : a[k];
    results.taken[k] = a[k] < b[k] ? 7.0 : a[k];
    results.total += results.sum[k];
  }
}

void expect_same_bits(const Results& a, const Results& b) {
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
}

TEST(LaneParts, DoWhatSingleNumbersWould) {
  RandomGenerator random(5);
  for (int trial = 0; trial < 100; ++trial) {
    Eight a, b;
    for (std::size_t k = 0; k < kCellLanes; ++k) {
      a[k] = random.uniform() - 0.5;
      // Some are equal.
      b[k] = random.below(4) == 0 ? a[k] : random.uniform() - 0.5;
    }
    Results expected, one, two, four;
    compute_one_by_one(a, b, expected);
    compute<LaneParts<1>>(a, b, one);
    compute<LaneParts<2>>(a, b, two);
    compute<LaneParts<4>>(a, b, four);
    expect_same_bits(expected, one);
    expect_same_bits(expected, two);
    expect_same_bits(expected, four);
  }
}

}  // namespace
}  // namespace mrpt_terrain
