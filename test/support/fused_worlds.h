// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "lidar.h"
#include "mrpt_terrain/core/apply_free_space.h"
#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/fused_cell.h"
#include "mrpt_terrain/core/fused_grid.h"

/// \file
/// Drives through the worlds of lidar.h with poses, and an occupancy grid that keeps its books like
/// OctoMap, so that fused grids can be given the free space that an octree would know.
namespace mrpt_terrain::worlds {

/// A scan of a sensor over (x, y), level, with the ends of its rays.
struct DriveScan {
  Points points;  ///< robot frame
  Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();
  Vec3 origin;             ///< of the rays, map frame
  std::vector<Vec3> ends;  ///< map frame; rays without return end at the maximum range
  std::vector<bool> hit;   ///< per ray
};

/// One turn, or the part of it within `half_angle_deg` of the x axis.
[[nodiscard]] inline DriveScan drive_scan(const Scene& scene, const LidarModel& model, double x,
                                          double y, RandomGenerator& random,
                                          double half_angle_deg = 180.0) {
  DriveScan result;
  result.T_map_robot.translation() = Eigen::Vector3d(x, y, 0.0);
  result.origin = {x, y, model.height};
  const double beam_step = (model.highest_deg - model.lowest_deg) / (model.beams - 1);
  for (double a = -half_angle_deg; a < half_angle_deg; a += model.azimuth_step_deg) {
    const double azimuth = radians(a);
    for (int beam = 0; beam < model.beams; ++beam) {
      const double elevation = radians(model.lowest_deg + beam * beam_step);
      const Vec3 d{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation)};
      const Hit hit = cast(scene, result.origin, d);
      const bool returns = hit.range < model.max_range;
      const double range =
          returns ? hit.range + model.range_sigma * normal_deviate(random) : model.max_range;
      result.ends.push_back({x + range * d.x, y + range * d.y, model.height + range * d.z});
      result.hit.push_back(returns);
      if (!returns) continue;
      add_point(result.points, range * d.x, range * d.y, model.height + range * d.z);
    }
  }
  return result;
}

struct VoxelHash {
  std::size_t operator()(const VoxelIndex& v) const {
    return (static_cast<std::size_t>(v.x) * 73856093U) ^
           (static_cast<std::size_t>(v.y) * 19349663U) ^
           (static_cast<std::size_t>(v.z) * 83492791U);
  }
};
struct VoxelEqual {
  bool operator()(const VoxelIndex& a, const VoxelIndex& b) const {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};
using VoxelSet = std::unordered_set<VoxelIndex, VoxelHash, VoxelEqual>;

/// Log-odds per voxel, with OctoMap's default numbers: a voxel gets one update a scan, and ends of
/// rays win over passages.
class OccupancyBook {
 public:
  explicit OccupancyBook(double resolution) : resolution_(resolution) {}

  /// Enters a scan; returns the voxels that its rays passed and that are free now.
  std::vector<VoxelIndex> insert(const DriveScan& scan) {
    VoxelSet occupied, passed;
    for (std::size_t k = 0; k < scan.ends.size(); ++k) {
      if (scan.hit[k]) occupied.insert(voxel(scan.ends[k]));
      walk(scan.origin, scan.ends[k], passed);
    }
    for (const VoxelIndex& v : occupied) {
      float& odds = odds_[v];
      odds = std::min(3.5F, odds + 0.85F);
    }
    std::vector<VoxelIndex> free;
    for (const VoxelIndex& v : passed) {
      if (occupied.count(v) != 0) continue;
      float& odds = odds_[v];
      odds = std::max(-2.0F, odds - 0.4F);
      if (odds < 0.0F) free.push_back(v);
    }
    return free;
  }

 private:
  [[nodiscard]] VoxelIndex voxel(const Vec3& p) const {
    return {floor_to_int(p.x / resolution_), floor_to_int(p.y / resolution_),
            floor_to_int(p.z / resolution_)};
  }

  // All voxels on the way, the last one left out (Amanatides and Woo 1987).
  void walk(const Vec3& from, const Vec3& to, VoxelSet& passed) const {
    VoxelIndex v = voxel(from);
    const VoxelIndex end = voxel(to);
    const std::array<double, 3> d = {to.x - from.x, to.y - from.y, to.z - from.z};
    const std::array<double, 3> o = {from.x, from.y, from.z};
    const std::array<std::int32_t*, 3> index = {&v.x, &v.y, &v.z};
    std::array<double, 3> next{}, step{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double border = (*index[k] + (d[k] > 0.0 ? 1 : 0)) * resolution_;
      next[k] = d[k] == 0.0 ? 1e300 : (border - o[k]) / d[k];
      step[k] = d[k] == 0.0 ? 0.0 : resolution_ / std::abs(d[k]);
    }
    while (!VoxelEqual{}(v, end)) {
      passed.insert(v);
      const auto k =
          static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
      if (next[k] > 1.0) break;
      *index[k] += d[k] > 0.0 ? 1 : -1;
      next[k] += step[k];
    }
  }

  double resolution_;
  std::unordered_map<VoxelIndex, float, VoxelHash, VoxelEqual> odds_;
};

/// A fused grid with the occupancy beside it.
struct Mapper {
  FusionParams params;
  FusedGrid grid;
  FusionWorkspace workspace;
  OccupancyBook book;
  FreeSpaceGrid free;
  FreeSpaceCounts freed;  ///< by the last scan
  double time = 0.0;

  explicit Mapper(const FusionParams& p) : params(p), grid(p), book(p.layer_height) {}

  FusionCounts fuse(const DriveScan& scan) {
    time += 0.1;
    return fuse_scan({scan.points.view(), scan.T_map_robot, time}, params, workspace, grid);
  }
  void fuse_and_free(const DriveScan& scan) {
    fuse(scan);
    std::vector<VoxelIndex> voxels = book.insert(scan);
    const int side = static_cast<int>(std::lround(params.cell_size / params.layer_height));
    collect_free_space(grid.now().lattice, side, time, voxels, free);
    freed = apply_free_space(free, params, grid);
  }
  /// The cell at (x, y); fails the test if nothing is known of it.
  [[nodiscard]] FusedCell cell_at(double x, double y) const {
    MapCell where;
    FusedCell cell;
    EXPECT_TRUE(grid.now().lattice.cell_at(x, y, where));
    EXPECT_TRUE(read_cell(grid.now(), where, params, cell)) << "at " << x << ", " << y;
    return cell;
  }
  [[nodiscard]] bool knows(double x, double y) const {
    MapCell where;
    FusedCell cell;
    return grid.now().lattice.cell_at(x, y, where) && read_cell(grid.now(), where, params, cell);
  }
};

}  // namespace mrpt_terrain::worlds
