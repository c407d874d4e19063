// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/top_view_layout.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::view {
namespace {

// All in pixels.
constexpr int kMargin = 24;
constexpr int kColumnGap = 28;
constexpr int kTitleHeight = 72;
constexpr int kCaptionHeight = 30;
constexpr int kAxisLeft = 58;
constexpr int kAxisBelow = 44;
constexpr int kKeyHeight = 78;
constexpr int kFooterHeight = 52;
constexpr int kLeastColumn = 560;  // below this, the legend would not fit
constexpr int kLeastWidth = 1200;
constexpr int kLeastHeight = 500;

constexpr int kHeightWithoutPanel =
    kTitleHeight + kCaptionHeight + kAxisBelow + kKeyHeight + kFooterHeight;

MapPanel map_extent(const GridGeometry& geometry) {
  MapPanel panel;
  panel.x_min = -geometry.half_length();
  panel.x_max = panel.x_min + geometry.cells_l() * geometry.cell_size();
  panel.y_min = -geometry.half_width();
  panel.y_max = panel.y_min + geometry.cells_w() * geometry.cell_size();
  return panel;
}

int pixels(double metres, double pixels_per_metre) {
  return std::max(1, static_cast<int>(std::lround(metres * pixels_per_metre)));
}

}  // namespace

TopViewLayout top_view_layout(const GridGeometry& geometry, int max_width, int max_height) {
  const int room_x = (std::max(max_width, kLeastWidth) - 2 * kMargin - kColumnGap) / 2 - kAxisLeft;
  const int room_y = std::max(max_height, kLeastHeight) - kHeightWithoutPanel;
  MapPanel panel = map_extent(geometry);
  const double extent_x = panel.x_max - panel.x_min;
  const double extent_y = panel.y_max - panel.y_min;
  const double scale = std::min(room_x / extent_y, room_y / extent_x);
  panel.width = pixels(extent_y, scale);
  panel.height = pixels(extent_x, scale);

  TopViewLayout layout;
  layout.column_width = std::max(kLeastColumn, kAxisLeft + panel.width);
  layout.left_column = kMargin;
  layout.right_column = kMargin + layout.column_width + kColumnGap;
  layout.width = layout.right_column + layout.column_width + kMargin;
  layout.height = kHeightWithoutPanel + panel.height;
  layout.key_top = kTitleHeight + kCaptionHeight + panel.height + kAxisBelow;
  layout.footer_top = layout.key_top + kKeyHeight;
  panel.top = kTitleHeight + kCaptionHeight;
  const int indent = kAxisLeft + (layout.column_width - kAxisLeft - panel.width) / 2;
  panel.left = layout.left_column + indent;
  layout.heights = panel;
  panel.left = layout.right_column + indent;
  layout.classes = panel;
  return layout;
}

}  // namespace mrpt_terrain::view
