// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/grid_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(GridGeometry, CountsOfThePapersMap) {
  const GridGeometry geometry(5.0, 5.0, 0.05);
  EXPECT_EQ(geometry.cells_l(), 100);
  EXPECT_EQ(geometry.cells_w(), 100);
  EXPECT_EQ(geometry.stride(), 102);
  EXPECT_EQ(geometry.array_size(), 102 * 102);
}

// Literal: five cells along x, four along y, each 1 m.
TEST(GridGeometry, CellsOfASmallMapByHand) {
  const GridGeometry geometry(5.0, 4.0, 1.0);
  struct Case {
    double x, y;
    int l, w;
  };
  for (const Case& c : {Case{-2.5, -2.0, 0, 0}, Case{-1.6, -1.1, 0, 0}, Case{-1.5, -1.0, 1, 1},
                        Case{0.0, 0.0, 2, 2}, Case{2.4, 1.9, 4, 3}, Case{2.4, -1.9, 4, 0}}) {
    CellIndex cell;
    ASSERT_TRUE(geometry.cell_at(c.x, c.y, cell)) << c.x << " " << c.y;
    EXPECT_EQ(cell.l, c.l) << c.x;
    EXPECT_EQ(cell.w, c.w) << c.y;
  }
}

TEST(GridGeometry, NumbersAreThoseOfTheCells) {
  const GridGeometry geometry(5.0, 3.9, 0.2);
  for (const double x : {-2.6, -2.5, -0.1, 0.0, 1.3, 2.4999, 2.5, kNan, kInf, -kInf}) {
    for (const double y : {-2.0, -1.95, -0.0, 0.7, 1.9499, 1.96, kNan, kInf, -kInf}) {
      CellIndex cell;
      const bool inside = geometry.cell_at(x, y, cell);
      EXPECT_EQ(geometry.number_at(x, y, true), inside ? value_of(geometry.id_of(cell)) : -1)
          << x << " " << y;
      EXPECT_EQ(geometry.number_at(x, y, false), -1);
    }
  }
}

// Row "0 < w in the projection": w = 0 is in the map.
TEST(PaperReading, FirstColumnOfTheGridIsInTheMap) {
  const GridGeometry geometry(5.0, 5.0, 0.05);
  CellIndex cell{-7, -7};
  ASSERT_TRUE(geometry.cell_at(0.0, -2.5, cell));
  EXPECT_EQ(cell.w, 0);
  ASSERT_TRUE(geometry.cell_at(0.0, -2.4999, cell));
  EXPECT_EQ(cell.w, 0);
}

// The same row: ranges are half open.
TEST(PaperReading, RangesOfTheMapAreHalfOpen) {
  const GridGeometry geometry(5.0, 5.0, 0.05);
  const double before_edge = std::nextafter(2.5F, 0.0F);
  CellIndex cell;
  EXPECT_TRUE(geometry.cell_at(-2.5, -2.5, cell));
  EXPECT_TRUE(geometry.cell_at(before_edge, before_edge, cell));
  EXPECT_EQ(cell.l, 99);
  EXPECT_EQ(cell.w, 99);
  EXPECT_FALSE(geometry.cell_at(2.5, 0.0, cell));
  EXPECT_FALSE(geometry.cell_at(0.0, 2.5, cell));
}

// The same row: truncation would fold the strip (-L/2 - c, -L/2) into the first cells.
TEST(PaperReading, ProjectionFloorsInsteadOfTruncating) {
  const GridGeometry geometry(5.0, 5.0, 0.05);
  const double outside = std::nextafter(-2.5F, -3.0F);
  CellIndex cell;
  EXPECT_FALSE(geometry.cell_at(outside, 0.0, cell));
  EXPECT_FALSE(geometry.cell_at(0.0, outside, cell));
  EXPECT_FALSE(geometry.cell_at(-2.52, -2.52, cell));
}

TEST(GridGeometry, RejectsWhatIsNoPositionInTheMap) {
  const GridGeometry geometry(5.0, 4.0, 1.0);
  for (const double bad : {kNan, kInf, -kInf, 1e30, -1e30, 2.5e9, -2.5e9}) {
    CellIndex cell{-7, -7};
    EXPECT_FALSE(geometry.cell_at(bad, 0.0, cell)) << bad;
    EXPECT_FALSE(geometry.cell_at(0.0, bad, cell)) << bad;
    EXPECT_EQ(cell, (CellIndex{-7, -7})) << "a rejected position writes nothing";
  }
}

TEST(GridGeometry, QuotientIsRoundedUp) {
  EXPECT_EQ(GridGeometry(1.0, 1.0, 0.3).cells_l(), 4);
  EXPECT_EQ(GridGeometry(1.0, 0.9, 0.3).cells_w(), 3);
  EXPECT_EQ(GridGeometry(0.1, 0.1, 10.0).cells_l(), 1);
}

// 1.1 / 0.1 = 11.000000000000002 in binary must not become twelve cells.
TEST(GridGeometry, RoundingOfTheQuotientAddsNoCell) {
  for (int cells = 1; cells <= 2000; ++cells) {
    for (const double size : {0.01, 0.05, 0.1, 0.2, 0.3, 0.7}) {
      EXPECT_EQ(GridGeometry(cells * size, size, size).cells_l(), cells) << cells << " x " << size;
    }
  }
}

// Oracle: the index is the floor of the quotient in long double, away from borders of cells.
TEST(GridGeometry, AgreesWithTheFormulaOfThePaper) {
  for (const double size : {0.05, 0.15, 0.2, 0.3}) {
    const GridGeometry geometry(6.0, 3.0, size);
    for (int k = 0; k < 6000; ++k) {
      const double x = -3.0 + (k + 0.37) * 1e-3;
      const double y = x / 2;
      CellIndex cell;
      ASSERT_TRUE(geometry.cell_at(x, y, cell));
      EXPECT_EQ(cell.l, static_cast<int>(std::floor((x + 3.0L) / static_cast<long double>(size))));
      EXPECT_EQ(cell.w, static_cast<int>(std::floor((y + 1.5L) / static_cast<long double>(size))));
    }
  }
}

TEST(GridGeometry, CentresLieInTheirCells) {
  const GridGeometry geometry(1.0, 2.0, 0.3);
  for (int l = 0; l < geometry.cells_l(); ++l) {
    for (int w = 0; w < geometry.cells_w(); ++w) {
      const Position2 centre = geometry.centre_of({l, w});
      CellIndex cell;
      ASSERT_TRUE(geometry.cell_at(centre.x, centre.y, cell)) << l << " " << w;
      EXPECT_EQ(cell, (CellIndex{l, w}));
    }
  }
}

TEST(GridGeometry, IdsAreUniqueAscendingByRowsAndInsideTheFrame) {
  const GridGeometry geometry(5.0, 4.0, 1.0);
  std::int32_t last = -1;
  for (int l = 0; l < 5; ++l) {
    for (int w = 0; w < 4; ++w) {
      const CellId id = geometry.id_of({l, w});
      EXPECT_GT(value_of(id), last);
      last = value_of(id);
      EXPECT_EQ(geometry.index_of(id), (CellIndex{l, w}));
      // All eight neighbours exist in arrays over the grid.
      EXPECT_GE(last - geometry.stride() - 1, 0);
      EXPECT_LT(last + geometry.stride() + 1, geometry.array_size());
    }
  }
}

TEST(GridGeometry, NeighboursOfTheBorderAreCellsOfTheFrame) {
  const GridGeometry geometry(5.0, 4.0, 1.0);
  std::set<std::int32_t> cells;
  for (int l = 0; l < 5; ++l) {
    for (int w = 0; w < 4; ++w) cells.insert(value_of(geometry.id_of({l, w})));
  }
  for (int l = 0; l < 5; ++l) {
    EXPECT_EQ(cells.count(value_of(geometry.id_of({l, 0})) - 1), 0U);
    EXPECT_EQ(cells.count(value_of(geometry.id_of({l, 3})) + 1), 0U);
  }
}

TEST(Divisor, DividesExactly) {
  constexpr std::int32_t kMost = 2147483647;
  RandomGenerator random(3);
  for (const std::int32_t divisor : {1, 2, 3, 5, 7, 502, 4096, 46341, 65537, 1000003, kMost}) {
    const Divisor by(divisor);
    const auto expect_exact = [&](std::int32_t number) {
      EXPECT_EQ(by.quotient_of(number), number / divisor) << number << " / " << divisor;
    };
    for (const std::int32_t number : {0, 1, divisor - 1, divisor, kMost - 1, kMost})
      expect_exact(number);
    // Multiples and what is just below them.
    for (int trial = 0; trial < 1000; ++trial) {
      const std::int32_t multiple =
          divisor *
          static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(kMost / divisor) + 1U));
      expect_exact(multiple);
      if (multiple > 0) expect_exact(multiple - 1);
      expect_exact(static_cast<std::int32_t>(random.below(kMost)));
    }
  }
}

TEST(GridGeometry, ContainsItsCellsOnly) {
  const GridGeometry geometry(5.0, 4.0, 1.0);
  EXPECT_TRUE(geometry.contains({0, 0}));
  EXPECT_TRUE(geometry.contains({4, 3}));
  EXPECT_FALSE(geometry.contains({-1, 0}));
  EXPECT_FALSE(geometry.contains({0, -1}));
  EXPECT_FALSE(geometry.contains({5, 0}));
  EXPECT_FALSE(geometry.contains({0, 4}));
}

TEST(GridGeometry, ComparesExtentAndResolution) {
  const GridGeometry a(5.0, 4.0, 1.0);
  EXPECT_EQ(a, GridGeometry(5.0, 4.0, 1.0));
  EXPECT_NE(a, GridGeometry(4.0, 4.0, 1.0));
  EXPECT_NE(a, GridGeometry(5.0, 5.0, 1.0));
  EXPECT_NE(a, GridGeometry(5.0, 4.0, 0.5));
  EXPECT_NE(a, GridGeometry());
}

}  // namespace
}  // namespace mrpt_terrain
