// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "grids.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using Rows = std::vector<std::string>;

/// Cells of 1 m from a drawing: '#' above the ground, 'v' below it, '.' ground, ' ' unobserved.
/// '#' reaches from 0.1 m to 1 m, 'T' is a roof from 2 m to 3 m, 'r' is ground raised by 0.1 m with
/// a sharp edge. One point each.
struct Cells {
  ElevationGrid grid;
  GroundSegmentation ground;
  FieldCells field;
};
Cells drawn(const Rows& rows) {
  Cells result;
  Rows marks = rows;
  for (std::string& row : marks) {
    for (char& mark : row) mark = mark == ' ' ? ' ' : mark == '.' || mark == 'r' ? '.' : '#';
  }
  grids::Drawing drawing = grids::drawing(marks);
  result.grid = std::move(drawing.grid);
  result.ground = std::move(drawing.ground);
  const std::size_t n = result.grid.observed();
  FieldCells& field = result.field;
  for (auto* values : {&field.ground, &field.low, &field.high, &field.floor, &field.rim,
                       &field.raised_low, &field.raised_high})
    values->assign(n, 0.0F);
  for (auto* counts : {&field.on, &field.above, &field.below, &field.raised}) counts->assign(n, 0);
  for (auto* counts : {&field.sharp_edges, &field.smooth_edges}) counts->assign(n, 0);
  field.deck.assign(n, -1);
  field.level.assign(n, 0);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const CellIndex at = result.grid.geometry.index_of(result.grid.cell[slot]);
    const char mark = rows[static_cast<std::size_t>(at.l)][static_cast<std::size_t>(at.w)];
    if (mark == '.' || mark == 'r') field.on[slot] = 1;
    if (mark == 'r') {
      field.raised[slot] = 1;
      field.raised_low[slot] = field.raised_high[slot] = 0.1F;
      field.sharp_edges[slot] = 1;
    }
    if (mark == 'v') {
      result.ground.rule[slot] = GroundRule::kLow;
      field.below[slot] = 1;
    }
    if (mark == '#' || mark == 'T') {
      field.above[slot] = 1;
      field.low[slot] = mark == 'T' ? 2.0F : 0.1F;
      field.high[slot] = mark == 'T' ? 3.0F : 1.0F;
    }
  }
  return result;
}

/// Everything is kept, only cells that touch are of one thing.
FieldClusterParams touching() {
  FieldClusterParams params;
  params.t_c = 1;
  params.t_points = 1;
  params.link = 0.0;
  params.link_growth = 0.0;
  params.step = 0.3;
  params.flat = 1e9;
  params.unseen = 0.0;
  return params;
}
FieldClusterParams linked(double link, double growth = 0.0) {
  FieldClusterParams params = touching();
  params.link = link;
  params.link_growth = growth;
  return params;
}

Clusters clustered(const Cells& cells, const FieldClusterParams& params) {
  Clusters result;
  FieldClusterWorkspace workspace;
  find_field_clusters(cells.grid, cells.ground, cells.field, params, workspace, result);
  return result;
}

/// The drawing with the number of its thing in place of each non-ground cell, 'x' where dropped.
Rows numbered(const Rows& rows, const FieldClusterParams& params) {
  const Cells cells = drawn(rows);
  const Clusters clusters = clustered(cells, params);
  Rows result = rows;
  for (std::size_t slot = 0; slot < cells.grid.observed(); ++slot) {
    if (cells.ground.is_ground(slot) && cells.field.raised[slot] == 0) continue;
    const CellIndex at = cells.grid.geometry.index_of(cells.grid.cell[slot]);
    const std::int32_t k = clusters.cluster_of[slot];
    result[static_cast<std::size_t>(at.l)][static_cast<std::size_t>(at.w)] =
        k == kNoCluster ? 'x' : static_cast<char>('0' + k);
  }
  return result;
}

// Literal: numbers follow the first cell of each thing in the order of the grid.
TEST(FieldClusters, ThingsAreNumberedByTheirFirstCells) {
  EXPECT_EQ(numbered({"..#..#",  //
                      "#..#..",  //
                      "#....#",  //
                      ".##..#"},
                     touching()),
            (Rows{"..0..1",  //
                  "2..0..",  //
                  "2....3",  //
                  ".22..3"}));
}

TEST(FieldClusters, ThingsAboveAndBelowTheGroundNeverMix) {
  EXPECT_EQ(numbered({"##vv",  //
                      "#vv#"},
                     touching()),
            (Rows{"0011",  //
                  "0112"}));
  FieldClusterParams wide = linked(10.0);
  wide.step = 100.0;
  EXPECT_EQ(numbered({"#v#v"}, wide), (Rows{"0101"}));
}

// A gap of `link` metres may be bridged, in whole cells, over ground and over what is not seen.
TEST(FieldClusters, GapsUpToTheLinkAreBridged) {
  EXPECT_EQ(numbered({"#.#"}, linked(0.99)), (Rows{"0.1"}));
  EXPECT_EQ(numbered({"#.#"}, linked(1.0)), (Rows{"0.0"}));
  EXPECT_EQ(numbered({"# #"}, linked(1.0)), (Rows{"0 0"}));
  EXPECT_EQ(numbered({"#..#"}, linked(1.99)), (Rows{"0..1"}));
  EXPECT_EQ(numbered({"#..#"}, linked(2.0)), (Rows{"0..0"}));
  EXPECT_EQ(numbered({"#..", "...", "..#"}, linked(1.0)), (Rows{"0..", "...", "..0"}));
  EXPECT_EQ(numbered({"..#", "...", "#.."}, linked(1.0)), (Rows{"..0", "...", "0.."}));
}

// However far away: two cells in between at most.
TEST(FieldClusters, GapsOfThreeCellsAreNeverBridged) {
  EXPECT_EQ(numbered({"#...#"}, linked(10.0, 1.0)), (Rows{"0...1"}));
  EXPECT_EQ(numbered({"#..#"}, linked(10.0, 1.0)), (Rows{"0..0"}));
}

// Pairs with one cell in between, the second of each at 1, 7, ... 25 m along y; the row's centres
// lie at w - 26. The gap of 1 m may be bridged from 0.2 + 0.06 d >= 1 on: d >= 13.3 m.
TEST(FieldClusters, LinkingGrowsWithDistance) {
  std::string row(53, '.');
  const std::vector<std::size_t> second{1, 7, 13, 19, 25};
  for (const std::size_t d : second) row[26 + d] = row[24 + d] = '#';
  const Cells cells = drawn({row});
  const Clusters clusters = clustered(cells, linked(0.2, 0.06));
  for (const std::size_t d : second) {
    const bool one = clusters.cluster_of[26 + d] == clusters.cluster_of[24 + d];
    EXPECT_EQ(one, d > 13) << d << " m";
  }
  EXPECT_EQ(clusters.size(), 3 * 2U + 2U);
}

// A roof from 2 m up beside a wall up to 1 m: 1 m apart in height.
TEST(FieldClusters, AGapInHeightKeepsACanopyOffAWall) {
  const Rows rows{"##TT", "##TT"};
  FieldClusterParams params = touching();
  EXPECT_EQ(numbered(rows, params), (Rows{"0011", "0011"}));
  params.step = 0.99;
  EXPECT_EQ(numbered(rows, params), (Rows{"0011", "0011"}));
  params.step = 1.01;
  EXPECT_EQ(numbered(rows, params), (Rows{"0000", "0000"}));
  // And the other way round: the order of the cells does not matter.
  EXPECT_EQ(numbered({"T#T#"}, touching()), (Rows{"0123"}));
  EXPECT_EQ(numbered({"T#T#"}, linked(1.0)), (Rows{"0101"})) << "past each other";
}

// Upright surfaces are seen without gaps: posts beside each other are two things.
TEST(FieldClusters, OnlyFlatCellsAreLinkedAcrossGaps) {
  FieldClusterParams params = linked(1.0);
  params.flat = 0.89;  // '#' extends over 0.9 m
  EXPECT_EQ(numbered({"#.#"}, params), (Rows{"0.1"}));
  EXPECT_EQ(numbered({"##"}, params), (Rows{"00"}));
  EXPECT_EQ(numbered({"r.r"}, params), (Rows{"0.0"}));
  params.flat = 0.91;
  EXPECT_EQ(numbered({"#.#"}, params), (Rows{"0.0"}));
}

TEST(FieldClusters, RaisedGroundIsOneThingWithWhatStandsBesideIt) {
  EXPECT_EQ(numbered({"rr#.r"}, touching()), (Rows{"000.1"}));
  EXPECT_EQ(numbered({"rT"}, touching()), (Rows{"01"})) << "1.9 m apart in height";
  EXPECT_EQ(numbered({"rvr"}, touching()), (Rows{"012"}));
}

// The side of a ramp does not rise above it; a wall beside it does.
TEST(FieldClusters, ADeckGoesWithItsSideButNotWithAWall) {
  for (const float top : {1.04F, 1.06F}) {
    Cells cells = drawn({"####"});
    cells.field.deck[0] = cells.field.deck[1] = 0;
    cells.field.high[2] = cells.field.high[3] = top;
    EXPECT_EQ(clustered(cells, touching()).size(), top < 1.05F ? 1U : 2U) << top;
    cells.field.deck[2] = cells.field.deck[3] = 1;
    EXPECT_EQ(clustered(cells, touching()).size(), 1U) << "two faces of a ramp";
  }
}

// Two rings meet a curb far apart: as long as no ground was seen between, it goes on there.
TEST(FieldClusters, RaisedGroundGoesOnWhereNothingWasSeen) {
  FieldClusterParams params = touching();
  params.unseen = 4.0;
  EXPECT_EQ(numbered({"r   r"}, params), (Rows{"0   0"}));
  EXPECT_EQ(numbered({"r    r"}, params), (Rows{"0    1"})) << "five cells away";
  EXPECT_EQ(numbered({"r . r"}, params), (Rows{"0 . 1"})) << "ground was seen between";
  EXPECT_EQ(numbered({"#   #"}, params), (Rows{"0   1"})) << "not of upright things";
  EXPECT_EQ(numbered({"r  ", "   ", "  r"}, params), (Rows{"0  ", "   ", "  0"}));
  Cells cells = drawn({"r   r"});
  cells.field.raised_low[1] = cells.field.raised_high[1] = 0.151F;
  EXPECT_EQ(clustered(cells, params).size(), 2U) << "of another height";
  cells.field.raised_low[1] = cells.field.raised_high[1] = 0.149F;
  EXPECT_EQ(clustered(cells, params).size(), 1U);
}

// What rises smoothly out of the ground is ground, whatever a few of its edges look like; what
// stands on it makes it a thing.
TEST(FieldClusters, SwellsOfTheGroundAreDropped) {
  FieldClusterParams params = touching();
  params.sharp = 0.3;
  Cells cells = drawn({"rrr.#"});
  for (std::size_t slot = 0; slot < 3; ++slot) {
    cells.field.sharp_edges[slot] = 2;
    cells.field.smooth_edges[slot] = 5;
  }
  EXPECT_EQ(clustered(cells, params).size(), 1U);
  EXPECT_EQ(clustered(cells, params).dropped, 1U);
  EXPECT_EQ(clustered(cells, params).cluster_of[0], kNoCluster);
  cells.field.smooth_edges[0] = 3;  // 6 of 19
  EXPECT_EQ(clustered(cells, params).size(), 2U);
  cells.field.smooth_edges[0] = 100;
  cells.field.above[2] = 1;
  EXPECT_EQ(clustered(cells, params).size(), 2U);
}

// A hole has no height above the ground, whatever hangs over some of its cells.
TEST(FieldClusters, WhatHangsOverAHoleDoesNotDivideIt) {
  Cells cells = drawn({"vvv"});
  cells.field.above[1] = 3;
  cells.field.low[1] = 1.0F;
  cells.field.high[1] = 2.0F;
  EXPECT_EQ(clustered(cells, touching()).size(), 1U);
}

// Dropped is what has too few cells and too few points; enough of one of them is enough.
TEST(FieldClusters, SmallThingsAreDroppedAndCounted) {
  FieldClusterParams params = touching();
  params.t_c = 3;
  params.t_points = 5;
  const Rows rows{"#..##..###..#"};
  EXPECT_EQ(numbered(rows, params), (Rows{"x..xx..000..x"}));
  Cells cells = drawn(rows);
  EXPECT_EQ(clustered(cells, params).dropped, 3U);
  cells.field.above[0] = 5;
  const Clusters kept = clustered(cells, params);
  EXPECT_EQ(kept.size(), 2U) << "one cell with five points";
  EXPECT_EQ(kept.dropped, 2U);
  EXPECT_EQ(kept.cluster_of[0], 0);
  EXPECT_EQ(kept.cluster_of[7], 1);
  cells.field.above[0] = 4;
  EXPECT_EQ(clustered(cells, params).dropped, 3U);
}

TEST(FieldClusters, RowsHoldTheSlotsAscending) {
  const Clusters clusters = clustered(drawn({"#.#", "#.#", "#.."}), touching());
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters.slots.items, (std::vector<std::int32_t>{0, 3, 6, 2, 5}));
  EXPECT_EQ(clusters.slots.first, (std::vector<std::int32_t>{0, 3, 5}));
}

TEST(FieldClusters, NoNonGroundCellsGiveNoThings) {
  for (const Rows& rows : {Rows{"..."}, Rows{"   "}}) {
    const Clusters clusters = clustered(drawn(rows), touching());
    EXPECT_EQ(clusters.size(), 0U);
    EXPECT_EQ(clusters.dropped, 0U);
    EXPECT_EQ(clusters.slots.first, (std::vector<std::int32_t>{0}));
  }
}

Rows random_rows(RandomGenerator& random, const std::string& marks) {
  Rows rows(1 + random.below(12));
  const std::size_t width = 1 + random.below(12);
  for (std::string& row : rows) {
    for (std::size_t w = 0; w < width; ++w)
      row += marks[random.below(static_cast<std::uint32_t>(marks.size()))];
  }
  return rows;
}

// Oracle: with links below a cell and any step, these are the paper's clusters.
TEST(FieldClusters, WithoutLinksAndStepsTheyAreThePapersClusters) {
  RandomGenerator random(261);
  FieldClusterWorkspace workspace;
  ClusterWorkspace papers_workspace;
  for (int trial = 0; trial < 300; ++trial) {
    const Cells cells = drawn(random_rows(random, trial % 2 == 0 ? "#.T " : "##T."));
    FieldClusterParams params = linked(0.9);
    params.step = 1e9;
    params.t_c = 1 + static_cast<int>(random.below(5));
    params.t_points = 1000000;
    Clusters field, paper;
    find_field_clusters(cells.grid, cells.ground, cells.field, params, workspace, field);
    find_clusters(cells.grid, cells.ground, ClusterParams{params.t_c}, papers_workspace, paper);
    ASSERT_EQ(field.cluster_of, paper.cluster_of) << trial;
    ASSERT_EQ(field.slots.first, paper.slots.first) << trial;
    ASSERT_EQ(field.slots.items, paper.slots.items) << trial;
    ASSERT_EQ(field.dropped, paper.dropped) << trial;
  }
}

/// Oracle: all pairs of cells, until no label changes; how far a link reaches is up to the later.
std::vector<std::int32_t> labels_by_pairs(const Cells& cells, const FieldClusterParams& params) {
  const auto n = static_cast<std::int32_t>(cells.grid.observed());
  std::vector<std::int32_t> label(static_cast<std::size_t>(n));
  for (std::int32_t i = 0; i < n; ++i) label[static_cast<std::size_t>(i)] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < label.size(); ++a) {
      for (std::size_t b = a + 1; b < label.size(); ++b) {
        if (cells.ground.is_ground(a) || cells.ground.rule[a] != cells.ground.rule[b]) continue;
        const CellIndex at = cells.grid.geometry.index_of(cells.grid.cell[a]);
        const CellIndex to = cells.grid.geometry.index_of(cells.grid.cell[b]);
        const Position2 centre = cells.grid.geometry.centre_of(to);
        const double gap = params.link + params.link_growth * std::hypot(centre.x, centre.y);
        const int steps = std::max(std::abs(at.l - to.l), std::abs(at.w - to.w));
        if (steps > 3 || steps - 1 > gap) continue;
        const float high = std::min(cells.field.high[a], cells.field.high[b]);
        const float low = std::max(cells.field.low[a], cells.field.low[b]);
        const bool apart = low - high > static_cast<float>(params.step);
        if (cells.ground.rule[a] != GroundRule::kLow && apart) continue;
        if (label[a] == label[b]) continue;
        label[a] = label[b] = std::min(label[a], label[b]);
        changed = true;
      }
    }
  }
  return label;
}

TEST(FieldClusters, SameAsLinkingAllPairs) {
  RandomGenerator random(262);
  FieldClusterWorkspace workspace;
  for (int trial = 0; trial < 200; ++trial) {
    Cells cells = drawn(random_rows(random, "#.v. ..T"));
    for (std::size_t slot = 0; slot < cells.field.size(); ++slot) {
      if (cells.ground.is_ground(slot)) continue;
      cells.field.low[slot] = static_cast<float>(2.0 * random.uniform());
      cells.field.high[slot] = cells.field.low[slot] + static_cast<float>(random.uniform());
    }
    const FieldClusterParams params = linked(1.5 * random.uniform(), 0.5 * random.uniform());
    Clusters clusters;
    find_field_clusters(cells.grid, cells.ground, cells.field, params, workspace, clusters);
    const std::vector<std::int32_t> label = labels_by_pairs(cells, params);
    std::vector<std::int32_t> number(label.size(), kNoCluster), expected;
    std::int32_t next = 0;
    for (std::size_t slot = 0; slot < label.size(); ++slot) {
      const auto root = static_cast<std::size_t>(label[slot]);
      if (!cells.ground.is_ground(slot) && number[root] == kNoCluster) number[root] = next++;
      expected.push_back(cells.ground.is_ground(slot) ? kNoCluster : number[root]);
    }
    ASSERT_EQ(clusters.cluster_of, expected) << trial;
  }
}

}  // namespace
}  // namespace mrpt_terrain
