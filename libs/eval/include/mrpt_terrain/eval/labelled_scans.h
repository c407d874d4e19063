// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"

/// \file
/// Scans with a label per point as SemanticKITTI stores them: `velodyne/NNNNNN.bin` (float32 x, y,
/// z, intensity) and `labels/NNNNNN.label` (uint32, class in the low 16 bits).
namespace mrpt_terrain::eval {

/// What the numbers of classes mean.
enum class LabelSet : std::uint8_t {
  kSemanticKitti = 0,  ///< everything that is neither ground nor ignored is an obstacle
  kRellis,             ///< RELLIS-3D
  kTerrain,            ///< the truth files of this project, doc/truth-files.md
};
constexpr EnumNames<LabelSet, 3> enum_names(LabelSet) {
  return {{{LabelSet::kSemanticKitti, "semantickitti"},
           {LabelSet::kRellis, "rellis"},
           {LabelSet::kTerrain, "terrain"}}};
}

/// kGround, kAbove, or kUnknown for classes that are not counted.
[[nodiscard]] Support support_of_label(LabelSet set, std::uint32_t label);

/// Points of one file and their truth. Zero returns are left out.
struct LabelledScan {
  Points points;                    ///< frame of the file, metres
  std::vector<Support> support;     ///< per point
  std::vector<std::uint32_t> slot;  ///< per point: its place in the file
  std::size_t slots = 0;            ///< of the file
};

struct LabelledFiles {
  std::string points, labels;
};
/// All scans of a folder, by name. Throws io::ReadError if it has none, or one without labels.
[[nodiscard]] std::vector<LabelledFiles> find_labelled_scans(const std::string& folder);

/// Throws io::ReadError if a file is missing, cut off, or the numbers of points and labels differ.
[[nodiscard]] LabelledScan read_labelled_scan(const LabelledFiles& files, LabelSet set);

/// What a description says of every point, as a label: support in the low 16 bits (40 ground, 50
/// above, 52 below, 0 unknown), class in the high 16 bits (`TerrainClass`).
[[nodiscard]] std::vector<std::uint32_t> prediction_labels(const PointLabels& labels);

/// Writes points with intensity 0. Throws std::runtime_error.
void write_kitti_points(const std::string& file, const Points& points);

}  // namespace mrpt_terrain::eval
