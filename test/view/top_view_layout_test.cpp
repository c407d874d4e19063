// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/top_view_layout.h"

#include <gtest/gtest.h>

namespace mrpt_terrain::view {
namespace {

struct MapSize {
  double length, width, cell_size;
};

class TopViewLayouts : public testing::TestWithParam<MapSize> {
 protected:
  const TopViewLayout layout_ =
      top_view_layout({GetParam().length, GetParam().width, GetParam().cell_size}, 1600, 920);
};

TEST_P(TopViewLayouts, PanelsAreInsideSideBySideAndOfEqualScale) {
  EXPECT_LE(layout_.width, 1600);
  EXPECT_LE(layout_.height, 920);
  EXPECT_GE(layout_.heights.left, layout_.left_column);
  EXPECT_LE(layout_.heights.left + layout_.heights.width, layout_.right_column);
  EXPECT_GT(layout_.classes.left, layout_.right_column);
  EXPECT_LT(layout_.classes.left + layout_.classes.width, layout_.width);
  EXPECT_LT(layout_.classes.top + layout_.classes.height, layout_.key_top);
  EXPECT_EQ(layout_.heights.width, layout_.classes.width);
  EXPECT_EQ(layout_.heights.height, layout_.classes.height);
  // Panels are whole pixels: half a pixel of the shorter side.
  const MapPanel& panel = layout_.classes;
  const double across = panel.width / (panel.y_max - panel.y_min);
  EXPECT_NEAR(across / panel.pixels_per_metre(), 1.0, 0.6 / panel.width + 0.6 / panel.height);
}

TEST_P(TopViewLayouts, OneSideOfThePanelUsesTheRoomThereIs) {
  const MapPanel& panel = layout_.classes;
  EXPECT_TRUE(layout_.height >= 915 || layout_.width >= 1590)
      << panel.width << " x " << panel.height;
}

TEST_P(TopViewLayouts, ForwardIsUpAndLeftIsLeft) {
  const MapPanel& panel = layout_.classes;
  const PixelPosition origin = panel.pixel_of({0.0, 0.0});
  EXPECT_LT(panel.pixel_of({0.4 * GetParam().length, 0.0}).y, origin.y);
  EXPECT_LT(panel.pixel_of({0.0, 0.4 * GetParam().width}).x, origin.x);
  EXPECT_DOUBLE_EQ(panel.pixel_of({panel.x_max, panel.y_max}).x, panel.left);
  EXPECT_DOUBLE_EQ(panel.pixel_of({panel.x_max, panel.y_max}).y, panel.top);
  EXPECT_DOUBLE_EQ(panel.pixel_of({panel.x_min, panel.y_min}).x, panel.left + panel.width);
  EXPECT_DOUBLE_EQ(panel.pixel_of({panel.x_min, panel.y_min}).y, panel.top + panel.height);
}

INSTANTIATE_TEST_SUITE_P(Maps, TopViewLayouts,
                         testing::Values(MapSize{5, 5, 0.05}, MapSize{100, 100, 0.2},
                                         MapSize{200, 200, 0.2}, MapSize{40, 12, 0.1},
                                         MapSize{12, 60, 0.1}, MapSize{5, 5, 0.3}));

TEST(TopViewLayout, TheEdgesAreThoseOfTheCells) {
  // 5 m in cells of 0.3 m: 17 cells, 5.1 m.
  const MapPanel panel = top_view_layout({5.0, 5.0, 0.3}, 1600, 920).heights;
  EXPECT_DOUBLE_EQ(panel.x_min, -2.5);
  EXPECT_NEAR(panel.x_max, 2.6, 1e-9);
}

}  // namespace
}  // namespace mrpt_terrain::view
