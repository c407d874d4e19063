// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/snapshot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mrpt_terrain/core/field_costs.h"
#include "mrpt_terrain/core/fused_cell.h"

namespace mrpt_terrain {
namespace {

// Points that give a cluster's features half of their worth.
constexpr double kHalfTrusted = 30.0;

double overlap(const MapBox& a, const MapBox& b) {
  const double x = std::min(a.max.x, b.max.x) - std::max(a.min.x, b.min.x);
  const double y = std::min(a.max.y, b.max.y) - std::max(a.min.y, b.min.y);
  return std::max(0.0, x) * std::max(0.0, y);
}

bool touch(const MapBox& a, const MapBox& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

MapBox box_of(const ClusterDescription& thing, const Eigen::Isometry3d& T_map_window) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MapBox box{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const double x : {thing.min_corner.x, thing.max_corner.x}) {
    for (const double y : {thing.min_corner.y, thing.max_corner.y}) {
      const double z = 0.5 * (static_cast<double>(thing.h_min) + static_cast<double>(thing.h_max));
      const Eigen::Vector3d corner = T_map_window * Eigen::Vector3d(x, y, z);
      box.min = {std::min(box.min.x, corner.x()), std::min(box.min.y, corner.y())};
      box.max = {std::max(box.max.x, corner.x()), std::max(box.max.y, corner.y())};
    }
  }
  return box;
}

ClusterView view_of(const ClusterDescription& thing, const Eigen::Isometry3d& T_map_window) {
  ClusterView view;
  view.description = thing;
  view.confidence = thing.points / (thing.points + kHalfTrusted);
  view.centre =
      T_map_window *
      Eigen::Vector3d(thing.centroid.x, thing.centroid.y,
                      0.5 * (static_cast<double>(thing.h_min) + static_cast<double>(thing.h_max)));
  view.box = box_of(thing, T_map_window);
  return view;
}

/// Two clusters, one of before and one of now, that share a place.
struct Match {
  double area;
  std::size_t now, before;
};

/// All pairs whose boxes overlap, the largest overlap first.
std::vector<Match> matches_of(const std::vector<ClusterView>& now,
                              const std::vector<ClusterView>& before) {
  std::vector<std::size_t> by_x(before.size());
  for (std::size_t k = 0; k < by_x.size(); ++k) by_x[k] = k;
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
    return before[a].box.min.x < before[b].box.min.x;
  });
  std::vector<Match> matches;
  for (std::size_t n = 0; n < now.size(); ++n) {
    for (const std::size_t b : by_x) {
      if (before[b].box.min.x > now[n].box.max.x) break;
      const double area = overlap(now[n].box, before[b].box);
      if (area > 0.0) matches.push_back({area, n, b});
    }
  }
  std::sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    if (a.area != b.area) return a.area > b.area;
    return a.now != b.now ? a.now < b.now : a.before < b.before;
  });
  return matches;
}

}  // namespace

std::unique_ptr<CostWorkspace> CostScratch::take() {
  {
    const std::lock_guard lock(mutex_);
    if (spare_) return std::move(spare_);
  }
  return std::make_unique<CostWorkspace>();
}

void CostScratch::give_back(std::unique_ptr<CostWorkspace> workspace) {
  const std::lock_guard lock(mutex_);
  spare_.swap(workspace);  // one that was there before ends here: the lock goes first
}

const CellCosts* TerrainSnapshot::known_costs() const {
  return computed_.load(std::memory_order_acquire) ? &costs_ : nullptr;
}

const CellCosts& TerrainSnapshot::costs() const {
  if (known_costs() != nullptr) return costs_;
  const std::lock_guard lock(computing_);
  if (known_costs() != nullptr) return costs_;  // somebody was faster
  auto workspace = scratch_ ? scratch_->take() : std::make_unique<CostWorkspace>();
  compute_cell_costs(description, {}, robot, *workspace, costs_);
  computed_.store(true, std::memory_order_release);
  if (scratch_) scratch_->give_back(std::move(workspace));
  return costs_;
}

void TerrainSnapshot::expect_costs(std::shared_ptr<CostScratch> scratch) {
  scratch_ = std::move(scratch);
  computed_.store(false, std::memory_order_relaxed);  // nobody else knows this snapshot yet
}

CellCosts& TerrainSnapshot::give_costs() {
  computed_.store(true, std::memory_order_relaxed);
  return costs_;
}

Position2 TerrainSnapshot::place_at(double x, double y) const {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d up = T_map_window.linear().col(2);
  const Eigen::Vector3d origin = T_map_window.translation();
  // A window on its edge has no place over (x, y).
  if (revision == 0 || !(std::abs(up.z()) > 1e-6)) return {kNowhere, kNowhere};
  const double z = origin.z() - (up.x() * (x - origin.x()) + up.y() * (y - origin.y())) / up.z();
  const Eigen::Vector3d place =
      T_map_window.linear().transpose() * (Eigen::Vector3d(x, y, z) - origin);
  return {place.x(), place.y()};
}

Slot TerrainSnapshot::slot_at(double x, double y, PlaceStatus& status) const {
  status = PlaceStatus::kOutside;
  const Position2 place = place_at(x, y);
  CellIndex cell;
  if (!description.grid.geometry.cell_at(place.x, place.y, cell)) return kUnobserved;
  const Slot slot = description.grid.slot_at(cell);
  status = slot == kUnobserved ? PlaceStatus::kUnknown : PlaceStatus::kKnown;
  return slot;
}

namespace {

/// What the description knows of a slot; heights in the frame of the window.
CellView described_cell(const TerrainSnapshot& snapshot, std::size_t k) {
  const Description& description = snapshot.description;
  const Moments moments = description.grid.moments(k);
  CellView view;
  view.status = PlaceStatus::kKnown;
  view.height = static_cast<double>(description.grid.h_mean[k]);
  view.variance = moments.covariance()(2, 2);
  view.lowest = static_cast<double>(description.grid.h_min[k]);
  view.highest = static_cast<double>(description.grid.h_max[k]);
  view.last_seen = snapshot.stamp;
  view.points = static_cast<std::int32_t>(moments.n);
  view.support = description.cells.support[k];
  view.terrain_class = description.cells.terrain_class[k];
  view.cluster = description.clusters.cluster_of[k];
  if (snapshot.fused.scans == 0) return view;
  view.height = static_cast<double>(snapshot.window_cells.height[k]);
  view.variance = static_cast<double>(snapshot.window_cells.variance[k]);
  view.last_seen = snapshot.window_cells.last_seen[k];
  return view;
}

UnseenReason unseen_at(const TerrainSnapshot& snapshot, double x, double y) {
  // Costs that are computed later do not tell why cells are unseen.
  const CellCosts* costs = snapshot.known_costs();
  if (costs == nullptr || costs->unseen.empty()) return UnseenReason::kSeen;
  const GridGeometry& geometry = snapshot.description.grid.geometry;
  const Position2 place = snapshot.place_at(x, y);
  CellIndex cell;
  if (!geometry.cell_at(place.x, place.y, cell)) return UnseenReason::kSeen;
  return costs->unseen[static_cast<std::size_t>(value_of(geometry.id_of(cell)))];
}

/// A fused cell that no description covers.
CellView fused_cell(const TerrainSnapshot& snapshot, double x, double y) {
  CellView view;
  MapCell where;
  if (!snapshot.fused.lattice.cell_at(x, y, where)) return view;
  if (!snapshot.fused.window.contains(where)) return view;
  view.status = PlaceStatus::kUnknown;
  FusedCell cell;
  if (!read_cell(snapshot.fused, where, snapshot.fusion, cell)) return view;
  view.status = PlaceStatus::kKnown;
  view.height = cell.height;
  view.variance = cell.variance;
  view.lowest = cell.h_min;
  view.highest = cell.h_max;
  view.last_seen = cell.last_seen;
  view.points = static_cast<std::int32_t>(cell.moments.n);
  return view;
}

}  // namespace

CellView TerrainSnapshot::cell_at(double x, double y) const {
  CellView view;
  const Slot slot = slot_at(x, y, view.status);
  if (view.status == PlaceStatus::kOutside && fused.scans != 0) return fused_cell(*this, x, y);
  const UnseenReason unseen = unseen_at(*this, x, y);
  view.unseen = unseen;
  if (slot == kUnobserved) return view;
  const auto k = static_cast<std::size_t>(slot);
  view = described_cell(*this, k);
  view.unseen = unseen;
  const GridGeometry& geometry = description.grid.geometry;
  const Position2 centre = geometry.centre_of(geometry.index_of(description.grid.cell[k]));
  for (double* height : {&view.height, &view.lowest, &view.highest}) {
    *height = (T_map_window * Eigen::Vector3d(centre.x, centre.y, *height)).z();
  }
  return view;
}

namespace {

double heading_in(const TerrainSnapshot& snapshot, double heading) {
  const Eigen::Vector3d ahead = snapshot.T_map_window.linear().transpose() *
                                Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace

Cost TerrainSnapshot::cost_at(double x, double y, double heading) const {
  return mrpt_terrain::cost_at(description.grid, costs(), place_at(x, y), robot,
                               heading_in(*this, heading));
}

Cost TerrainSnapshot::cost_at(double x, double y) const {
  return mrpt_terrain::cost_at(description.grid, costs(), place_at(x, y), robot);
}

Cost TerrainSnapshot::footprint_cost_at(double x, double y, double heading) const {
  return mrpt_terrain::footprint_cost_at(description.grid, costs(), place_at(x, y), robot,
                                         heading_in(*this, heading));
}

std::vector<std::size_t> TerrainSnapshot::clusters_in(const MapBox& box) const {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (touch(clusters[k].box, box)) found.push_back(k);
  }
  return found;
}

void TerrainSnapshot::list_clusters() {
  clusters.clear();
  for (const ClusterDescription& thing : description.things) {
    clusters.push_back(view_of(thing, T_map_window));
  }
}

void TerrainSnapshot::set_identities(const std::vector<std::uint64_t>& identities) {
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    clusters[k].identity = clusters[k].description.identity = description.things[k].identity =
        identities[k];
  }
}

void TerrainSnapshot::name_clusters(const TerrainSnapshot* before, std::uint64_t& next_identity) {
  list_clusters();
  std::vector<bool> named(clusters.size(), false);
  if (before != nullptr) {
    std::vector<bool> passed_on(before->clusters.size(), false);
    for (const Match& match : matches_of(clusters, before->clusters)) {
      if (named[match.now] || passed_on[match.before]) continue;
      named[match.now] = passed_on[match.before] = true;
      clusters[match.now].identity = before->clusters[match.before].identity;
    }
  }
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (!named[k]) clusters[k].identity = next_identity++;
  }
}

}  // namespace mrpt_terrain
