// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "worlds.h"

namespace mrpt_terrain::worlds {

/// Every point of a cloud as one cluster.
class WholeCloud {
 public:
  explicit WholeCloud(Points points) : points_(std::move(points)), members_(points_.size()) {
    std::iota(members_.begin(), members_.end(), 0);
  }
  [[nodiscard]] PointsView points() const { return points_.view(); }
  [[nodiscard]] IndexRange members() const {
    return {members_.data(), members_.data() + members_.size()};
  }

 private:
  Points points_;
  std::vector<std::int32_t> members_;
};

/// Ramp of 1.2 m x 1 m, 1.25 m ahead, with 1200 points and noise along its normal.
[[nodiscard]] inline Points ramp_cloud(double degrees, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  add_ramp(points, {1.25, 2.45, -0.5, 0.5}, 1.0 / 32.0, radians(degrees), sigma, random);
  return points;
}

/// The same with a box on it, 0.2 m above the low edge, that holds one point in `one_in`.
[[nodiscard]] inline Points ramp_with_box(double degrees, double sigma, std::uint64_t seed,
                                          std::size_t one_in) {
  Points points = ramp_cloud(degrees, sigma, seed);
  const std::size_t outliers = points.size() / (one_in - 1);
  RandomGenerator random(seed, 1);
  for (std::size_t k = 0; k < outliers; ++k) {
    add_point(points, 1.3 + 0.2 * random.uniform(), 0.4 * random.uniform(),
              0.2 + 0.1 * random.uniform());
  }
  return points;
}

}  // namespace mrpt_terrain::worlds
