// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/scan_truth.h"
#include "mrpt_terrain/eval/support_score.h"

namespace mrpt_terrain::eval {

/// Which holes have to be found, and what finding them is.
struct PotholeRules {
  double width_min = 0.3, width_max = 1.0;   ///< of the shorter side, metres
  double depth_min = 0.05, depth_max = 0.2;  ///< metres
  std::size_t deep_returns = 10;             ///< more than half the depth below the rim
  std::size_t rings = 2;                     ///< that they come from
  double depth_in_sigmas = 5.0;              ///< of the noise of a range, at the hole's distance
  double grown = 0.3;                        ///< metres about a hole in which a pothole is right
  double least_inside = 0.25;                ///< share of a pothole's cells that must lie there
};

/// Upper edges of the bins of distance in the curves of detection, metres; one more lies beyond.
inline constexpr std::array<double, 8> kHoleEdges{2, 3, 4, 5, 6, 8, 10, 15};
inline constexpr std::size_t kHoleBins = kHoleEdges.size() + 1;

/// Whether width and depth of a hole are within the rules.
[[nodiscard]] bool is_right_size(const TrueThing& hole, const PotholeRules& rules);

/// A true hole in one scan.
struct HoleView {
  std::int32_t thing = kNoThing;  ///< index into ScanTruth::things
  double distance = 0.0;          ///< of its centre from the robot, horizontal, metres
  std::size_t returns = 0;        ///< from floor and walls
  std::size_t deep = 0;           ///< of these, more than half the depth below the rim
  std::size_t rings = 0;          ///< that the deep ones come from
  bool right_size = false;        ///< width and depth within the rules
  bool due = false;               ///< of the right size and seen well enough: has to be found
  bool found = false;             ///< a described pothole lies at it
};

/// A described pothole where there is none.
struct FalsePothole {
  std::string family;
  std::uint64_t seed = 0;
  std::size_t sweep = 0;
  double x = 0.0, y = 0.0;  ///< mean of its cells, map frame, metres
  double distance = 0.0;    ///< from the robot, metres
  std::int32_t cells = 0, points = 0;
  double h_min = 0.0, h_max = 0.0;  ///< as described, metres
  std::string at;  ///< type of the thing that most of its points come from, or "ground"
};

/// Cells of described potholes as places of the map, a row per thing of the description.
struct PotholePlaces {
  std::vector<std::vector<Eigen::Vector2d>> places;  ///< empty where the thing is no pothole
};
[[nodiscard]] PotholePlaces places_of_potholes(const Description& description,
                                               const Eigen::Isometry3d& T_map_given);

/// Whether a described pothole lies at a hole.
[[nodiscard]] bool is_found(const TrueThing& hole, const PotholePlaces& potholes,
                            const PotholeRules& rules);

/// All holes of a scan of which there is at least one return, and whether they were found.
[[nodiscard]] std::vector<HoleView> look_at_holes(const PointsView& points, const ScanTruth& truth,
                                                  const PotholePlaces& potholes,
                                                  const PotholeRules& rules);

/// Potholes of which less than `least_inside` lies within `grown` of a true hole. Family, seed and
/// sweep are left to the caller.
[[nodiscard]] std::vector<FalsePothole> false_potholes(const Description& description,
                                                       const ScanTruth& truth,
                                                       const PotholePlaces& potholes,
                                                       const PotholeRules& rules);

/// Side of the cells in which observed ground is measured, metres.
inline constexpr double kAreaCell = 0.2;
/// Square metres of true ground that a scan shows within the description's grid: area of the cells
/// of `kAreaCell` with at least one point on ground.
[[nodiscard]] double observed_ground(const PointsView& points, const ScanTruth& truth,
                                     const std::vector<UnknownReason>& reasons);

struct PotholeScore {
  Share found;                          ///< of the holes that are due, each scan apart
  Share found_small;                    ///< of those of the right size, however well they are seen
  Share found_other;                    ///< of holes of other sizes with enough deep returns
  std::array<Share, kHoleBins> due_at;  ///< by distance, found of those that are due
  std::array<Share, kHoleBins> small_at;  ///< by distance, found of those of the right size
  double ground = 0.0;                    ///< observed, square metres, each scan apart
  std::vector<FalsePothole> wrong;
  Share ahead;  ///< holes on the path found in time, see world_scans.h
  void add(const PotholeScore& other);
  /// False potholes per 1000 square metres; NaN without ground.
  [[nodiscard]] double wrong_per_1000() const;
};
void add_holes(const std::vector<HoleView>& holes, const PotholeRules& rules, PotholeScore& score);

}  // namespace mrpt_terrain::eval
