// SPDX-License-Identifier: BSD-3-Clause
#include "scan_cells.h"

#include <gtest/gtest.h>

#include <map>

#include "mrpt_terrain/core/random.h"
#include "ray_set.h"

namespace mrpt_terrain::octree {
namespace {

TEST(CellCode, LiteralBitsAreInterleavedWithXLowest) {
  EXPECT_EQ(code_of({1, 0, 0}), 1U);
  EXPECT_EQ(code_of({0, 1, 0}), 2U);
  EXPECT_EQ(code_of({0, 0, 1}), 4U);
  EXPECT_EQ(code_of({0xffff, 0xffff, 0xffff}), 0xffffffffffffU);
  RandomGenerator random(1);
  for (int k = 0; k < 1000; ++k) {
    const CellKey key = {static_cast<std::uint16_t>(random.next()),
                         static_cast<std::uint16_t>(random.next()),
                         static_cast<std::uint16_t>(random.next())};
    EXPECT_EQ(key_of(code_of(key)), key);
  }
}

TEST(ScanCells, OracleHoldsWhatWasMarked) {
  RandomGenerator random(2);
  ScanCells cells;
  for (int round = 0; round < 3; ++round) {
    std::map<CellCode, std::uint64_t> free, occupied;
    cells.clear();
    for (int k = 0; k < 3000; ++k) {
      // Far more tiles than the table has places for at first.
      const CellCode code = (std::uint64_t{random.next()} << 16) & 0xffffffffffc0U;
      const std::uint64_t bit = std::uint64_t{1} << random.below(64);
      cells.mark_free(code, bit);
      free[code] |= bit;
      if (k % 3 != 0) continue;
      cells.mark_occupied(code | 5);
      occupied[code] |= 32;
    }
    std::size_t words = 0;
    for (const CellTile& tile : cells.tiles()) {
      for (CellCode place = 0; place < 4096; ++place) {
        const std::uint32_t block = tile.block[place >> 3];
        EXPECT_EQ(block != 0, (tile.present[place >> 9] >> (place >> 3 & 63) & 1) != 0);
        if (block == 0) continue;
        const CellCode code = tile.code << 18 | place << 6;
        const std::uint64_t word = cells.free(block).words[place & 7];
        words += word != 0 ? 1 : 0;
        EXPECT_EQ(word, free.count(code) != 0 ? free[code] : 0);
        EXPECT_EQ(cells.occupied(block).words[place & 7],
                  occupied.count(code) != 0 ? occupied[code] : 0);
      }
    }
    EXPECT_EQ(words, free.size());
  }
}

TEST(RaySet, LiteralRaysAreKnownByOriginAndEnd) {
  RaySet rays;
  for (int round = 0; round < 2; ++round) {
    rays.reset(3);
    EXPECT_TRUE(rays.insert(0, 7));
    EXPECT_FALSE(rays.insert(0, 7));
    EXPECT_TRUE(rays.insert(1, 7));
    EXPECT_TRUE(rays.insert(0, 8));
    EXPECT_FALSE(rays.insert(1, 7));
  }
}

}  // namespace
}  // namespace mrpt_terrain::octree
