// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/cell_bits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using Cells = std::vector<CellIndex>;

Cells marked_around(const CellBits& bits, CellIndex at, int reach) {
  Cells cells;
  bits.for_marked_around(at, reach, [&cells](CellIndex cell) { cells.push_back(cell); });
  return cells;
}

Cells marked_before(const CellBits& bits, CellIndex at, int reach) {
  Cells cells;
  bits.for_marked_before(at, reach, [&cells](CellIndex cell) { cells.push_back(cell); });
  return cells;
}

// Oracle: every cell is looked at.
TEST(CellBits, FindsTheCellsThatALookAtEveryCellFinds) {
  for (const int width : {1, 7, 63, 64, 65, 128, 200}) {
    const GridGeometry geometry(20.0, width, 1.0);
    CellBits bits;
    bits.clear(geometry);
    std::vector<bool> marked(static_cast<std::size_t>(20 * width), false);
    RandomGenerator random(static_cast<std::uint64_t>(width));
    const auto place = [width](CellIndex cell) {
      return static_cast<std::size_t>(cell.l * width + cell.w);
    };
    for (int trial = 0; trial < 300; ++trial) {
      const CellIndex cell{static_cast<int>(random.below(20)),
                           static_cast<int>(random.below(static_cast<std::uint32_t>(width)))};
      const bool mark = random.below(4) > 0;
      if (mark) {
        bits.mark(cell);
      } else {
        bits.unmark(cell);
      }
      marked[place(cell)] = mark;
      EXPECT_EQ(bits.is_marked(cell), mark);
      const int reach = static_cast<int>(random.below(trial % 10 == 0 ? 150 : 5));
      Cells expected;
      for (int l = 0; l < 20; ++l) {
        for (int w = 0; w < width; ++w) {
          if (std::abs(l - cell.l) <= reach && std::abs(w - cell.w) <= reach &&
              marked[place({l, w})])
            expected.push_back({l, w});
        }
      }
      EXPECT_EQ(marked_around(bits, cell, reach), expected) << width << " " << trial;
      expected.erase(std::remove_if(expected.begin(), expected.end(),
                                    [cell](CellIndex other) { return other.l > cell.l; }),
                     expected.end());
      EXPECT_EQ(marked_before(bits, cell, reach), expected) << width << " " << trial;
    }
  }
}

TEST(CellBits, CellsMayBeUnmarkedWhileTheyAreVisited) {
  const GridGeometry geometry(3.0, 100.0, 1.0);
  CellBits bits;
  bits.clear(geometry);
  for (int w = 0; w < 100; ++w) bits.mark({1, w});
  int visits = 0;
  bits.for_marked_around({1, 50}, 70, [&](CellIndex cell) {
    ++visits;
    bits.unmark(cell);
  });
  EXPECT_EQ(visits, 100);
  EXPECT_TRUE(marked_around(bits, {1, 50}, 70).empty());
}

TEST(CellBits, NothingIsMarkedAfterClearing) {
  CellBits bits;
  bits.clear(GridGeometry(10.0, 10.0, 1.0));
  bits.mark({5, 5});
  bits.clear(GridGeometry(20.0, 5.0, 1.0));
  EXPECT_TRUE(marked_around(bits, {10, 2}, 20).empty());
}

}  // namespace
}  // namespace mrpt_terrain
