// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Form of the height-difference kernel, which the paper shows only as a figure.
enum class GroundKernel : std::uint8_t {
  kMeanDifference,  ///< centre +1, neighbours -1/8: metres above the mean of the neighbours
  kSumDifference,   ///< centre +8, neighbours -1: eight times that
};
constexpr EnumNames<GroundKernel, 2> enum_names(GroundKernel) {
  return {{{GroundKernel::kMeanDifference, "mean_difference"},
           {GroundKernel::kSumDifference, "sum_difference"}}};
}

/// Thresholds of the ground segmentation (paper, eqs. 1 and 2).
struct GroundParams {
  double t_diff = 0.05;  ///< T_diff, metres
  double t_high = 0.05;  ///< T_high, metres
  double t_low = -0.05;  ///< T_low, metres
  GroundKernel kernel = GroundKernel::kMeanDifference;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_diff, ParamInfo{"t_diff", "T_diff", "m", 0.001, 10.0,
                                 "height difference from which a cell is not ground"});
    visit(self.t_high, ParamInfo{"t_high", "T_high", "m", 0.0, 10.0,
                                 "lowest height from which a cell is not ground"});
    visit(self.t_low, ParamInfo{"t_low", "T_low", "m", -10.0, 0.0,
                                "lowest height down to which a cell is ground"});
    visit(self.kernel,
          ParamInfo{"kernel", "w(s,t)", "", 0, 0, "weights of the height-difference kernel"});
  }
};

/// Which rule took a cell out of the ground; the first that applies, in this order.
enum class GroundRule : std::uint8_t {
  kGround = 0,  ///< none: the cell is in C_G
  kDifference,  ///< eq. 1: h_diff >= T_diff
  kHigh,        ///< eq. 1: h_min >= T_high
  kLow,         ///< eq. 1: h_min <= T_low
  kKernel,      ///< eq. 2
};

/// C_G and C_N of the paper. Cells without points are in neither.
struct GroundSegmentation {
  std::vector<GroundRule> rule;  ///< per slot; kGround = C_G, everything else = C_N
  std::vector<float> h_mean;  ///< per slot, metres: mean height, raised by eq. 2 where it says so

  [[nodiscard]] bool is_ground(std::size_t slot) const { return rule[slot] == GroundRule::kGround; }
};

/// Scratch memory of `segment_ground`.
struct GroundWorkspace {
  std::vector<std::uint8_t> ground;  ///< per CellId: in C_G after eq. 1
};

/// Splits the observed cells into ground and non-ground: eq. 1, then the height-difference kernel
/// of eq. 2 on ground cells whose eight neighbours are ground. Eq. 2 sees the C_G that eq. 1 left,
/// for all cells at once, so that the result does not depend on the order of the cells; a cell it
/// removes gets h_mean = max(h_mean, T_high).
void segment_ground(const ElevationGrid& grid, const GroundParams& params,
                    GroundWorkspace& workspace, GroundSegmentation& result);

}  // namespace mrpt_terrain
