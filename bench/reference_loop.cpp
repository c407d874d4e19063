// SPDX-License-Identifier: BSD-3-Clause
#include "reference_loop.h"

#include <cmath>
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
    const int l = static_cast<int>(std::floor((points.x[i] + kHalf) * kCellsPerMetre));
    const int w = static_cast<int>(std::floor((points.y[i] + kHalf) * kCellsPerMetre));
    if (l < 0 || l >= kReferenceCells || w < 0 || w >= kReferenceCells) continue;
    ReferenceCell& cell = grid[static_cast<std::size_t>(l * kReferenceCells + w)];
    if (z < cell.min) cell.min = z;
    if (z > cell.max) cell.max = z;
    cell.sum += z;
    ++cell.count;
  }
}

}  // namespace mrpt_terrain::bench
