// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/top_view.h"

namespace mrpt_terrain::view {

/// Colour of a cell by its cost: `cost_colour`, or those of lethal and unknown cells.
[[nodiscard]] Rgb colour_of(const Cost& cost);

/// Writes a PNG like `write_top_view`, with the costs of the cells for the worst heading in place
/// of the classes: heights and costs, one scale, a legend with the numbers of cells. \param costs
/// of the description's grid; its `unseen` colours cells that were not observed \param robot that
/// the costs are for
void write_cost_view(const std::string& file, const Description& description,
                     const CellCosts& costs, const RobotParams& robot,
                     const TopViewOptions& options);

/// Writes a PNG with a small map per part of the costs, for the worst heading, and one of the costs
/// themselves: which part makes a cell dear or lethal. Only parts that are known of these costs.
void write_cost_layers(const std::string& file, const Description& description,
                       const CellCosts& costs, const RobotParams& robot,
                       const TopViewOptions& options);

}  // namespace mrpt_terrain::view
