// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "mrpt_terrain/core/thing_tracker.h"
#include "mrpt_terrain/eval/cluster_score.h"
#include "mrpt_terrain/eval/cost_score.h"
#include "mrpt_terrain/eval/gap_score.h"
#include "mrpt_terrain/eval/identity_score.h"
#include "mrpt_terrain/eval/pothole_score.h"
#include "mrpt_terrain/eval/slope_score.h"
#include "mrpt_terrain/eval/support_score.h"
#include "mrpt_terrain/eval/world_scans.h"

/// \file
/// All metrics of a world, or of many.
namespace mrpt_terrain::eval {

struct WorldScore {
  std::size_t worlds = 0, scans = 0, points = 0;
  double seconds = 0.0;  ///< that the descriptions took; not part of any result
  SupportScore support;
  ClusterScore clusters;
  SlopeScore slopes;
  PotholeScore potholes;
  GapScore gaps;
  IdentityScore identities;         ///< if `WorldTask::follow`
  std::vector<ThingRecord> things;  ///< if `WorldTask::list_things`
  CostScore costs;                  ///< if `WorldTask::costs`
  void add(const WorldScore& other);
};

struct ScoreRules {
  ClusterRules clusters;
  PotholeRules potholes;
  GapRules gaps;
  ApproachRules approach;
  CostRules costs;
};

/// The method under test: describes one scan into `description`.
using Describe = std::function<void(const ScanView& scan, Description& description)>;

/// Told of every scan that is scored, with the pairs of things and clusters: for files of points
/// and labels, and for judging identities from scan to scan.
struct ScoredScan {
  const DrivenWorld& world;
  std::size_t sweep;
  const TestScan& scan;
  const Description& description;
  const ClusterMatching& matching;
};
using ScoredScanListener = std::function<void(const ScoredScan& scored)>;

struct WorldTask {
  const sim::Family& family;
  std::uint64_t seed = 0;
  std::size_t scans = 8;     ///< spread evenly over the drive
  bool approach = false;     ///< also look at the approach to holes on the path
  bool list_things = false;  ///< fill in WorldScore::things
  std::size_t follow = 0;    ///< consecutive scans from the middle of the drive for identities
  TrackingParams tracking;   ///< of identities
  const ScanOptions& options;
  const ScoreRules& rules;
  const Describe& describe;
  ScoredScanListener listener;  ///< may be empty
  MeasureCosts costs = {};      ///< empty: costs are not looked at
};

/// Makes a world, drives through it, describes scans and compares them with the truth. The same
/// arguments give the same score, but for `seconds`.
[[nodiscard]] WorldScore score_world(const WorldTask& task);

}  // namespace mrpt_terrain::eval
