// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "mrpt_terrain/eval/support_score.h"
#include "mrpt_terrain/eval/world_score.h"

/// \file
/// Maps of many scans against descriptions of the last one alone, on the same drives.
namespace mrpt_terrain::eval {

/// What a map says after a scan.
struct MapDescription {
  const Description* description = nullptr;  ///< `labels` are those of the scan's points
  Eigen::Isometry3d T_map_window = Eigen::Isometry3d::Identity();  ///< of its grid
};

/// The map under test: takes a scan and says what it knows then.
/// \param time of the scan, seconds; rises
/// \param T_map_robot where the scan's frame lies
using InsertScan = std::function<MapDescription(const TestScan& scan, double time,
                                                const Eigen::Isometry3d& T_map_robot)>;

/// Support of cells and holes.
struct PlaceScore {
  SupportCounts cells;  ///< within reach whose truth and support are known
  Share holes;          ///< found of those that some scan so far had to show
  void add(const PlaceScore& other);
};

struct FusedScore {
  WorldScore single, fused;  ///< of the scored scans' points
  PlaceScore single_places;
  PlaceScore fused_places;      ///< of cells, those that the last scan shows, too
  SupportCounts only_in_map;    ///< cells that the last scan does not show
  double insertions = 0.0;      ///< scans taken by the map
  double insert_seconds = 0.0;  ///< that they took; not part of any result
  void add(const FusedScore& other);
};

struct FusedTask {
  const sim::Family& family;
  std::uint64_t seed = 0;
  std::size_t scans = 32;  ///< inserted, spread evenly over the drive
  std::size_t every = 4;   ///< of these, every so many are scored, the last one among them
  double reach = 12.0;     ///< metres to all four sides within which places are scored
  const ScanOptions& options;
  const ScoreRules& rules;
  const Describe& describe;  ///< of single scans
  const InsertScan& insert;  ///< into a map that is empty
};

/// Drives through a world with a map. The same arguments give the same score, but for seconds.
[[nodiscard]] FusedScore score_fused_world(const FusedTask& task);

}  // namespace mrpt_terrain::eval
