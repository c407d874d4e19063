// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/map_lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

TEST(MapLattice, CellsAndLayersByHand) {
  const MapLattice lattice(0.5, 0.25);
  MapCell cell;
  ASSERT_TRUE(lattice.cell_at(0.0, -0.1, cell));
  EXPECT_EQ(cell, (MapCell{0, -1}));
  ASSERT_TRUE(lattice.cell_at(-0.5, 0.5, cell));
  EXPECT_EQ(cell, (MapCell{-1, 1})) << "cells are half open";
  ASSERT_TRUE(lattice.cell_at(-0.51, 1.49, cell));
  EXPECT_EQ(cell, (MapCell{-2, 2}));
  std::int32_t layer = 7;
  ASSERT_TRUE(lattice.layer_at(-0.01, layer));
  EXPECT_EQ(layer, -1);
  ASSERT_TRUE(lattice.layer_at(0.25, layer));
  EXPECT_EQ(layer, 1);
  EXPECT_EQ(lattice.bottom_of(-2), -0.5);
  EXPECT_EQ(lattice.centre_of({-1, 2}).x, -0.25);
  EXPECT_EQ(lattice.centre_of({-1, 2}).y, 1.25);
}

TEST(MapLattice, FloorsLikeTheLibrary) {
  RandomGenerator random(3);
  for (int k = 0; k < 10000; ++k) {
    const double value = (random.uniform() - 0.5) * 1e6;
    EXPECT_EQ(floor_to_int(value), static_cast<std::int32_t>(std::floor(value)));
  }
}

TEST(MapLattice, WhatLiesBeyondIsNoCell) {
  const MapLattice lattice(0.2, 0.2);
  MapCell cell{5, 6};
  std::int32_t layer = 7;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e9, -1e9}) {
    EXPECT_FALSE(lattice.cell_at(bad, 0.0, cell));
    EXPECT_FALSE(lattice.cell_at(0.0, bad, cell));
    EXPECT_FALSE(lattice.layer_at(bad, layer));
  }
  EXPECT_EQ(cell, (MapCell{5, 6}));
  EXPECT_EQ(layer, 7);
}

}  // namespace
}  // namespace mrpt_terrain
