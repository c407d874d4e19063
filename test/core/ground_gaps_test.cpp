// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/ground_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "allocation_counter.h"
#include "field_worlds.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using worlds::FieldStages;
using worlds::radians;

constexpr double kSensorHeight = 0.81;
/// So far below the ground that no beam comes back.
constexpr double kNothing = -1000.0;

/// 32 beams from -30.67 deg to 10.67 deg, 0.25 deg apart; at 5 m their rings are 0.75 m apart.
worlds::LidarModel rings() {
  worlds::LidarModel model;
  model.azimuth_step_deg = 0.25;
  model.max_range = 40.0;
  return model;
}

struct Gaps {
  FieldStages stages;
  HoleWorkspace hole_workspace;
  GapWorkspace workspace;
  std::vector<HoleDescription> found;
  IndexRows cells;

  void find(const ScanView& scan, const GapParams& params = {}) {
    worlds::measure(scan.points, worlds::field_params(), stages);
    const HoleInput input{stages.field, stages.grid, scan.origins};
    find_holes(input, HoleParams{}, hole_workspace, stages.cells, stages.ground, found, cells);
    find_gaps(input, stages.cells, params, workspace, stages.ground, found, cells);
  }
  [[nodiscard]] std::vector<HoleDescription> of(HoleKind kind) const {
    std::vector<HoleDescription> result;
    for (const HoleDescription& hole : found) {
      if (hole.kind == kind) result.push_back(hole);
    }
    return result;
  }
  [[nodiscard]] std::size_t without_floor() const {
    return found.size() - of(HoleKind::kFloor).size();
  }
  /// Middles of the cells of the k-th.
  [[nodiscard]] std::vector<Position2> places(std::size_t k) const {
    std::vector<Position2> result;
    const GridGeometry& geometry = stages.grid.geometry;
    for (const std::int32_t cell : cells.row(k))
      result.push_back(geometry.centre_of(geometry.index_of(CellId{cell})));
    return result;
  }
};

struct RingScan {
  Points points;
  std::array<float, 3> origin{0.0F, 0.0F, static_cast<float>(kSensorHeight)};
  [[nodiscard]] ScanView view() const { return {points.view(), {&origin, nullptr}}; }
};

template <class Height>
Gaps gaps_in(Height&& height, const worlds::LidarModel& model = rings(),
             const GapParams& params = {}) {
  const RingScan scan{worlds::ring_scan(model, kSensorHeight, height)};
  Gaps result;
  result.find(scan.view(), params);
  return result;
}

/// Depth of a ditch between x0 and x1 with walls of 73 deg.
double ditch(double x, double x0, double x1, double depth) {
  const double wall = 0.3 * depth;
  return -depth * std::clamp(std::min(x - x0, x1 - x) / wall, 0.0, 1.0);
}

// A ditch across the way, 20 m long, whose floor no beam meets: at 5 m they fall by 0.16 m per
// metre, so that 1.2 m behind the edge they are at most 0.2 m down. Of the place, rings tell no
// more than where they lie: it must not lie outside of the ditch by more than a cell.
TEST(Gaps, ADitchWithoutFloorIsFound) {
  for (const double from : {3.4, 4.0, 4.6, 5.2}) {
    const double to = from + 1.2;
    const Gaps gaps = gaps_in(
        [=](double x, double y) { return std::abs(y) < 10.0 ? ditch(x, from, to, 0.6) : 0.0; });
    const std::vector<HoleDescription> ditches = gaps.of(HoleKind::kGap);
    ASSERT_GE(ditches.size(), 1U) << from;
    EXPECT_TRUE(gaps.of(HoleKind::kDrop).empty()) << from;
    for (const HoleDescription& hole : ditches) {
      EXPECT_GE(hole.depth, 0.08) << from;
      EXPECT_LE(hole.depth, 0.61) << from << ": a lower bound";
      EXPECT_LE(hole.width, 1.2 + 0.4) << from;
      EXPECT_GT(hole.confidence, 0.0) << from;
      EXPECT_LE(hole.confidence, 1.0) << from;
      ASSERT_GE(hole.slot, 0) << from;
      EXPECT_EQ(gaps.stages.ground.rule[static_cast<std::size_t>(hole.slot)], GroundRule::kLow);
    }
    ASSERT_EQ(gaps.cells.rows(), gaps.found.size());
    for (std::size_t k = 0; k < gaps.found.size(); ++k) {
      for (const Position2 place : gaps.places(k)) {
        EXPECT_GT(place.x, from - 0.2) << from;
        EXPECT_LT(place.x, to + 0.3) << from;
      }
    }
  }
}

// A pit that the robot cannot look into: beams meet its far side only, well below its edge.
TEST(Gaps, APitWhoseFarSideIsSeenIsFound) {
  const double from = 3.5;
  for (const double length : {2.5, 5.0, 7.0}) {
    const double to = from + length;
    const auto ground = [=](double x, double y) {
      return std::abs(y) < 10.0 ? ditch(x, from, to, 6.0) : 0.0;
    };
    const std::vector<HoleDescription> pits = gaps_in(ground).of(HoleKind::kGap);
    ASSERT_GE(pits.size(), 1U) << length;
    for (const HoleDescription& pit : pits) EXPECT_GE(pit.depth, 0.3) << length;
    GapParams narrower;
    narrower.widest = length - 1.0;
    EXPECT_TRUE(gaps_in(ground, rings(), narrower).of(HoleKind::kGap).empty()) << length;
  }
}

// The lower ground is seen, parallel to that before the edge.
TEST(Gaps, ADropToLowerGroundIsFound) {
  for (const double depth : {0.5, 0.65, 0.8}) {
    for (const double from : {3.3, 4.0, 4.7}) {
      const Gaps gaps = gaps_in(
          [=](double x, double) { return -depth * std::clamp((x - from) / 0.1, 0.0, 1.0); });
      const std::vector<HoleDescription> drops = gaps.of(HoleKind::kDrop);
      ASSERT_EQ(drops.size(), 1U) << depth << " " << from;
      EXPECT_NEAR(drops[0].depth, depth, 0.05) << from;
      EXPECT_GT(drops[0].length, 2.0) << depth << " " << from;
      for (std::size_t k = 0; k < gaps.found.size(); ++k) {
        if (gaps.found[k].kind != HoleKind::kDrop) continue;
        for (const Position2 place : gaps.places(k)) EXPECT_GT(place.x, from - 0.3) << depth;
      }
    }
  }
}

// Nothing comes back from behind the edge.
TEST(Gaps, TheEndOfTheGroundIsFound) {
  for (const double from : {3.3, 4.0, 4.7}) {
    const Gaps gaps = gaps_in([=](double x, double) { return x > from ? kNothing : 0.0; });
    ASSERT_FALSE(gaps.found.empty()) << from;
    double length = 0.0;
    for (std::size_t k = 0; k < gaps.found.size(); ++k) {
      EXPECT_EQ(gaps.found[k].kind, HoleKind::kDrop) << from;
      EXPECT_EQ(gaps.found[k].depth, 0.0) << "nothing was seen of it";
      length += gaps.found[k].length;
      // Between the last ring and the next one, 0.75 m behind at 5 m, lies the edge.
      for (const Position2 place : gaps.places(k)) {
        EXPECT_GT(place.x, from - 0.3) << from;
        EXPECT_LT(place.x, from + 1.8) << from;
      }
    }
    EXPECT_GT(length, 2.0) << from;
  }
}

TEST(Gaps, GroundHasNone) {
  for (const double degrees : {-8.0, -3.0, 0.0, 5.0}) {
    const double fall = std::tan(radians(degrees));
    EXPECT_EQ(gaps_in([=](double x, double) { return -fall * x; }).without_floor(), 0U) << degrees;
  }
}

// Crests hide what lies behind: the ground meets, followed back. Wavelengths of 8 and 13 m.
TEST(Gaps, HillsHaveNone) {
  for (const double wavelength : {8.0, 13.0}) {
    for (const double amplitude : {0.2, 0.4}) {
      for (const double phase : {0.0, 0.3, 0.6, 0.9}) {
        const auto hills = [=](double x, double y) {
          const double k = 2.0 * M_PI / wavelength;
          const auto at = [=](double u, double v) {
            return amplitude * std::sin(k * u + 2.0 * M_PI * phase) * std::cos(0.7 * k * v);
          };
          return at(x, y) - at(0.0, 0.0);
        };
        EXPECT_EQ(gaps_in(hills).without_floor(), 0U)
            << wavelength << " " << amplitude << " " << phase;
      }
    }
  }
}

// A curb down is no drop, and a road between curbs no ditch.
TEST(Gaps, CurbsAreNone) {
  for (const double from : {3.0, 3.9, 5.2}) {
    const auto step = [=](double x, double) {
      return -0.15 * std::clamp((x - from) / 0.03, 0.0, 1.0);
    };
    EXPECT_EQ(gaps_in(step).without_floor(), 0U) << from;
    const auto road = [=](double, double y) { return std::abs(y) < from ? 0.0 : 0.15; };
    EXPECT_EQ(gaps_in(road).without_floor(), 0U) << from;
  }
}

// Boxes and walls hide the ground behind them, over widths that would be a drop.
TEST(Gaps, ShadowsAreNone) {
  RandomGenerator random(311);
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({4.0, 4.8, -1.5, 0.5}, 0.0, 0.4, 0));
  scene.solids.push_back(worlds::box_solid({-6.0, -5.7, -6.0, 6.0}, 0.0, 2.0, 1));
  scene.solids.push_back(worlds::box_solid({1.0, 3.0, 3.0, 3.3}, 0.0, 0.2, 2));
  for (const double sigma : {0.0, 0.02}) {
    RingScan scan{worlds::scan(scene, worlds::thirty_two_beams(sigma), random).points};
    Gaps gaps;
    gaps.find(scan.view());
    EXPECT_EQ(gaps.without_floor(), 0U) << sigma;
  }
}

// The uppermost beam points to the ground: behind its ring nothing is missing.
TEST(Gaps, TheEndOfTheViewIsNone) {
  worlds::LidarModel model = rings();
  model.highest_deg = -7.0;
  EXPECT_EQ(gaps_in([](double, double) { return 0.0; }, model).without_floor(), 0U);
}

// Water swallows beams, and the ground goes on behind.
TEST(Gaps, APuddleIsNone) {
  const Gaps gaps =
      gaps_in([](double x, double y) { return std::hypot(x - 4.5, y) < 1.3 ? kNothing : 0.0; });
  EXPECT_EQ(gaps.without_floor(), 0U);
}

// The robot pitches by 10 deg: in front of it, even the uppermost beams that meet the ground do so
// near, and the frame is tilted.
TEST(Gaps, APitchingRobotSeesNone) {
  worlds::LidarModel model = rings();
  model.highest_deg = 2.0;
  const double pitch = radians(10.0);
  const auto tilted_ground = [=](double x, double) { return std::tan(pitch) * x; };
  EXPECT_EQ(gaps_in(tilted_ground, model).without_floor(), 0U);
}

// Origins of beams are not needed for what is seen.
TEST(Gaps, OriginsMayBeUnknown) {
  const RingScan scan{worlds::ring_scan(rings(), kSensorHeight, [](double x, double) {
    return -0.8 * std::clamp((x - 4.0) / 0.1, 0.0, 1.0);
  })};
  Gaps gaps;
  gaps.find(scan.points.view());
  EXPECT_EQ(gaps.of(HoleKind::kDrop).size(), 1U);
}

TEST(Gaps, EveryParameterCounts) {
  const auto trench = [](double x, double y) {
    return std::abs(y) < 10.0 ? ditch(x, 4.0, 5.2, 0.6) : 0.0;
  };
  ASSERT_GE(gaps_in(trench).of(HoleKind::kGap).size(), 1U);
  GapParams params;
  params.least_depth = 0.7;
  EXPECT_TRUE(gaps_in(trench, rings(), params).of(HoleKind::kGap).empty()) << "least_depth";
  params = {};
  params.widest = 0.5;
  EXPECT_TRUE(gaps_in(trench, rings(), params).of(HoleKind::kGap).empty()) << "widest";
  params = {};
  params.least_width = 60.0;
  EXPECT_TRUE(gaps_in(trench, rings(), params).of(HoleKind::kGap).empty()) << "least_width";
  params = {};
  params.least_fall = 0.3;
  EXPECT_TRUE(gaps_in(trench, rings(), params).of(HoleKind::kGap).empty()) << "least_fall";
  const auto quay = [](double x, double) { return -0.8 * std::clamp((x - 4.0) / 0.1, 0.0, 1.0); };
  params = {};
  params.drop_depth = 1.0;
  EXPECT_TRUE(gaps_in(quay, rings(), params).of(HoleKind::kDrop).empty()) << "drop_depth";
  const auto end = [](double x, double) { return x > 4.0 ? kNothing : 0.0; };
  params = {};
  params.missing = 30;
  EXPECT_TRUE(gaps_in(end, rings(), params).of(HoleKind::kDrop).empty()) << "missing";
}

TEST(Gaps, NoGroundNoGaps) {
  Gaps gaps;
  gaps.find(Points{}.view());
  EXPECT_TRUE(gaps.found.empty());
  Points one;
  one.push_back(3.0F, 1.0F, -0.5F);
  gaps.find(one.view());
  EXPECT_TRUE(gaps.found.empty());
}

TEST(Gaps, ASecondTimeIsTheSameAndDoesNotAllocate) {
  const RingScan scan{worlds::ring_scan(rings(), kSensorHeight, [](double x, double y) {
    return y > 3.5 ? kNothing : ditch(x, 4.0, 5.2, 0.6);
  })};
  Gaps used;
  used.find(scan.view());
  const std::vector<std::int32_t> cells = used.cells.items;
  ASSERT_GE(used.found.size(), 2U);
  const ScanView view = scan.view();
  const HoleInput input{used.stages.field, used.stages.grid, view.origins};
  worlds::measure(view.points, worlds::field_params(), used.stages);
  const std::size_t before = bench::allocations();
  find_holes(input, HoleParams{}, used.hole_workspace, used.stages.cells, used.stages.ground,
             used.found, used.cells);
  find_gaps(input, used.stages.cells, {}, used.workspace, used.stages.ground, used.found,
            used.cells);
  EXPECT_EQ(bench::allocations(), before);
  EXPECT_EQ(used.cells.items, cells);
}

}  // namespace
}  // namespace mrpt_terrain
