// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/points.h"

/// \file
/// Costs of what a description of field mode knows; doc/costs.md.
namespace mrpt_terrain {

/// The points of a description, as far as they are at hand; borrowed.
struct DescribedPoints {
  PointsView points;                  ///< that were described; none: not at hand
  const PointSlots* slots = nullptr;  ///< of them, `DescriptionWorkspace::point_slots`
  const float* height = nullptr;      ///< of them, above the ground reference; null: not at hand
};

/// Measures what the costs of a description depend on. In paper mode, or as long as a description
/// has no cells of field mode, it is the function of the same name in costs.h.
///
/// In field mode, slope, step and roughness are those of what a wheel can rest on: of points whose
/// support is ground, and of the top of decks. What stands, hangs or gapes there is told apart:
/// * Obstacle: height of the highest point above the ground (on decks: above the deck) that lies
///   below the robot's height and its reserve; where the cell has ground as well, no less than from
///   the mean of that to the highest point, but for what the ground around rises across the cell.
///   What hangs higher does not count, unless no ground was seen in the cell and those next to it
///   and something stands beside: then it is taken for the upper part of that. Obstacles are as
///   likely as the cluster of the cell, or as one of as many points.
/// * Holes have no part in the ground; their cells have the surface of the rim around them.
/// * Doubt: two standard errors of the mean height of the cell's ground.
/// * Ground: kOccluded where a cell has points, but none that a wheel can rest on.
///
/// Without points, cells that hold ground and other things are taken as level ground at their
/// `FieldCells::floor`, and what is above it as one piece from the lowest to the highest point.
/// `CellCosts::unseen` is left empty: `explain_unseen_cells` fills it in. The same input gives the
/// same bytes; results that keep their memory do not allocate.
void compute_cell_costs(const Description& description, const DescribedPoints& scan,
                        const RobotParams& robot, CostWorkspace& workspace, CellCosts& costs);

/// The scan that `describe` has just described with a workspace.
[[nodiscard]] DescribedPoints described_points(const PointsView& points,
                                               const DescriptionWorkspace& workspace);

}  // namespace mrpt_terrain
