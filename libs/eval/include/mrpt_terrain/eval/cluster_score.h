// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/scan_truth.h"
#include "mrpt_terrain/eval/support_score.h"

namespace mrpt_terrain::eval {

/// When things and clusters count, and when they are the same.
struct ClusterRules {
  double least_iou = 0.5;     ///< a match has more than this; from 0.5 on there is one at most
  std::size_t returns = 10;   ///< things and clusters with fewer points do not count
  std::size_t counted = 5;    ///< nor those with fewer points whose truth counts
  double split_share = 0.2;   ///< a cluster is a part of a thing from this share of it on
  double merged_share = 0.5;  ///< a cluster has swallowed a thing from this share of it on
};

/// A thing that counts.
struct MatchedThing {
  std::int32_t thing = kNoThing;      ///< index into ScanTruth::things
  std::int32_t cluster = kNoCluster;  ///< that it was found as; kNoCluster: missed
  double iou = 0.0;                   ///< of their points, those not counted left out
  std::size_t parts = 0;              ///< clusters that hold at least `split_share` of it
  double distance = 0.0;              ///< mean of its counted points, horizontal, metres
};

enum class ClusterFate : std::uint8_t {
  kMatched,     ///< is a thing
  kFalse,       ///< is none
  kNotCounted,  ///< too small, or mostly of points or things that do not count
};

struct ClusterMatching {
  std::vector<MatchedThing> things;    ///< in the order of ScanTruth::things
  std::vector<ClusterFate> fate;       ///< per described cluster
  std::vector<std::size_t> swallowed;  ///< per cluster: things of which it holds the most
};

/// Compares the clusters of a description with the true things by the points that they share.
/// A point counts if its true support is known and it is no ground cover. Clusters of class kNone
/// are none.
/// \param labels of the description
/// \param clusters their classes, one per cluster
[[nodiscard]] ClusterMatching match_clusters(const PointsView& points, const ScanTruth& truth,
                                             const PointLabels& labels,
                                             const std::vector<ClusterDescription>& clusters,
                                             const ClusterRules& rules);

inline constexpr std::size_t kClassCount = 5;

/// A true thing that counts beside the cluster that shares the most points with it, or a cluster
/// that is no thing beside the thing with which it shares the most.
struct ThingRecord {
  std::string family;
  std::uint64_t seed = 0;
  std::size_t sweep = 0;
  bool is_false = false;          ///< a cluster that is no thing
  std::int32_t thing = kNoThing;  ///< number of the solid; kNoThing: ground or nothing
  std::string type;               ///< of the solid; "": none
  TerrainClass truth = TerrainClass::kNone;
  std::int32_t cluster = kNoCluster;
  TerrainClass described = TerrainClass::kNone;
  double x = 0.0, y = 0.0;   ///< mean of the counted points, frame of the description
  std::size_t of_thing = 0;  ///< counted points
  std::size_t of_cluster = 0;
  std::size_t shared = 0;
  std::size_t loose = 0;      ///< of the thing: in no cluster and called ground
  std::size_t dropped = 0;    ///< of the thing: in no cluster and not called ground
  std::size_t parts = 0;      ///< MatchedThing::parts
  std::size_t swallowed = 0;  ///< ClusterMatching::swallowed of the cluster
  std::int32_t points = 0, cells = 0, raised = 0;  ///< of the cluster, as described
  double confidence = 0.0;                         ///< of the cluster, as described
  [[nodiscard]] double iou() const;
};

struct ClusterScore {
  Share found;                  ///< things: matched of all, the recall
  Share right;                  ///< clusters: matched of all that count, the precision
  Share split;                  ///< things of which at least two clusters hold a part
  Share merged;                 ///< clusters that count and have swallowed at least two things
  std::size_t not_counted = 0;  ///< clusters
  std::array<Share, kClassCount> found_of_class;
  std::array<Share, kDistanceBins> found_at;
  /// Row: true class, kNone for clusters that are no thing; column: described class, kNone for
  /// things that were not found.
  std::array<std::array<std::size_t, kClassCount>, kClassCount> confusion{};
  void add(const ClusterScore& other);
};

void add_clusters(const ClusterMatching& matching, const ScanTruth& truth,
                  const std::vector<ClusterDescription>& clusters, ClusterScore& score);

/// All things that count and all clusters that are none, in this order. Family, seed and sweep are
/// left to the caller.
[[nodiscard]] std::vector<ThingRecord> list_things(const PointsView& points, const ScanTruth& truth,
                                                   const PointLabels& labels,
                                                   const std::vector<ClusterDescription>& clusters,
                                                   const ClusterMatching& matching);

}  // namespace mrpt_terrain::eval
