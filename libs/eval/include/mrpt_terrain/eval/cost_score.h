// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/scan_truth.h"
#include "mrpt_terrain/eval/support_score.h"
#include "mrpt_terrain/sim/truth.h"

/// \file
/// Costs of cells against what is true of them.
namespace mrpt_terrain::eval {

/// What truth says a cell is to a robot.
enum class TrueCell : std::uint8_t {
  kNotCounted = 0,  ///< between the others, or something moves there
  kTraversable,     ///< ground, even to half of the robot's limits
  kObstacle,        ///< something stands in it that is higher than the robot takes
  kHole,            ///< in a hole into which a wheel falls by more than the robot takes
  kEdge,            ///< at a step of the ground higher than the robot takes
  kSteep,           ///< steeper than the smaller of the robot's limits
};
constexpr EnumNames<TrueCell, 6> enum_names(TrueCell) {
  return {{{TrueCell::kNotCounted, "not_counted"},
           {TrueCell::kTraversable, "traversable"},
           {TrueCell::kObstacle, "obstacle"},
           {TrueCell::kHole, "hole"},
           {TrueCell::kEdge, "edge"},
           {TrueCell::kSteep, "steep"}}};
}
inline constexpr std::size_t kTrueCellCount = 6;

/// How costs are judged.
struct CostRules {
  RobotParams robot;
  double radius = 15.0;  ///< metres: cells up to so far in x and y count
};

/// Observed cells, each scan apart. Beside: in the cell or the eight around it.
struct CostScore {
  Share blocked;       ///< traversable cells: lethal
  Share blocked_free;  ///< of these with nothing but traversable ones beside: lethal
  // Per kind of truly lethal cells:
  std::array<Share, kTrueCellCount> open;      ///< not lethal
  std::array<Share, kTrueCellCount> unknown;   ///< cost unknown; not lethal either
  std::array<Share, kTrueCellCount> all_open;  ///< not lethal, nor is anything beside
  void add(const CostScore& other);
};

/// A square of cells about the origin that reaches to `radius`, with the cells of a larger grid.
[[nodiscard]] GridGeometry middle_of(const GridGeometry& grid, double radius);

/// Kinds of the cells of `truth`; cell l * cells_w + w. Heights are those of `truth_of_cells` with
/// the robot's height as overhang.
/// \param holes things with a depth; footprints in the map frame
/// \param T_map_grid of `truth`
[[nodiscard]] std::vector<TrueCell> true_cells(const sim::CellTruth& truth,
                                               const std::vector<TrueThing>& holes,
                                               const Eigen::Isometry3d& T_map_grid,
                                               const RobotParams& robot);

/// Compares the costs for the worst heading with the kinds of the cells in the middle of the grid.
void add_costs(const ElevationGrid& grid, const CellCosts& costs, const GridGeometry& middle,
               const std::vector<TrueCell>& kinds, const RobotParams& robot, CostScore& score);

/// Measures the costs of a description of a scan.
using MeasureCosts =
    std::function<void(const ScanView& scan, const Description& description, CellCosts& costs)>;

}  // namespace mrpt_terrain::eval
