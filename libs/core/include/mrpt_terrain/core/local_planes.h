// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/feature_status.h"

namespace mrpt_terrain {

/// Greatest reach of a window, cells: 7 x 7 cells.
inline constexpr int kMaxReach = 3;

/// Length of the steepest gradient that is told, 84 deg: steeper planes are walls, and no heights
/// over x and y.
inline constexpr double kSteepestGradient = 10.0;

/// Plane of total least squares through all points of a window of cells:
/// height(px, py) = z + gradient_x * (px - x) + gradient_y * (py - y).
struct LocalPlane {
  double x = 0.0, y = 0.0, z = 0.0;  ///< mean of the points, metres
  float gradient_x = 0.0F;           ///< rise per metre along x
  float gradient_y = 0.0F;           ///< rise per metre along y
  float roughness = 0.0F;  ///< standard deviation of the points across the plane (sqrt of the
                           ///< smallest eigenvalue of their covariance), metres
  std::int32_t cells = 0;  ///< observed cells of the window; valid with every status
  /// kOk, kTooFewPoints (too few cells observed) or kDegenerate (the points are on a line)
  FeatureStatus status = FeatureStatus::kTooFewPoints;

  [[nodiscard]] double height_at(double px, double py) const {
    return z + gradient_x * (px - x) + gradient_y * (py - y);
  }
};

/// Fits a plane to the points of the window of (2 reach + 1)^2 cells about every observed cell;
/// windows end at the edges of the grid. A plane needs 2 reach + 1 observed cells (more than one
/// row), and points whose spread across their longest direction is at least a quarter (in variance)
/// of that of a full window.
///
/// The cost is proportional to the observed cells times (2 reach + 1). The same grid gives the same
/// bytes.
/// \param reach cells to each side, 1 to kMaxReach
/// \param[out] planes one per slot; keeps its memory
void fit_local_planes(const ElevationGrid& grid, int reach, std::vector<LocalPlane>& planes);

/// Other points in the cells of a grid, and which cells do without a window. All borrowed.
struct CellSelection {
  const std::vector<MomentSums>& sums;  ///< per slot: of its points, about the frame's origin
  /// Per slot: not 0 where no plane is wanted; null: all are.
  const std::vector<std::uint8_t>* skipped = nullptr;

  [[nodiscard]] bool is_skipped(std::size_t slot) const {
    return skipped != nullptr && (*skipped)[slot] != 0;
  }
};

/// The same with other points. Cells without any count as not observed in the windows of others.
/// \param[out] planes kTooFewPoints with no cells where skipped
void fit_local_planes(const ElevationGrid& grid, const CellSelection& cells, int reach,
                      std::vector<LocalPlane>& planes);

}  // namespace mrpt_terrain
