// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/label_stage.h"

namespace mrpt_terrain {

void label_cells(const GroundSegmentation& ground, const Clusters& clusters,
                 const std::vector<TerrainClass>& class_of, CellLabels& result) {
  const std::size_t n = ground.rule.size();
  result.support.resize(n);
  result.terrain_class.resize(n);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const GroundRule rule = ground.rule[slot];
    result.support[slot] = rule == GroundRule::kGround ? Support::kGround
                           : rule == GroundRule::kLow  ? Support::kBelow
                                                       : Support::kAbove;
    const std::int32_t cluster = clusters.cluster_of[slot];
    result.terrain_class[slot] =
        cluster == kNoCluster ? TerrainClass::kNone : class_of[static_cast<std::size_t>(cluster)];
  }
}

void label_points(const PointsView& points, const PointSlots& point_slots, const CellLabels& cells,
                  const Clusters& clusters, const GroundParams& params, PointLabels& result) {
  result.support.resize(points.size);
  result.reason.resize(points.size);
  result.terrain_class.resize(points.size);
  result.cluster.resize(points.size);
  const auto t_low = static_cast<float>(params.t_low);
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t point_slot = point_slots[i];
    result.reason[i] = reason_of(point_slot);
    if (point_slot < 0) {
      result.support[i] = Support::kUnknown;
      result.terrain_class[i] = TerrainClass::kNone;
      result.cluster[i] = kNoCluster;
      continue;
    }
    const auto slot = static_cast<std::size_t>(point_slot);
    const Support off_ground = points.z[i] <= t_low ? Support::kBelow : Support::kAbove;
    result.support[i] = cells.support[slot] == Support::kGround ? Support::kGround : off_ground;
    result.terrain_class[i] = cells.terrain_class[slot];
    result.cluster[i] = clusters.cluster_of[slot];
  }
}

}  // namespace mrpt_terrain
