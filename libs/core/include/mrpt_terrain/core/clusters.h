// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"
#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// Parameters of the grids clustering.
struct ClusterParams {
  int t_c = 5;  ///< T_c, cells

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_c, ParamInfo{"t_c", "T_c", "", 1, 1000000, "clusters of fewer cells are dropped"});
  }
};

/// Range of indices into one of the arrays of a compressed-row table.
struct IndexRange {
  const std::int32_t* first = nullptr;
  const std::int32_t* last = nullptr;
  [[nodiscard]] const std::int32_t* begin() const { return first; }
  [[nodiscard]] const std::int32_t* end() const { return last; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

/// All of a list of indices.
[[nodiscard]] inline IndexRange all_of(const std::vector<std::int32_t>& items) {
  return {items.data(), items.data() + items.size()};
}

/// Rows of indices, one after the other in one array: row k is `[first[k], first[k + 1])`.
struct IndexRows {
  std::vector<std::int32_t> first{0};
  std::vector<std::int32_t> items;

  [[nodiscard]] std::size_t rows() const { return first.size() - 1; }
  [[nodiscard]] IndexRange row(std::size_t k) const {
    return {items.data() + first[k], items.data() + first[k + 1]};
  }
};

/// Eight-connected clusters of non-ground cells, numbered by their first cell in row order.
struct Clusters {
  IndexRows slots;                       ///< per cluster: its slots, ascending
  std::vector<std::int32_t> cluster_of;  ///< per slot: number of the cluster, or kNoCluster
  std::size_t dropped = 0;               ///< connected groups of fewer than T_c cells

  [[nodiscard]] std::size_t size() const { return slots.rows(); }
};

/// Non-ground cells that lie side by side in one row; their slots are consecutive too.
struct CellRun {
  std::int32_t first_id;
  std::int32_t last_id;
  Slot first_slot;
  std::int32_t parent;  ///< another run of the same group, or itself
};

/// Scratch memory of `find_clusters`.
struct ClusterWorkspace {
  std::vector<CellRun> runs;
  std::vector<std::int32_t> cells_of_root;  ///< per run: cells of the group whose first run it is
  std::vector<std::int32_t> cluster_of_root;
};

/// Flood fill over the non-ground cells, connected in eight directions (paper, section "Grids
/// clustering"); groups of fewer than `t_c` cells are dropped. Unobserved cells connect nothing.
void find_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                   const ClusterParams& params, ClusterWorkspace& workspace, Clusters& result);

/// Merges the points of the wanted clusters: per cluster the indices of its points, ascending.
/// \param points_wanted per cluster: how many points it has, or 0 to leave its row empty
/// \param[out] rows one row per cluster
void gather_points(const PointSlots& point_slots, const Clusters& clusters,
                   const std::vector<std::int32_t>& points_wanted, IndexRows& rows);

/// Points of the wanted slots: per slot the indices of its points, ascending.
/// \param slot_wanted per slot: 0 leaves its row empty
/// \param[out] rows one row per slot
void gather_points_by_slot(const PointSlots& point_slots,
                           const std::vector<std::uint8_t>& slot_wanted, IndexRows& rows);

}  // namespace mrpt_terrain
