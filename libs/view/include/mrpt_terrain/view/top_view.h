// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/unseen_reason.h"

namespace mrpt_terrain::view {

/// Whose x points up in a view from above. The robot is at the origin in both cases.
enum class ViewAxes : std::uint8_t { kRobot, kMap };

/// What a top view says beside the description, and how large it is.
struct TopViewOptions {
  std::string source;          ///< file that the scan came from; its base name is shown
  std::size_t scan_index = 0;  ///< number of the scan in its run
  double stamp = 0.0;          ///< seconds since the Unix epoch or the start of the data set
  DescriptionParams params;    ///< those of the description, for the footer
  ViewAxes axes = ViewAxes::kRobot;
  int max_width = 1600;         ///< of the picture, pixels
  int max_height = 920;         ///< of the picture, pixels
  std::size_t max_labels = 25;  ///< clusters that get their number, the largest first
  /// Per `CellId`, why the ground was not seen (`explain_unseen_cells`); null or empty: not told.
  const std::vector<UnseenReason>* unseen = nullptr;
};

/// Writes a PNG with two views of the description from above, x up and y to the left: mean
/// heights of the cells with their scale, and classes of the clusters with their numbers; the robot
/// at the origin, a metric grid, a scale bar, a legend with counts, and the parameters. Holes have
/// labels of their own, "h" with their number and the depth in centimetres; cells that were not
/// observed have the colour of the reason, if `unseen` tells it.
///
/// The file appears as a whole or not at all. Throws std::runtime_error "FILE: cannot be written:
/// reason".
void write_top_view(const std::string& file, const Description& description,
                    const TopViewOptions& options);

}  // namespace mrpt_terrain::view
