// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <cstddef>
#include <string>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain::view {

/// What a scene shows.
struct SceneOptions {
  bool cells = true;            ///< the observed cells as a surface, coloured by mean height and
                                ///< drawn 2 cm lower than it so that the points stay visible
  std::size_t max_boxes = 300;  ///< clusters that get a box, the largest first
  std::size_t max_labels = 60;  ///< clusters that get their number too
};

/// The description as a 3D scene in the robot's frame, of stock MRPT objects only, named "points"
/// (coloured by class), "cells", "clusters" (boxes in the colour of the class, with numbers),
/// "grid", and "robot".
/// \param points those that were described; points that are not finite are left out
[[nodiscard]] mrpt::opengl::COpenGLScene::Ptr make_scene(const Description& description,
                                                         const PointsView& points,
                                                         const SceneOptions& options = {});

/// Writes the scene as a `.3Dscene` file for SceneViewer3D. The file appears as a whole or not at
/// all. Throws std::runtime_error "FILE: cannot be written: reason".
void write_scene(const std::string& file, const Description& description, const PointsView& points,
                 const SceneOptions& options = {});

}  // namespace mrpt_terrain::view
