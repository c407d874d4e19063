// SPDX-License-Identifier: BSD-3-Clause
#include "sort_in_buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

struct Entry {
  std::uint32_t key, value;
};

bool operator==(const Entry& a, const Entry& b) { return a.key == b.key && a.value == b.value; }

bool less(const Entry& a, const Entry& b) {
  return a.key != b.key ? a.key < b.key : a.value < b.value;
}

// Oracle: `std::sort`. Some buckets are empty, some hold many entries, and the memory of the last
// round is used again.
TEST(SortInBuckets, GivesTheOrderOfTheComparison) {
  RandomGenerator random(81, 0);
  std::vector<Entry> scratch;
  std::vector<std::int32_t> next;
  for (const std::size_t n : {0U, 1U, 2U, 1000U, 10U}) {
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < n; ++k) entries.push_back({random.below(70), random.below(9)});
    std::vector<Entry> expected = entries;
    std::sort(expected.begin(), expected.end(), less);
    sort_in_buckets(
        8, [](const Entry& entry) { return std::size_t{entry.key} / 10; }, less, entries, scratch,
        next);
    EXPECT_TRUE(entries == expected) << n;
  }
}

TEST(PutIntoBuckets, KeepsTheOrderWithinABucket) {
  std::vector<Entry> entries{{2, 0}, {0, 1}, {2, 2}, {0, 3}, {3, 4}}, scratch;
  std::vector<std::int32_t> end;
  put_into_buckets(
      4, [](const Entry& entry) { return std::size_t{entry.key}; }, entries, scratch, end);
  EXPECT_TRUE(entries == (std::vector<Entry>{{0, 1}, {0, 3}, {2, 0}, {2, 2}, {3, 4}}));
  end.resize(4);
  EXPECT_EQ(end, (std::vector<std::int32_t>{2, 2, 4, 5}));
}

}  // namespace
}  // namespace mrpt_terrain
