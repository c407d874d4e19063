// SPDX-License-Identifier: BSD-3-Clause
#include "reference_loop.h"

#include <algorithm>
#include <limits>

namespace mrpt_terrain::bench {

void reference_loop(const PointsView& points, std::vector<ReferenceCell>& grid) {
  constexpr float kHalf = kReferenceCells * kReferenceCellSize / 2;
  constexpr float kCellsPerMetre = 1 / kReferenceCellSize;
  constexpr ReferenceCell kEmpty{std::numeric_limits<float>::max(),
                                 std::numeric_limits<float>::lowest(), 0.0F, 0};
  grid.assign(std::size_t{kReferenceCells} * kReferenceCells, kEmpty);
  for (std::size_t i = 0; i < points.size; ++i) {
    const float z = points.z[i];
    if (!(z < 1.5F)) continue;
    const float l = (points.x[i] + kHalf) * kCellsPerMetre;
    const float w = (points.y[i] + kHalf) * kCellsPerMetre;
    // Within the range the cast is the floor; std::floor would make the loop half as fast.
    if (!(l >= 0 && l < kReferenceCells && w >= 0 && w < kReferenceCells)) continue;
    const int index = static_cast<int>(l) * kReferenceCells + static_cast<int>(w);
    ReferenceCell& cell = grid[static_cast<std::size_t>(index)];
    // Without branches: comparing and storing would make it half as fast again.
    cell.min = std::min(cell.min, z);
    cell.max = std::max(cell.max, z);
    cell.sum += z;
    ++cell.count;
  }
}

}  // namespace mrpt_terrain::bench
