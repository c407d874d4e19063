// SPDX-License-Identifier: BSD-3-Clause
#include "ring_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

auto order_of(const FaceBeam& beam) {
  return std::make_tuple(beam.column, beam.elevation, beam.ground, beam.point);
}

// Oracle: all beams sorted by all that counts. Few columns and elevations, so that many are equal.
TEST(SortBeams, OrdersByColumnElevationAndNumber) {
  FaceSlopeWorkspace workspace;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomGenerator random(seed);
    const std::uint32_t n = random.below(200), columns = 1 + random.below(40);
    workspace.beams.clear();
    for (std::uint32_t k = 0; k < n; ++k) {
      FaceBeam beam;
      beam.column = static_cast<std::int32_t>(random.below(columns)) - 17;
      beam.elevation = 0.1F * static_cast<float>(random.below(5)) - 0.3F;
      beam.point = static_cast<std::int32_t>((k * 89) % 211);
      beam.ground = random.below(2) > 0;
      workspace.beams.push_back(beam);
    }
    std::vector<FaceBeam> expected = workspace.beams;
    std::sort(expected.begin(), expected.end(),
              [](const FaceBeam& a, const FaceBeam& b) { return order_of(a) < order_of(b); });
    sort_beams(workspace);
    ASSERT_EQ(workspace.beams.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_EQ(order_of(workspace.beams[k]), order_of(expected[k])) << seed << " " << k;
  }
}

}  // namespace
}  // namespace mrpt_terrain
