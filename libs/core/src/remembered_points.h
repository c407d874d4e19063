// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/describe_fused.h"

namespace mrpt_terrain {

/// Appends, to the points of the last scan, points that stand for what the cells of a window
/// remember beyond it.
///
/// A bin becomes four points with its mean and covariance: mean + L s with L L^T the covariance and
/// s = (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1), the corners of a tetrahedron (the simplex
/// sigma points of Julier 2003, with equal weights). A flat one, as ground is, and one well above
/// the lowest of its cell, as of walls, become two on a diagonal, with its mean and variances. They
/// are kept within the bin's cell and heights. Left out are bins that the scan shows itself: those
/// that it alone has hit, and those that it has hit in cells where `kEnough` of its points lie.
/// Bins below the ground of their cell (`FusedCell::below`) are left out, too, and flat ones that
/// lie a little beside the ground that the scan sees there, if that is so in most cells around.
/// \param measured number of the points of the last scan, which come first
/// \param[in,out] points frame of the window
void append_remembered(const FusedSnapshot& map, const WindowFrame& frame,
                       const FusionParams& params, std::size_t measured,
                       RememberedWorkspace& workspace, Points& points);

}  // namespace mrpt_terrain
