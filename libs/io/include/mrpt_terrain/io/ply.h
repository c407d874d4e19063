// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/io/file_cloud.h"

namespace mrpt_terrain::io {

/// Reads the vertices of a PLY file (ascii, binary of either byte order) with properties x, y, z
/// and, where present, intensity (also `scalar_Intensity`) and label (also `scalar_Label`). Other
/// properties, lists and elements are stepped over.
/// Throws ReadError "file:line: ..." or "file: byte N: ...".
[[nodiscard]] FileCloud read_ply(const std::string& file);

struct PointColor {
  std::uint8_t red = 0, green = 0, blue = 0;
};
/// Colour of a point by its labels; libs/view has the one that all pictures use.
using PointPalette = std::function<PointColor(Support, TerrainClass)>;

/// Writes points with their labels as binary little-endian PLY, whole or not at all: x, y, z
/// (float); support, class (uchar, values of the enumerations); cluster (int, -1: none); red,
/// green, blue (uchar). Throws std::runtime_error when the file cannot be written. \param labels of
/// the same length as the points
void write_labelled_ply(const std::string& file, PointsView points, const PointLabels& labels,
                        const PointPalette& palette);

}  // namespace mrpt_terrain::io
