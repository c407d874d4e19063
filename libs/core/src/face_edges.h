// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/face_slope.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {

/// Finds the points within the noise of a face that belong to what joins on to it: the platform
/// behind a ramp, its sides, its other face, a wall that it leads to.
///
/// Near an edge the next surface is off the plane of the face by less than noise, and always to the
/// same side: along a whole edge, that turns the plane. Up to four planes are sought in the points
/// that are not on the face. Where such a plane and the face meet in a ridge, a beam ends at
/// whichever of the two it meets last; in a valley, at whichever it meets first. That does not
/// depend on the measured range, so that the points which stay have the noise that they should
/// have.
/// \param fit of the face
/// \param beam mean direction of the beams
/// \param[in,out] workspace `points`, `beams` of the face; `beyond` has 0 per point before, and 1
/// for those that belong to another surface after; `points.count` is 1 for those of the face, else
/// 0
void find_edges(const BeamPlaneFit& fit, const Eigen::Vector3f& beam, const BeamSlopeParams& params,
                RandomGenerator& random, FaceSlopeWorkspace& workspace);

}  // namespace mrpt_terrain
