// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/free_space_holes.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain {
namespace {

/// The ground of a scan below places of the map.
struct MapGround {
  const GroundSurface& ground;
  const Eigen::Isometry3d& T_map_scan;
  Eigen::Isometry3d T_scan_map = T_map_scan.inverse();

  /// Place in the scan's frame, on the ground. Twice: the first guess has the height of the scan's
  /// origin.
  [[nodiscard]] Eigen::Vector3d below(Position2 at) const {
    double z = T_map_scan.translation().z();
    Eigen::Vector3d place;
    for (int round = 0; round < 2; ++round) {
      place = T_scan_map * Eigen::Vector3d(at.x, at.y, z);
      place.z() = static_cast<double>(
          ground.height_at(static_cast<float>(place.x()), static_cast<float>(place.y())));
      z = (T_map_scan * place).z();
    }
    return place;
  }
};

// How far space is free from the ground downwards, metres.
double free_below(const FreeSpaceGrid& free, std::size_t k, double ground) {
  const double layer = free.lattice.layer_height();
  for (const LayerSpan* span = free.begin_of(k); span != free.end_of(k); ++span) {
    const double low = free.lattice.bottom_of(span->low), high = free.lattice.bottom_of(span->high);
    if (low < ground - layer && high > ground - layer) return ground - low;
  }
  return 0.0;
}

// Entries that touch an entry, whatever comes first.
template <class F>
void for_entries_around(const FreeSpaceGrid& free, std::size_t k, F&& f) {
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const std::size_t other = free.find({free.cell[k].i + i, free.cell[k].j + j});
      if (other != free.size()) f(other);
    }
  }
}

void collect(const FreeSpaceGrid& free, std::size_t first, const std::vector<float>& depth,
             std::vector<std::uint8_t>& taken, std::vector<std::int32_t>& members) {
  members.assign(1, static_cast<std::int32_t>(first));
  taken[first] = 1;
  for (std::size_t next = 0; next < members.size(); ++next) {
    for_entries_around(free, static_cast<std::size_t>(members[next]), [&](std::size_t other) {
      if (taken[other] != 0 || depth[other] <= 0.0F) return;
      taken[other] = 1;
      members.push_back(static_cast<std::int32_t>(other));
    });
  }
  std::sort(members.begin(), members.end());
}

HoleDescription describe(const FreeSpaceGrid& free, const MapGround& ground,
                         const FreeSpaceHoleWorkspace& workspace) {
  MomentSums sums;
  float depth = 0.0F;
  for (const std::int32_t member : workspace.members) {
    const auto k = static_cast<std::size_t>(member);
    const Eigen::Vector3d place = ground.below(free.lattice.centre_of(free.cell[k]));
    sums.add(place.x(), place.y(), 0.0);
    depth = std::max(depth, workspace.depth[k]);
  }
  const Moments m = moments_from(sums);
  // Variances along the axes of the cells; a rectangle of length l has l^2 / 12.
  const double cell = free.lattice.cell_size() * free.lattice.cell_size() / 12.0;
  const double xx = m.m_xx / m.n + cell, yy = m.m_yy / m.n + cell, xy = m.m_xy / m.n;
  const double middle = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
  HoleDescription hole;
  hole.kind = HoleKind::kFreeSpace;
  hole.centre = {m.mean_x, m.mean_y};
  hole.length = std::sqrt(12.0 * (middle + apart));
  hole.width = std::sqrt(12.0 * std::max(middle - apart, 0.0));
  hole.depth = static_cast<double>(depth);
  hole.confidence = std::max(0.0, 1.0 - free.lattice.layer_height() / hole.depth);
  return hole;
}

}  // namespace

void find_free_space_holes(const FreeSpaceGrid& free, const GroundSurface& ground,
                           const Eigen::Isometry3d& T_map_scan, const FreeSpaceHoleParams& params,
                           FreeSpaceHoleWorkspace& workspace, std::vector<HoleDescription>& holes,
                           IndexRows& hole_cells) {
  const MapGround map_ground{ground, T_map_scan};
  holes.clear();
  clear_rows(hole_cells);
  workspace.depth.assign(free.size(), 0.0F);
  workspace.taken.assign(free.size(), 0);
  const double least = params.least_depth + free.lattice.layer_height();
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Vector3d place = map_ground.below(free.lattice.centre_of(free.cell[k]));
    const double depth = free_below(free, k, (T_map_scan * place).z());
    if (depth >= least) workspace.depth[k] = static_cast<float>(depth);
  }
  const double area = free.lattice.cell_size() * free.lattice.cell_size();
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (workspace.depth[k] <= 0.0F || workspace.taken[k] != 0) continue;
    collect(free, k, workspace.depth, workspace.taken, workspace.members);
    if (static_cast<double>(workspace.members.size()) * area < params.least_area) continue;
    holes.push_back(describe(free, map_ground, workspace));
    hole_cells.items.insert(hole_cells.items.end(), workspace.members.begin(),
                            workspace.members.end());
    hole_cells.first.push_back(static_cast<std::int32_t>(hole_cells.items.size()));
  }
}

}  // namespace mrpt_terrain
