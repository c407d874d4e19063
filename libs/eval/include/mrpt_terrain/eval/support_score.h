// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/eval/scan_truth.h"

namespace mrpt_terrain::eval {

/// `hits` of `total`.
struct Share {
  std::size_t hits = 0, total = 0;
  void count(bool hit) {
    hits += hit ? 1U : 0U;
    ++total;
  }
  void add(const Share& other) {
    hits += other.hits;
    total += other.total;
  }
  /// 0 to 1; NaN of nothing.
  [[nodiscard]] double value() const;
};

/// Points by true and described support. Described: ground, not ground (above or below), unknown.
/// Unknown is wrong for both: it misses ground, and it is no obstacle to a planner.
struct SupportCounts {
  std::size_t true_ground = 0;      ///< ground called ground
  std::size_t missed_ground = 0;    ///< ground called anything else
  std::size_t true_obstacle = 0;    ///< above called above or below
  std::size_t missed_obstacle = 0;  ///< above called ground or unknown

  void add(const SupportCounts& other);
  // 0 to 1; NaN of nothing.
  [[nodiscard]] double precision() const;
  [[nodiscard]] double recall() const;
  [[nodiscard]] double f1() const;
  [[nodiscard]] double iou() const;
  [[nodiscard]] double obstacle_tpr() const;
};

/// Upper edges of the bins of horizontal distance, metres; one more bin lies beyond.
inline constexpr std::array<double, 3> kDistanceEdges{10.0, 20.0, 40.0};
inline constexpr std::size_t kDistanceBins = kDistanceEdges.size() + 1;
/// Upper edges of the bins of the height of obstacle points above the true ground, metres.
inline constexpr std::array<double, 2> kHeightEdges{0.2, 0.5};
inline constexpr std::size_t kHeightBins = kHeightEdges.size() + 1;

/// Number of the bin, edges belong to the upper one.
[[nodiscard]] std::size_t distance_bin(double metres);
[[nodiscard]] std::size_t height_bin(double metres);

struct SupportScore {
  SupportCounts all;
  std::array<SupportCounts, kDistanceBins> by_distance;
  std::array<Share, kHeightBins> obstacles_by_height;  ///< found of all, where heights are known
  void add(const SupportScore& other);
};

/// Counts the points of one scan whose truth is known.
/// \param points robot frame, metres: for the distance
/// \param described one per point
void add_support(const PointsView& points, const ScanTruth& truth,
                 const std::vector<Support>& described, SupportScore& score);

}  // namespace mrpt_terrain::eval
