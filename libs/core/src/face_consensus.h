// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "mrpt_terrain/core/face_slope.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {

/// Points that a first plane is sought in.
inline constexpr std::size_t kConsensusSize = 256;
/// Points may be so far from a first plane, along their beams, metres: three standard deviations
/// of range noise and errors of rings.
inline constexpr float kAlongBeam = 0.06F;

/// Distance from a plane up to which points may be on it, metres: noise lies along the beams.
/// \param normal unit, of the plane
/// \param beam unit, mean direction of the beams
[[nodiscard]] float seed_distance(const Eigen::Vector3f& normal, const Eigen::Vector3f& beam,
                                  const BeamSlopeParams& params);

/// The best of random planes, by truncated squared distances (MSAC, Torr and Zisserman 2000).
/// \param workspace its sample `x`, `y`, `z` of at least three points
/// \param beam mean direction of the beams
/// \param steepest inclination that is permitted, radians
/// \return nothing if all planes were too steep, or none was spanned
[[nodiscard]] std::optional<BeamPlane> consensus_plane(const FaceSlopeWorkspace& workspace,
                                                       const Eigen::Vector3f& beam,
                                                       const BeamSlopeParams& params,
                                                       double steepest, RandomGenerator& random);

}  // namespace mrpt_terrain
