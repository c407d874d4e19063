// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/support_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace mrpt_terrain::eval {
namespace {

double ratio(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(part) / static_cast<double>(whole);
}

template <std::size_t N>
std::size_t bin_of(double value, const std::array<double, N>& edges) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) -
                                  edges.begin());
}

void count(Support truth, Support described, SupportCounts& counts) {
  if (truth == Support::kGround) {
    ++(described == Support::kGround ? counts.true_ground : counts.missed_ground);
  } else {
    const bool found = described == Support::kAbove || described == Support::kBelow;
    ++(found ? counts.true_obstacle : counts.missed_obstacle);
  }
}

}  // namespace

double Share::value() const { return ratio(hits, total); }

void SupportCounts::add(const SupportCounts& other) {
  true_ground += other.true_ground;
  missed_ground += other.missed_ground;
  true_obstacle += other.true_obstacle;
  missed_obstacle += other.missed_obstacle;
}
double SupportCounts::precision() const {
  return ratio(true_ground, true_ground + missed_obstacle);
}
double SupportCounts::recall() const { return ratio(true_ground, true_ground + missed_ground); }
double SupportCounts::f1() const {
  return ratio(2 * true_ground, 2 * true_ground + missed_ground + missed_obstacle);
}
double SupportCounts::iou() const {
  return ratio(true_ground, true_ground + missed_ground + missed_obstacle);
}
double SupportCounts::obstacle_tpr() const {
  return ratio(true_obstacle, true_obstacle + missed_obstacle);
}

std::size_t distance_bin(double metres) { return bin_of(metres, kDistanceEdges); }
std::size_t height_bin(double metres) { return bin_of(metres, kHeightEdges); }

void SupportScore::add(const SupportScore& other) {
  all.add(other.all);
  for (std::size_t k = 0; k < kDistanceBins; ++k) by_distance[k].add(other.by_distance[k]);
  for (std::size_t k = 0; k < kHeightBins; ++k) {
    obstacles_by_height[k].add(other.obstacles_by_height[k]);
  }
}

void add_support(const PointsView& points, const ScanTruth& truth,
                 const std::vector<Support>& described, SupportScore& score) {
  assert(truth.support.size() == points.size && described.size() == points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    const Support is = truth.support[i];
    if (is == Support::kUnknown) continue;
    SupportCounts counts;
    count(is, described[i], counts);
    score.all.add(counts);
    const double distance =
        std::hypot(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]));
    score.by_distance[distance_bin(distance)].add(counts);
    if (is == Support::kGround || truth.height.empty()) continue;
    score.obstacles_by_height[height_bin(static_cast<double>(truth.height[i]))].count(
        counts.true_obstacle == 1);
  }
}

}  // namespace mrpt_terrain::eval
