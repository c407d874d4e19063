// SPDX-License-Identifier: BSD-3-Clause
#include "octomap_insertion.h"

#include <octomap/Pointcloud.h>

#include <cmath>

#include "guard_cells.h"
#include "rays.h"

namespace mrpt_terrain::octree {
namespace {

bool is_finite(const Place& place) {
  return std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]);
}

// The rays of each origin, without those that are left out.
std::vector<octomap::Pointcloud> sort_by_origin(const RayEnds& ends, const RayOrigins& origins,
                                                const InsertionOptions& options,
                                                const CellGrid& grid, InsertionResult& result) {
  std::vector<octomap::Pointcloud> clouds(origins.size);
  for (std::size_t k = 0; k < ends.size; ++k) {
    const std::uint32_t origin = origins.origin_of == nullptr ? 0 : origins.origin_of[k];
    const Place end = {ends.x[k], ends.y[k], ends.z[k]};
    if (!is_finite(origins.origins[origin]) || !is_finite(end)) {
      ++result.non_finite;
      continue;
    }
    CellKey key{};
    if (!grid.find_key(end, key)) {
      ++result.out_of_range;
      if (options.discretize) continue;
    }
    clouds[origin].push_back(end[0], end[1], end[2]);
    ++result.rays;
  }
  return clouds;
}

}  // namespace

InsertionResult insert_with_octomap(const RayEnds& ends, const RayOrigins& origins,
                                    const InsertionOptions& options, octomap::OcTree& tree,
                                    FreeCells* before) {
  InsertionResult result;
  result.inserter = Inserter::kOctomap;
  const auto clouds =
      sort_by_origin(ends, origins, options, CellGrid(tree.getResolution()), result);
  KeySets cells;
  for (std::size_t k = 0; k < clouds.size(); ++k) {
    const Place& place = origins.origins[k];
    const octomap::point3d origin(place[0], place[1], place[2]);
    if (origins.size == 1 && options.guarded == nullptr) {
      tree.insertPointCloud(clouds[k], origin, options.max_range, false, options.discretize);
      return result;
    }
    // Both take occupied cells out of all free ones in the end.
    if (options.discretize) {
      tree.computeDiscreteUpdate(clouds[k], origin, cells.free, cells.occupied, options.max_range);
    } else {
      tree.computeUpdate(clouds[k], origin, cells.free, cells.occupied, options.max_range);
    }
  }
  if (options.guarded != nullptr) {
    // What one origin sees may be occupied for another.
    for (const octomap::OcTreeKey& key : cells.occupied) cells.free.erase(key);
    result.kept = guard_cells(*options.guarded, cells, tree, before);
  }
  for (const octomap::OcTreeKey& key : cells.free) tree.updateNode(key, false, false);
  for (const octomap::OcTreeKey& key : cells.occupied) tree.updateNode(key, true, false);
  return result;
}

}  // namespace mrpt_terrain::octree
