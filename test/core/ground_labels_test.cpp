// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

/// Points by their heights above the reference, which is not looked at: cells of 0.4 m.
class HeightsInCells {
 public:
  /// \param heights of points in the cell that holds (x, y)
  HeightsInCells& add(float x, float y, const std::vector<float>& heights) {
    for (const float height : heights) points_.push_back(x, y, height);
    return *this;
  }
  HeightsInCells& add(float x, float y, std::size_t n, float height) {
    return add(x, y, std::vector<float>(n, height));
  }
  [[nodiscard]] GroundSurface surface() const {
    GroundSurface result;
    CellPointsWorkspace workspace;
    sort_into_cells(points_.view(), {128, 0.4F}, workspace, result.cells);
    for (const CellPoint& point : result.cells.points) result.height.push_back(point.z);
    return result;
  }

 private:
  Points points_;
};

struct Labelled {
  GroundSurface surface;
  std::vector<float> threshold;
  std::vector<Support> support;

  [[nodiscard]] float threshold_at(float x, float y) const {
    const auto cell = static_cast<std::size_t>(surface.lattice().cell_at(x, y));
    return threshold[static_cast<std::size_t>(surface.cells.slot_of[cell])];
  }
};
Labelled labelled(const HeightsInCells& heights, const GroundLabelParams& params = {}) {
  Labelled result;
  GroundLabelWorkspace workspace;
  result.surface = heights.surface();
  label_by_height(result.surface, params, workspace, result.threshold, result.support);
  return result;
}

/// Centre of a cell near the robot, 0.2 m away from it in x and y.
constexpr float kHere = 0.2F;
const float kDistance = kHere * std::sqrt(2.0F);

/// `n` heights, evenly from 0.1 m on: something upright.
std::vector<float> upright(int n, float extent = 0.4F) {
  std::vector<float> heights;
  for (int i = 0; i < n; ++i) {
    heights.push_back(0.1F + extent * (static_cast<float>(i) + 0.5F) / static_cast<float>(n));
  }
  return heights;
}

// Nothing stands there: the plain threshold, which grows with distance. 1e-6 m covers rounding.
TEST(GroundLabels, OpenGroundMayBeAsRoughAsThePlainThreshold) {
  const GroundLabelParams params;
  const std::vector<float> heights{0.0F, -0.05F, 0.05F, 0.09F, 0.7F};
  const Labelled labels =
      labelled(HeightsInCells{}.add(kHere, kHere, heights).add(20.2F, kHere, heights), params);
  EXPECT_NEAR(labels.threshold_at(kHere, kHere), params.most + params.growth * kDistance, 1e-6);
  EXPECT_NEAR(labels.threshold_at(20.2F, kHere),
              params.most + params.growth * std::hypot(20.2, double{kHere}), 1e-6);
  const std::vector<Support> expected{Support::kGround, Support::kGround, Support::kGround,
                                      Support::kGround, Support::kAbove};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(labels.support[i], expected[i]) << i;
    EXPECT_EQ(labels.support[5 + i], expected[i]) << i;
  }
}

// A point exactly on a border is ground on both sides.
TEST(GroundLabels, BordersBelongToTheGround) {
  GroundLabelParams params;
  params.most = 0.0625;  // these three are exact
  params.growth = 0.0;
  params.below = 0.25;
  const Labelled labels =
      labelled(HeightsInCells{}.add(kHere, kHere, {0.0625F, 0.0626F, -0.25F, -0.2501F}), params);
  EXPECT_EQ(labels.support, (std::vector<Support>{Support::kGround, Support::kAbove,
                                                  Support::kGround, Support::kBelow}));
}

// Analytic: where n_g N(h; 0, sigma) = prior n_o / 0.4 m. Looked for by halving, with the counts of
// a cell that has no neighbours; of the points in the 6 cm of the ground those are taken off that
// things have there, which are as dense as in their extent above 0.1 m, and 0.3 points are added;
// the spread is the least that is permitted. Float logarithms: 1e-5 m.
TEST(GroundLabels, ThresholdIsWhereGroundAndThingsAreEquallyLikely) {
  const GroundLabelParams params;
  const double most = params.most + params.growth * kDistance;
  for (const int ground : {1, 5, 40}) {
    for (const int object : {1, 5, 40}) {
      for (const double extent : {0.02, 0.05, 0.1, 0.4}) {
        const auto excess = [&](double h) {
          const double z = h / params.sigma_min;
          const double normal =
              std::exp(-0.5 * z * z) / (params.sigma_min * std::sqrt(2.0 * worlds::kPi));
          const double own = std::max(ground - object * 0.06 / std::max(extent, 0.05), 0.0);
          return (own + 0.3) * normal - params.prior * object / 0.4;
        };
        double low = 0.0, high = 1.0;
        for (int k = 0; k < 40; ++k) {
          const double middle = 0.5 * (low + high);
          (excess(middle) > 0.0 ? low : high) = middle;
        }
        const Labelled labels =
            labelled(HeightsInCells{}
                         .add(kHere, kHere, static_cast<std::size_t>(ground), 0.0F)
                         .add(kHere, kHere, upright(object, static_cast<float>(extent))),
                     params);
        EXPECT_NEAR(labels.threshold_at(kHere, kHere), std::min(std::max(low, params.least), most),
                    1e-5)
            << ground << " " << object << " " << extent;
      }
    }
  }
}

// The foot of a pole is told from the ground: a point at 7 cm beside 30 points of a pole stands
// out, the same point in open ground does not.
TEST(GroundLabels, TheFootOfAPoleStandsOut) {
  const Labelled pole = labelled(
      HeightsInCells{}.add(kHere, kHere, {0.0F, 0.01F, 0.07F}).add(kHere, kHere, upright(30)));
  EXPECT_EQ(pole.support[0], Support::kGround);
  EXPECT_EQ(pole.support[1], Support::kGround);
  EXPECT_EQ(pole.support[2], Support::kAbove);
  const Labelled open = labelled(HeightsInCells{}.add(kHere, kHere, {0.0F, 0.01F, 0.07F}));
  EXPECT_EQ(open.support[2], Support::kGround);
}

TEST(GroundLabels, PriorZeroGivesThePlainThreshold) {
  GroundLabelParams params;
  params.prior = 0.0;
  const Labelled labels = labelled(
      HeightsInCells{}.add(kHere, kHere, {0.0F, 0.07F}).add(kHere, kHere, upright(30)), params);
  EXPECT_NEAR(labels.threshold_at(kHere, kHere), params.most + params.growth * kDistance, 1e-6);
  EXPECT_EQ(labels.support[1], Support::kGround);
}

// Points of a thing in a cell beside count 0.3 each, across corners too; two cells away, nothing.
TEST(GroundLabels, ThingsBesideACellLowerItsThreshold) {
  const auto with_thing_at = [](float x, float y, int points) {
    return labelled(HeightsInCells{}.add(kHere, kHere, 10, 0.0F).add(x, y, upright(points)))
        .threshold_at(kHere, kHere);
  };
  const float alone = with_thing_at(kHere + 0.8F, kHere, 30);
  EXPECT_NEAR(alone, 0.12 + 0.0015 * double{kDistance}, 1e-6);
  const float three_here = with_thing_at(kHere, kHere, 3);
  EXPECT_LT(three_here, alone);
  for (const float dx : {-0.4F, 0.0F, 0.4F}) {
    for (const float dy : {-0.4F, 0.0F, 0.4F}) {
      if (dx == 0.0F && dy == 0.0F) continue;
      EXPECT_NEAR(with_thing_at(kHere + dx, kHere + dy, 10), three_here, 1e-6) << dx << " " << dy;
    }
  }
}

// Whatever is seen, thresholds stay between least and most, and more of a thing never raises them.
TEST(GroundLabels, ThresholdsFallWithTheThingAndKeepTheirBounds) {
  for (const double prior : {0.001, 0.03, 1.0, 1000.0}) {
    GroundLabelParams params;
    params.prior = prior;
    params.growth = 0.0;
    float last = 1.0F;
    for (int object = 0; object < 60; object += 3) {
      const float threshold =
          labelled(HeightsInCells{}.add(kHere, kHere, 8, 0.02F).add(kHere, kHere, upright(object)),
                   params)
              .threshold_at(kHere, kHere);
      EXPECT_LE(threshold, last) << prior << " " << object;
      EXPECT_LE(threshold, static_cast<float>(params.most));
      EXPECT_GE(threshold, static_cast<float>(params.least));
      last = threshold;
    }
  }
}

// A thing that hides its ground: everything over `least` stands out.
TEST(GroundLabels, WithoutGroundTheLeastThresholdIsLeft) {
  GroundLabelParams params;
  params.prior = 1.0;
  const Labelled labels = labelled(HeightsInCells{}.add(kHere, kHere, upright(200)), params);
  EXPECT_FLOAT_EQ(labels.threshold_at(kHere, kHere), static_cast<float>(params.least));
}

// Rough ground with a thing on it keeps a higher threshold than smooth ground with the same thing.
TEST(GroundLabels, RoughGroundKeepsMoreOfItsPoints) {
  std::vector<float> rough, smooth;
  for (int i = 0; i < 20; ++i) {
    rough.push_back(i % 2 == 0 ? 0.035F : -0.035F);
    smooth.push_back(i % 2 == 0 ? 0.005F : -0.005F);
  }
  const auto threshold = [](const std::vector<float>& ground) {
    return labelled(HeightsInCells{}.add(kHere, kHere, ground).add(kHere, kHere, upright(10)))
        .threshold_at(kHere, kHere);
  };
  EXPECT_GT(threshold(rough), threshold(smooth) + 0.02F);
}

TEST(GroundLabels, NoPointsNoLabels) {
  const Labelled labels = labelled(HeightsInCells{});
  EXPECT_TRUE(labels.threshold.empty());
  EXPECT_TRUE(labels.support.empty());
}

// Used memory leaves no trace.
TEST(GroundLabels, ReuseGivesWhatAFreshStartGives) {
  const HeightsInCells large = HeightsInCells{}
                                   .add(kHere, kHere, {0.0F, 0.07F})
                                   .add(kHere, kHere, upright(30))
                                   .add(3.0F, 3.0F, upright(5));
  const HeightsInCells small = HeightsInCells{}.add(kHere, kHere, {0.0F, 0.07F, -1.0F});
  GroundLabelWorkspace workspace;
  std::vector<float> threshold;
  std::vector<Support> support;
  label_by_height(large.surface(), {}, workspace, threshold, support);
  label_by_height(small.surface(), {}, workspace, threshold, support);
  const Labelled fresh = labelled(small);
  EXPECT_EQ(threshold, fresh.threshold);
  EXPECT_EQ(support, fresh.support);
}

}  // namespace
}  // namespace mrpt_terrain
