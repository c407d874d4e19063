// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/field_clusters.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::Rect;

constexpr int kSide = 100;
constexpr double kCell = 0.2;

/// What is seen in cells of 0.2 m on 20 m x 20 m, on level ground at z = 0.
class Scene {
 public:
  /// Ground is seen in a rectangle.
  void ground(const Rect& rect) {
    for_cells(rect, [](Cell& cell) { cell.on = 1; });
  }
  /// Points from `low` to `high` above the ground are seen in a rectangle.
  void thing(const Rect& rect, float low, float high) {
    for_cells(rect, [&](Cell& cell) {
      cell.above = 5;
      cell.low = low;
      cell.high = high;
    });
  }
  /// What is above the ground in a rectangle is no higher than the ground around.
  void level(const Rect& rect) {
    for_cells(rect, [](Cell& cell) { cell.level = 1; });
  }

  /// Numbers of the things at some places.
  [[nodiscard]] std::vector<std::int32_t> things_at(
      const std::vector<Position2>& places, const std::array<float, 3>* sensor = nullptr) const {
    const Cells cells = build();
    Clusters clusters;
    FieldClusterWorkspace workspace;
    find_field_clusters(cells.grid, cells.ground, cells.field, FieldClusterParams{}, workspace,
                        clusters, sensor);
    std::vector<std::int32_t> result;
    for (const Position2& place : places) {
      CellIndex at;
      EXPECT_TRUE(cells.grid.geometry.cell_at(place.x, place.y, at));
      const Slot slot = cells.grid.slot_at(at);
      EXPECT_NE(slot, kUnobserved) << place.x << ' ' << place.y;
      result.push_back(clusters.cluster_of[static_cast<std::size_t>(slot)]);
    }
    return result;
  }

 private:
  struct Cell {
    std::int32_t on = 0, above = 0;
    float low = 0.0F, high = 0.0F;
    std::uint8_t level = 0;
  };
  struct Cells {
    ElevationGrid grid;
    GroundSegmentation ground;
    FieldCells field;
  };

  template <class F>
  void for_cells(const Rect& rect, F&& f) {
    for (int l = 0; l < kSide; ++l) {
      for (int w = 0; w < kSide; ++w) {
        const Position2 at = geometry().centre_of({l, w});
        if (worlds::inside(rect, at.x, at.y)) f(cells_[static_cast<std::size_t>(l * kSide + w)]);
      }
    }
  }
  [[nodiscard]] static GridGeometry geometry() {
    return GridGeometry(kSide * kCell, kSide * kCell, kCell);
  }
  [[nodiscard]] Cells build() const {
    Cells result;
    result.grid.geometry = geometry();
    result.grid.slot_of.assign(static_cast<std::size_t>(geometry().array_size()), kUnobserved);
    FieldCells& field = result.field;
    for (int l = 0; l < kSide; ++l) {
      for (int w = 0; w < kSide; ++w) {
        const Cell& cell = cells_[static_cast<std::size_t>(l * kSide + w)];
        if (cell.on + cell.above == 0) continue;
        const CellId id = geometry().id_of({l, w});
        result.grid.slot_of[static_cast<std::size_t>(value_of(id))] =
            static_cast<Slot>(result.grid.cell.size());
        result.grid.cell.push_back(id);
        result.ground.rule.push_back(cell.above > 0 ? GroundRule::kHigh : GroundRule::kGround);
        field.on.push_back(cell.on);
        field.above.push_back(cell.above);
        field.low.push_back(cell.low);
        field.high.push_back(cell.high);
        field.level.push_back(cell.level);
      }
    }
    const std::size_t n = result.grid.observed();
    for (auto* values :
         {&field.ground, &field.floor, &field.rim, &field.raised_low, &field.raised_high})
      values->assign(n, 0.0F);
    for (auto* counts : {&field.below, &field.raised}) counts->assign(n, 0);
    for (auto* counts : {&field.sharp_edges, &field.smooth_edges}) counts->assign(n, 0);
    field.deck.assign(n, -1);
    return result;
  }

  std::vector<Cell> cells_ = std::vector<Cell>(kSide * kSide);
};

/// A cell about a place.
Rect at(double x, double y) { return {x - 0.05, x + 0.05, y - 0.05, y + 0.05}; }

bool all_one(const std::vector<std::int32_t>& things) {
  for (const std::int32_t thing : things)
    if (thing != things.front() || thing == kNoCluster) return false;
  return true;
}
bool all_apart(const std::vector<std::int32_t>& things) {
  for (std::size_t a = 0; a < things.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b)
      if (things[a] == kNoCluster || (a != b && things[a] == things[b])) return false;
  }
  return true;
}

// Of a table's top 0.8 m high, a ring in the middle is seen, and two of its legs 0.5 m beside.
struct Table {
  Scene scene;
  std::vector<Position2> places{{3.1, 0.1}, {3.1, -0.5}, {3.7, 0.7}};

  Table(float leg, bool ground_below) {
    scene.thing({2.4, 4.0, 0.0, 0.2}, 0.76F, 0.8F);
    if (ground_below) scene.ground({2.4, 4.0, 0.0, 0.2});
    scene.thing(at(3.1, -0.5), 0.05F, leg);
    scene.thing(at(3.7, 0.7), 0.05F, leg);
  }
};

TEST(LinkedThings, ATableIsOneWithItsLegs) {
  const Table table(0.7F, true);
  EXPECT_TRUE(all_one(table.scene.things_at(table.places)));
}

// The same beside the top of a box, below which no ground is seen; posts that are higher than the
// table, and lower than its top by more than rings miss.
TEST(LinkedThings, PostsBesideABoxOrOfOtherHeightsAreNoLegs) {
  const Table box(0.7F, false), higher(1.2F, true), lower(0.4F, true);
  for (const Table* table : {&box, &higher, &lower})
    EXPECT_TRUE(all_apart(table->scene.things_at(table->places)));
}

struct Posts {
  Scene scene;
  std::vector<Position2> places;
  void add(double x, double y, float high) {
    scene.thing(at(x, y), 0.05F, high);
    places.push_back({x, y});
  }
};

// Turned by 45 degrees about (3, 3), sides of 1.4 m and 0.85 m.
TEST(LinkedThings, FourPostsAtTheCornersOfARectangleAreOne) {
  Posts four;
  four.add(2.1, 3.1, 0.7F);
  four.add(3.1, 4.1, 0.75F);
  four.add(2.7, 2.5, 0.7F);
  four.add(3.7, 3.5, 0.72F);
  EXPECT_TRUE(all_one(four.scene.things_at(four.places)));
}

TEST(LinkedThings, PostsThatAreNoRectangleOrNotAsHighStayApart) {
  Posts three, lower, skew, wide;
  for (Posts* posts : {&three, &lower, &skew}) {
    posts->add(2.1, 2.1, 0.7F);
    posts->add(3.3, 2.1, 0.7F);
    posts->add(2.1, 2.9, 0.7F);
  }
  lower.add(3.3, 2.9, 0.5F);
  skew.add(3.9, 2.9, 0.7F);
  for (const double x : {2.1, 5.1})
    for (const double y : {2.1, 2.9}) wide.add(x, y, 0.7F);
  for (const Posts* posts : {&three, &lower, &skew, &wide})
    EXPECT_TRUE(all_apart(posts->scene.things_at(posts->places)));
}

constexpr std::array<float, 3> kSensor{0.0F, 0.0F, 1.0F};

/// A wall along y at x = 6, which is seen left and right of a gap of 1.6 m.
struct Wall {
  Scene scene;
  std::vector<Position2> places{{6.1, -2.1}, {6.1, 2.1}};
  explicit Wall(float right = 1.9F) {
    scene.thing({6.0, 6.2, -4.0, -0.8}, 0.05F, 2.0F);
    scene.thing({6.0, 6.2, 0.8, 4.0}, 0.05F, right);
  }
  [[nodiscard]] std::vector<std::int32_t> things() const {
    return scene.things_at(places, &kSensor);
  }
};

TEST(LinkedThings, AWallGoesOnBehindWhatHidesIt) {
  Wall wall;
  wall.scene.thing({3.0, 3.4, -0.4, 0.4}, 0.05F, 0.9F);  // hides the gap, and what is behind
  EXPECT_TRUE(all_one(wall.things()));
  EXPECT_TRUE(all_apart(wall.scene.things_at(wall.places))) << "no sensor, no beams";
}

TEST(LinkedThings, AGateIsNoHiddenWall) {
  Wall gate, view, low;
  gate.scene.ground(at(6.1, 0.1));
  EXPECT_TRUE(all_apart(gate.things())) << "the ground is seen in it";
  // 2 m behind, a beam meets the ground that has passed the gap 0.25 m above it...
  view.scene.ground({8.0, 8.2, -0.2, 0.2});
  EXPECT_TRUE(all_apart(view.things()));
  // ...and one meets a thing far behind.
  low.scene.thing({9.4, 9.6, -0.2, 0.2}, 0.5F, 1.5F);
  EXPECT_TRUE(all_apart(low.things()));
}

TEST(LinkedThings, WhatIsFarLowerOrBesideTheLineIsAnotherThing) {
  EXPECT_TRUE(all_apart(Wall(0.3F).things()));
  Wall beside;
  beside.scene = Scene();
  beside.scene.thing({6.0, 6.2, -4.0, -0.8}, 0.05F, 2.0F);
  beside.scene.thing({6.8, 7.0, 0.8, 4.0}, 0.05F, 2.0F);
  beside.places[1].x = 6.9;
  EXPECT_TRUE(all_apart(beside.things()));
}

/// A curb 0.12 m high along x at y = 2, which two rings meet 1.2 m apart, or farther.
struct Curb {
  Scene scene;
  std::vector<Position2> places{{4.1, 2.1}, {5.9, 2.1}};
  explicit Curb(double second = 5.8, float high = 0.12F) {
    scene.thing({4.0, 4.6, 2.0, 2.4}, 0.08F, 0.12F);
    scene.thing({second, second + 0.6, 2.0, 2.4}, high - 0.04F, high);
    places[1].x = second + 0.1;
  }
  [[nodiscard]] std::vector<std::int32_t> things() const {
    return scene.things_at(places, &kSensor);
  }
};

TEST(LinkedThings, ACurbGoesOnBetweenTwoRings) {
  EXPECT_TRUE(all_one(Curb().things()));
  Curb interrupted;
  interrupted.scene.ground(at(5.1, 2.1));
  EXPECT_TRUE(all_apart(interrupted.things())) << "the ground is seen between";
  EXPECT_TRUE(all_apart(Curb(5.8, 0.2F).things())) << "not as high";
  EXPECT_TRUE(all_apart(Curb(7.0).things())) << "too far";
}

TEST(LinkedThings, WhatIsNoHigherThanTheGroundAroundIsNone) {
  Scene scene;
  const Rect whole{3.0, 4.0, 1.0, 2.0};
  scene.thing(whole, 0.1F, 0.3F);
  const std::vector<Position2> place{{3.5, 1.5}};
  EXPECT_NE(scene.things_at(place).front(), kNoCluster);
  Scene half = scene;
  half.level({3.0, 3.4, 1.0, 2.0});
  EXPECT_NE(half.things_at(place).front(), kNoCluster);
  scene.level(whole);
  EXPECT_EQ(scene.things_at(place).front(), kNoCluster);
}

}  // namespace
}  // namespace mrpt_terrain
