// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain::bench {

/// The named reference of all speed claims: the least that any elevation map has to do.
/// One pass over the points with z < 1.5 m that computes the cell (floor, range check) and updates
/// a 16-byte cell of a 500 x 500 grid of 0.2 m cells; the grid is cleared first. No pose, no vector
/// intrinsics.
struct ReferenceCell {
  float min;
  float max;
  float sum;
  std::int32_t count;
};
static_assert(sizeof(ReferenceCell) == 16);

inline constexpr int kReferenceCells = 500;
inline constexpr float kReferenceCellSize = 0.2F;

void reference_loop(const PointsView& points, std::vector<ReferenceCell>& grid);

}  // namespace mrpt_terrain::bench
