// SPDX-License-Identifier: BSD-3-Clause
#include "length_of.h"

#include <gtest/gtest.h>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

// Oracle: long double. Rounding twice may take the neighbour of the nearest float.
TEST(LengthOf, IsThatOfTheVector) {
  EXPECT_EQ(length_of(3.0F, -4.0F), 5.0F);
  EXPECT_EQ(length_of(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(length_of(3e30F, 4e30F), 5e30F);
  RandomGenerator random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const auto x = static_cast<float>(200.0 * random.uniform() - 100.0);
    const auto y = static_cast<float>(random.uniform());
    const long double u = x, v = y;
    EXPECT_FLOAT_EQ(length_of(x, y), static_cast<float>(std::sqrt(u * u + v * v)));
  }
}

}  // namespace
}  // namespace mrpt_terrain
