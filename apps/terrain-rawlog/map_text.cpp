// SPDX-License-Identifier: BSD-3-Clause
#include "map_text.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>

#include "mrpt_terrain/view/tables.h"
#include "mrpt_terrain/view/text.h"

namespace {

using namespace mrpt_terrain;

/// Cells with points, and the rectangle of the map that holds them, metres.
struct Extent {
  std::size_t cells = 0;
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x;
  double max_x = -min_x, max_y = -min_x;

  void add(double x, double y, double half) {
    ++cells;
    min_x = std::min(min_x, x - half);
    max_x = std::max(max_x, x + half);
    min_y = std::min(min_y, y - half);
    max_y = std::max(max_y, y + half);
  }
};

Extent extent_of_fused(const FusedSnapshot& fused) {
  Extent extent;
  const double half = 0.5 * fused.lattice.cell_size();
  fused.tiles.for_each([&](TileIndex index, const Tile& tile) {
    for (std::size_t place = 0; place < tile.cells.size(); ++place) {
      if (tile.cells[place].first == kNoBin) continue;
      const Position2 centre = fused.lattice.centre_of(cell_of(index, place));
      extent.add(centre.x, centre.y, half);
    }
  });
  return extent;
}

// Cells of a turned window count as if they were parallel to the map.
Extent extent_of_window(const TerrainSnapshot& snapshot) {
  Extent extent;
  const ElevationGrid& grid = snapshot.description.grid;
  const double half = 0.5 * grid.geometry.cell_size();
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    const Position2 centre = grid.geometry.centre_of(grid.geometry.index_of(grid.cell[slot]));
    const Eigen::Vector3d in_map =
        snapshot.T_map_window * Eigen::Vector3d(centre.x, centre.y, grid.h_mean[slot]);
    extent.add(in_map.x(), in_map.y(), half);
  }
  return extent;
}

std::string cells_text(const Extent& extent, double cell_size) {
  std::string text =
      "cells: " + view::grouped(extent.cells) + " of " + view::shortest(cell_size) + " m";
  if (extent.cells == 0) return text + "\n";
  const auto range = [](double low, double high) {
    return view::fixed(low, 1) + " to " + view::fixed(high, 1) + " m";
  };
  return text + ", x " + range(extent.min_x, extent.max_x) + ", y " +
         range(extent.min_y, extent.max_y) + " of the map\n";
}

std::string octree_text(const CTerrainMap& map) {
  const auto tree = map.octree();
  if (!tree) return "OctoMap: none\n";
  return "OctoMap: " + view::grouped(tree->size()) + " nodes, voxels of " +
         view::shortest(tree->getResolution()) + " m\n";
}

std::string last_scan_text(const TerrainSnapshot& snapshot) {
  std::string text = "scans: " + std::to_string(snapshot.revision) + ", the last with " +
                     view::grouped(snapshot.points.size()) + " points";
  const std::string time = view::time_text(snapshot.stamp);
  if (!time.empty()) text += ", " + time;
  const Eigen::Vector3d at = snapshot.T_map_robot.translation();
  return text + ", robot at " + view::fixed(at.x(), 2) + " " + view::fixed(at.y(), 2) + " " +
         view::fixed(at.z(), 2) + " m\n";
}

}  // namespace

std::string map_text(const CTerrainMap& map) {
  const TerrainSnapshotPtr now = map.snapshot();
  const bool rolling = map.params().creation.fusion == Fusion::kRolling;
  std::string text = std::string("terrain map, fusion = ") + name_of(map.params().creation.fusion) +
                     (rolling ? ": all scans so far\n" : ": the last scan by itself\n");
  if (now->revision == 0) return text + "empty\n";
  const Extent extent = rolling ? extent_of_fused(now->fused) : extent_of_window(*now);
  return text + last_scan_text(*now) + cells_text(extent, map.params().description.grid.cell_size) +
         octree_text(map) + view::class_summary(now->description) + "\n";
}

std::string files_text(const CTerrainMap& map, const std::string& prefix,
                       const std::string& first) {
  std::string endings = first + (first.empty() ? "" : " ") + ".3Dscene";
  if (map.octree()) endings += " .ot .bt";
  endings += " _clusters.csv _cost.pgm _cost.yaml";
  if (!map.isEmpty()) endings += " _classes.png _cost.png";
  if (map.snapshot()->costs().has(CostPart::kObstacle) && !map.isEmpty())
    endings += " _holes.csv _cost_layers.png _cost_PART.pgm _cost_PART.yaml";
  return "written: " + prefix + endings + "\n";
}
