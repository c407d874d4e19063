// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cluster_order.h"

#include <gtest/gtest.h>

namespace mrpt_terrain::view {
namespace {

using Numbers = std::vector<std::size_t>;

TEST(ClusterOrder, LargestFirstAndLowerNumberFirstAmongEquals) {
  Description description;
  for (const int cells : {5, 9, 5, 12, 9}) {
    description.things.emplace_back();
    description.things.back().cells = cells;
  }
  EXPECT_EQ(largest_clusters(description, 10), (Numbers{3, 1, 4, 0, 2}));
  EXPECT_EQ(largest_clusters(description, 2), (Numbers{3, 1}));
  EXPECT_EQ(largest_clusters(description, 0), Numbers{});
  EXPECT_EQ(largest_clusters(Description{}, 3), Numbers{});
}

}  // namespace
}  // namespace mrpt_terrain::view
