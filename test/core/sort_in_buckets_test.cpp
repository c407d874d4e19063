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

}  // namespace
}  // namespace mrpt_terrain
