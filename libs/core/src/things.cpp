// SPDX-License-Identifier: BSD-3-Clause
#include "things.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace mrpt_terrain {
namespace {

// Ground beside a thing is looked for within so many cells.
constexpr int kStepReach = 2;
// Share of the steps that are lower than the lowest, or higher than the highest.
constexpr double kTail = 0.1;
// A thing with this share of its points on one face is not rough.
constexpr double kFaceShare = 0.5;
// Logarithm of the number of points from which more points make a thing no more likely.
constexpr double kLargest = 6.6;

// Height index (3) with heights above the reference: a thing on falling ground keeps its sign.
HeightIndex height_above_ground(const GroundSegmentation& ground, IndexRange slots, double mean,
                                double lowest, double highest) {
  HeightIndex result;
  const auto first = static_cast<std::size_t>(*slots.begin());
  const bool above = ground.rule[first] != GroundRule::kLow;
  result.h_m = mean;
  result.h_d = above ? std::max(highest, 0.0) : std::max(-lowest, 0.0);
  result.h_f = above ? std::max(result.h_d, mean) : std::min(-result.h_d, mean);
  return result;
}

void sum_things(const PointsView& points, DescriptionWorkspace& workspace,
                const Description& description) {
  const FieldPoints& field = workspace.field.points;
  const Clusters& clusters = description.clusters;
  workspace.cluster_sums.assign(clusters.size(), ClusterSums{});
  for (const ClusterPoint& member : workspace.cluster_points) {
    const auto i = static_cast<std::size_t>(member.point);
    ClusterSums& sums = workspace.cluster_sums[static_cast<std::size_t>(member.cluster)];
    sums.points.add(points.x[i], points.y[i], points.z[i]);
    const auto cell = static_cast<std::size_t>(workspace.cluster_slots[i]);
    const bool hole = description.ground.rule[cell] == GroundRule::kLow;
    const float raised = workspace.raised_ground.height[i];
    const float height =
        hole ? points.z[i] - description.field.rim[cell] : std::max(field.height[i], raised);
    sums.height += height;
    sums.raised += raised > 0.0F ? 1 : 0;
    sums.low = std::min(sums.low, height);
    sums.high = std::max(sums.high, height);
    sums.z_low = std::min(sums.z_low, points.z[i]);
    sums.z_high = std::max(sums.z_high, points.z[i]);
  }
}

// RMS distance from the plane of least squares.
double scatter_of(const Moments& moments) {
  if (moments.n < 3.0) return 0.0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance(), Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

// Ground of the first observed cell along an axis if that has no part of a thing: mean height above
// the reference, metres.
bool ground_beside(const Description& description, CellIndex at, CellIndex direction,
                   float& height) {
  for (int k = 1; k <= kStepReach; ++k) {
    const Slot slot = description.grid.slot_at({at.l + k * direction.l, at.w + k * direction.w});
    if (slot == kUnobserved) continue;
    const auto s = static_cast<std::size_t>(slot);
    if (description.clusters.cluster_of[s] != kNoCluster || description.field.on[s] == 0 ||
        !description.ground.is_ground(s))
      return false;
    height = description.field.floor[s] - description.field.ground[s];
    return true;
  }
  return false;
}

void measure_steps(const Description& description, IndexRange slots, std::vector<float>& steps,
                   ClusterDescription& thing) {
  const FieldCells& field = description.field;
  steps.clear();
  for (const std::int32_t item : slots) {
    const auto slot = static_cast<std::size_t>(item);
    if (description.ground.rule[slot] == GroundRule::kLow) return;
    const CellIndex at = description.grid.geometry.index_of(description.grid.cell[slot]);
    const float top = std::max(field.high[slot], field.raised_high[slot]);
    for (const CellIndex direction :
         {CellIndex{1, 0}, CellIndex{-1, 0}, CellIndex{0, 1}, CellIndex{0, -1}}) {
      float ground = 0.0F;
      if (ground_beside(description, at, direction, ground))
        steps.push_back(std::max(0.0F, top - ground));
    }
  }
  if (steps.empty()) return;
  const auto tail = static_cast<std::ptrdiff_t>(kTail * static_cast<double>(steps.size()));
  std::nth_element(steps.begin(), steps.begin() + tail, steps.end());
  thing.lowest_step = static_cast<double>(steps[static_cast<std::size_t>(tail)]);
  std::nth_element(steps.begin(), steps.end() - 1 - tail, steps.end());
  thing.highest_step = static_cast<double>(*(steps.end() - 1 - tail));
}

// Brings the points of each thing together.
void gather_all(DescriptionWorkspace& workspace, const Description& description) {
  IndexRows& rows = workspace.points_of;
  rows.first.assign(1, 0);
  for (const ClusterDescription& thing : description.things)
    rows.first.push_back(rows.first.back() + thing.points);
  rows.items.resize(workspace.cluster_points.size());
  std::vector<std::int32_t>& next = workspace.points_wanted;
  next.assign(rows.first.begin(), rows.first.end());
  for (const ClusterPoint& member : workspace.cluster_points) {
    std::int32_t& place = next[static_cast<std::size_t>(member.cluster)];
    rows.items[static_cast<std::size_t>(place++)] = member.point;
  }
}

// The points of a thing for its slope: where some are remembered, only those that the scan has
// measured, if they lie in enough of the thing's cells. They come first.
IndexRange points_for_slope(const StageInput& stage, DescriptionWorkspace& workspace,
                            const Description& description, std::size_t k) {
  const IndexRange all = workspace.points_of.row(k);
  const std::size_t measured = stage.scan.origins.measured;
  const auto end =
      std::lower_bound(all.begin(), all.end(), measured, [](std::int32_t point, std::size_t first) {
        return static_cast<std::size_t>(point) < first;
      });
  if (end == all.end()) return all;
  std::int32_t cells = 0;
  for (const std::int32_t* point = all.begin(); point != end; ++point) {
    const auto slot =
        static_cast<std::size_t>(workspace.cluster_slots[static_cast<std::size_t>(*point)]);
    cells += workspace.slot_wanted[slot] == 0 ? 1 : 0;
    workspace.slot_wanted[slot] = 1;
  }
  const bool covered = cells >= *stage.points_cover * description.things[k].cells;
  return covered ? IndexRange{all.begin(), end} : all;
}

// Against the plane of the ground around; its errors are those of neighbouring cells as well.
void measure_to_ground(const GroundAround& around, double max_sigma, ClusterDescription& thing) {
  SlopeToGround& result = thing.slope.to_ground;
  result.status = FeatureStatus::kTooFewPoints;
  if (!around.known) return;
  const Eigen::Vector3d ground(-around.gradient_x, -around.gradient_y, 1.0);
  result.ground_normal = ground.normalized();
  const double sigma = static_cast<double>(around.sigma);
  const double variance =
      sigma * sigma * 0.5 * static_cast<double>(around.spread[3] + around.spread[5]);
  result.angle = std::atan2(thing.slope.normal.cross(result.ground_normal).norm(),
                            thing.slope.normal.dot(result.ground_normal));
  result.angle_sigma = std::sqrt(thing.slope.angle_sigma * thing.slope.angle_sigma + variance);
  const Eigen::Vector3d at(
      thing.centroid.x, thing.centroid.y,
      static_cast<double>(around.height_at(static_cast<float>(thing.centroid.x),
                                           static_cast<float>(thing.centroid.y))));
  result.ground_offset = -result.ground_normal.dot(at);
  result.status = result.angle_sigma <= max_sigma ? FeatureStatus::kOk : FeatureStatus::kUncertain;
}

Slope estimate_slope_of_thing(const StageInput& stage, const GroundAround* around, std::size_t k,
                              DescriptionWorkspace& workspace, const Description& description) {
  const BeamSlopeParams& params = stage.params.beam_slope;
  const IndexRange members = points_for_slope(stage, workspace, description, k);
  const std::uint64_t seed = stage.params.slope.seed;
  const PointsView& points = stage.scan.points;
  if (around == nullptr || !around->known) {
    return estimate_face_slope(points, stage.scan.origins, members, params, seed, k,
                               workspace.face_slope);
  }
  const Position2 at = description.things[k].centroid;
  const float z = around->height_at(static_cast<float>(at.x), static_cast<float>(at.y));
  const Eigen::Vector3d place(at.x, at.y, static_cast<double>(z));
  const Eigen::Vector3d normal =
      Eigen::Vector3f(-around->gradient_x, -around->gradient_y, 1.0F).cast<double>().normalized();
  const FaceSurroundings surroundings{
      workspace.field, workspace.raised_ground.height, {normal, -normal.dot(place)}, place};
  return estimate_face_slope(points, stage.scan.origins, members, params, seed, k,
                             workspace.face_slope, &surroundings);
}

}  // namespace

double confidence_of(double points, double raised) {
  const double size = std::min(std::log(points), kLargest);
  const double logit = -5.0 + 2.37 * size - 0.178 * size * size - 1.49 * raised;
  return 1.0 / (1.0 + std::exp(-logit));
}

void measure_things(const StageInput& stage, DescriptionWorkspace& workspace,
                    Description& description) {
  const Clusters& clusters = description.clusters;
  sum_things(stage.scan.points, workspace, description);
  description.things.assign(clusters.size(), ClusterDescription{});
  workspace.cluster_moments.resize(clusters.size());
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const ClusterSums& sums = workspace.cluster_sums[k];
    ClusterDescription& thing = description.things[k];
    const Moments moments = workspace.cluster_moments[k] = moments_from(sums.points);
    measure_extent(description.grid, clusters.slots.row(k), thing);
    thing.points = static_cast<std::int32_t>(moments.n);
    thing.centroid = {moments.mean_x, moments.mean_y};
    thing.h_min = sums.z_low;
    thing.h_max = sums.z_high;
    thing.height = height_above_ground(description.ground, clusters.slots.row(k),
                                       sums.height / std::max(moments.n, 1.0), sums.low, sums.high);
    measure_roughness(stage.params, moments, thing);
    thing.scatter = scatter_of(moments);
    thing.raised = sums.raised;
    thing.confidence =
        confidence_of(std::max(moments.n, 1.0), thing.raised / std::max(moments.n, 1.0));
    measure_steps(description, clusters.slots.row(k), workspace.steps, thing);
  }
  gather_all(workspace, description);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    description.things[k].box =
        box_around(stage.scan.points, workspace.points_of.row(k), workspace.box);
  }
}

void measure_thing_slopes(const StageInput& stage, DescriptionWorkspace& workspace,
                          Description& description) {
  if (stage.params.slope.method != SlopeMethod::kBeam) {
    measure_slopes(stage, workspace, description);
    return;
  }
  const ClassParams& classes = stage.params.classes;
  workspace.slot_wanted.assign(description.grid.observed(), 0);
  for (std::size_t k = 0; k < description.things.size(); ++k) {
    ClusterDescription& thing = description.things[k];
    const bool needed = class_from_height(thing.height, classes) == TerrainClass::kNone;
    if (!needed && !classes.all_features) continue;
    const GroundAround* around =
        ground_around(description.grid.geometry, stage.params.raised_ground,
                      workspace.raised_ground, thing.centroid.x, thing.centroid.y);
    thing.slope = estimate_slope_of_thing(stage, around, k, workspace, description);
    if (thing.slope.status != FeatureStatus::kOk) continue;
    if (around != nullptr)
      measure_to_ground(*around, stage.params.beam_slope.max_angle_sigma, thing);
    if (thing.roughness.status == FeatureStatus::kOk &&
        thing.slope.inliers >= kFaceShare * thing.points)
      thing.roughness.rough = false;
  }
}

}  // namespace mrpt_terrain
