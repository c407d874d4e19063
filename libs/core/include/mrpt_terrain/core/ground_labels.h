// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/ground_surface.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// How points are told apart by their heights above the ground reference.
struct GroundLabelParams {
  double most = 0.12;        ///< metres: points higher than this are above the ground
  double growth = 0.0015;    ///< and this much more per metre of distance
  double least = 0.03;       ///< metres: points up to this height are ground
  double prior = 0.008;      ///< how many times likelier an object's point is taken to be than seen
  double below = 0.3;        ///< metres: points this far below the reference are below the ground
  double sigma_min = 0.015;  ///< metres: least spread of heights on the ground
  double sigma_max = 0.04;   ///< metres: greatest spread of heights on the ground

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.most, ParamInfo{"most", "", "m", 0.01, 2.0, "higher points are above the ground"});
    visit(self.growth,
          ParamInfo{"growth", "", "m/m", 0.0, 0.1, "and this much more per metre of distance"});
    visit(self.least, ParamInfo{"least", "", "m", 0.0, 2.0, "points up to this height are ground"});
    visit(self.prior, ParamInfo{"prior", "", "", 0.0, 1000.0,
                                "weight of points of objects against those of the ground"});
    visit(self.below, ParamInfo{"below", "", "m", 0.01, 10.0,
                                "points this far below the reference are below the ground"});
    visit(self.sigma_min, ParamInfo{"sigma_min", "", "m", 0.001, 1.0,
                                    "least standard deviation of heights on the ground"});
    visit(self.sigma_max, ParamInfo{"sigma_max", "", "m", 0.001, 1.0,
                                    "greatest standard deviation of heights on the ground"});
  }
};

/// Points of a cell, by height.
struct HeightCounts {
  float ground = 0.0F;          ///< within 6 cm of the reference
  float squares = 0.0F;         ///< sum of their squared heights, m^2
  float object = 0.0F;          ///< 0.1 to 0.5 m above it
  float object_heights = 0.0F;  ///< sum of the heights of these above 0.1 m, metres
};

/// Scratch memory of `label_by_height`.
struct GroundLabelWorkspace {
  std::vector<HeightCounts> counts;  ///< per slot of the surface's cells
};

/// Labels points by their heights above the reference. Heights of ground are normal, those of a
/// thing that stands on it are spread evenly: each cell's threshold is the height at which the two
/// are equally likely, given how many points of both there are in it and, less, in the eight cells
/// around. So the feet of things are told from the ground in which they stand, and where nothing
/// stands, the ground may be rough.
/// \param[out] threshold per slot of the surface's cells: greatest height of ground, metres
/// \param[out] support per point of the surface's cells
void label_by_height(const GroundSurface& surface, const GroundLabelParams& params,
                     GroundLabelWorkspace& workspace, std::vector<float>& threshold,
                     std::vector<Support>& support);

}  // namespace mrpt_terrain
