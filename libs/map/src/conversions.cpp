// SPDX-License-Identifier: BSD-3-Clause
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>

#include "map_state.h"
#include "mrpt_terrain/view/palette.h"

namespace mrpt_terrain {
namespace {

using mrpt::opengl::COctoMapVoxels;

COctoMapVoxels::TVoxel voxel_of(const octomap::OcTree::leaf_iterator& leaf, view::Rgb colour) {
  const octomap::point3d centre = leaf.getCoordinate();
  return {{centre.x(), centre.y(), centre.z()}, leaf.getSize(), {colour.r, colour.g, colour.b}};
}

}  // namespace

mrpt::maps::CSimplePointsMap::Ptr CTerrainMap::as_points_map() const {
  const TerrainSnapshotPtr now = snapshot();
  auto map = mrpt::maps::CSimplePointsMap::Create();
  const Points& points = now->points;
  map->reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3f robot(points.x[k], points.y[k], points.z[k]);
    const Eigen::Vector3d p = now->T_map_robot * robot.cast<double>();
    if (!p.allFinite()) continue;
    map->insertPoint(static_cast<float>(p.x()), static_cast<float>(p.y()),
                     static_cast<float>(p.z()));
  }
  return map;
}

mrpt::maps::COccupancyGridMap2D::Ptr CTerrainMap::as_occupancy_grid() const {
  const TerrainSnapshotPtr now = snapshot();
  auto map = mrpt::maps::COccupancyGridMap2D::Create();
  const GridGeometry& geometry = now->description.grid.geometry;
  if (now->revision == 0) return map;
  // Axis-parallel in the map, as large as the turned window.
  const double reach = std::hypot(geometry.half_length(), geometry.half_width());
  const Eigen::Vector3d centre = now->T_map_window.translation();
  map->setSize(static_cast<float>(centre.x() - reach), static_cast<float>(centre.x() + reach),
               static_cast<float>(centre.y() - reach), static_cast<float>(centre.y() + reach),
               static_cast<float>(geometry.cell_size()), 0.5F);
  for (int cx = 0; cx < static_cast<int>(map->getSizeX()); ++cx) {
    for (int cy = 0; cy < static_cast<int>(map->getSizeY()); ++cy) {
      const Cost cost =
          now->cost_at(static_cast<double>(map->idx2x(cx)), static_cast<double>(map->idx2y(cy)));
      if (is_known(cost)) map->setCell(cx, cy, static_cast<float>(1.0 - cost.cost));
    }
  }
  return map;
}

COctoMapVoxels::Ptr CTerrainMap::as_voxels() const {
  auto voxels = COctoMapVoxels::Create();
  voxels->setName("octree");
  voxels->resizeVoxelSets(2);
  voxels->setVisualizationMode(COctoMapVoxels::FIXED);
  const std::shared_ptr<const octomap::OcTree> tree = octree();
  if (!tree || tree->size() == 0) return voxels;
  double x0, y0, z0, x1, y1, z1;
  tree->getMetricMin(x0, y0, z0);
  tree->getMetricMax(x1, y1, z1);
  const double height = std::max(z1 - z0, 1e-3);
  for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
    const view::Rgb colour = view::height_colour((leaf.getZ() - z0) / height);
    const auto set = tree->isNodeOccupied(*leaf) ? mrpt::opengl::VOXEL_SET_OCCUPIED
                                                 : mrpt::opengl::VOXEL_SET_FREESPACE;
    voxels->push_back_Voxel(set, voxel_of(leaf, colour));
  }
  voxels->setBoundingBox({x0, y0, z0}, {x1, y1, z1});
  return voxels;
}

}  // namespace mrpt_terrain
