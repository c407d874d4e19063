// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/face_slope.h"
#include "mrpt_terrain/core/moments.h"

namespace mrpt_terrain {

/// The plane of a face whose rings have errors of their own, and how uncertain it is.
///
/// Generalised least squares: the errors of the rings on the face are unknowns with a prior, that
/// of `FaceRing::error` and `variance`. What a ring tells by its own course over the face counts as
/// much as its noise permits; that it lies higher or lower than the next one counts as little as
/// the errors of both leave of it.
/// \param face moments of its points
/// \param shared covariance of the ground's plane, which errors share by `FaceRing::shared`
/// \param[in,out] workspace `beams` with their rings, `points`; of the rings `pull`, `information`
/// and `sum` are overwritten, and `parts`
/// \param[in,out] fit the plane and the noise along the beams; its plane and covariance change
void fit_with_errors_of_rings(const Moments& face, const Eigen::Matrix3d& shared,
                              FaceSlopeWorkspace& workspace, BeamPlaneFit& fit);

}  // namespace mrpt_terrain
