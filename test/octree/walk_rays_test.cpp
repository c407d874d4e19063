// SPDX-License-Identifier: BSD-3-Clause
#include "walk_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "octree_scans.h"
#include "walk_chunk.h"

namespace mrpt_terrain::octree {
namespace {

std::set<CellCode> free_cells(const ScanCells& cells) {
  std::set<CellCode> codes;
  for (const CellTile& tile : cells.tiles()) {
    for (CellCode block = 0; block < 512; ++block) {
      if (tile.block[block] == 0) continue;
      const CellBlock& bits = cells.free(tile.block[block]);
      for (CellCode cell = 0; cell < 512; ++cell) {
        if ((bits.words[cell >> 6] >> (cell & 63) & 1) != 0) {
          codes.insert(tile.code << 18 | block << 9 | cell);
        }
      }
    }
  }
  return codes;
}

void add_ray(const CellGrid& grid, const Place& origin, const Place& end, RayBatch& batch) {
  CellKey from{}, to{};
  ASSERT_TRUE(grid.find_key(origin, from) && grid.find_key(end, to));
  std::uint32_t steps = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    steps += static_cast<std::uint32_t>(std::abs(int{to[axis]} - int{from[axis]}));
  if (from != to) batch.add({grid, origin, from}, end, steps, code_of(to));
  batch.prepare(grid.resolution);
}

TEST(WalkRays, OracleTheCellsAreThoseOfComputeRayKeys) {
  RandomGenerator random(1);
  const CellGrid grid(0.25);
  const octomap::OcTree tree(0.25);
  octomap::KeyRay keys;
  RayBatch batch;
  ScanCells cells;
  for (int round = 0; round < 3000; ++round) {
    const bool snap = round % 2 == 0;
    const int reach = round % 3 == 0 ? 400 : 10;
    Place origin{}, end{};
    for (float& value : origin) value = test::random_coordinate(random, 0.25, 5, snap);
    for (float& value : end) value = test::random_coordinate(random, 0.25, reach, snap);
    cells.clear();
    add_ray(grid, origin, end, batch);
    walk_rays<Ties::kAsOctomap>(batch, cells);
    EXPECT_EQ(batch.size, 0U);
    ASSERT_TRUE(
        tree.computeRayKeys({origin[0], origin[1], origin[2]}, {end[0], end[1], end[2]}, keys));
    std::set<CellCode> expected;
    for (const octomap::OcTreeKey& key : keys) expected.insert(code_of({key[0], key[1], key[2]}));
    ASSERT_EQ(free_cells(cells), expected) << round;
  }
}

TEST(WalkRays, LiteralTiesGoAlongZThenYThenX) {
  const CellGrid grid(1.0);
  RayBatch batch;
  ScanCells cells;
  constexpr std::uint16_t kMiddle = 32768;
  add_ray(grid, {0.5F, 0.5F, 0.5F}, {1.5F, 1.5F, 1.5F}, batch);
  walk_rays<Ties::kAsOctomap>(batch, cells);
  EXPECT_EQ(free_cells(cells), (std::set<CellCode>{code_of({kMiddle, kMiddle, kMiddle}),
                                                   code_of({kMiddle, kMiddle, kMiddle + 1}),
                                                   code_of({kMiddle, kMiddle + 1, kMiddle + 1})}));
  cells.clear();
  add_ray(grid, {0.5F, 0.5F, 0.5F}, {1.5F, 1.5F, 1.5F}, batch);
  walk_rays<Ties::kFlipped>(batch, cells);
  EXPECT_EQ(free_cells(cells), (std::set<CellCode>{code_of({kMiddle, kMiddle, kMiddle}),
                                                   code_of({kMiddle + 1, kMiddle, kMiddle}),
                                                   code_of({kMiddle + 1, kMiddle + 1, kMiddle})}));
}

TEST(WalkRays, RaysTooShortForTheirLengthEndInTheirFirstCell) {
  const CellGrid grid(0.1);
  RayBatch batch;
  ScanCells cells;
  add_ray(grid, {1e-30F, 1e-30F, 0.05F}, {-1e-30F, -1e-30F, 0.05F}, batch);
  ASSERT_EQ(batch.size, 1U);
  walk_rays<Ties::kAsOctomap>(batch, cells);
  EXPECT_EQ(free_cells(cells), (std::set<CellCode>{code_of({32768, 32768, 32768})}));
}

/// Lanes with random rays, some of which have arrived, or all of which are sure to walk on, if
/// their lengths, some of which are halved, do not end them.
Lanes random_lanes(RandomGenerator& random) {
  const CellGrid grid(0.1);
  Lanes lanes{};
  RayBatch batch;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    Place origin{}, end{};
    for (float& value : origin) value = test::random_coordinate(random, 0.1, 5, lane % 2 == 0);
    for (float& value : end) value = test::random_coordinate(random, 0.1, 40, lane % 2 == 0);
    end[2] += 5.0F;
    add_ray(grid, origin, end, batch);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lanes.crossing[axis][lane] = batch.crossing[axis][lane];
      lanes.spacing[axis][lane] = batch.spacing[axis][lane];
      lanes.step[axis][lane] = batch.step[axis][lane];
    }
    lanes.length[lane] = batch.length[lane];
    lanes.cell[lane] = batch.first[lane];
    lanes.last[lane] = batch.last[lane];
    lanes.word[lane] = std::uint64_t{1} << (batch.first[lane] & 63);
  }
  if (random.below(2) == 0) {
    lanes.alive = static_cast<std::uint16_t>(random.below(65536));
    return lanes;
  }
  lanes.alive = 0xffff;
  lanes.surely_alive = *std::min_element(batch.cells.begin(), batch.cells.begin() + kLanes) - 1;
  if (random.below(2) == 0) lanes.length[random.below(kLanes)] *= 0.5;
  return lanes;
}

using Words = std::multiset<std::pair<CellCode, std::uint64_t>>;

/// All that lanes leave behind.
Words walk_to_end(ChunkWalker walker, const Lanes& start) {
  Lanes lanes = start;
  Words words;
  Marks marks;
  while (lanes.alive != 0) {
    walker(lanes, marks);
    for (std::size_t k = 0; k < marks.size; ++k) words.emplace(marks.cell[k], marks.word[k]);
  }
  return words;
}

/// Random marks, with runs of the same word.
Marks random_marks(RandomGenerator& random) {
  Marks marks;
  marks.size = random.below(kChunk * kLanes + 1);
  CellCode word = 0;
  for (std::size_t k = 0; k < marks.size; ++k) {
    if (random.below(4) == 0) word = random.below(3);
    marks.cell[k] = word << 6 | random.below(64);
    marks.word[k] = std::uint64_t{1} << random.below(64);
  }
  return marks;
}

std::map<CellCode, std::uint64_t> bits_of(const Marks& marks) {
  std::map<CellCode, std::uint64_t> bits;
  for (std::size_t k = 0; k < marks.size; ++k) bits[marks.cell[k] >> 6] |= marks.word[k];
  return bits;
}

TEST(MarkJoiners, InvariantTheBitsOfAllWordsStayAndNeighboursAreJoined) {
  RandomGenerator random(3);
  for (int round = 0; round < 2000; ++round) {
    const Marks marks = random_marks(random);
    for (const MarkJoiner join : mark_joiners()) {
      Marks joined = marks;
      join(joined);
      ASSERT_EQ(bits_of(joined), bits_of(marks)) << round;
      ASSERT_LE(joined.size, marks.size);
      if (marks.size > 100) {
        ASSERT_LT(joined.size, marks.size);
      }
    }
  }
}

TEST(WalkChunk, OracleAllVersionsGiveTheSameBits) {
  const auto& walkers = chunk_walkers<Ties::kAsOctomap>();
  if (walkers.front() == walkers.back()) GTEST_SKIP() << "this processor has one version only";
  RandomGenerator random(2);
  for (int round = 0; round < 200; ++round) {
    const Lanes lanes = random_lanes(random);
    const Words expected = walk_to_end(walkers[2], lanes);
    ASSERT_EQ(walk_to_end(walkers[0], lanes), expected) << round;
    ASSERT_EQ(walk_to_end(walkers[1], lanes), expected) << round;
  }
}

}  // namespace
}  // namespace mrpt_terrain::octree
