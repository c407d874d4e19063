// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/cell_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "allocation_counter.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

CellPoints sorted(const Points& points, const SquareLattice& lattice) {
  CellPoints result;
  CellPointsWorkspace workspace;
  sort_into_cells(points.view(), lattice, workspace, result);
  return result;
}

/// Everything that a result says, one number after the other.
std::vector<std::int64_t> contents(const CellPoints& cells) {
  std::vector<std::int64_t> all{cells.lattice.side};
  for (const LatticeCell cell : cells.cell) all.insert(all.end(), {cell.row, cell.column});
  all.insert(all.end(), cells.first.begin(), cells.first.end());
  all.insert(all.end(), cells.slot_of.begin(), cells.slot_of.end());
  for (const CellPoint& point : cells.points) all.push_back(point.index);
  return all;
}

/// `n` points, evenly over a square of half side `half`, one in ten without one of its coordinates.
Points random_points(int n, double half, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  for (int i = 0; i < n; ++i) {
    float place[3];
    for (float& value : place) value = static_cast<float>(half * (2.0 * random.uniform() - 1.0));
    if (random.below(10) == 0) place[random.below(3)] = random.below(2) == 0 ? kNan : -kInf;
    points.push_back(place[0], place[1], place[2]);
  }
  return points;
}

TEST(CellPoints, EveryPointKnowsItsPlace) {
  const Points points = random_points(2000, 20.0, 5);
  CellPointsWorkspace workspace;
  CellPoints cells;
  sort_into_cells(points.view(), {32, 0.4F}, workspace, cells);
  ASSERT_EQ(workspace.place_of.size(), points.size());
  std::size_t placed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (workspace.place_of[i] < 0) continue;
    ++placed;
    EXPECT_EQ(cells.points[static_cast<std::size_t>(workspace.place_of[i])].index,
              static_cast<std::int32_t>(i));
  }
  EXPECT_EQ(placed, cells.points.size());
  EXPECT_GT(placed, 100U);
  EXPECT_LT(placed, points.size());
}

// Literal: four cells a side, 1 m wide, from -2 to 2.
TEST(CellPoints, FivePointsByHand) {
  Points points;
  points.push_back(1.5F, 1.5F, 10.0F);    // cell (3, 3)
  points.push_back(-1.5F, 0.5F, 20.0F);   // cell (0, 2)
  points.push_back(1.25F, 1.75F, 30.0F);  // cell (3, 3)
  points.push_back(0.0F, -2.0F, 40.0F);   // cell (2, 0)
  points.push_back(2.0F, 0.0F, 50.0F);    // beyond the edge
  const CellPoints cells = sorted(points, {4, 1.0F});
  ASSERT_EQ(cells.occupied(), 3U);
  EXPECT_EQ(cells.first, (std::vector<std::int32_t>{0, 1, 2, 4}));
  EXPECT_EQ(cells.slot_of, (std::vector<std::int32_t>{-1, -1, 0, -1,   //
                                                      -1, -1, -1, -1,  //
                                                      1, -1, -1, -1,   //
                                                      -1, -1, -1, 2}));
  ASSERT_EQ(cells.points.size(), 4U);
  const std::vector<std::int32_t> order{1, 3, 0, 2};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    EXPECT_EQ(cells.points[k].index, order[k]);
    EXPECT_EQ(cells.points[k].x, points.x[i]);
    EXPECT_EQ(cells.points[k].y, points.y[i]);
    EXPECT_EQ(cells.points[k].z, points.z[i]);
  }
  EXPECT_EQ(cells.number_of({3, 2}), 14U);
}

// The lower edges of cells belong to them, the upper ones to the next. All numbers are exact.
TEST(CellPoints, CellsAreHalfOpen) {
  const SquareLattice lattice{4, 0.5F};
  EXPECT_EQ(lattice.cell_at(-1.0F, -1.0F), 0);
  EXPECT_EQ(lattice.cell_at(-0.5F, -1.0F), 4);
  EXPECT_EQ(lattice.cell_at(-1.0F, -0.5F), 1);
  EXPECT_EQ(lattice.cell_at(0.75F, 0.75F), 15);
  for (const float beyond : {1.0F, -1.0001F, 1e30F, -1e30F, kNan, kInf, -kInf}) {
    EXPECT_EQ(lattice.cell_at(beyond, 0.0F), -1) << beyond;
    EXPECT_EQ(lattice.cell_at(0.0F, beyond), -1) << beyond;
  }
  for (std::int32_t cell = 0; cell < 16; ++cell) {
    EXPECT_EQ(lattice.cell_at(lattice.centre(cell / 4), lattice.centre(cell % 4)), cell);
  }
}

// Oracle: all cells in order, and for each all points in order. Cells of 0.5 m, so that the
// divisions are exact.
TEST(CellPoints, SameAsLookingThroughAllPointsForEveryCell) {
  for (const std::uint64_t seed : {201, 202, 203}) {
    const Points points = random_points(2000, 6.0, seed);
    const SquareLattice lattice{16, 0.5F};
    const CellPoints cells = sorted(points, lattice);
    std::vector<std::int32_t> order, first, slot_of;
    for (int row = 0; row < 16; ++row) {
      for (int column = 0; column < 16; ++column) {
        const std::size_t before = order.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
          if (!std::isfinite(points.z[i])) continue;
          if (std::floor(points.x[i] / 0.5F) + 8.0F != static_cast<float>(row)) continue;
          if (std::floor(points.y[i] / 0.5F) + 8.0F != static_cast<float>(column)) continue;
          order.push_back(static_cast<std::int32_t>(i));
        }
        const bool occupied = order.size() > before;
        slot_of.push_back(occupied ? static_cast<std::int32_t>(first.size()) : -1);
        if (occupied) first.push_back(static_cast<std::int32_t>(before));
      }
    }
    first.push_back(static_cast<std::int32_t>(order.size()));
    ASSERT_GT(order.size(), 500U) << seed;
    EXPECT_EQ(cells.first, first) << seed;
    EXPECT_EQ(cells.slot_of, slot_of) << seed;
    ASSERT_EQ(cells.points.size(), order.size()) << seed;
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_EQ(cells.points[k].index, order[k]) << seed;
    }
  }
}

TEST(CellPoints, WithoutPointsThereAreNoSlots) {
  Points nothing;
  Points useless;
  useless.push_back(kNan, 0.0F, 0.0F);
  useless.push_back(0.0F, kInf, 0.0F);
  useless.push_back(0.0F, 0.0F, kNan);
  useless.push_back(100.0F, 0.0F, 0.0F);
  for (const Points& points : {nothing, useless}) {
    const CellPoints cells = sorted(points, {8, 0.4F});
    EXPECT_EQ(cells.occupied(), 0U);
    EXPECT_TRUE(cells.points.empty());
    EXPECT_EQ(cells.first, (std::vector<std::int32_t>{0}));
    EXPECT_EQ(cells.slot_of, std::vector<std::int32_t>(64, -1));
  }
}

// Whatever was there before leaves no trace: larger, smaller, and finer lattices.
TEST(CellPoints, ReuseGivesWhatAFreshStartGives) {
  CellPoints used;
  CellPointsWorkspace workspace;
  std::uint64_t seed = 210;
  for (const SquareLattice& lattice :
       {SquareLattice{16, 0.5F}, SquareLattice{16, 0.5F}, SquareLattice{16, 0.25F},
        SquareLattice{32, 0.5F}, SquareLattice{4, 1.0F}, SquareLattice{16, 0.5F}}) {
    const Points points = random_points(300, 6.0, ++seed);
    sort_into_cells(points.view(), lattice, workspace, used);
    EXPECT_EQ(contents(used), contents(sorted(points, lattice))) << seed;
    EXPECT_EQ(used.lattice.cell_size, lattice.cell_size);
  }
}

TEST(CellPoints, ASecondTimeDoesNotAllocate) {
  const Points points = random_points(5000, 6.0, 220);
  CellPoints cells;
  CellPointsWorkspace workspace;
  sort_into_cells(points.view(), {32, 0.4F}, workspace, cells);
  const std::size_t before = bench::allocations();
  sort_into_cells(points.view(), {32, 0.4F}, workspace, cells);
  EXPECT_EQ(bench::allocations(), before);
}

}  // namespace
}  // namespace mrpt_terrain
