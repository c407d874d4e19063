// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_labels.h"

#include <algorithm>
#include <cmath>

#include "nine_cells.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr float kGroundBand = 0.06F;                    // metres
constexpr float kObjectLow = 0.1F, kObjectHigh = 0.5F;  // metres
constexpr float kNeighbourShare = 0.3F;                 // of a point in a cell beside it
// Range of heights over which a thing is taken to be evenly spread, from kObjectLow on, metres.
constexpr float kLeastExtent = 0.05F, kMostExtent = kObjectHigh - kObjectLow;
// What is taken to be seen besides the points: a third of a point, and one of 2 cm spread.
constexpr float kPriorPoints = 0.3F;
constexpr float kPriorSigma = 0.02F;

HeightCounts count_heights(const float* height, std::size_t points) {
  HeightCounts counts;
  for (std::size_t i = 0; i < points; ++i) {
    const float h = height[i];
    const float ground = std::abs(h) < kGroundBand ? 1.0F : 0.0F;
    counts.ground += ground;
    counts.squares += ground * h * h;
    const float object = (h > kObjectLow) & (h < kObjectHigh) ? 1.0F : 0.0F;
    counts.object += object;
    counts.object_heights += object * (h - kObjectLow);
  }
  return counts;
}

HeightCounts counts_around(const CellPoints& cells, const std::vector<HeightCounts>& counts,
                           std::size_t slot) {
  HeightCounts around;
  for_nine_cells(cells, slot, [&](std::int32_t row, std::int32_t column, std::size_t other) {
    const HeightCounts& from = counts[other];
    const float share = row == 0 && column == 0 ? 1.0F : kNeighbourShare;
    around.ground += share * from.ground;
    around.squares += share * from.squares;
    around.object_heights += share * from.object_heights;
    around.object += share * from.object;
  });
  return around;
}

// Height at which ground, normal about 0, and objects, even over their band, are equally dense.
float threshold_of(const HeightCounts& counts, const GroundLabelParams& params, float most) {
  if (counts.object == 0.0F || params.prior == 0.0) return most;
  const float extent =
      std::clamp(2.0F * counts.object_heights / counts.object, kLeastExtent, kMostExtent);
  const float own = std::max(counts.ground - counts.object * kGroundBand / extent, 0.0F);
  const float variance =
      (counts.squares + kPriorSigma * kPriorSigma) / (counts.ground + kPriorPoints + 1.0F);
  const float sigma = std::clamp(std::sqrt(variance), static_cast<float>(params.sigma_min),
                                 static_cast<float>(params.sigma_max));
  constexpr float kRootOfTwoPi = 2.5066283F;
  const float ground = (own + kPriorPoints) / (sigma * kRootOfTwoPi);
  const float object = static_cast<float>(params.prior) * counts.object / kMostExtent;
  const float height = ground > object ? sigma * std::sqrt(2.0F * std::log(ground / object)) : 0.0F;
  return std::min(most, std::max(height, static_cast<float>(params.least)));
}

// One selection after the other, without branches: which points are ground cannot be predicted.
MRPT_TERRAIN_WIDE_REGISTERS
void label_points(const float* height, const std::int32_t* first, const float* threshold,
                  std::size_t slots, float below, Support* support) {
  for (std::size_t slot = 0; slot < slots; ++slot) {
    for (std::int32_t i = first[slot]; i < first[slot + 1]; ++i) {
      const Support on_or_above = height[i] <= threshold[slot] ? Support::kGround : Support::kAbove;
      support[i] = height[i] < below ? Support::kBelow : on_or_above;
    }
  }
}

}  // namespace

void label_by_height(const GroundSurface& surface, const GroundLabelParams& params,
                     GroundLabelWorkspace& workspace, std::vector<float>& threshold,
                     std::vector<Support>& support) {
  const CellPoints& cells = surface.cells;
  workspace.counts.resize(cells.occupied() + 1);
  workspace.counts.back() = {};  // of empty cells
  threshold.resize(cells.occupied());
  support.resize(surface.height.size());
  const auto first_of = [&cells](std::size_t slot) {
    return static_cast<std::size_t>(cells.first[slot]);
  };
  for (std::size_t slot = 0; slot < cells.occupied(); ++slot) {
    workspace.counts[slot] =
        count_heights(surface.height.data() + first_of(slot), first_of(slot + 1) - first_of(slot));
  }
  for (std::size_t slot = 0; slot < cells.occupied(); ++slot) {
    const float x = cells.lattice.centre(cells.cell[slot].row);
    const float y = cells.lattice.centre(cells.cell[slot].column);
    const float most = static_cast<float>(params.most) +
                       static_cast<float>(params.growth) * std::sqrt(x * x + y * y);
    threshold[slot] = threshold_of(counts_around(cells, workspace.counts, slot), params, most);
  }
  label_points(surface.height.data(), cells.first.data(), threshold.data(), cells.occupied(),
               -static_cast<float>(params.below), support.data());
}

}  // namespace mrpt_terrain
