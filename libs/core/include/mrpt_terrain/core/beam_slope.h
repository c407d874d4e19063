// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/slope.h"

namespace mrpt_terrain {

/// Parameters of `slope.method = beam`.
struct BeamSlopeParams {
  int hypotheses = 64;          ///< of the sample consensus that finds the first plane
  double seed_distance = 0.03;  ///< metres from the plane at which its cost stops growing
  double growth = 0.5;          ///< metres: how far the surface is followed beyond the cluster
  double ground_margin = 1.0;   ///< metres: where the local ground plane is taken from
  double least_height = 0.01;   ///< metres above the ground from which points count
  double least_sigma = 0.001;   ///< metres: the noise is never taken to be less
  double least_share = 0.3;     ///< of the cluster's points in cells that the plane explains
  double max_scatter = 0.04;    ///< metres: of the points across the plane, standard deviation
  double ring_sigma = 0.013;    ///< metres: error of a ring that all its points share
  double max_angle_sigma = 0.03490658503988659;  ///< radians: less certain is not trustworthy

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.hypotheses,
          ParamInfo{"hypotheses", "", "", 1, 10000, "planes tried to find the first one"});
    visit(self.seed_distance, ParamInfo{"seed_distance", "", "m", 0.001, 1.0,
                                        "distance from the first plane beyond which all points "
                                        "cost the same"});
    visit(self.growth, ParamInfo{"growth", "", "m", 0.0, 10.0,
                                 "how far the surface is followed into cells called ground"});
    visit(self.ground_margin,
          ParamInfo{"ground_margin", "", "m", 0.0, 20.0,
                    "distance from the cluster up to which cells tell the local ground plane"});
    visit(self.least_height, ParamInfo{"least_height", "", "m", 0.0, 1.0,
                                       "height over the ground plane from which points count"});
    visit(self.least_sigma,
          ParamInfo{"least_sigma", "", "m", 1e-6, 0.1, "least standard deviation of ranges"});
    visit(self.least_share, ParamInfo{"least_share", "", "", 0.0, 1.0,
                                      "share of the cluster's points that the plane must explain"});
    visit(self.max_scatter,
          ParamInfo{"max_scatter", "", "m", 0.001, 1.0,
                    "standard deviation of the points across the plane above which it is none"});
    visit(self.ring_sigma,
          ParamInfo{"ring_sigma", "", "m", 0.0, 1.0,
                    "standard deviation of an error that all points of a ring share (field mode)"});
    visit(self.max_angle_sigma, ParamInfo{"max_angle_sigma_deg", "", "deg", 0.001, 90.0,
                                          "standard deviation of the angle above which it is not "
                                          "trustworthy"});
  }
};

/// What the estimate looks at: the scan, its grid and what was found in it. All borrowed.
struct BeamSlopeInput {
  const PointsView& points;
  const BeamOrigins& origins;
  const ElevationGrid& grid;
  const GroundSegmentation& ground;
  const Clusters& clusters;
  /// Per slot: its points. Rows farther than `beam_slope_reach` from the cluster may be empty.
  const IndexRows& points_of_slot;
  /// Per slot: sums of its points; of a fused grid, those of the scan alone, which may be none.
  const std::vector<MomentSums>& sums;
};

/// Scratch memory of `estimate_beam_slope`; `marks` is zero between calls.
struct BeamSlopeWorkspace {
  BeamPoints sample;
  BeamPoints surface;
  BeamPoints ground;
  std::vector<float> residuals;
  std::vector<std::uint8_t> marks;  ///< per CellId
  std::vector<std::int32_t> cells;  ///< per point of `surface`: where its beam meets the plane
  std::vector<std::int32_t> open;   ///< cells of the flood fill still to be looked at
};

/// Rectangle of cells, corners included.
struct CellBox {
  CellIndex low, high;
};

/// Bounding box of the slots' cells and what lies within `margin` metres of it, cut to the grid.
[[nodiscard]] CellBox cells_around(const ElevationGrid& grid, IndexRange slots, double margin);

/// How far from the cluster's bounding box the estimate may use points, metres.
[[nodiscard]] double beam_slope_reach(const ElevationGrid& grid, const BeamSlopeParams& params);

/// Slope of a cluster by the plane that is most likely if range noise acts along the beams.
///
/// 1. Sample consensus (MSAC) on some of the cluster's points gives a first plane, Gauss-Newton
///    steps (beam_plane.h) refine it.
/// 2. The local ground plane is fitted to the mean points of the ground cells around.
/// 3. The surface is made up of the cells whose points agree with the plane in mean and scatter:
///    those of the cluster, and cells called ground next to them (the foot of a ramp is lower than
///    T_high) as far as plane and ground can be told apart there. Cells with an object on them drop
///    out as a whole.
/// 4. Points are selected again by where their beam *meets the plane*, which their own noise does
///    not change: within the surface and above the ground. Selecting by the measured position
///    would favour points that err towards the surface.
/// 5. The plane is fitted to these points; its covariance gives the uncertainties, which cover
///    independent noise of the ranges, not errors of the pose or of the sensor's calibration.
/// \param cluster number of the cluster
/// \param seed of the sample consensus
[[nodiscard]] Slope estimate_beam_slope(const BeamSlopeInput& input, std::size_t cluster,
                                        const BeamSlopeParams& params, std::uint64_t seed,
                                        BeamSlopeWorkspace& workspace);

}  // namespace mrpt_terrain
