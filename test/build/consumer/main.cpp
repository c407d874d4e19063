// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Somebody else's program: a box on flat ground must come out as one obstacle.
#include <cstdlib>
#include <iostream>

#include "mrpt_terrain/core/describe.h"
#ifdef HAVE_params
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/params/ini.h"
#endif
#ifdef HAVE_io
#include "mrpt_terrain/io/trajectory.h"
#endif
#ifdef HAVE_octree
#include "mrpt_terrain/octree/insert_scan.h"
#endif

namespace {

/// Flat ground of 4 m x 4 m with a box of 0.3 m x 0.3 m x 0.4 m, a point every 2 cm.
mrpt_terrain::Points box_on_ground() {
  mrpt_terrain::Points points;
  for (int i = -100; i < 100; ++i) {
    for (int j = -100; j < 100; ++j) {
      const bool in_box = i >= 50 && i < 65 && j >= 0 && j < 15;
      const int layers = in_box ? 20 : 1;
      for (int k = 0; k < layers; ++k) {
        points.push_back(0.02F * static_cast<float>(i) + 0.01F,
                         0.02F * static_cast<float>(j) + 0.01F, 0.02F * static_cast<float>(k));
      }
    }
  }
  return points;
}

}  // namespace

int main() {
  mrpt_terrain::DescriptionParams params;
#ifdef HAVE_params
  const auto file = mrpt_terrain::params::find_data_folder() / "params" / "paper.ini";
  mrpt_terrain::params::load_ini(file.string(), params);
#endif
#ifdef HAVE_io
  mrpt_terrain::io::Trajectory trajectory;
  trajectory.add(1.0, mrpt::poses::CPose3D());
  if (!trajectory.at(1.0)) return EXIT_FAILURE;
#endif
#ifdef HAVE_octree
  octomap::OcTree tree(0.1);
  mrpt_terrain::octree::InsertionWorkspace memory;
  const float x = 1.05F, y = 0.05F, z = 0.05F;
  const std::array<float, 3> origin = {0.05F, 0.05F, 0.05F};
  mrpt_terrain::octree::insert_scan({&x, &y, &z, 1}, {&origin, 1}, {}, memory, tree);
  if (tree.getNumLeafNodes() != 11) return EXIT_FAILURE;
#endif
  mrpt_terrain::DescriptionWorkspace workspace;
  mrpt_terrain::Description description;
  const mrpt_terrain::Points points = box_on_ground();
  mrpt_terrain::describe(points.view(), params, workspace, description);
  std::cout << description.things.size() << " cluster(s)\n";
  const bool one_obstacle =
      description.things.size() == 1 &&
      description.things[0].terrain_class == mrpt_terrain::TerrainClass::kObstacle;
  return one_obstacle ? EXIT_SUCCESS : EXIT_FAILURE;
}
