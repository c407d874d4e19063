// SPDX-License-Identifier: BSD-3-Clause
#include "climbed_sides.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

constexpr float kReach = 0.025F;

/// Rings every 2 deg from 0.84 m above level ground, ranges off by up to 2 cm. What they meet ahead
/// stands 8.4 m away and extends to 4 m on both sides: one ring meets it, 0.1 m up in the middle.
class OneRingAhead {
 public:
  enum class What { kNothing, kFace, kRound };

  explicit OneRingAhead(What what) {
    for (double fall = 15.0; fall >= 3.0; fall -= 2.0) {
      for (double azimuth = -180.0; azimuth < 180.0; azimuth += 0.2) add(what, fall, azimuth);
    }
    find_field_ground({points_.view(), {&origin_}}, {}, {}, field_);
    support_ = field_.points.support;
  }
  void label() {
    DeckWorkspace workspace;
    label_climbed_sides(field_, kReach, workspace, support_);
  }
  /// Points on what stands ahead that are at least 5 cm up and have a label.
  [[nodiscard]] int count(Support label) const {
    int n = 0;
    for (const std::size_t i : ahead_) n += support_[i] == label ? 1 : 0;
    return n;
  }
  [[nodiscard]] int above_elsewhere() const {
    int n = 0;
    for (const Support support : support_) n += support == Support::kAbove ? 1 : 0;
    return n - count(Support::kAbove);
  }

 private:
  void add(What what, double fall, double azimuth) {
    constexpr double kHeight = 0.84, kAhead = 8.4, kAside = 4.0, kTop = 0.15;
    const double down = std::tan(worlds::radians(fall));
    const double cosine = std::cos(worlds::radians(azimuth)),
                 sine = std::sin(worlds::radians(azimuth));
    double distance = kHeight / down;
    const double face = what == What::kRound ? kAhead : kAhead / cosine;
    const bool meets = what != What::kNothing && cosine > 0.5 && std::abs(face * sine) < kAside &&
                       face < distance && kHeight - face * down < kTop;
    if (meets) distance = face;
    if (meets && kHeight - face * down > 0.05) ahead_.push_back(points_.size());
    distance += 0.02 * (2.0 * random_.uniform() - 1.0);
    points_.push_back(static_cast<float>(distance * cosine), static_cast<float>(distance * sine),
                      static_cast<float>(kHeight - distance * down));
  }

  Points points_;
  std::array<float, 3> origin_{0.0F, 0.0F, 0.84F};
  FieldWorkspace field_;
  std::vector<Support> support_;
  std::vector<std::size_t> ahead_;
  RandomGenerator random_{7};
};

// The reference follows the ring, between two that lie on the ground; its line tells what it is.
TEST(ClimbedSides, ARingAlongAFaceIsAboveTheGround) {
  OneRingAhead scan(OneRingAhead::What::kFace);
  ASSERT_GT(scan.count(Support::kGround), 100);
  scan.label();
  EXPECT_LE(scan.count(Support::kGround), 10);
  EXPECT_EQ(scan.above_elsewhere(), 0);
}

// A bank whose ring is bent around the sensor, as on level ground, rises as high and stays ground.
TEST(ClimbedSides, ABentRingStaysGround) {
  OneRingAhead scan(OneRingAhead::What::kRound);
  const int ground = scan.count(Support::kGround);
  ASSERT_GT(ground, 100);
  scan.label();
  EXPECT_EQ(scan.count(Support::kGround), ground);
}

TEST(ClimbedSides, LevelGroundHasNone) {
  OneRingAhead scan(OneRingAhead::What::kNothing);
  scan.label();
  EXPECT_EQ(scan.above_elsewhere(), 0);
}

}  // namespace
}  // namespace mrpt_terrain
