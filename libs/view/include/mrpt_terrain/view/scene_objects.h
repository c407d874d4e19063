// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <cstddef>
#include <functional>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/view/palette.h"

/// \file
/// What scenes are made of: stock MRPT objects in the frame of the description.
namespace mrpt_terrain::view {

/// Colour of an observed cell by its slot.
using CellColours = std::function<Rgb(std::size_t slot)>;

/// Colours by mean height over the range that most cells have. `grid` has to stay alive.
[[nodiscard]] CellColours height_colours(const ElevationGrid& grid);

/// The observed cells as a surface in half-light colours, 2 cm lower than their mean heights so
/// that points stay visible; named "cells".
[[nodiscard]] mrpt::opengl::CSetOfTriangles::Ptr make_cells(const ElevationGrid& grid,
                                                            const CellColours& colours);

/// The points that were described, coloured by class, those that are not finite left out; named
/// "points".
[[nodiscard]] mrpt::opengl::CPointCloudColoured::Ptr make_points(const Description& description,
                                                                 const PointsView& points);

/// Boxes in the colours of their classes for the `max_boxes` largest clusters, with their numbers
/// for the `max_labels` largest; named "clusters".
[[nodiscard]] mrpt::opengl::CSetOfObjects::Ptr make_clusters(const Description& description,
                                                             std::size_t max_boxes,
                                                             std::size_t max_labels);

}  // namespace mrpt_terrain::view
