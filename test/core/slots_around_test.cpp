// SPDX-License-Identifier: BSD-3-Clause
#include "slots_around.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mrpt_terrain {
namespace {

// Exact: halves are rounded away from zero.
int nearest(int step, int cells, int steps) {
  const int twice = (2 * step * std::abs(cells) + steps) / (2 * steps);
  return cells < 0 ? -twice : twice;
}

TEST(CellSteps, GoToTheNearestCells) {
  for (int steps = 1; steps <= 30; ++steps) {
    for (int cells = -steps; cells <= steps; ++cells) {
      CellSteps way(cells, steps);
      for (int step = 1; step <= steps; ++step) {
        way.next();
        EXPECT_EQ(way.at(), nearest(step, cells, steps)) << step << " of " << steps;
      }
      EXPECT_EQ(way.at(), cells);
    }
  }
}

}  // namespace
}  // namespace mrpt_terrain
