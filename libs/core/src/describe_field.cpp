// SPDX-License-Identifier: BSD-3-Clause
#include "describe_field.h"

#include <algorithm>
#include <cmath>

#include "climbed_sides.h"
#include "describe_stages.h"
#include "thing_parts.h"
#include "things.h"

namespace mrpt_terrain {
namespace {

// Whether a point is one of those that the cluster of its cell consists of: what stands out of the
// ground, or in a hole the floor.
bool belongs(Support support, GroundRule rule, float raised) {
  return rule == GroundRule::kLow ? support == Support::kGround || support == Support::kBelow
                                  : support == Support::kAbove || raised > 0.0F;
}

// Finds the points that clusters consist of.
void find_cluster_points(const Description& description, DescriptionWorkspace& workspace) {
  const FieldPoints& points = workspace.field.points;
  const PointSlots& point_slots = workspace.point_slots;
  workspace.cluster_slots.resize(point_slots.size());
  workspace.cluster_points.clear();
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    const std::int32_t slot = point_slots[i];
    const auto cell = static_cast<std::size_t>(slot);
    const bool member = slot >= 0 && workspace.holes.stray[i] == 0 &&
                        belongs(points.support[i], description.ground.rule[cell],
                                workspace.raised_ground.height[i]);
    workspace.cluster_slots[i] = member ? slot : point_slot_of(UnknownReason::kNone);
    if (!member || description.clusters.cluster_of[cell] == kNoCluster) continue;
    workspace.cluster_points.push_back(
        {static_cast<std::int32_t>(i), description.clusters.cluster_of[cell]});
  }
}

void label_field_cells(const Description& description, const std::vector<TerrainClass>& class_of,
                       CellLabels& result) {
  label_cells(description.ground, description.clusters, class_of, result);
  for (std::size_t slot = 0; slot < result.support.size(); ++slot) {
    const bool floor = description.ground.rule[slot] == GroundRule::kLow;
    const bool on_deck = description.field.deck[slot] >= 0;
    if (floor || on_deck || description.field.under[slot] != 0)
      result.support[slot] = Support::kGround;
  }
}

void label_field_points(const PointsView& points, const DeckParams& decks,
                        const Description& description, DescriptionWorkspace& workspace,
                        PointLabels& result) {
  const std::size_t n = workspace.point_slots.size();
  result.support = workspace.field.points.support;
  label_deck_points(points, workspace.field.points, workspace.point_slots, description.grid,
                    description.field, decks, workspace.decks, result.support);
  label_climbed_sides(workspace.field, static_cast<float>(decks.side), workspace.decks,
                      result.support);
  result.reason.resize(n);
  result.terrain_class.assign(n, TerrainClass::kNone);
  result.cluster.assign(n, kNoCluster);
  for (std::size_t i = 0; i < n; ++i) {
    const bool known = result.support[i] != Support::kUnknown;
    // A point in the map has no support where the map reaches beyond the reference.
    const UnknownReason reason = workspace.point_slots[i] < 0 ? reason_of(workspace.point_slots[i])
                                                              : UnknownReason::kOutsideMap;
    result.reason[i] = known ? UnknownReason::kNone : reason;
  }
  for (const ClusterPoint& member : workspace.cluster_points) {
    const auto i = static_cast<std::size_t>(member.point);
    result.cluster[i] = member.cluster;
    result.terrain_class[i] = workspace.class_of[static_cast<std::size_t>(member.cluster)];
  }
}

}  // namespace

void describe_field(const ScanView& scan, const DescriptionParams& params,
                    DescriptionWorkspace& workspace, Description& description,
                    StageListener* listener, const double* points_cover) {
  const StageInput stage{scan, params, listener, points_cover, &workspace.cluster_slots};
  const auto done = [listener](Stage what) {
    if (listener != nullptr) listener->stage_done(what);
  };
  find_field_ground(scan, params.ground_surface, params.ground_labels, workspace.field);
  done(Stage::kGround);
  description.projection =
      build_elevation_grid(scan.points, params.grid, workspace.grid, description.grid,
                           workspace.point_slots, workspace.field.points.height.data());
  measure_field_cells(scan.points, workspace.field, description.grid, workspace.point_slots,
                      description.field, description.ground);
  const HoleInput hole_input{workspace.field, description.grid, scan.origins};
  find_holes(hole_input, params.holes, workspace.holes, description.field, description.ground,
             description.holes, description.hole_cells);
  find_gaps(hole_input, description.field, params.gaps, workspace.gaps, description.ground,
            description.holes, description.hole_cells);
  find_decks(scan, workspace.field.points, workspace.point_slots, description.grid,
             description.ground, params.decks, workspace.decks, description.field);
  find_raised_ground(scan.points, workspace.field, description.grid, description.ground,
                     workspace.point_slots, params.raised_ground, workspace.raised_ground,
                     description.field);
  mark_thing_parts(scan, workspace.field.points, workspace.raised_ground.height,
                   workspace.point_slots, description.grid, description.field);
  find_overhangs(description.grid, params.overhangs, description.field);
  done(Stage::kGrid);
  find_field_clusters(description.grid, description.ground, description.field,
                      params.field_clusters, workspace.field_clusters, description.clusters,
                      scan.origins.known() ? &scan.origins.of(0) : nullptr);
  find_cluster_points(description, workspace);
  done(Stage::kClusters);
  measure_things(stage, workspace, description);
  done(Stage::kHeightAndRoughness);
  measure_thing_slopes(stage, workspace, description);
  done(Stage::kSlope);
  classify_all(params.classes, workspace.class_of, description.things);
  done(Stage::kClasses);
  label_field_cells(description, workspace.class_of, description.cells);
  label_field_points(scan.points, params.decks, description, workspace, description.labels);
  done(Stage::kLabels);
}

}  // namespace mrpt_terrain
