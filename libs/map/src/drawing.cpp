// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/opengl/CSetOfObjects.h>

#include "map_state.h"
#include "mrpt_terrain/view/cost_view.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/scene_objects.h"

namespace mrpt_terrain {
namespace {

// As many as a person can tell apart.
constexpr std::size_t kMostBoxes = 300;
constexpr std::size_t kMostLabels = 60;

view::CellColours colours_of(const TerrainSnapshot& snapshot, CellColouring colouring) {
  const Description& description = snapshot.description;
  switch (colouring) {
    case CellColouring::kClass:
      return [&description](std::size_t slot) {
        return view::colour_of(description.cells.terrain_class[slot],
                               description.cells.support[slot]);
      };
    case CellColouring::kCost:
      return [&costs = snapshot.costs(), &snapshot](std::size_t slot) {
        const Cost cost = cost_of(costs, static_cast<Slot>(slot), snapshot.robot);
        return view::colour_of(cost);
      };
    case CellColouring::kHeight:
      break;
  }
  return view::height_colours(description.grid);
}

}  // namespace

void draw(const CTerrainMap& map, const MapRenderParams& render,
          mrpt::opengl::CSetOfObjects& objects) {
  const TerrainSnapshotPtr now = map.snapshot();
  if (now->revision == 0) return;
  auto window = mrpt::opengl::CSetOfObjects::Create();
  window->setName("terrain");
  window->setPose(pose_of(now->T_map_window));
  if (render.cells) {
    window->insert(view::make_cells(now->description.grid, colours_of(*now, render.colouring)));
  }
  if (render.clusters) {
    window->insert(view::make_clusters(now->description, kMostBoxes, kMostLabels));
  }
  objects.insert(window);
  if (render.points) {
    auto points = view::make_points(now->description, now->points.view());
    points->setPose(pose_of(now->T_map_robot));
    objects.insert(points);
  }
  if (!render.octree) return;
  auto voxels = map.as_voxels();
  voxels->showVoxels(mrpt::opengl::VOXEL_SET_FREESPACE, false);
  objects.insert(voxels);
}

}  // namespace mrpt_terrain
