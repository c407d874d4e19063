// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <queue>
#include <string>
#include <vector>

#include "grids.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain {
namespace {

using grids::drawing;
using grids::Drawing;

Clusters clustered(const Drawing& d, int t_c = 1) {
  Clusters result;
  ClusterWorkspace workspace;
  find_clusters(d.grid, d.ground, ClusterParams{t_c}, workspace, result);
  return result;
}

/// The drawing with the number of its cluster in place of each '#' ('x' where it has none).
std::vector<std::string> numbered(const Drawing& d, const Clusters& clusters) {
  std::vector<std::string> rows;
  for (int l = 0; l < d.grid.geometry.cells_l(); ++l) {
    rows.emplace_back();
    for (int w = 0; w < d.grid.geometry.cells_w(); ++w) {
      const Slot slot = d.grid.slot_at({l, w});
      if (slot == kUnobserved) {
        rows.back() += ' ';
      } else if (d.ground.is_ground(static_cast<std::size_t>(slot))) {
        rows.back() += '.';
      } else {
        const std::int32_t k = clusters.cluster_of[static_cast<std::size_t>(slot)];
        rows.back() += k == kNoCluster ? 'x' : static_cast<char>('0' + k);
      }
    }
  }
  return rows;
}

using Rows = std::vector<std::string>;

// Literal.
TEST(Clusters, TwoClustersByHand) {
  const Drawing d = drawing({"##..#",  //
                             "#...#",  //
                             ".....",  //
                             "..###"});
  EXPECT_EQ(numbered(d, clustered(d)), (Rows{"00..1", "0...1", ".....", "..222"}));
}

TEST(Clusters, ConnectInAllEightDirections) {
  const Rows centre = {"...", ".#.", "..."};
  for (int l = 0; l < 3; ++l) {
    for (int w = 0; w < 3; ++w) {
      if (l == 1 && w == 1) continue;
      Rows rows = centre;
      rows[static_cast<std::size_t>(l)][static_cast<std::size_t>(w)] = '#';
      EXPECT_EQ(clustered(drawing(rows)).size(), 1U) << l << " " << w;
    }
  }
}

TEST(Clusters, DoNotReachOverOneCell) {
  EXPECT_EQ(clustered(drawing({"#.#"})).size(), 2U);
  EXPECT_EQ(clustered(drawing({"#", ".", "#"})).size(), 2U);
  EXPECT_EQ(clustered(drawing({"#..", "..#"})).size(), 2U);
}

TEST(Clusters, TheEndOfARowDoesNotTouchTheStartOfTheNext) {
  EXPECT_EQ(clustered(drawing({"..#", "#.."})).size(), 2U);
  EXPECT_EQ(clustered(drawing({"..#", "...", "#.."})).size(), 2U);
}

// Branches that meet only in the last row, and a ring about an island.
TEST(Clusters, LateJunctionsAndIslands) {
  const Drawing comb = drawing({"#.#.#.#",  //
                                "#.#.#.#",  //
                                "#######"});
  EXPECT_EQ(numbered(comb, clustered(comb)), (Rows{"0.0.0.0", "0.0.0.0", "0000000"}));
  const Drawing ring = drawing({".###.",  //
                                "#...#",  //
                                "#.#.#",  //
                                "#...#",  //
                                ".###."});
  EXPECT_EQ(numbered(ring, clustered(ring)), (Rows{".000.", "0...0", "0.1.0", "0...0", ".000."}));
}

// Row "empty cells": they connect nothing.
TEST(PaperReading, EmptyCellsConnectNothing) {
  const Drawing d = drawing({"## ##", "## ##"});
  EXPECT_EQ(numbered(d, clustered(d)), (Rows{"00 11", "00 11"}));
}

// Row "T_c": clusters of n_c < T_c cells are removed, those of exactly T_c stay; default 5.
TEST(PaperReading, ClustersOfFewerThanTcCellsAreRemoved) {
  EXPECT_EQ(ClusterParams{}.t_c, 5);
  const Drawing d = drawing({"####.#####"});
  const Clusters clusters = clustered(d, ClusterParams{}.t_c);
  EXPECT_EQ(numbered(d, clusters), (Rows{"xxxx.00000"}));
  EXPECT_EQ(clusters.dropped, 1U);
}

TEST(Clusters, RowsHoldTheSlotsAscending) {
  const Drawing d = drawing({"#.#",  //
                             "#.#",  //
                             "#.#"});
  const Clusters clusters = clustered(d, 3);
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters.slots.items, (std::vector<std::int32_t>{0, 3, 6, 2, 5, 8}));
  EXPECT_EQ(clusters.slots.first, (std::vector<std::int32_t>{0, 3, 6}));
}

TEST(Clusters, NoNonGroundCellsGiveNoClusters) {
  for (const Rows& rows : {Rows{"..."}, Rows{"   "}}) {
    const Clusters clusters = clustered(drawing(rows));
    EXPECT_EQ(clusters.size(), 0U);
    EXPECT_EQ(clusters.dropped, 0U);
  }
}

/// Oracle: flood fill with a queue, seeds in row order.
std::vector<std::int32_t> filled_naively(const Drawing& d, int t_c, std::size_t& dropped) {
  std::vector<std::int32_t> number(d.grid.observed(), -2);
  std::int32_t next = 0;
  dropped = 0;
  for (std::size_t seed = 0; seed < number.size(); ++seed) {
    if (d.ground.is_ground(seed) || number[seed] != -2) continue;
    std::vector<std::size_t> members;
    std::queue<std::size_t> open;
    open.push(seed);
    number[seed] = -3;
    while (!open.empty()) {
      const std::size_t slot = open.front();
      open.pop();
      members.push_back(slot);
      const CellIndex centre = d.grid.geometry.index_of(d.grid.cell[slot]);
      for (int s = -1; s <= 1; ++s) {
        for (int t = -1; t <= 1; ++t) {
          const Slot other = d.grid.slot_at({centre.l + s, centre.w + t});
          const auto q = static_cast<std::size_t>(other);
          if (other == kUnobserved || d.ground.is_ground(q) || number[q] != -2) continue;
          number[q] = -3;
          open.push(q);
        }
      }
    }
    const bool kept = static_cast<int>(members.size()) >= t_c;
    for (const std::size_t slot : members) number[slot] = kept ? next : kNoCluster;
    next += kept ? 1 : 0;
    dropped += kept ? 0U : 1U;
  }
  for (std::int32_t& n : number) n = n == -2 ? kNoCluster : n;
  return number;
}

Rows random_drawing(RandomGenerator& random) {
  const double share = random.uniform();
  const double empty = 0.3 * random.uniform();
  Rows rows(1 + random.below(25));
  const std::size_t columns = 1 + random.below(25);
  for (std::string& row : rows) {
    for (std::size_t w = 0; w < columns; ++w) {
      row += random.uniform() < empty ? ' ' : (random.uniform() < share ? '#' : '.');
    }
  }
  return rows;
}

TEST(Clusters, EqualAFloodFillWithAQueue) {
  RandomGenerator random(31);
  ClusterWorkspace workspace;  // reused, as in a run over many scans
  Clusters clusters;
  for (int k = 0; k < 500; ++k) {
    const Drawing d = drawing(random_drawing(random));
    const int t_c = 1 + static_cast<int>(random.below(6));
    std::size_t dropped = 0;
    const std::vector<std::int32_t> naive = filled_naively(d, t_c, dropped);
    find_clusters(d.grid, d.ground, ClusterParams{t_c}, workspace, clusters);
    ASSERT_EQ(clusters.cluster_of, naive) << "seed 31, drawing " << k;
    ASSERT_EQ(clusters.dropped, dropped) << "seed 31, drawing " << k;
    std::size_t in_rows = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const IndexRange row = clusters.slots.row(c);
      ASSERT_GE(row.size(), static_cast<std::size_t>(t_c));
      EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
      for (const std::int32_t slot : row) {
        ASSERT_EQ(naive[static_cast<std::size_t>(slot)], static_cast<std::int32_t>(c));
      }
      in_rows += row.size();
    }
    const auto in_clusters =
        std::count_if(naive.begin(), naive.end(), [](std::int32_t n) { return n != kNoCluster; });
    EXPECT_EQ(in_rows, static_cast<std::size_t>(in_clusters));
  }
}

TEST(Clusters, TurningTheDrawingTurnsTheClusters) {
  RandomGenerator random(32);
  for (int k = 0; k < 50; ++k) {
    const Rows rows = random_drawing(random);
    Rows turned(rows.front().size(), std::string(rows.size(), ' '));
    for (std::size_t l = 0; l < rows.size(); ++l) {
      for (std::size_t w = 0; w < rows[l].size(); ++w) {
        turned[rows[l].size() - 1 - w][l] = rows[l][w];
      }
    }
    const auto sizes = [](const Clusters& clusters) {
      std::vector<std::size_t> cells;
      for (std::size_t c = 0; c < clusters.size(); ++c)
        cells.push_back(clusters.slots.row(c).size());
      std::sort(cells.begin(), cells.end());
      return cells;
    };
    EXPECT_EQ(sizes(clustered(drawing(rows))), sizes(clustered(drawing(turned)))) << "seed 32";
  }
}

// Three clusters of one cell each; points of unknown place and of ground cells are skipped.
TEST(GatherPoints, ByHand) {
  const Drawing d = drawing({"#.#.#"});
  const Clusters clusters = clustered(d);
  ASSERT_EQ(clusters.size(), 3U);
  const PointSlots point_slots = {4, 0, 1, point_slot_of(UnknownReason::kTooHigh), 2, 0, 4, -2, 3};
  IndexRows rows;
  rows.items = {9, 9, 9, 9, 9, 9, 9, 9};  // of an earlier scan
  gather_points(point_slots, clusters, {2, 1, 2}, rows);
  EXPECT_EQ(rows.first, (std::vector<std::int32_t>{0, 2, 3, 5}));
  EXPECT_EQ(rows.items, (std::vector<std::int32_t>{1, 5, 4, 0, 6}));
  gather_points(point_slots, clusters, {2, 0, 2}, rows);
  EXPECT_EQ(rows.first, (std::vector<std::int32_t>{0, 2, 2, 4}));
  EXPECT_EQ(rows.items, (std::vector<std::int32_t>{1, 5, 0, 6}));
}

TEST(GatherPoints, OfNoClusters) {
  IndexRows rows;
  gather_points({0, -2}, clustered(drawing({"."})), {}, rows);
  EXPECT_EQ(rows.rows(), 0U);
  EXPECT_TRUE(rows.items.empty());
}

}  // namespace
}  // namespace mrpt_terrain
