// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/face_slope.h"

namespace mrpt_terrain {

/// Beams further apart in azimuth than this are of different columns, radians: 0.5 deg.
inline constexpr float kColumn = 0.0087F;
/// By how much the elevation of a ring may change from one column to the next if the sensor is
/// tilted, radians: less than half of the narrowest usual beam spacing.
inline constexpr float kRingGap = 0.0026F;

/// Azimuth of a beam that has not been asked for yet.
inline constexpr float kUnknownAzimuth = 10.0F;
/// Azimuth of the beam to a point of the thing, radians. It is asked for several times, and takes
/// long.
[[nodiscard]] float azimuth_of(std::size_t point, FaceSlopeWorkspace& workspace);

/// Adds the beams to points of the ground beside a face to those of the face.
///
/// They lie within a quarter of a right angle beside the face, at about the elevations at which it
/// is seen, and are no part of a thing.
/// \param origin where the beams of the face start, metres
/// \param[in,out] workspace `beams` are those of the face before, and sorted after
void add_beams_beside(const BeamOrigins& origins, const FaceSurroundings& around,
                      const std::array<float, 3>& origin, FaceSlopeWorkspace& workspace);

/// Sorts beams by column, then by elevation.
void sort_beams(FaceSlopeWorkspace& workspace);

/// Gives every beam the number of its ring: that whose elevation was nearest in the columns
/// before. A ring that was not seen for some columns ends.
/// \param[out] rings in the order in which they begin
void follow_beams(std::vector<FaceBeam>& beams, std::vector<FaceRing>& rings);

/// Brings points of rings together in parts of a few columns.
class PartsOfRings {
 public:
  /// \param workspace `rings` are known, `parts` is emptied
  explicit PartsOfRings(FaceSlopeWorkspace& workspace) : workspace_(workspace) {
    workspace.parts.clear();
    workspace.open_parts.assign(workspace.rings.size(), -1);
  }
  /// The part that a beam belongs to, until the next call. Beams come in the order of their
  /// columns.
  [[nodiscard]] RingPart& of(const FaceBeam& beam);

 private:
  FaceSlopeWorkspace& workspace_;
};

/// Estimates the error of each ring from where it meets the ground beside the face, whose plane is
/// estimated with them: least squares with the prior that errors have the standard deviation
/// `ring_sigma`. Rings without ground, and all of them where the ground is uneven, keep their
/// prior: 0 give or take `ring_sigma`.
/// \param around null: nothing is known of the ground
/// \param[in,out] workspace `beams` with their rings; `error`, `variance` and `shared` of `rings`
/// are overwritten
/// \return covariance of the ground's height and gradient, which errors share by `shared`
Eigen::Matrix3d estimate_ring_errors(const PointsView& points, const BeamOrigins& origins,
                                     const FaceSurroundings* around, double ring_sigma,
                                     FaceSlopeWorkspace& workspace);

}  // namespace mrpt_terrain
