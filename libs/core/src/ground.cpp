// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground.h"

#include <algorithm>
#include <array>

namespace mrpt_terrain {
namespace {

std::size_t at(CellId id) { return static_cast<std::size_t>(value_of(id)); }

// Eq. (1). Thresholds are compared as floats, like the heights, so that a height equal to a
// threshold in the file is equal here too.
GroundRule rule_by_height(float h_diff, float h_min, const GroundParams& params) {
  if (h_diff >= static_cast<float>(params.t_diff)) return GroundRule::kDifference;
  if (h_min >= static_cast<float>(params.t_high)) return GroundRule::kHigh;
  if (h_min <= static_cast<float>(params.t_low)) return GroundRule::kLow;
  return GroundRule::kGround;
}

/// Offsets from a cell to its eight neighbours in arrays over the grid.
std::array<std::int32_t, 8> neighbour_offsets(std::int32_t stride) {
  return {{-stride - 1, -stride, -stride + 1, -1, 1, stride - 1, stride, stride + 1}};
}

// Eq. (2): the kernel's response at a cell with eight ground neighbours.
double kernel_response(const ElevationGrid& grid, std::size_t slot, GroundKernel kernel,
                       const std::array<std::int32_t, 8>& offsets) {
  double neighbours = 0.0;
  for (const std::int32_t offset : offsets) {
    const CellId id{value_of(grid.cell[slot]) + offset};
    neighbours += grid.h_mean[static_cast<std::size_t>(grid.slot_of[at(id)])];
  }
  const double sum = 8.0 * grid.h_mean[slot] - neighbours;
  return kernel == GroundKernel::kSumDifference ? sum : sum / 8.0;
}

}  // namespace

void segment_ground(const ElevationGrid& grid, const GroundParams& params,
                    GroundWorkspace& workspace, GroundSegmentation& result) {
  const std::size_t n = grid.observed();
  result.rule.resize(n);
  result.h_mean.assign(grid.h_mean.begin(), grid.h_mean.end());
  workspace.ground.assign(grid.slot_of.size(), 0);
  for (std::size_t slot = 0; slot < n; ++slot) {
    result.rule[slot] = rule_by_height(grid.h_diff(slot), grid.h_min[slot], params);
    workspace.ground[at(grid.cell[slot])] = result.is_ground(slot) ? 1 : 0;
  }

  const auto offsets = neighbour_offsets(grid.geometry.stride());
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (!result.is_ground(slot)) continue;
    const std::uint8_t* centre = &workspace.ground[at(grid.cell[slot])];
    const bool surrounded =
        std::all_of(offsets.begin(), offsets.end(),
                    [centre](std::int32_t offset) { return centre[offset] != 0; });
    if (!surrounded || kernel_response(grid, slot, params.kernel, offsets) < params.t_diff)
      continue;
    result.rule[slot] = GroundRule::kKernel;
    result.h_mean[slot] = std::max(grid.h_mean[slot], static_cast<float>(params.t_high));
  }
}

}  // namespace mrpt_terrain
