// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/points.h"

/// \file
/// Planes fitted to points whose noise lies along the beams that measured them.
///
/// A LiDAR measures the range along a known direction d, so that a point's error is sigma * d, not
/// a sphere about it. Its distance e = n . p + offset from a plane with normal n then has the
/// standard deviation sigma * |n . d|: points that are seen at a grazing angle lie close to the
/// plane and weigh much. The fit is the maximum likelihood estimate under this noise, with Tukey's
/// weights against outliers. Its Jacobian is taken where the *beam* meets the plane, not at the
/// measured point, which would bias the estimate (errors in variables). A share `kAcrossBeam` of
/// the noise is taken to be isotropic, so that planes through the sensor, which no beam meets, are
/// no special case.
namespace mrpt_terrain {

/// Where the beams of a scan start: one place for all, or one of several for each point (a moving
/// sensor). Borrowed, like `PointsView`.
struct BeamOrigins {
  const std::array<float, 3>* origins = nullptr;  ///< frame of the points, metres; null: unknown
  const std::uint32_t* origin_of = nullptr;       ///< per point: its origin; null: all the first
  /// Points from this number on are remembered from earlier scans: they lie on no ring, and `of`
  /// gives them the first origin.
  std::size_t measured = std::numeric_limits<std::size_t>::max();
  [[nodiscard]] bool known() const { return origins != nullptr; }
  [[nodiscard]] bool is_measured(std::size_t point) const { return point < measured; }
  [[nodiscard]] const std::array<float, 3>& of(std::size_t point) const {
    return origins[origin_of == nullptr || point >= measured ? 0 : origin_of[point]];
  }
};

/// Points about a centre with the directions of their beams. The arrays are as long as the greatest
/// number of points so far, rounded up to a multiple of `kPadding`.
struct BeamPoints {
  static constexpr std::size_t kPadding = 8;
  std::size_t size = 0;
  std::vector<float> x, y, z;     ///< metres
  std::vector<float> dx, dy, dz;  ///< unit, from the sensor to the point
  std::vector<float> count;       ///< measured points that this one is the mean of; 0: left out

  /// Changes the number of points; new ones mean nothing until `set`.
  void resize(std::size_t n);

  /// Writes entry k: the point about `centre` and the beam from `origin` to it, which
  /// `normalise_beams` has to turn into a direction. The point counts.
  void set(std::size_t k, const Eigen::Vector3f& point, const std::array<float, 3>& origin,
           const Eigen::Vector3f& centre) {
    x[k] = point.x() - centre.x();
    y[k] = point.y() - centre.y();
    z[k] = point.z() - centre.z();
    dx[k] = point.x() - origin[0];
    dy[k] = point.y() - origin[1];
    dz[k] = point.z() - origin[2];
    count[k] = 1.0F;
  }

  /// Gives the beams of the points from number `begin` on unit length.
  void normalise_beams(std::size_t begin = 0);
};

/// Share of the noise along the beam that is taken to act in every direction too: the width of the
/// beam, the grain of the surface.
inline constexpr double kAcrossBeam = 0.03;
/// Tukey's constant: residuals beyond this many standard deviations do not count. At 6 the
/// estimate's variance is 1 % above that of least squares if there are no outliers.
inline constexpr double kTukey = 6.0;

/// Plane normal . p + offset = 0 about the centre of the points.
struct BeamPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double offset = 0.0;                                ///< metres
};

/// Result of a fit.
struct BeamPlaneFit {
  bool ok = false;  ///< false: the points do not span a plane, or none is near the start
  /// Whether the last step turned the plane by no more than its standard deviation. Where it did
  /// not, the plane is still on its way and the covariance means nothing.
  bool converged = false;
  BeamPlane plane;
  double range_sigma = 0.0;  ///< standard deviation along the beam, metres
  std::int32_t inliers = 0;  ///< points that counted
  /// Covariance of the normal, rad^2: singular along the normal itself.
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
};

/// Improves a plane by Gauss-Newton steps.
/// \param start plane near the points
/// \param range_sigma first guess of the noise along the beam, metres, > 0; estimated anew in
/// every step
/// \param least_sigma the estimate of the noise does not fall below this, metres
/// \param steps at least 1
/// \param stride only every so many blocks of eight points are looked at
[[nodiscard]] BeamPlaneFit fit_beam_plane(const BeamPoints& points, const BeamPlane& start,
                                          double range_sigma, double least_sigma, int steps,
                                          std::size_t stride = 1);

/// For every point the cell in which its beam meets a plane; for beams along the plane the cell of
/// the plane's nearest point.
/// \param centre of the points, in the frame of the grid
/// \param ground plane about the same centre; points that meet the plane closer to it than
/// `least_height`, metres, get cell 0, as do points outside the grid
/// \param stride only every so many blocks of eight points are looked at, as by fit_beam_plane
/// \param[out] cells CellId per point, filled up like the arrays of `points`
void find_meeting_cells(const BeamPoints& points, const BeamPlane& plane, const BeamPlane& ground,
                        double least_height, const GridGeometry& geometry,
                        const Eigen::Vector3d& centre, std::size_t stride,
                        std::vector<std::int32_t>& cells);

/// Noise along the beam from the median of the absolute residuals of every `stride`-th point,
/// metres; robust against up to half of them being outliers.
[[nodiscard]] double median_range_sigma(const BeamPoints& points, const BeamPlane& plane,
                                        std::size_t stride, std::vector<float>& scratch);

}  // namespace mrpt_terrain
