// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/height_index.h"

#include <algorithm>
#include <cassert>

namespace mrpt_terrain {

HeightIndex height_index(const ElevationGrid& grid, const GroundSegmentation& ground,
                         IndexRange slots) {
  assert(slots.size() > 0);
  const auto first = static_cast<std::size_t>(*slots.begin());
  float highest = grid.h_max[first];
  float lowest = grid.h_min[first];
  double sum_of_means = 0.0;
  for (const std::int32_t item : slots) {
    const auto slot = static_cast<std::size_t>(item);
    highest = std::max(highest, grid.h_max[slot]);
    lowest = std::min(lowest, grid.h_min[slot]);
    sum_of_means += ground.h_mean[slot];
  }
  HeightIndex result;
  result.h_d = double{highest} - double{lowest};
  result.h_m = sum_of_means / static_cast<double>(slots.size());
  result.h_f =
      result.h_m >= 0.0 ? std::max(result.h_d, result.h_m) : std::min(-result.h_d, result.h_m);
  return result;
}

}  // namespace mrpt_terrain
