// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/grid_geometry.h"

namespace mrpt_terrain::view {

/// Place in a picture, pixels from its upper left corner.
struct PixelPosition {
  double x = 0.0;
  double y = 0.0;
};

/// Part of the picture that shows the map: x forward is up, y left is left, one scale for both.
struct MapPanel {
  int left = 0;                     ///< pixels
  int top = 0;                      ///< pixels
  int width = 0;                    ///< pixels, extent of the map along y
  int height = 0;                   ///< pixels, extent of the map along x
  double x_min = 0.0, x_max = 0.0;  ///< metres, outer edges of the cells
  double y_min = 0.0, y_max = 0.0;  ///< metres, outer edges of the cells

  [[nodiscard]] double pixels_per_metre() const { return height / (x_max - x_min); }
  [[nodiscard]] PixelPosition pixel_of(Position2 place) const {
    return {left + (y_max - place.y) / (y_max - y_min) * width,
            top + (x_max - place.x) / (x_max - x_min) * height};
  }
};

/// Where everything lies in a top view: title above, two panels of equal scale side by side, each
/// in a column with its caption above and its key below, and a footer.
struct TopViewLayout {
  int width = 0;         ///< of the picture, pixels
  int height = 0;        ///< of the picture, pixels
  int column_width = 0;  ///< of either column, pixels
  int left_column = 0;   ///< left edge of the column of heights
  int right_column = 0;  ///< left edge of the column of classes
  int key_top = 0;       ///< upper edge of colour bar and legend
  int footer_top = 0;
  MapPanel heights;
  MapPanel classes;
};

/// The layout for a map. The panels are as large as fit; the picture shrinks with them when the map
/// is narrow or flat.
/// \param max_width, max_height of the picture, pixels; at least 1200 x 500 are used
[[nodiscard]] TopViewLayout top_view_layout(const GridGeometry& geometry, int max_width,
                                            int max_height);

}  // namespace mrpt_terrain::view
