// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain::test {

/// Builds a description by hand, cell by cell, without running any stage, so that what shows
/// descriptions can be tested apart from what computes them.
class DescriptionBuilder {
 public:
  DescriptionBuilder(double length, double width, double cell_size)
      : geometry_(length, width, cell_size) {}

  DescriptionBuilder& ground(CellIndex cell, float height) {
    cells_[geometry_.id_of(cell)] = {height, height, GroundRule::kGround, kNoCluster};
    return *this;
  }
  /// A non-ground cell that belongs to no cluster.
  DescriptionBuilder& dropped(CellIndex cell, float height) {
    cells_[geometry_.id_of(cell)] = {height, height, GroundRule::kHigh, kNoCluster};
    ++description_.clusters.dropped;
    return *this;
  }
  /// A cluster that fills the rectangle of cells [first, last], both included.
  DescriptionBuilder& cluster(TerrainClass terrain_class, CellIndex first, CellIndex last,
                              float h_min, float h_max) {
    const auto number = static_cast<std::int32_t>(description_.things.size());
    const GroundRule rule = h_max > 0.0F ? GroundRule::kHigh : GroundRule::kLow;
    for (int l = first.l; l <= last.l; ++l) {
      for (int w = first.w; w <= last.w; ++w) {
        cells_[geometry_.id_of({l, w})] = {h_min, h_max, rule, number};
      }
    }
    description_.things.push_back(thing(terrain_class, first, last, h_min, h_max));
    return *this;
  }
  /// The cluster made last, to give it features.
  ClusterDescription& last() { return description_.things.back(); }

  /// The description, with a point in the middle of every cell at its mean height (see `points`).
  /// Sums for covariances are left empty.
  [[nodiscard]] Description build() {
    Description result = std::move(description_);
    result.grid.geometry = geometry_;
    result.grid.slot_of.assign(static_cast<std::size_t>(geometry_.array_size()), kUnobserved);
    std::vector<std::vector<std::int32_t>> slots(result.things.size());
    for (const auto& [id, cell] : cells_) {
      const auto slot = static_cast<std::int32_t>(result.grid.cell.size());
      result.grid.slot_of[static_cast<std::size_t>(value_of(id))] = slot;
      add_cell(result, id, cell);
      add_point(result, id, cell);
      if (cell.cluster != kNoCluster) slots[static_cast<std::size_t>(cell.cluster)].push_back(slot);
    }
    for (const auto& row : slots) {
      result.clusters.slots.items.insert(result.clusters.slots.items.end(), row.begin(), row.end());
      result.clusters.slots.first.push_back(
          static_cast<std::int32_t>(result.clusters.slots.items.size()));
    }
    result.projection.in_map = cells_.size();
    return result;
  }

  Points points;  ///< filled by `build`

 private:
  struct Cell {
    float h_min = 0.0F;
    float h_max = 0.0F;
    GroundRule rule = GroundRule::kGround;
    std::int32_t cluster = kNoCluster;
    [[nodiscard]] float mean() const { return 0.5F * (h_min + h_max); }
    [[nodiscard]] Support support() const {
      if (rule == GroundRule::kGround) return Support::kGround;
      return rule == GroundRule::kLow ? Support::kBelow : Support::kAbove;
    }
  };

  [[nodiscard]] ClusterDescription thing(TerrainClass terrain_class, CellIndex first,
                                         CellIndex last, float h_min, float h_max) const {
    ClusterDescription result;
    result.terrain_class = terrain_class;
    result.cells = (last.l - first.l + 1) * (last.w - first.w + 1);
    result.points = result.cells;
    result.h_min = h_min;
    result.h_max = h_max;
    const double half = 0.5 * geometry_.cell_size();
    const Position2 low = geometry_.centre_of(first);
    const Position2 high = geometry_.centre_of(last);
    result.centroid = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    result.min_corner = {low.x - half, low.y - half};
    result.max_corner = {high.x + half, high.y + half};
    return result;
  }

  static void add_cell(Description& result, CellId id, const Cell& cell) {
    result.grid.cell.push_back(id);
    result.grid.h_min.push_back(cell.h_min);
    result.grid.h_max.push_back(cell.h_max);
    result.grid.h_mean.push_back(cell.mean());
    result.grid.sums.emplace_back();
    result.ground.rule.push_back(cell.rule);
    result.ground.h_mean.push_back(cell.mean());
    result.clusters.cluster_of.push_back(cell.cluster);
    result.cells.support.push_back(cell.support());
    result.cells.terrain_class.push_back(class_of(result, cell));
  }

  void add_point(Description& result, CellId id, const Cell& cell) {
    const Position2 centre = geometry_.centre_of(geometry_.index_of(id));
    points.push_back(static_cast<float>(centre.x), static_cast<float>(centre.y), cell.mean());
    result.labels.support.push_back(cell.support());
    result.labels.reason.push_back(UnknownReason::kNone);
    result.labels.cluster.push_back(cell.cluster);
    result.labels.terrain_class.push_back(class_of(result, cell));
  }

  static TerrainClass class_of(const Description& result, const Cell& cell) {
    return cell.cluster == kNoCluster
               ? TerrainClass::kNone
               : result.things[static_cast<std::size_t>(cell.cluster)].terrain_class;
  }

  GridGeometry geometry_;
  std::map<CellId, Cell> cells_;
  Description description_;
};

}  // namespace mrpt_terrain::test
