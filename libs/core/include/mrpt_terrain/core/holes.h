// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What counts as a hole in the ground: pothole or ditch.
struct HoleParams {
  double least_depth = 0.03;  ///< metres below the rim from which a cell may belong to a hole
  double mean_depth = 0.035;  ///< metres: least depth of a hole
  int least_points = 6;       ///< fewest points in it
  double rim_depth = 0.12;    ///< greatest spread of the rim about its plane, over the depth
  double rim_sigma = 0.009;   ///< metres: or this, whichever is greater
  double wall_share = 1.5;    ///< most points between rim and floor, over those on the floor
  double widest = 3.0;        ///< metres: greatest extent across

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.least_depth, ParamInfo{"least_depth", "", "m", 0.005, 5.0,
                                      "depth from which a cell may belong to a hole"});
    visit(self.mean_depth, ParamInfo{"mean_depth", "", "m", 0.005, 5.0,
                                     "least depth of a hole, which a fifth of its points exceed"});
    visit(self.least_points,
          ParamInfo{"least_points", "", "", 1, 1000000, "holes of fewer points are left out"});
    visit(self.rim_depth, ParamInfo{"rim_depth", "", "", 0.0, 1.0,
                                    "greatest spread of the rim about its plane, over the depth"});
    visit(self.rim_sigma,
          ParamInfo{"rim_sigma", "", "m", 0.0, 1.0, "or this spread, whichever is greater"});
    visit(self.wall_share, ParamInfo{"wall_share", "", "", 0.0, 100.0,
                                     "most points between rim and floor, over those on the floor"});
    visit(self.widest,
          ParamInfo{"widest", "", "m", 0.1, 100.0, "greatest extent of a hole across"});
  }
};

/// Mean height of the ground about a cell of the rim's level.
struct RimSums {
  float sum = 0.0F, weight = 0.0F;
};

/// Height of the rim at the centre of a cell, and how it changes in it.
struct RimBase {
  float height = 0.0F, gradient_x = 0.0F, gradient_y = 0.0F;
};

/// A point in or around a hole.
struct HolePoint {
  float x, y, z;
  bool in_hole;  ///< in a cell of the hole
};

/// Scratch memory of `find_holes`.
struct HoleWorkspace {
  std::vector<RimSums> sums, around;    ///< per cell of the rim's level
  std::vector<float> height;            ///< per slot of the surface: low height above level 3
  std::vector<RimBase> base;            ///< per slot of the surface
  std::vector<std::uint8_t> candidate;  ///< per slot of the grid
  std::vector<std::int32_t> members;    ///< slots of one hole
  std::vector<std::uint8_t> in_hole;    ///< per slot of the grid: one of the members
  std::vector<HolePoint> points;        ///< in and around the members
  std::vector<float> depths;            ///< of the points in the hole
};

/// Looks for holes. The height of the rim is the mean of the ground within about 1.2 m, which the
/// ground reference, that goes down into holes, is compared with; ground that lies low does not
/// count in it. Cells that lie below the rim, up to two cells apart, are a hole if they are deep,
/// their walls are steep, and an even rim is seen on at least three sides: wide dips of rolling
/// ground have no even rim, the foot of a low step has one on one side only.
/// \param[in,out] cells `rim` is filled in
/// \param[in,out] ground cells of holes become `GroundRule::kLow`
void find_holes(const FieldWorkspace& field, const ElevationGrid& grid, const HoleParams& params,
                HoleWorkspace& workspace, FieldCells& cells, GroundSegmentation& ground);

}  // namespace mrpt_terrain
