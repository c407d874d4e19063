// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What of the ground stands out of the ground around it: low curbs, flat ramps and the feet of
/// steep ones. A wheel can rest there, so its points are ground, and yet they are part of a thing.
struct RaisedGroundParams {
  double block = 1.6;          ///< metres: a plane is fitted to three by three blocks of this side
  double least_height = 0.03;  ///< metres above the plane from which points may stand out
  double sigmas = 3.0;         ///< and so many standard deviations of the ground about the plane
  double sigma_min = 0.004;    ///< metres: the ground is never taken to be smoother
  double sigma_max = 0.03;     ///< metres: of rougher ground nothing stands out

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.block,
          ParamInfo{"block", "", "m", 0.1, 20.0,
                    "the ground around is a plane in three by three blocks of this side"});
    visit(self.least_height, ParamInfo{"least_height", "", "m", 0.0, 1.0,
                                       "least height above the ground around of what is raised"});
    visit(self.sigmas, ParamInfo{"sigmas", "", "", 0.0, 100.0,
                                 "and so many standard deviations of the ground about its plane"});
    visit(self.sigma_min, ParamInfo{"sigma_min", "", "m", 1e-4, 1.0,
                                    "least standard deviation of the ground about its plane"});
    visit(self.sigma_max, ParamInfo{"sigma_max", "", "m", 1e-4, 1.0,
                                    "where the ground deviates more, nothing is raised"});
  }
};

/// The ground in a block and in those around it: z = height + gradient . (place - centre).
struct GroundAround {
  bool known = false;
  float centre_x = 0.0F, centre_y = 0.0F;
  float height = 0.0F, gradient_x = 0.0F, gradient_y = 0.0F;
  float sigma = 0.0F;  ///< of the ground about the plane, metres
  /// Covariance of height and gradient over sigma^2: rows of the upper triangle.
  float spread[6] = {};

  [[nodiscard]] float height_at(float x, float y) const {
    return height + gradient_x * (x - centre_x) + gradient_y * (y - centre_y);
  }
  /// Variance of `height_at` over sigma^2.
  [[nodiscard]] float leverage_at(float x, float y) const {
    const float u = x - centre_x, v = y - centre_y;
    return spread[0] + 2.0F * (u * spread[1] + v * spread[2]) + u * u * spread[3] +
           2.0F * u * v * spread[4] + v * v * spread[5];
  }
};

/// Samples that a plane is fitted to, about its centre in x and y; a multiple of the lanes that are
/// worked on side by side.
struct GroundWindow {
  std::vector<float> u, v, z;  ///< metres
  std::vector<float> use;      ///< 1, and 0 where the samples end
  std::size_t samples = 0;

  void resize(std::size_t n) {
    for (auto* values : {&u, &v, &z, &use}) values->resize(n);
  }
  void set(std::size_t k, float pu, float pv, float pz, float weight) {
    u[k] = pu;
    v[k] = pv;
    z[k] = pz;
    use[k] = weight;
  }
};

/// Scratch memory of `find_raised_ground`, and what later stages need of it.
struct RaisedGroundWorkspace {
  std::vector<std::int32_t> block;    ///< per slot: in which block it lies
  std::vector<std::int32_t> first;    ///< per block: of its samples; one more at the end
  std::vector<GroundSample> samples;  ///< by block
  GroundWindow window;                ///< of one plane
  std::vector<GroundAround> around;   ///< per block
  /// Per point: how far a raised point of the ground stands above the ground around, metres; 0 for
  /// all others.
  std::vector<float> height;
};

/// Finds the points of the ground that stand above the ground around them.
///
/// In every window of three by three blocks, a plane is fitted to the mean points of the ground of
/// each cell, first by asymmetric least squares (Newey and Powell 1987: points below the plane
/// count 30 times as much, as nothing lies below the ground), then by Tukey's biweight about that.
/// A point is raised if it lies above the plane by `least_height` and by `sigmas` standard
/// deviations of the ground about the plane and of the plane itself. Rolling ground deviates from
/// its plane by more, so that less stands out of it.
/// Cells whose highest point is above the reference, but not above that plane by `least_height`,
/// are `level`: there it is the reference that lies too low, as at the rim of a hole.
/// \param field with the sums that `measure_field_cells` made of the same points
/// \param[in,out] cells `raised`, `raised_low`, `raised_high`, edges and `level` are filled in
void find_raised_ground(const PointsView& points, const FieldWorkspace& field,
                        const ElevationGrid& grid, const GroundSegmentation& ground,
                        const PointSlots& point_slots, const RaisedGroundParams& params,
                        RaisedGroundWorkspace& workspace, FieldCells& cells);

/// The plane of the ground around a place that `find_raised_ground` fitted; null outside the grid.
[[nodiscard]] const GroundAround* ground_around(const GridGeometry& geometry,
                                                const RaisedGroundParams& params,
                                                const RaisedGroundWorkspace& workspace, double x,
                                                double y);

}  // namespace mrpt_terrain
