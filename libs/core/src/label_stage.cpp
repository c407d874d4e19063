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

namespace {

// The negative codes of points without a slot become the first entries of the table, so that the
// loop over the points needs no branch.
constexpr std::size_t kReasons = enum_names(UnknownReason{}).size();
static_assert(point_slot_of(UnknownReason::kOutsideMap) + static_cast<std::int32_t>(kReasons) == 0);

void share_labels(const CellLabels& cells, const Clusters& clusters,
                  std::vector<SharedLabel>& shared) {
  shared.resize(kReasons + cells.support.size());
  for (std::size_t k = 0; k < kReasons; ++k) {
    const UnknownReason reason =
        reason_of(static_cast<std::int32_t>(k) - static_cast<std::int32_t>(kReasons));
    shared[k] = {kNoCluster, TerrainClass::kNone, reason, {Support::kUnknown, Support::kUnknown}};
  }
  for (std::size_t slot = 0; slot < cells.support.size(); ++slot) {
    const bool ground = cells.support[slot] == Support::kGround;
    using Supports = std::array<Support, 2>;
    shared[kReasons + slot] = {clusters.cluster_of[slot], cells.terrain_class[slot],
                               UnknownReason::kNone,
                               ground ? Supports{Support::kGround, Support::kGround}
                                      : Supports{Support::kAbove, Support::kBelow}};
  }
}

}  // namespace

void label_points(const PointsView& points, const PointSlots& point_slots, const CellLabels& cells,
                  const Clusters& clusters, const GroundParams& params, LabelWorkspace& workspace,
                  PointLabels& result) {
  result.support.resize(points.size);
  result.reason.resize(points.size);
  result.terrain_class.resize(points.size);
  result.cluster.resize(points.size);
  share_labels(cells, clusters, workspace.shared);
  const SharedLabel* shared = workspace.shared.data() + kReasons;
  const auto t_low = static_cast<float>(params.t_low);
  const std::int32_t* slots = point_slots.data();
  Support* support = result.support.data();
  UnknownReason* reason = result.reason.data();
  TerrainClass* terrain_class = result.terrain_class.data();
  std::int32_t* cluster = result.cluster.data();
  const float* z = points.z;
  for (std::size_t i = 0; i < points.size; ++i) {
    const SharedLabel& label = shared[slots[i]];
    support[i] = label.support[z[i] <= t_low ? 1 : 0];
    reason[i] = label.reason;
    terrain_class[i] = label.terrain_class;
    cluster[i] = label.cluster;
  }
}

}  // namespace mrpt_terrain
