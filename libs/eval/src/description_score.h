// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/eval/world_score.h"

namespace mrpt_terrain::eval {

/// A description of a scan, or of a map with that scan in it.
struct JudgedDescription {
  const DrivenWorld& world;
  std::size_t sweep;
  const TestScan& scan;
  const Description& description;
  const Eigen::Isometry3d& T_map_description;  ///< of the grid
};

/// Compares the labels of a scan's points, the clusters and the potholes with the truth.
ClusterMatching add_description(const JudgedDescription& judged, const ScoreRules& rules,
                                WorldScore& score);

}  // namespace mrpt_terrain::eval
