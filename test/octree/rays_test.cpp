// SPDX-License-Identifier: BSD-3-Clause
#include "rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "octree_scans.h"

namespace mrpt_terrain::octree {
namespace {

/// The end of a ray of OctoMap's `computeUpdate`: point3d's arithmetic.
struct OctomapEnd {
  bool is_short;
  Place place;

  OctomapEnd(const Place& from, const Place& to, double range) : is_short(true), place(to) {
    const octomap::point3d origin(from[0], from[1], from[2]), end(to[0], to[1], to[2]);
    if (range < 0.0 || (end - origin).norm() <= range) return;
    is_short = false;
    const octomap::point3d cut = origin + (end - origin).normalized() * static_cast<float>(range);
    place = {cut.x(), cut.y(), cut.z()};
  }
};

Place random_end(RandomGenerator& random, int round) {
  Place end{};
  const int reach = round % 5 == 0 ? 40000 : 300;  // some beyond all cells
  for (float& value : end) value = test::random_coordinate(random, 0.1, reach, round % 2 == 0);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kGreatest = std::numeric_limits<float>::max();
  const auto axis = static_cast<std::size_t>(round % 3);
  if (round % 17 == 0) end[axis] = std::numeric_limits<float>::quiet_NaN();
  if (round % 19 == 0) end[axis] = -kInfinity;
  if (round % 23 == 0) end[axis] = kGreatest;
  if (round % 29 == 0) end[axis] = round % 2 == 0 ? 3276.8F : -3276.8F;
  return end;
}

// Oracle: one ray at a time, with octomap's vectors.
TEST(EndBatch, OracleEndsAreThoseOfSingleRays) {
  RandomGenerator random(1);
  const CellGrid grid(0.1);
  EndBatch ends;
  int cut = 0, beyond = 0;
  for (const double range : {-1.0, 0.0, 12.5}) {
    for (int batch = 0; batch < 20; ++batch) {
      Place from{};
      for (float& value : from) value = test::random_coordinate(random, 0.1, 5, batch % 2 == 0);
      CellKey from_key{};
      ASSERT_TRUE(grid.find_key(from, from_key));
      std::vector<Place> given;
      ends.size = 0;
      for (int k = 0; k < 37 + batch; ++k) given.push_back(random_end(random, k));
      given.push_back(from);
      for (const Place& end : given) ends.add(end);
      ends.measure({grid, from, from_key}, grid, range);
      for (std::size_t k = 0; k < given.size(); ++k) {
        const Place& end = given[k];
        const bool finite = std::isfinite(end[0]) && std::isfinite(end[1]) && std::isfinite(end[2]);
        ASSERT_EQ((ends.flags[k] & kFiniteEnd) != 0, finite) << k;
        if (!finite) continue;
        const OctomapEnd expected(from, end, range);
        CellKey key{};
        EXPECT_EQ((ends.flags[k] & kEndInRange) != 0, grid.find_key(end, key)) << k;
        ASSERT_EQ((ends.flags[k] & kShort) != 0, expected.is_short) << k;
        const bool in_range = grid.find_key(expected.place, key);
        ASSERT_EQ((ends.flags[k] & kInRange) != 0, in_range) << k;
        cut += expected.is_short ? 0 : 1;
        beyond += in_range ? 0 : 1;
        if (!in_range) continue;
        EXPECT_EQ(ends.end(k), expected.place) << k;
        EXPECT_EQ(ends.code[k], code_of(key)) << k;
        std::uint32_t steps = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          steps += static_cast<std::uint32_t>(std::abs(int{key[axis]} - int{from_key[axis]}));
        }
        EXPECT_EQ(ends.cells[k], steps) << k;
      }
    }
  }
  EXPECT_GT(cut, 500);
  EXPECT_GT(beyond, 100);
}

}  // namespace
}  // namespace mrpt_terrain::octree
