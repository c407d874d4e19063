// SPDX-License-Identifier: BSD-3-Clause
#include "face_consensus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plane_inliers.h"

namespace mrpt_terrain {
namespace {

// Points of two planes that cross, with noise.
void make_sample(std::size_t n, RandomGenerator& random, FaceSlopeWorkspace& workspace) {
  for (auto* values : {&workspace.x, &workspace.y, &workspace.z}) values->clear();
  for (std::size_t k = 0; k < n; ++k) {
    const auto x = static_cast<float>(2.0 * random.uniform() - 1.0);
    const auto noise = static_cast<float>(0.02 * random.uniform());
    workspace.x.push_back(x);
    workspace.y.push_back(static_cast<float>(2.0 * random.uniform() - 1.0));
    workspace.z.push_back(noise + (random.below(3) > 0 ? 0.2F * x : -0.4F * x));
  }
}

// Oracle: the same planes one after the other, each compared with the best so far.
TEST(FaceConsensus, IsTheBestOfThePlanesTriedOneByOne) {
  const Eigen::Vector3f beam(0.9F, 0.0F, -0.43589F);
  FaceSlopeWorkspace workspace;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    BeamSlopeParams params;
    params.hypotheses = 1 + static_cast<int>(seed * 3 % 70);
    RandomGenerator of_sample(seed), random(seed, 1), again(seed, 1);
    make_sample(3 + of_sample.below(250), of_sample, workspace);
    const auto found = consensus_plane(workspace, beam, params, kSteepestFace, random);
    const PointsView cloud{workspace.x.data(), workspace.y.data(), workspace.z.data(),
                           workspace.x.size()};
    float least = std::numeric_limits<float>::max();
    std::optional<BeamPlane> expected;
    for (int k = 0; k < params.hypotheses; ++k) {
      const std::optional<Plane> plane = random_plane(cloud, again);
      if (!plane || std::abs(plane->c) < static_cast<float>(std::cos(kSteepestFace))) continue;
      const float limit = seed_distance({plane->a, plane->b, plane->c}, beam, params);
      const float per_square = 1.0F / (limit * limit);
      float cost = 0.0F;
      for (std::size_t i = 0; i < cloud.size; ++i) {
        const float e =
            plane->a * cloud.x[i] + plane->b * cloud.y[i] + plane->c * cloud.z[i] + plane->d;
        cost += std::min(e * e * per_square, 1.0F);
      }
      if (!(cost < least)) continue;
      least = cost;
      expected = beam_plane_of(*plane);
    }
    ASSERT_EQ(found.has_value(), expected.has_value()) << seed;
    if (!found) continue;
    EXPECT_EQ(found->normal, expected->normal) << seed;
    EXPECT_EQ(found->offset, expected->offset) << seed;
    EXPECT_EQ(random.next(), again.next()) << seed;
  }
}

}  // namespace
}  // namespace mrpt_terrain
