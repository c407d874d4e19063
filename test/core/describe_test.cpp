// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/describe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "allocation_counter.h"
#include "lidar.h"
#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;
using worlds::Rect;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Description described(const Points& points, const DescriptionParams& params = {}) {
  Description result;
  DescriptionWorkspace workspace;
  describe(points.view(), params, workspace, result);
  return result;
}

/// Cluster whose centroid lies in `rect`; fails the test if there is not exactly one.
ClusterDescription thing_in(const Description& d, const Rect& rect) {
  ClusterDescription found;
  int count = 0;
  for (const ClusterDescription& thing : d.things) {
    if (!worlds::inside(rect, thing.centroid.x, thing.centroid.y)) continue;
    found = thing;
    ++count;
  }
  EXPECT_EQ(count, 1) << "clusters about x " << rect.x0 << ", y " << rect.y0;
  return found;
}

/// All bytes of a result, for comparisons that tolerate nothing.
class Fingerprint {
 public:
  template <class T>
  Fingerprint& add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "no padding");
    const char* bytes = reinterpret_cast<const char*>(&value);
    bytes_.append(bytes, sizeof(T));
    return *this;
  }
  template <class T>
  Fingerprint& add(const std::vector<T>& values) {
    add(values.size());
    for (const T& value : values) add(value);
    return *this;
  }
  Fingerprint& add(const MomentSums& s) {
    for (const double v : {s.n, s.x, s.y, s.z, s.xx, s.xy, s.xz, s.yy, s.yz, s.zz}) add(v);
    return *this;
  }
  Fingerprint& add(const ClusterDescription& t) {
    for (const double v :
         {t.height.h_d, t.height.h_m, t.height.h_f, t.roughness.lambda[0], t.roughness.lambda[1],
          t.roughness.lambda[2], t.slope.angle, t.slope.normal.x(), t.slope.normal.y(),
          t.slope.normal.z(), t.slope.offset, t.centroid.x, t.centroid.y, t.min_corner.x,
          t.min_corner.y, t.max_corner.x, t.max_corner.y}) {
      add(v);
    }
    for (const std::int32_t v :
         {t.cells, t.points, t.slope.inliers, t.slope.points, t.slope.iterations}) {
      add(v);
    }
    add(t.terrain_class).add(t.roughness.status).add(t.slope.status).add(t.roughness.rough);
    return add(t.h_min).add(t.h_max);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string fingerprint(const Description& d) {
  Fingerprint f;
  f.add(d.grid.slot_of).add(d.grid.cell).add(d.grid.h_min).add(d.grid.h_max).add(d.grid.h_mean);
  f.add(d.grid.sums).add(d.ground.rule).add(d.ground.h_mean);
  f.add(d.clusters.slots.first).add(d.clusters.slots.items).add(d.clusters.cluster_of);
  f.add(d.clusters.dropped).add(d.things);
  f.add(d.cells.support).add(d.cells.terrain_class);
  f.add(d.labels.support).add(d.labels.reason).add(d.labels.terrain_class).add(d.labels.cluster);
  f.add(d.projection.in_map).add(d.projection.not_finite);
  f.add(d.projection.too_high).add(d.projection.outside_map);
  return f.bytes();
}

void expect_finite(const Description& d, const std::string& name) {
  for (std::size_t slot = 0; slot < d.grid.observed(); ++slot) {
    EXPECT_TRUE(std::isfinite(d.grid.h_mean[slot]) && std::isfinite(d.ground.h_mean[slot])) << name;
    EXPECT_TRUE(std::isfinite(d.grid.h_diff(slot))) << name;
  }
  for (const ClusterDescription& t : d.things) {
    for (const double v :
         {t.height.h_d, t.height.h_m, t.height.h_f, t.roughness.lambda[0], t.roughness.lambda[1],
          t.roughness.lambda[2], t.slope.angle, t.slope.offset, t.slope.normal.sum(), t.centroid.x,
          t.centroid.y, t.min_corner.x, t.max_corner.y, double{t.h_min}, double{t.h_max}}) {
      EXPECT_TRUE(std::isfinite(v)) << name;
    }
  }
}

// Analytic world: one thing of each class, where it stands and as large as it is.
TEST(Describe, WorldOfAllClasses) {
  const Description d = described(worlds::world_of_all_classes(91));
  ASSERT_EQ(d.things.size(), 4U);

  const ClusterDescription ramp = thing_in(d, worlds::kRampRect);
  EXPECT_EQ(ramp.terrain_class, TerrainClass::kSlope);
  EXPECT_NEAR(ramp.slope.angle, worlds::kRampAngle, 2e-6);
  // The last point of the lattice is half a spacing below the top.
  EXPECT_NEAR(ramp.h_max, std::tan(worlds::kRampAngle) * (1.0 - 0.0125), 1e-6);
  // Cells are ground until their lowest point is 5 cm high: 0.187 m from the foot, so up to 1.2 m.
  EXPECT_NEAR(ramp.min_corner.x, 1.2, 1e-9);
  EXPECT_NEAR(ramp.max_corner.x, 2.0, 1e-9);
  EXPECT_EQ(ramp.cells, 16 * 20);
  EXPECT_EQ(ramp.points, 4 * 16 * 20);

  const ClusterDescription box = thing_in(d, worlds::kBoxRect);
  EXPECT_EQ(box.terrain_class, TerrainClass::kObstacle);
  EXPECT_NEAR(box.height.h_f, 0.3 - 0.0125, 1e-6);
  EXPECT_EQ(box.cells, 64);

  const ClusterDescription pothole = thing_in(d, worlds::kPotholeRect);
  EXPECT_EQ(pothole.terrain_class, TerrainClass::kPothole);
  EXPECT_NEAR(pothole.height.h_f, -0.12, 1e-7);
  EXPECT_NEAR(pothole.centroid.x, -1.2, 1e-6);
  EXPECT_NEAR(pothole.centroid.y, 1.2, 1e-6);

  EXPECT_EQ(thing_in(d, worlds::kHeapRect).terrain_class, TerrainClass::kObstacle);
}

// Rows of points 4 cm and -0.99 cm high within each cell of a patch: a difference below T_pos,
// which only a smaller T_diff takes out of the ground.
TEST(Describe, LowUnevennessIsOther) {
  Points points;
  worlds::add_surface(points, {-2.5, 2.5, -2.5, 2.5}, 0.025, [](double x, double y) {
    if (!worlds::inside({0.5, 1.0, 0.5, 1.0}, x, y)) return 0.0;
    return std::lround((x + 0.0125) / 0.025) % 2 == 0 ? 0.04 : -0.0099;
  });
  DescriptionParams params;
  EXPECT_EQ(described(points, params).things.size(), 0U);
  params.ground.t_diff = 0.04;
  const Description d = described(points, params);
  ASSERT_EQ(d.things.size(), 1U);
  EXPECT_EQ(d.things[0].terrain_class, TerrainClass::kOther);
  EXPECT_EQ(d.things[0].roughness.status, FeatureStatus::kNotNeeded);
}

TEST(Describe, FlatGroundHasNothingOnIt) {
  Points points;
  worlds::add_flat(points, {-2.5, 2.5, -2.5, 2.5}, 0.025, 0.0);
  const Description d = described(points);
  EXPECT_EQ(d.grid.observed(), 10000U);
  EXPECT_TRUE(d.things.empty());
  for (const Support support : d.labels.support) EXPECT_EQ(support, Support::kGround);
}

TEST(Describe, AWallIsAnObstacle) {
  RandomGenerator random(92);
  Points points;
  worlds::add_wall(points, 1.525, -1.0, 1.0, 1.0, 0.025, 0.004, random);
  const Description d = described(points);
  ASSERT_EQ(d.things.size(), 1U);
  EXPECT_FALSE(d.things[0].roughness.rough) << "it is flat";
  EXPECT_EQ(d.things[0].slope.status, FeatureStatus::kOk);
  EXPECT_GT(d.things[0].slope.angle, radians(85.0));
  EXPECT_EQ(d.things[0].terrain_class, TerrainClass::kObstacle);
}

// "Features are computed in sequence and only when needed."
TEST(Describe, FeaturesAreComputedOnlyWhenNeeded) {
  const Points points = worlds::world_of_all_classes(93);
  const Description d = described(points);
  const ClusterDescription pothole = thing_in(d, worlds::kPotholeRect);
  EXPECT_EQ(pothole.roughness.status, FeatureStatus::kNotNeeded);
  EXPECT_EQ(pothole.slope.status, FeatureStatus::kNotNeeded);
  const ClusterDescription box = thing_in(d, worlds::kBoxRect);
  EXPECT_EQ(box.roughness.status, FeatureStatus::kOk);
  EXPECT_EQ(box.slope.status, FeatureStatus::kNotNeeded);
  const ClusterDescription ramp = thing_in(d, worlds::kRampRect);
  EXPECT_EQ(ramp.roughness.status, FeatureStatus::kOk);
  EXPECT_EQ(ramp.slope.status, FeatureStatus::kOk);

  DescriptionParams params;
  params.classes.all_features = true;
  const Description all = described(points, params);
  ASSERT_EQ(all.things.size(), d.things.size());
  for (std::size_t k = 0; k < all.things.size(); ++k) {
    EXPECT_NE(all.things[k].roughness.status, FeatureStatus::kNotNeeded);
    EXPECT_NE(all.things[k].slope.status, FeatureStatus::kNotNeeded);
    EXPECT_EQ(all.things[k].terrain_class, d.things[k].terrain_class);
  }
}

// Oracle: what a cluster says about itself equals what the labels of the points say.
TEST(Describe, ClustersAgreeWithTheLabelsOfTheirPoints) {
  const Points points = worlds::world_of_all_classes(94, 0.005);
  const Description d = described(points);
  ASSERT_GE(d.things.size(), 4U);
  for (std::size_t k = 0; k < d.things.size(); ++k) {
    const ClusterDescription& thing = d.things[k];
    std::int32_t n = 0;
    double x = 0.0;
    double y = 0.0;
    float lowest = kInf;
    float highest = -kInf;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (d.labels.cluster[i] != static_cast<std::int32_t>(k)) continue;
      ++n;
      x += points.x[i];
      y += points.y[i];
      lowest = std::min(lowest, points.z[i]);
      highest = std::max(highest, points.z[i]);
      EXPECT_GE(points.x[i], thing.min_corner.x - 1e-6);
      EXPECT_LE(points.x[i], thing.max_corner.x + 1e-6);
      EXPECT_GE(points.y[i], thing.min_corner.y - 1e-6);
      EXPECT_LE(points.y[i], thing.max_corner.y + 1e-6);
      EXPECT_EQ(d.labels.terrain_class[i], thing.terrain_class);
      EXPECT_NE(d.labels.support[i], Support::kGround);
    }
    EXPECT_EQ(thing.points, n);
    EXPECT_EQ(thing.cells, static_cast<std::int32_t>(d.clusters.slots.row(k).size()));
    EXPECT_EQ(thing.h_min, lowest);
    EXPECT_EQ(thing.h_max, highest);
    EXPECT_NEAR(thing.centroid.x, x / n, 1e-9);
    EXPECT_NEAR(thing.centroid.y, y / n, 1e-9);
  }
}

// Oracle: the features of a cluster are those of its points taken from the labels, and each cluster
// draws random triples of its own: the stream is its number.
TEST(Describe, FeaturesAreThoseOfTheLabelledPoints) {
  const Points points = worlds::world_of_all_classes(110, 0.01);
  DescriptionParams params;
  params.classes.all_features = true;
  params.slope.inlier_distance = 0.005;  // far from a consensus, so that the triples matter
  const Description d = described(points, params);
  ASSERT_GE(d.things.size(), 4U);
  SlopeWorkspace workspace;
  for (std::size_t k = 0; k < d.things.size(); ++k) {
    std::vector<std::int32_t> members;
    MomentSums sums;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (d.labels.cluster[i] != static_cast<std::int32_t>(k)) continue;
      members.push_back(static_cast<std::int32_t>(i));
      sums.add(points.x[i], points.y[i], points.z[i]);
    }
    const Slope slope =
        estimate_slope(points.view(), {members.data(), members.data() + members.size()},
                       params.slope, k, workspace);
    EXPECT_EQ(d.things[k].slope.status, slope.status);
    EXPECT_EQ(d.things[k].slope.angle, slope.angle);
    EXPECT_EQ(d.things[k].slope.inliers, slope.inliers);
    EXPECT_EQ(d.things[k].slope.iterations, slope.iterations);
    // The description sums cell by cell: another order.
    const Roughness expected = roughness(moments_from(sums), params.roughness);
    EXPECT_EQ(d.things[k].roughness.rough, expected.rough);
    for (std::size_t q = 0; q < 3; ++q) {
      EXPECT_NEAR(d.things[k].roughness.lambda[q], expected.lambda[q], 1e-12);
    }
  }
}

/// The clusters in an order that does not depend on where they lie.
std::vector<ClusterDescription> by_size(const Description& d) {
  std::vector<ClusterDescription> things = d.things;
  std::sort(things.begin(), things.end(), [](const auto& a, const auto& b) {
    return std::tie(a.cells, a.points) < std::tie(b.cells, b.points);
  });
  return things;
}

void expect_same_shapes(const Description& a, const Description& b) {
  const auto things_a = by_size(a);
  const auto things_b = by_size(b);
  ASSERT_EQ(things_a.size(), things_b.size());
  for (std::size_t k = 0; k < things_a.size(); ++k) {
    const ClusterDescription& s = things_a[k];
    const ClusterDescription& t = things_b[k];
    EXPECT_EQ(s.cells, t.cells);
    EXPECT_EQ(s.points, t.points);
    EXPECT_EQ(s.terrain_class, t.terrain_class);
    EXPECT_EQ(s.h_min, t.h_min);
    EXPECT_EQ(s.h_max, t.h_max);
    // Sums in another order, then one rounding of each mean to float.
    EXPECT_NEAR(s.height.h_f, t.height.h_f, 1e-7);
    // The ramp is exact, so that its angle does not depend on the random triples.
    EXPECT_NEAR(s.slope.angle, t.slope.angle, 4e-6);
  }
}

TEST(Describe, TurningTheWorldTurnsTheResult) {
  const Points points = worlds::world_of_all_classes(95);
  const Description a = described(points);
  const Description b = described(worlds::turned_left(points));
  expect_same_shapes(a, b);
  const ClusterDescription ramp = thing_in(a, worlds::kRampRect);
  const ClusterDescription turned = thing_in(b, {1.0, 2.0, 1.0, 2.0});
  EXPECT_NEAR(turned.centroid.x, -ramp.centroid.y, 1e-9);
  EXPECT_NEAR(turned.centroid.y, ramp.centroid.x, 1e-9);
  EXPECT_NEAR(turned.slope.normal.x(), -ramp.slope.normal.y(), 4e-6);
  EXPECT_NEAR(turned.slope.normal.y(), ramp.slope.normal.x(), 4e-6);
}

TEST(Describe, ShiftByWholeCellsShiftsTheResult) {
  const Points points = worlds::world_of_all_classes(96);
  const Description a = described(points);
  const Description b = described(worlds::shifted(points, 0.25F, -0.15F));
  expect_same_shapes(a, b);
  const ClusterDescription box = thing_in(a, worlds::kBoxRect);
  const ClusterDescription moved = thing_in(b, {1.25, 1.65, 0.85, 1.25});
  EXPECT_NEAR(moved.min_corner.x, box.min_corner.x + 0.25, 1e-9);
  EXPECT_NEAR(moved.max_corner.y, box.max_corner.y - 0.15, 1e-9);
}

TEST(Describe, OrderOfThePointsDoesNotMatter) {
  const Points points = worlds::world_of_all_classes(97);
  std::vector<std::size_t> order;
  const Points mixed = worlds::shuffled(points, 98, &order);
  const Description a = described(points);
  const Description b = described(mixed);
  expect_same_shapes(a, b);
  EXPECT_EQ(a.clusters.cluster_of, b.clusters.cluster_of);
  EXPECT_EQ(a.ground.rule, b.ground.rule);
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(b.labels.support[i], a.labels.support[order[i]]);
    ASSERT_EQ(b.labels.terrain_class[i], a.labels.terrain_class[order[i]]);
    ASSERT_EQ(b.labels.cluster[i], a.labels.cluster[order[i]]);
  }
}

TEST(Describe, SameInputAndSeedGiveTheSameBytes) {
  const Points points = worlds::world_of_all_classes(99, 0.008);
  EXPECT_EQ(fingerprint(described(points)), fingerprint(described(points)));
}

TEST(Describe, EarlierScansAndSizesLeaveNoTrace) {
  const Points points = worlds::world_of_all_classes(100, 0.008);
  const std::string expected = fingerprint(described(points));
  const Points other = worlds::shifted(worlds::world_of_all_classes(101, 0.02), 0.4F, 0.3F);
  DescriptionParams wide;
  wide.grid.length = 12.0;
  wide.grid.width = 3.0;
  wide.grid.cell_size = 0.13;
  DescriptionParams all_features;
  all_features.classes.all_features = true;
  DescriptionWorkspace workspace;
  Description description;
  for (const DescriptionParams& between : {DescriptionParams{}, wide, all_features}) {
    describe(other.view(), between, workspace, description);
    describe(points.view(), {}, workspace, description);
    EXPECT_EQ(fingerprint(description), expected);
    describe(PointsView{}, between, workspace, description);
    EXPECT_TRUE(description.things.empty());
    describe(points.view(), {}, workspace, description);
    EXPECT_EQ(fingerprint(description), expected);
    Description fresh;
    describe(points.view(), {}, workspace, fresh);
    EXPECT_EQ(fingerprint(fresh), expected);
  }
}

TEST(Describe, ListenerHearsEveryStageInOrder) {
  struct Recorder : StageListener {
    std::vector<Stage> stages;
    void stage_done(Stage stage) override { stages.push_back(stage); }
  } recorder;
  DescriptionWorkspace workspace;
  Description description;
  describe(PointsView{}, {}, workspace, description, &recorder);
  ASSERT_EQ(recorder.stages.size(), kStageCount);
  for (std::size_t k = 0; k < kStageCount; ++k) {
    EXPECT_EQ(recorder.stages[k], static_cast<Stage>(k));
  }
}

Points repeated(std::size_t n, float x, float y, float z) {
  Points points;
  for (std::size_t i = 0; i < n; ++i) points.push_back(x, y, z);
  return points;
}

Points upright_line() {
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back(1.01F, 0.51F, 0.01F * static_cast<float>(i));
  return points;
}

Points level_line(float z) {
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back(0.01F * static_cast<float>(i) + 0.005F, 0.51F, z);
  return points;
}

Points huge_depths() {
  Points points = level_line(0.3F);
  for (std::size_t i = 0; i < points.size(); i += 4) points.z[i] = -1e30F;
  return points;
}

// Table of degenerate input: how many points became what, and what clusters there are.
TEST(Describe, DegenerateInputSaysWhy) {
  struct Case {
    const char* name;
    Points points;
    std::size_t in_map, not_finite, too_high, outside, clusters;
  };
  const std::vector<Case> cases = {
      {"no point", {}, 0, 0, 0, 0, 0},
      {"one point", repeated(1, 1, 1, 1), 1, 0, 0, 0, 1},
      {"two points", repeated(2, 1, 1, 1), 2, 0, 0, 0, 1},
      {"three points", repeated(3, 1, 1, 1), 3, 0, 0, 0, 1},
      {"all equal", repeated(1000, 1.234F, -0.777F, 0.4F), 1000, 0, 0, 0, 1},
      {"an upright line", upright_line(), 100, 0, 0, 0, 1},
      {"a level line", level_line(0.3F), 100, 0, 0, 0, 1},
      {"a deep line", level_line(-0.3F), 100, 0, 0, 0, 1},
      {"NaN", repeated(5, kNan, kNan, kNan), 0, 5, 0, 0, 0},
      {"NaN in z", repeated(5, 0, 0, kNan), 0, 5, 0, 0, 0},
      {"infinite", repeated(5, 0, kInf, 0), 0, 5, 0, 0, 0},
      {"infinitely deep", repeated(5, 0, 0, -kInf), 0, 5, 0, 0, 0},
      {"all outside", repeated(5, 3, 0, 0), 0, 0, 0, 5, 0},
      {"all too high", repeated(5, 0, 0, 2), 0, 0, 5, 0, 0},
      {"far away", repeated(5, 1e30F, -1e30F, 0), 0, 0, 0, 5, 0},
      {"far below", repeated(5, 0, 0, -1e30F), 5, 0, 0, 0, 1},
      {"far above", repeated(5, 0, 0, 1e30F), 0, 0, 5, 0, 0},
      {"partly far below", huge_depths(), 100, 0, 0, 0, 1},
  };
  DescriptionWorkspace workspace;
  Description d;
  for (const bool all_features : {false, true}) {
    DescriptionParams params;
    params.clusters.t_c = 1;
    params.classes.all_features = all_features;
    for (const Case& c : cases) {
      describe(c.points.view(), params, workspace, d);
      EXPECT_EQ(d.projection.in_map, c.in_map) << c.name;
      EXPECT_EQ(d.projection.not_finite, c.not_finite) << c.name;
      EXPECT_EQ(d.projection.too_high, c.too_high) << c.name;
      EXPECT_EQ(d.projection.outside_map, c.outside) << c.name;
      EXPECT_EQ(d.things.size(), c.clusters) << c.name;
      EXPECT_EQ(d.labels.support.size(), c.points.size()) << c.name;
      expect_finite(d, c.name);
      for (const ClusterDescription& thing : d.things) {
        EXPECT_NE(thing.terrain_class, TerrainClass::kSlope) << c.name;
        EXPECT_NE(thing.terrain_class, TerrainClass::kNone) << c.name;
        EXPECT_NE(thing.slope.status, FeatureStatus::kOk) << c.name;
      }
    }
  }
}

TEST(Describe, MapsOfOddSizes) {
  const Points points = worlds::world_of_all_classes(102);
  for (const GridParams& grid :
       {GridParams{5.0, 5.0, 5.0, 1.5}, GridParams{0.1, 0.1, 10.0, 1.5},
        GridParams{5.0, 0.1, 0.07, 1.5}, GridParams{4.99, 3.33, 0.37, 1.5}}) {
    DescriptionParams params;
    params.grid = grid;
    params.clusters.t_c = 1;
    params.classes.all_features = true;
    const Description d = described(points, params);
    expect_finite(d, "cell size " + std::to_string(grid.cell_size));
    EXPECT_GT(d.projection.in_map, 0U);
    EXPECT_EQ(d.projection.in_map + d.projection.outside_map, points.size());
    EXPECT_EQ(d.grid.slot_of.size(), static_cast<std::size_t>((d.grid.geometry.cells_l() + 2) *
                                                              (d.grid.geometry.cells_w() + 2)));
  }
}

// All features of all clusters, after two scans have warmed the memory.
TEST(Describe, DoesNotAllocateInSteadyState) {
  Points points = worlds::world_of_all_classes(103, 0.01);
  RandomGenerator random(104);
  while (points.size() < 100000) {
    const double x = 6.0 * random.uniform() - 3.0;
    const double y = 6.0 * random.uniform() - 3.0;
    worlds::add_point(points, x, y, 0.0);
  }
  const Points mixed = worlds::shuffled(points, 105);
  DescriptionParams params;
  params.classes.all_features = true;
  DescriptionWorkspace workspace;
  Description description;
  describe(points.view(), params, workspace, description);
  describe(mixed.view(), params, workspace, description);
  ASSERT_GE(description.things.size(), 4U);
  const std::size_t before = bench::allocations();
  for (int k = 0; k < 3; ++k) {
    describe(points.view(), params, workspace, description);
    describe(mixed.view(), params, workspace, description);
  }
  EXPECT_EQ(bench::allocations() - before, 0U);
  const std::vector<int> proof(100, 1);
  EXPECT_GT(bench::allocations() - before, 0U) << "the counter counts";
}

// Row "the LiDAR": where the lowest ring of a level sensor 0.81 m high meets the ground.
TEST(PaperReading, FirstRingOfSixteenBeamsLiesOutsideTheMap) {
  RandomGenerator random(106);
  const worlds::LidarScan scan = worlds::scan({}, worlds::sixteen_beams(), random);
  double nearest = 1e9;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    nearest = std::min(nearest, std::hypot(double{scan.points.x[i]}, double{scan.points.y[i]}));
  }
  EXPECT_NEAR(nearest, 3.02, 0.005);
  EXPECT_GT(nearest, GridParams{}.length / 2);
}

TEST(PaperReading, FirstRingOfThirtyTwoBeamsLiesInsideTheMap) {
  RandomGenerator random(107);
  const worlds::LidarScan scan = worlds::scan({}, worlds::thirty_two_beams(0.0), random);
  double nearest = 1e9;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    nearest = std::min(nearest, std::hypot(double{scan.points.x[i]}, double{scan.points.y[i]}));
  }
  EXPECT_NEAR(nearest, 1.37, 0.005);
  EXPECT_LT(nearest, GridParams{}.length / 2);
}

// The same row: points of 32 beams in the map. Analytic: a ring of radius r has all of its 2168
// points in the square if r < L/2, and the share 1 - (4/pi) acos(L / (2 r)) up to r = L / sqrt(2);
// each of its eight crossings of the edge may gain or lose one point.
TEST(PaperReading, ThirtyTwoBeamsPutThisManyPointsIntoTheMap) {
  constexpr double kHalf = 2.5;
  constexpr int kSteps = 2168;
  double expected = 0.0;
  double tolerance = 0.5;
  for (int beam = 0; beam < 32; ++beam) {
    const double elevation = radians(-30.67 + beam * (10.67 + 30.67) / 31);
    if (elevation >= 0.0) continue;
    const double r = 0.81 / std::tan(-elevation);
    const double outside = r < kHalf ? 0.0 : 4.0 / worlds::kPi * std::acos(kHalf / r);
    if (outside >= 1.0) continue;
    expected += kSteps * (1.0 - outside);
    tolerance += outside > 0.0 ? 8.0 : 0.0;
  }
  RandomGenerator random(108);
  const worlds::LidarScan scan = worlds::scan({}, worlds::thirty_two_beams(0.0), random);
  const Description d = described(scan.points);
  EXPECT_NEAR(static_cast<double>(d.projection.in_map), expected, tolerance);
  EXPECT_TRUE(d.things.empty());
  const Description sixteen = described(worlds::scan({}, worlds::sixteen_beams(), random).points);
  EXPECT_LT(sixteen.projection.in_map, d.projection.in_map / 10);
}

// The paper's ramp C seen by the 32-beam sensor. The far end shatters into strips of one ring each,
// because rings lie further apart than cells; the cluster of most points is the ramp. Tolerance:
// the estimates published for the real ramp scatter by less than 0.3 deg about their mean.
TEST(Describe, RampSeenByTheThirtyTwoBeamSensor) {
  worlds::Scene scene;
  scene.solids.push_back(worlds::ramp_solid({1.25, 2.45, -0.5, 0.5}, radians(18.51), 0));
  RandomGenerator random(109);
  const worlds::LidarScan scan = worlds::scan(scene, worlds::thirty_two_beams(0.005), random);
  const Description d = described(scan.points);
  ASSERT_FALSE(d.things.empty());
  const auto ramp =
      std::max_element(d.things.begin(), d.things.end(),
                       [](const auto& a, const auto& b) { return a.points < b.points; });
  EXPECT_EQ(ramp->terrain_class, TerrainClass::kSlope);
  EXPECT_NEAR(ramp->slope.angle, radians(18.51), radians(0.3));
  EXPECT_GT(ramp->points, 2000);
}

}  // namespace
}  // namespace mrpt_terrain
