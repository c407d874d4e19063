// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/field_clusters.h"
#include "worlds.h"

namespace mrpt_terrain::worlds {

/// What is seen in cells of 0.2 m on 20 m x 20 m, on level ground at z = 0.
class CellScene {
 public:
  /// Ground is seen in a rectangle, so high.
  void ground(const Rect& rect, float height = 0.0F) {
    for_cells(rect, [&](Cell& cell) {
      cell.on = 1;
      cell.floor = height;
    });
  }
  /// Points from `low` to `high` above the ground are seen in a rectangle.
  void thing(const Rect& rect, float low, float high) {
    for_cells(rect, [&](Cell& cell) {
      cell.above = 5;
      cell.low = low;
      cell.high = high;
    });
  }
  /// What is above the ground in a rectangle is a deck.
  void deck(const Rect& rect) {
    for_cells(rect, [](Cell& cell) { cell.deck = 0; });
  }
  /// The edges of things in a rectangle are sharp.
  void sharp(const Rect& rect) {
    for_cells(rect, [](Cell& cell) { cell.sharp = 1; });
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
    float low = 0.0F, high = 0.0F, floor = 0.0F;
    std::uint8_t level = 0;
    std::int8_t sharp = 0;
    std::int32_t deck = -1;
  };
  static constexpr int kSide = 100;
  static constexpr double kCell = 0.2;
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
        field.floor.push_back(cell.floor);
        field.level.push_back(cell.level);
        field.sharp_edges.push_back(cell.sharp);
        field.deck.push_back(cell.deck);
      }
    }
    const std::size_t n = result.grid.observed();
    for (auto* values : {&field.ground, &field.rim, &field.raised_low, &field.raised_high})
      values->assign(n, 0.0F);
    for (auto* counts : {&field.below, &field.raised}) counts->assign(n, 0);
    field.smooth_edges.assign(n, 0);
    return result;
  }

  std::vector<Cell> cells_ = std::vector<Cell>(kSide * kSide);
};

/// A cell about a place.
inline Rect at(double x, double y) { return {x - 0.05, x + 0.05, y - 0.05, y + 0.05}; }

/// Whether all are of one thing, or each of another.
inline bool all_one(const std::vector<std::int32_t>& things) {
  for (const std::int32_t thing : things)
    if (thing != things.front() || thing == kNoCluster) return false;
  return true;
}
inline bool all_apart(const std::vector<std::int32_t>& things) {
  for (std::size_t a = 0; a < things.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b)
      if (things[a] == kNoCluster || (a != b && things[a] == things[b])) return false;
  }
  return true;
}

}  // namespace mrpt_terrain::worlds
