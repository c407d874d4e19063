// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/beam_slope.h"
#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/slope.h"

namespace mrpt_terrain {

/// Direction of a beam to a point on the face, or to one on the ground beside it.
struct FaceBeam {
  std::int32_t column = 0;  ///< of directions
  float elevation = 0.0F;   ///< radians
  std::int32_t point = 0;   ///< number among the points of the thing; of the ground: of the scan
  std::int32_t ring = 0;    ///< number among those that are followed
  bool ground = false;      ///< beside the face
};
/// A ring of the sensor on its way from column to column.
struct FaceRing {
  float elevation = 0.0F;                          ///< in the last column, radians
  std::int32_t column = 0;                         ///< where it was seen last
  bool on_face = false;                            ///< seen on the face
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();  ///< of an error of 1 m on the normal equations
  double error = 0.0;     ///< of its ranges, metres, as far as the ground beside the face tells
  double variance = 0.0;  ///< of the error, if the plane of the ground were known, m^2
  /// How the error follows from that of the plane of the ground.
  Eigen::Vector3d shared = Eigen::Vector3d::Zero();
  double information = 0.0, sum = 0.0;  ///< on the error, and from what is measured
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
};
/// A part of a ring on the ground: means over its points.
struct RingPart {
  std::int32_t ring = 0, number = 0;
  Eigen::Vector3d row = Eigen::Vector3d::Zero();  ///< 1, and the place about the face, metres
  double distance = 0.0;                          ///< from the ground around, metres
  double along = 0.0;                             ///< cosine of beam and normal of the ground
};

/// Lowest and highest beam to a face in a column, radians.
struct ColumnExtent {
  float low, high;
};

/// Scratch memory of `estimate_face_slope`.
struct FaceSlopeWorkspace {
  BeamPoints points;
  std::vector<float> azimuth;  ///< per point: of its beam where that has been asked for, radians
  std::vector<float> x, y, z;  ///< of the sample
  std::vector<std::int32_t> rest;    ///< points that are not on the face
  std::vector<std::uint8_t> beyond;  ///< per point: 1: on another surface
  std::vector<FaceBeam> beams;
  std::vector<ColumnExtent> columns;
  std::vector<FaceBeam> beams_by_column;  ///< while beams are sorted...
  std::vector<std::int32_t> first_beam;   ///< ...and where those of each column begin
  std::vector<FaceRing> rings;
  std::vector<RingPart> parts;
  std::vector<std::int32_t> open_parts;  ///< per ring: its last part
};

/// What lies around a face.
struct FaceSurroundings {
  const FieldWorkspace& field;
  const std::vector<float>& raised;  ///< RaisedGroundWorkspace::height
  BeamPlane ground;                  ///< near the ground around, frame of the scan
  Eigen::Vector3d place;             ///< of the face, roughly
};

/// Slope of the face of a thing that a wheel could stand on: of all planes no steeper than
/// `kSteepestFace`, the one that most of its points lie on.
///
/// Sample consensus (MSAC) among the thing's own points gives a first plane, Gauss-Newton steps
/// with noise along the beams (beam_plane.h) make it the most likely one. The sides of a ramp and
/// what stands on it are left out by Tukey's weights, and what is within the noise of the face but
/// beyond its edges by the planes that it belongs to. Errors that all points of a ring share
/// (`BeamSlopeParams::ring_sigma`) are estimated with the plane: with two or three rings on a face
/// they are most of its error. Where the same rings meet the ground beside the face, that tells a
/// part of them. The covariance is that of what both leave; the direction of a face that is
/// inclined by less than three standard deviations has the standard deviation pi.
///
/// \param members points of the thing
/// \param seed, stream of the sample consensus
/// \param around null: nothing is known of it, and rings keep their errors
/// \return status kNotPlanar where the plane explains less than `BeamSlopeParams::least_share` of
/// the points and is no clear face near the ground, or they scatter by more than `max_scatter`
[[nodiscard]] Slope estimate_face_slope(const PointsView& points, const BeamOrigins& origins,
                                        IndexRange members, const BeamSlopeParams& params,
                                        std::uint64_t seed, std::uint64_t stream,
                                        FaceSlopeWorkspace& workspace,
                                        const FaceSurroundings* around = nullptr);

/// Radians: 45 deg.
inline constexpr double kSteepestFace = 0.78539816339744831;
}  // namespace mrpt_terrain
