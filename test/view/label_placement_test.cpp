// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/label_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace mrpt_terrain::view {
namespace {

constexpr int kSize = 200;

Raster<std::uint8_t> free_picture() { return {kSize, kSize}; }

TEST(LabelPlacement, OverTheThingWhereNothingIsHidden) {
  const auto places = place_labels({{100.0, 60.0, 20.0, 14.0}}, free_picture(), {});
  ASSERT_TRUE(places[0].has_value());
  EXPECT_DOUBLE_EQ(places[0]->left, 90.0);
  EXPECT_DOUBLE_EQ(places[0]->top, 53.0);
}

TEST(LabelPlacement, BesideASmallThingAndOverALargeOne) {
  auto small = free_picture();
  auto large = free_picture();
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const int distance = std::max(std::abs(row - 100), std::abs(column - 100));
      small.at(column, row) = distance <= 6 ? 1 : 0;
      large.at(column, row) = distance <= 90 ? 1 : 0;
    }
  }
  const std::vector<LabelRequest> requests{{100.0, 100.0, 20.0, 14.0}};
  const auto beside = place_labels(requests, small, {});
  ASSERT_TRUE(beside[0].has_value());
  EXPECT_FALSE(beside[0]->overlaps({94.0, 94.0, 13.0, 13.0}));
  const auto over = place_labels(requests, large, {});
  ASSERT_TRUE(over[0].has_value());
  EXPECT_DOUBLE_EQ(over[0]->left, 90.0);
}

TEST(LabelPlacement, NoLabelOverlapsAnotherOrAReservedBoxOrLeavesThePicture) {
  std::vector<LabelRequest> requests;
  for (int k = 0; k < 60; ++k) {
    requests.push_back({std::fmod(37.0 * k, kSize), std::fmod(53.0 * k, kSize), 24.0, 15.0});
  }
  const Box reserved{80.0, 80.0, 40.0, 40.0};
  const auto places = place_labels(requests, free_picture(), {reserved});
  ASSERT_EQ(places.size(), requests.size());
  int placed = 0;
  for (std::size_t a = 0; a < places.size(); ++a) {
    if (!places[a]) continue;
    ++placed;
    EXPECT_FALSE(places[a]->overlaps(reserved));
    EXPECT_GE(places[a]->left, 0.0);
    EXPECT_LE(places[a]->top + places[a]->height, kSize);
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_FALSE(places[b] && places[a]->overlaps(*places[b])) << a << " and " << b;
    }
  }
  EXPECT_GE(placed, 30) << "labels of 360 pixels each into 40000 pixels";
}

TEST(LabelPlacement, TheFirstComesFirstAndTheLastGoesWithout) {
  std::vector<LabelRequest> requests(200, LabelRequest{100.0, 100.0, 30.0, 15.0});
  const auto places = place_labels(requests, free_picture(), {});
  ASSERT_TRUE(places.front().has_value());
  EXPECT_DOUBLE_EQ(places.front()->left, 85.0);
  EXPECT_FALSE(places.back().has_value());
}

}  // namespace
}  // namespace mrpt_terrain::view
