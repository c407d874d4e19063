// SPDX-License-Identifier: BSD-3-Clause
#include "describe_stages.h"

#include <algorithm>

#include "mrpt_terrain/core/label_stage.h"

namespace mrpt_terrain {
namespace {

/// Extent, number and moments of a cluster's points, from its cells.
void summarise(const ElevationGrid& grid, IndexRange slots, ClusterDescription& thing,
               Moments& moments) {
  thing = ClusterDescription{};
  MomentSums sums;
  const auto first = static_cast<std::size_t>(*slots.begin());
  thing.h_min = grid.h_min[first];
  thing.h_max = grid.h_max[first];
  for (const std::int32_t item : slots) {
    const auto slot = static_cast<std::size_t>(item);
    thing.h_min = std::min(thing.h_min, grid.h_min[slot]);
    thing.h_max = std::max(thing.h_max, grid.h_max[slot]);
    sums.add(grid.sums[slot]);
  }
  moments = moments_from(sums);
  measure_extent(grid, slots, thing);
  thing.centroid = {moments.mean_x, moments.mean_y};
  thing.points = static_cast<std::int32_t>(moments.n);
}

// Height index of every cluster, roughness where the class depends on it.
void measure_height_and_roughness(const DescriptionParams& params, DescriptionWorkspace& workspace,
                                  Description& description) {
  const Clusters& clusters = description.clusters;
  description.things.resize(clusters.size());
  workspace.cluster_moments.resize(clusters.size());
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    ClusterDescription& thing = description.things[k];
    Moments& moments = workspace.cluster_moments[k];
    summarise(description.grid, clusters.slots.row(k), thing, moments);
    thing.height = height_index(description.grid, description.ground, clusters.slots.row(k));
    measure_roughness(params, moments, thing);
  }
}

// Points of each cluster whose slope is wanted, 0 for the others; false if there are none.
bool find_wanted_slopes(const DescriptionParams& params, DescriptionWorkspace& workspace,
                        const std::vector<ClusterDescription>& things) {
  workspace.points_wanted.assign(things.size(), 0);
  bool any = false;
  for (std::size_t k = 0; k < things.size(); ++k) {
    const Roughness& measured = things[k].roughness;
    const bool flat = measured.status == FeatureStatus::kOk && !measured.rough;
    const bool needed =
        flat && class_from_height(things[k].height, params.classes) == TerrainClass::kNone;
    if (!needed && !params.classes.all_features) continue;
    workspace.points_wanted[k] = things[k].points;
    any = true;
  }
  return any;
}

void measure_slopes_by_ransac(const StageInput& stage, DescriptionWorkspace& workspace,
                              Description& description) {
  const PointsView& points = stage.scan.points;
  const SlopeParams& params = stage.params.slope;
  const PointSlots& slots =
      stage.cluster_slots == nullptr ? workspace.point_slots : *stage.cluster_slots;
  gather_points(slots, description.clusters, workspace.points_wanted, workspace.points_of);
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    if (workspace.points_wanted[k] == 0) continue;
    description.things[k].slope =
        estimate_slope(points, workspace.points_of.row(k), params, k, workspace.slope);
  }
}

// Marks the slots whose points the estimates may look at.
void want_slots_around(const Description& description, const BeamSlopeParams& params,
                       DescriptionWorkspace& workspace) {
  const ElevationGrid& grid = description.grid;
  workspace.slot_wanted.assign(grid.observed(), 0);
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    if (workspace.points_wanted[k] == 0) continue;
    const CellBox box =
        cells_around(grid, description.clusters.slots.row(k), beam_slope_reach(grid, params));
    for (int l = box.low.l; l <= box.high.l; ++l) {
      for (int w = box.low.w; w <= box.high.w; ++w) {
        const Slot slot = grid.slot_at({l, w});
        if (slot != kUnobserved) workspace.slot_wanted[static_cast<std::size_t>(slot)] = 1;
      }
    }
  }
}

void measure_slopes_by_beams(const StageInput& stage, DescriptionWorkspace& workspace,
                             Description& description) {
  const DescriptionParams& params = stage.params;
  want_slots_around(description, params.beam_slope, workspace);
  gather_points_by_slot(workspace.point_slots, workspace.slot_wanted, workspace.points_of);
  const auto& sums = stage.is_fused() ? workspace.scan_sums : description.grid.sums;
  const BeamSlopeInput input{stage.scan.points,
                             stage.scan.origins,
                             description.grid,
                             description.ground,
                             description.clusters,
                             workspace.points_of,
                             sums};
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    if (workspace.points_wanted[k] == 0) continue;
    description.things[k].slope =
        estimate_beam_slope(input, k, params.beam_slope, params.slope.seed, workspace.beam_slope);
  }
}

// Sums of the scan's points per slot.
void sum_points_of_scan(const PointsView& points, const PointSlots& point_slots,
                        std::vector<MomentSums>& sums, std::size_t slots) {
  sums.assign(slots, MomentSums{});
  for (std::size_t i = 0; i < points.size; ++i) {
    if (point_slots[i] < 0) continue;
    sums[static_cast<std::size_t>(point_slots[i])].add(points.x[i], points.y[i], points.z[i]);
  }
}

// How many points of the scan lie in a cluster; 0 if they cover too little of it.
std::int32_t points_in(IndexRange slots, const std::vector<MomentSums>& sums, double cover) {
  double points = 0.0;
  std::size_t cells = 0;
  for (const std::int32_t slot : slots) {
    const double n = sums[static_cast<std::size_t>(slot)].n;
    points += n;
    cells += n > 0.0 ? 1U : 0U;
  }
  const double least = cover * static_cast<double>(slots.size());
  return static_cast<double>(cells) < least ? 0 : static_cast<std::int32_t>(points);
}

// In a fused grid: lets clusters without enough points of the scan have no points at all.
void count_points_of_scan(const StageInput& stage, DescriptionWorkspace& workspace,
                          const Description& description) {
  sum_points_of_scan(stage.scan.points, workspace.point_slots, workspace.scan_sums,
                     description.grid.observed());
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    std::int32_t& wanted = workspace.points_wanted[k];
    if (wanted == 0) continue;
    wanted = points_in(description.clusters.slots.row(k), workspace.scan_sums, *stage.points_cover);
  }
}

// Planes of the wanted clusters that the points of the scan gave none.
void fill_in_slopes_from_moments(const SlopeParams& params, DescriptionWorkspace& workspace,
                                 Description& description) {
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    Slope& slope = description.things[k].slope;
    const bool has_points =
        workspace.points_wanted[k] > 0 && slope.status != FeatureStatus::kTooFewPoints;
    if (workspace.slope_wanted[k] == 0 || has_points) continue;
    slope = slope_from_moments(workspace.cluster_moments[k], params);
  }
}

}  // namespace

void measure_slopes(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description) {
  const DescriptionParams& params = stage.params;
  if (!find_wanted_slopes(params, workspace, description.things)) return;
  if (stage.is_fused()) {
    workspace.slope_wanted = workspace.points_wanted;
    count_points_of_scan(stage, workspace, description);
  }
  if (params.slope.method == SlopeMethod::kBeam) {
    measure_slopes_by_beams(stage, workspace, description);
  } else {
    measure_slopes_by_ransac(stage, workspace, description);
  }
  if (stage.is_fused()) fill_in_slopes_from_moments(params.slope, workspace, description);
}

void classify_all(const ClassParams& params, std::vector<TerrainClass>& class_of,
                  std::vector<ClusterDescription>& things) {
  class_of.clear();
  for (ClusterDescription& thing : things) {
    thing.terrain_class = classify(thing.height, thing.roughness, thing.slope, params);
    class_of.push_back(thing.terrain_class);
  }
}

void measure_extent(const ElevationGrid& grid, IndexRange slots, ClusterDescription& thing) {
  const CellBox box = cells_around(grid, slots, 0.0);
  const double half = grid.geometry.cell_size() / 2;
  const Position2 low = grid.geometry.centre_of(box.low);
  const Position2 high = grid.geometry.centre_of(box.high);
  thing.min_corner = {low.x - half, low.y - half};
  thing.max_corner = {high.x + half, high.y + half};
  thing.cells = static_cast<std::int32_t>(slots.size());
}

void measure_roughness(const DescriptionParams& params, const Moments& moments,
                       ClusterDescription& thing) {
  const bool needed = class_from_height(thing.height, params.classes) == TerrainClass::kNone;
  if (needed || params.classes.all_features) {
    thing.roughness = roughness(moments, params.roughness);
  }
}

void describe_cells(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description) {
  const DescriptionParams& params = stage.params;
  const auto done = [&stage](Stage what) {
    if (stage.listener != nullptr) stage.listener->stage_done(what);
  };
  done(Stage::kGrid);
  segment_ground(description.grid, params.ground, workspace.ground,
                 description.ground);  // (1), (2)
  done(Stage::kGround);
  find_clusters(description.grid, description.ground, params.clusters, workspace.clusters,
                description.clusters);
  done(Stage::kClusters);
  measure_height_and_roughness(params, workspace, description);  // (3), (4)
  done(Stage::kHeightAndRoughness);
  measure_slopes(stage, workspace, description);  // (5), (6)
  done(Stage::kSlope);
  classify_all(params.classes, workspace.class_of, description.things);  // Table 1
  done(Stage::kClasses);
  label_cells(description.ground, description.clusters, workspace.class_of, description.cells);
  label_points(stage.scan.points, workspace.point_slots, description.cells, description.clusters,
               params.ground, workspace.labels, description.labels);
  done(Stage::kLabels);
}

}  // namespace mrpt_terrain
