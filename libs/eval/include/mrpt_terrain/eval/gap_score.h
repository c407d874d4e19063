// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/scan_truth.h"

namespace mrpt_terrain::eval {

/// When a ditch or drop whose floor was not seen is right.
struct GapRules {
  double grown = 0.5;          ///< metres about a true hole in which its cells are right
  double edge = 1.0;           ///< metres from the edge of the ground; what lies beyond is right
  double least_inside = 0.25;  ///< share of its cells that must lie there
};

/// A described ditch or drop where there is none.
struct FalseGap {
  std::string family;
  std::uint64_t seed = 0;
  std::size_t sweep = 0;
  HoleKind kind = HoleKind::kGap;
  double x = 0.0, y = 0.0;                                          ///< map frame, metres
  double distance = 0.0;                                            ///< from the robot, metres
  double length = 0.0, width = 0.0, depth = 0.0, confidence = 0.0;  ///< as described
};

/// Negative obstacles of the kinds that are told without their floors.
struct GapScore {
  std::array<std::size_t, 4> described{};  ///< per `HoleKind`; those with a floor do not count
  std::vector<FalseGap> wrong;
  void add(const GapScore& other);
};

/// Compares the ditches and drops of one scan with the true holes and the edges of the ground.
/// Family, seed and sweep of those that are wrong are left to the caller.
/// \param T_map_description of the description's grid: of a scan, `truth.T_map_given`
[[nodiscard]] GapScore judge_gaps(const Description& description, const ScanTruth& truth,
                                  const Eigen::Isometry3d& T_map_description,
                                  const GapRules& rules);

}  // namespace mrpt_terrain::eval
