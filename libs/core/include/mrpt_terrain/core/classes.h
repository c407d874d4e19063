// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/height_index.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/roughness.h"
#include "mrpt_terrain/core/slope.h"

namespace mrpt_terrain {

/// Thresholds of the classes (paper, Table 1).
struct ClassParams {
  double t_pos = 0.05;                    ///< T_pos, metres
  double t_neg = -0.05;                   ///< T_neg, metres
  double slope_min = 0.0;                 ///< radians; flat clusters below are obstacles
  double slope_max = 0.7853981633974483;  ///< radians; flat clusters above are obstacles
  bool all_features = false;  ///< compute roughness and slope of every cluster (paper, Figs. 9, 10)

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_pos, ParamInfo{"t_pos", "T_pos", "m", 0.0, 10.0,
                                "height index from which a cluster is an obstacle or a slope"});
    visit(self.t_neg, ParamInfo{"t_neg", "T_neg", "m", -10.0, 0.0,
                                "height index down from which a cluster is a pothole"});
    visit(self.slope_min,
          ParamInfo{"slope_min_deg", "", "deg", 0.0, 90.0, "least angle that counts as a slope"});
    visit(self.slope_max,
          ParamInfo{"slope_max_deg", "", "deg", 0.0, 90.0,
                    "greatest angle that counts as a slope; steeper is an obstacle"});
    visit(self.all_features,
          ParamInfo{"all_features", "", "", 0, 0,
                    "computes roughness and slope also where the class does not need them"});
  }
};

/// Class by height index alone: pothole, other, or kNone where roughness has to decide.
[[nodiscard]] TerrainClass class_from_height(const HeightIndex& height, const ClassParams& params);

/// Class by Table 1, in the table's order. A cluster that rises to `t_pos` is a slope only if its
/// roughness and its angle could be computed and both say so; otherwise it is an obstacle.
[[nodiscard]] TerrainClass classify(const HeightIndex& height, const Roughness& roughness,
                                    const Slope& slope, const ClassParams& params);

}  // namespace mrpt_terrain
