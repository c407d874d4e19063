// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mrpt_terrain/view/raster.h"

namespace mrpt_terrain::view {

/// Rectangle in pixels.
struct Box {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] bool overlaps(const Box& other) const {
    return left < other.left + other.width && other.left < left + width &&
           top < other.top + other.height && other.top < top + height;
  }
};

/// A label that wants a place near the thing it names.
struct LabelRequest {
  double x = 0.0;  ///< the thing, pixels
  double y = 0.0;
  double width = 0.0;  ///< the label, pixels
  double height = 0.0;
};

/// Finds places for labels one after the other (the most important first): inside the picture, over
/// no earlier label and no reserved box, and where they hide little. A label without such a place
/// near its thing gets none.
/// \param busy pixels that a label should rather not hide: 0 free, else how much they matter
[[nodiscard]] std::vector<std::optional<Box>> place_labels(
    const std::vector<LabelRequest>& requests, const Raster<std::uint8_t>& busy,
    const std::vector<Box>& reserved);

}  // namespace mrpt_terrain::view
