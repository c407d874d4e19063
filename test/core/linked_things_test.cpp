// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "cell_scene.h"

namespace mrpt_terrain {
namespace {

using worlds::Rect;

using worlds::all_apart;
using worlds::all_one;
using worlds::at;
using Scene = worlds::CellScene;

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

// Of a deck 2.4 m up, and a column of points on a wall that carries it.
TEST(LinkedThings, WhatCarriesADeckMayBeHigh) {
  Scene scene;
  scene.thing({2.4, 4.0, 0.0, 0.2}, 2.36F, 2.4F);
  scene.ground({2.4, 4.0, 0.0, 0.2});
  scene.thing(at(3.1, -0.5), 0.05F, 2.3F);
  EXPECT_TRUE(all_one(scene.things_at({{3.1, 0.1}, {3.1, -0.5}})));
}

/// A row of cells of a table's top 0.8 m high, below which the ground is seen.
void add_top(Scene& scene, double y, float high) {
  const Rect row{2.4, 4.0, y - 0.1, y + 0.1};
  scene.thing(row, high - 0.04F, high);
  scene.ground(row);
}

// Its centre is a metre beside that of the row.
std::vector<std::int32_t> far_leg(float high) {
  Scene scene;
  add_top(scene, 0.1, 0.8F);
  scene.thing(at(3.1, -0.9), 0.05F, high);
  return scene.things_at({{3.1, 0.1}, {3.1, -0.9}});
}

TEST(LinkedThings, LegsThatAreAsHighAsATableMayBeFartherFromIt) {
  EXPECT_TRUE(all_one(far_leg(0.7F)));
  EXPECT_TRUE(all_apart(far_leg(0.55F)));
}

std::vector<std::int32_t> two_rows(double apart, float high) {
  Scene scene;
  add_top(scene, 0.1, 0.8F);
  add_top(scene, 0.1 + apart, high);
  return scene.things_at({{3.1, 0.1}, {3.1, 0.1 + apart}});
}

TEST(LinkedThings, TwoRowsOfATopAreOneIfTheyAreAsHigh) {
  EXPECT_TRUE(all_one(two_rows(0.6, 0.82F)));
  EXPECT_TRUE(all_apart(two_rows(0.6, 0.9F)));
  EXPECT_TRUE(all_apart(two_rows(0.8, 0.82F)));
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

TEST(LinkedThings, ThreeCornersOfARectangleWillDo) {
  Posts three;
  three.add(2.1, 2.1, 0.7F);
  three.add(3.3, 2.1, 0.75F);
  three.add(2.1, 2.9, 0.7F);
  EXPECT_TRUE(all_one(three.scene.things_at(three.places)));
}

TEST(LinkedThings, PostsThatAreNoRectangleOrNotAsHighStayApart) {
  Posts two, lower, skew, wide, high;
  for (Posts* posts : {&two, &lower, &skew}) {
    posts->add(2.1, 2.1, 0.7F);
    posts->add(3.3, 2.1, 0.7F);
  }
  for (const double x : {2.1, 3.3})
    for (const double y : {2.1, 2.9}) high.add(x, y, 1.8F);
  lower.add(2.1, 2.9, 0.5F);
  skew.add(2.9, 2.9, 0.7F);
  for (const double x : {2.1, 5.1})
    for (const double y : {2.1, 2.9}) wide.add(x, y, 0.7F);
  for (const Posts* posts : {&two, &lower, &skew, &wide, &high})
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

/// A wall at a flat angle to the beams, which the next column of them meets 0.8 m farther along;
/// the ground before it is seen between.
std::vector<std::int32_t> flat_wall(double y) {
  Scene scene;
  scene.thing({4.0, 6.0, y, y + 0.2}, 0.05F, 0.9F);
  scene.thing(at(6.7, y + 0.1), 0.05F, 0.9F);
  scene.ground({6.0, 6.6, y, y + 0.2});
  return scene.things_at({{4.5, y + 0.1}, {6.7, y + 0.1}}, &kSensor);
}

TEST(LinkedThings, WhatColumnsOfBeamsMeetFarApartIsOneWall) {
  EXPECT_TRUE(all_one(flat_wall(0.6)));
  EXPECT_TRUE(all_apart(flat_wall(3.0))) << "beams pass between";
}

/// Columns of points on a wall that goes away from the sensor, 0.4 m of it unseen between any two.
struct Columns {
  Scene scene;
  std::vector<Position2> places;
  void add(double x, double y, float high = 1.8F) {
    places.push_back({x, y});
    scene.thing(at(x, y), 0.05F, high);
  }
  [[nodiscard]] std::vector<std::int32_t> things() const {
    return scene.things_at(places, &kSensor);
  }
};
Columns three_columns(double y, double beside = 0.0, float last = 1.8F) {
  Columns columns;
  columns.add(6.1, y);
  columns.add(6.7, y + beside);
  columns.add(7.3, y, last);
  return columns;
}

TEST(LinkedThings, ThreeColumnsOfBeamsInARowAreAWall) {
  EXPECT_TRUE(all_one(three_columns(0.7).things()));
  Columns two, low;
  two.add(6.1, 0.7);
  two.add(6.7, 0.7);
  EXPECT_TRUE(all_apart(two.things())) << "one may stand behind the other";
  for (const double x : {6.1, 6.7, 7.3}) low.add(x, 0.7, 0.7F);
  EXPECT_TRUE(all_apart(low.things())) << "too low for a wall";
  EXPECT_TRUE(all_apart(three_columns(0.7, 0.6).things())) << "in no row";
  EXPECT_TRUE(all_apart(three_columns(3.1).things())) << "beams pass between";
  EXPECT_TRUE(all_apart(three_columns(0.7, 0.0, 2.8F).things())) << "not as high";
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
  EXPECT_TRUE(all_one(Curb(8.0).things()));
  EXPECT_TRUE(all_apart(Curb(9.0).things())) << "too far";
}

/// A curb 0.12 m high along x at y = 2, and something small at x, y beside its end at x = 6. The
/// ground is seen between.
std::vector<std::int32_t> beside_curb(double x, double y, float high) {
  Scene scene;
  const Rect curb{3.0, 6.0, 2.0, 2.4};
  scene.thing(curb, 0.05F, 0.12F);
  scene.sharp(curb);
  scene.ground({6.0, 6.4, 2.0, 2.4});
  scene.thing({x - 0.2, x + 0.2, y - 0.1, y + 0.1}, 0.05F, high);
  return scene.things_at({{5.1, 2.1}, {x, y}}, &kSensor);
}

TEST(LinkedThings, WhatLiesInTheStripOfACurbIsAPieceOfIt) {
  EXPECT_TRUE(all_one(beside_curb(6.8, 2.3, 0.15F)));
  EXPECT_TRUE(all_apart(beside_curb(6.8, 2.3, 0.2F))) << "higher";
  EXPECT_TRUE(all_apart(beside_curb(6.8, 2.9, 0.15F))) << "beside";
  EXPECT_TRUE(all_apart(beside_curb(7.6, 2.3, 0.15F))) << "too far";
}

/// Two walls along x, `apart` metres from each other; the second begins at `begin`.
struct Abutments {
  Scene scene;
  std::vector<Position2> places;
  explicit Abutments(double begin = 3.0, float high = 2.0F, double apart = 3.0)
      : places{{4.1, -1.5}, {begin + 1.1, apart - 1.5}} {
    scene.thing({3.0, 6.0, -1.6, -1.4}, 0.05F, 2.0F);
    scene.thing({begin, begin + 3.0, apart - 1.6, apart - 1.4}, 0.05F, high);
    scene.ground({2.0, 7.0, -1.0, 1.0});
  }
};

TEST(LinkedThings, TwoWallsThatAreAlikeAndOppositeEachOtherCarryADeck) {
  const Abutments bridge;
  EXPECT_TRUE(all_one(bridge.scene.things_at(bridge.places)));
  const Abutments nearer(3.0, 1.5F);
  EXPECT_TRUE(all_one(nearer.scene.things_at(nearer.places))) << "the top ring ends lower on it";
  const Abutments lower(3.0, 1.3F), shifted(3.6), wide(3.0, 2.0F, 6.4);
  for (const Abutments* street : {&lower, &shifted, &wide})
    EXPECT_TRUE(all_apart(street->scene.things_at(street->places)));
}

// Of each wall the side towards the other one and its near end are seen, which turns the directions
// of both by 5 deg, against each other.
TEST(LinkedThings, TheNearEndsOfAbutmentsDoNotTurnThem) {
  Scene scene;
  for (const double side : {-1.0, 1.0}) {
    const double face = side > 0.0 ? 2.0 : -2.2, end = side > 0.0 ? 2.2 : -2.6;
    scene.thing({3.0, 5.4, face, face + 0.2}, 0.05F, 2.0F);
    scene.thing({3.0, 3.2, end, end + 0.4}, 0.05F, 2.0F);
  }
  EXPECT_TRUE(all_one(scene.things_at({{4.1, -2.1}, {4.1, 2.1}})));
}

// The second wall ends opposite the middle of the first.
TEST(LinkedThings, PartOfAnAbutmentMayBeHidden) {
  Scene scene;
  scene.thing({3.0, 6.0, -1.6, -1.4}, 0.05F, 2.0F);
  scene.thing({3.0, 4.6, 1.4, 1.6}, 0.05F, 2.0F);
  const std::vector<Position2> places{{4.1, -1.5}, {4.1, 1.5}};
  EXPECT_TRUE(all_one(scene.things_at(places, &kSensor)));
  EXPECT_TRUE(all_apart(scene.things_at(places))) << "no sensor, no beams";
  scene.ground({6.4, 6.8, 1.8, 2.2});
  EXPECT_TRUE(all_apart(scene.things_at(places, &kSensor))) << "the ground behind is seen";
}

/// Two pieces of a lawn, the first 0.2 m high, with a point on the ground between.
std::vector<std::int32_t> lawn(float second, double gap, bool sharp) {
  Scene scene;
  const Rect near{4.0, 4.4, -1.0, 1.0}, far{4.4 + gap, 4.8 + gap, -1.0, 1.0};
  scene.thing(near, 0.05F, 0.2F);
  scene.thing(far, 0.05F, second);
  scene.ground(at(4.7, 0.1));
  if (sharp) scene.sharp(near);
  return scene.things_at({{4.1, 0.1}, {4.5 + gap, 0.1}});
}

TEST(LinkedThings, PiecesOfALawnAreOneIfTheyAreAsHigh) {
  EXPECT_TRUE(all_one(lawn(0.22F, 0.8, false)));
  EXPECT_TRUE(all_apart(lawn(0.3F, 0.8, false))) << "not as high";
  EXPECT_TRUE(all_apart(lawn(0.22F, 1.2, false))) << "too far";
  EXPECT_TRUE(all_apart(lawn(0.22F, 0.8, true))) << "kerbs have sharp edges";
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

/// What rises to `high` in the middle of a rectangle, with ground at some height beside it.
std::int32_t rise(float high, float ground, float extent = 0.05F) {
  Scene scene;
  scene.ground({2.8, 4.2, 0.8, 2.2}, ground);
  scene.thing({3.0, 4.0, 1.0, 2.0}, 0.1F, 0.1F + extent);
  scene.thing({3.4, 3.6, 1.4, 1.6}, high - extent, high);
  return scene.things_at({{3.5, 1.5}}).front();
}

TEST(LinkedThings, WhatTheGroundRisesToWithoutAStepIsNone) {
  EXPECT_EQ(rise(0.3F, 0.08F), kNoCluster);
  EXPECT_NE(rise(0.3F, 0.02F), kNoCluster) << "a step down to the ground";
  EXPECT_NE(rise(0.5F, 0.08F), kNoCluster) << "high";
  EXPECT_NE(rise(0.3F, 0.08F, 0.12F), kNoCluster) << "upright";
}

/// What is even and so high, with a step down to the ground along one of its long sides and, if
/// there are two, along the other.
std::int32_t deck_with_steps(int steps, bool deck, float high) {
  Scene scene;
  const Rect whole{3.0, 4.0, 1.0, 1.4};
  scene.ground({2.8, 4.2, 0.8, 1.6}, 0.8F * high);
  scene.ground({3.0, 4.0, 0.8, 1.0});
  if (steps == 2) scene.ground({3.0, 4.0, 1.4, 1.6});
  scene.thing(whole, high - 0.05F, high);
  if (deck) scene.deck(whole);
  return scene.things_at({{3.5, 1.1}}).front();
}

TEST(LinkedThings, ADeckEndsInStepsForTheMostPart) {
  EXPECT_EQ(deck_with_steps(1, true, 0.2F), kNoCluster);
  EXPECT_EQ(deck_with_steps(1, true, 0.6F), kNoCluster) << "however high";
  EXPECT_NE(deck_with_steps(2, true, 0.2F), kNoCluster);
  EXPECT_NE(deck_with_steps(1, false, 0.2F), kNoCluster) << "no deck";
}

}  // namespace
}  // namespace mrpt_terrain
