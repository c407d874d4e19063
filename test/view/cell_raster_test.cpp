// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cell_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "description_builder.h"

namespace mrpt_terrain::view {
namespace {

/// 2 m along x, 3 m along y, cells of 1 m: 2 rows of 3.
Description small_world() {
  test::DescriptionBuilder builder(2.0, 3.0, 1.0);
  builder.ground({0, 0}, 0.1F).ground({0, 2}, 0.3F).dropped({1, 0}, 0.5F);
  builder.cluster(TerrainClass::kObstacle, {1, 2}, {1, 2}, 0.0F, 1.0F);
  return builder.build();
}

TEST(CellRaster, OnePixelPerCellForwardIsUpAndLeftIsLeft) {
  const auto kinds = kind_raster(small_world(), 3, 2);
  // Upper row: l = 1, from w = 2 on the left to w = 0 on the right.
  EXPECT_EQ(kinds.at(0, 0), CellKind::kObstacle);
  EXPECT_EQ(kinds.at(1, 0), CellKind::kUnobserved);
  EXPECT_EQ(kinds.at(2, 0), CellKind::kDropped);
  EXPECT_EQ(kinds.at(0, 1), CellKind::kGround);
  EXPECT_EQ(kinds.at(1, 1), CellKind::kUnobserved);
  EXPECT_EQ(kinds.at(2, 1), CellKind::kGround);
  const auto heights = height_raster(small_world().grid, 3, 2);
  EXPECT_FLOAT_EQ(heights.at(0, 0), 0.5F);
  EXPECT_TRUE(std::isnan(heights.at(1, 0)));
  EXPECT_FLOAT_EQ(heights.at(0, 1), 0.3F);
  EXPECT_FLOAT_EQ(heights.at(2, 1), 0.1F);
}

TEST(CellRaster, CellsFillTheirSharesOfManyPixels) {
  const auto kinds = kind_raster(small_world(), 30, 20);
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 30; ++column) {
      const auto coarse = kind_raster(small_world(), 3, 2);
      ASSERT_EQ(kinds.at(column, row), coarse.at(column / 10, row / 10)) << column << " " << row;
    }
  }
}

TEST(CellRaster, WhereCellsShareAPixelTheMostDangerousShowsAndHeightsAverage) {
  const auto kinds = kind_raster(small_world(), 1, 1);
  EXPECT_EQ(kinds.at(0, 0), CellKind::kObstacle);
  EXPECT_FLOAT_EQ(height_raster(small_world().grid, 1, 1).at(0, 0),
                  (0.1F + 0.3F + 0.5F + 0.5F) / 4);
}

TEST(CellRaster, EveryCellIsSeenWhenThereAreMoreCellsThanPixels) {
  for (int l = 0; l < 13; ++l) {
    for (int w = 0; w < 17; ++w) {
      test::DescriptionBuilder builder(13.0, 17.0, 1.0);
      builder.ground({l, w}, 0.0F);
      const auto kinds = kind_raster(builder.build(), 5, 7);
      const auto seen = std::count(kinds.values.begin(), kinds.values.end(), CellKind::kGround);
      ASSERT_GE(seen, 1) << l << " " << w;
      ASSERT_LE(seen, 4) << l << " " << w;
    }
  }
}

TEST(CellRaster, OneWildCellDoesNotTakeTheColours) {
  test::DescriptionBuilder builder(10.0, 10.0, 1.0);
  for (int l = 0; l < 10; ++l) {
    for (int w = 0; w < 10; ++w) builder.ground({l, w}, 0.01F * static_cast<float>(10 * l + w));
  }
  builder.ground({0, 0}, -50.0F);
  const HeightRange range = robust_range(builder.build().grid);
  EXPECT_FALSE(range.empty);
  EXPECT_FLOAT_EQ(static_cast<float>(range.lowest), -50.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(range.highest), 0.99F);
  EXPECT_NEAR(range.low, 0.02, 1e-6);   // two of a hundred lie below
  EXPECT_NEAR(range.high, 0.97, 1e-6);  // two lie above
}

TEST(CellRaster, FlatGroundHasARangeAroundIt) {
  test::DescriptionBuilder builder(2.0, 2.0, 1.0);
  builder.ground({0, 0}, 0.25F);
  const HeightRange range = robust_range(builder.build().grid);
  EXPECT_NEAR(range.low, 0.2, 1e-9);
  EXPECT_NEAR(range.high, 0.3, 1e-9);
  EXPECT_TRUE(robust_range(ElevationGrid{}).empty);
}

// Two by two cells, one of them observed: a pixel per cell, and one for all.
TEST(UnseenRaster, ReasonsOfCellsThatWereNotObserved) {
  test::DescriptionBuilder builder(2.0, 2.0, 1.0);
  builder.ground({1, 1}, 0.0F);  // x > 0, y > 0: the upper left pixel
  const Description description = builder.build();
  const GridGeometry& geometry = description.grid.geometry;
  std::vector<UnseenReason> reasons(static_cast<std::size_t>(geometry.array_size()),
                                    UnseenReason::kNoReturn);
  const auto at = [&](CellIndex cell) -> UnseenReason& {
    return reasons[static_cast<std::size_t>(value_of(geometry.id_of(cell)))];
  };
  at({1, 1}) = UnseenReason::kOccluded;  // something was seen, but not the ground
  at({1, 0}) = UnseenReason::kOutOfView;
  at({0, 1}) = UnseenReason::kOccluded;
  const auto raster = unseen_raster(description.grid, reasons, 2, 2);
  EXPECT_EQ(raster.values,
            (std::vector<UnseenReason>{UnseenReason::kSeen, UnseenReason::kOutOfView,
                                       UnseenReason::kOccluded, UnseenReason::kNoReturn}));
  EXPECT_EQ(unseen_raster(description.grid, reasons, 1, 1).values.front(), UnseenReason::kSeen);
  EXPECT_EQ(count_unseen(description.grid, reasons),
            (std::array<std::size_t, kUnseenReasonCount>{1, 1, 1, 1}));
}

}  // namespace
}  // namespace mrpt_terrain::view
