// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/eval/plane_estimators.h"

namespace mrpt_terrain::peers {

/// How PCL's estimators are run. Iterations (at most 1000) and probability (0.99) are PCL's own
/// defaults.
struct PclOptions {
  /// Off: the plane through the three points of the best sample, as the methods were published.
  /// On: PCL's least-squares refinement over that plane's inliers.
  bool refine = false;
};

/// The plane estimators of PCL's sample_consensus, in the order of the paper's Table 4: "ransac",
/// "lmeds", "msac", "rransac", "mlesac", "prosac".
///
/// PCL draws the same random numbers in every run (seed 12345) or none that can be repeated (the
/// time); here both of its generators are seeded with the seed of each estimate. Two more things
/// differ from a plain call:
/// * RRANSAC tests each hypothesis on one random point first. PCL's default, a tenth of the points
///   all of which must fit, is never passed where there is an outlier in ten, and PCL does not
///   count the hypotheses that fail: it never returns.
/// * PROSAC wants the best points first. Points are sorted by their distance from the plane of
///   their principal components, the only measure of quality that a bare cloud has to offer.
///
/// Switches PCL's messages off, for the whole program.
[[nodiscard]] eval::PlaneEstimators pcl_estimators(const PclOptions& options = {});

/// Version of PCL, such as "1.13.0".
[[nodiscard]] const char* pcl_version();

}  // namespace mrpt_terrain::peers
