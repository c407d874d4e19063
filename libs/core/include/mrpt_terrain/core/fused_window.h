// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/grid_geometry.h"

namespace mrpt_terrain {

/// Where the frame of a window lies in the map: parallel to the map's axes, its origin at the
/// robot up to half a cell (so that the cells of window and map coincide), z = 0 at the robot's
/// ground.
struct WindowFrame {
  GridGeometry geometry;  ///< of the window, in its own frame
  MapCell first;          ///< cell of the map that is cell (0, 0) of the window
  double x = 0.0;         ///< origin of the window in the map, metres
  double y = 0.0;
  double z = 0.0;

  [[nodiscard]] MapCell map_cell_of(CellIndex cell) const {
    return {first.i + cell.l, first.j + cell.w};
  }
};

/// Frame of the window of `params.length` x `params.width` around a robot.
/// \param params its `cell_size` is ignored: that of the map counts
/// \param robot position of the robot in the map, z on its ground, metres; within the lattice
[[nodiscard]] WindowFrame window_around(const MapLattice& lattice, const GridParams& params,
                                        const Eigen::Vector3d& robot);

/// The cells of a window as the stages of a description take them, with what else is known of each.
struct WindowCells {
  ElevationGrid grid;             ///< heights and sums in the frame of the window
  std::vector<float> height;      ///< per slot: robust height of the ground, window frame, metres
  std::vector<float> variance;    ///< per slot: of the points about it, m^2
  std::vector<double> last_seen;  ///< per slot: stamp, seconds
  std::vector<float> clearance;   ///< per slot: height of the lowest overhang over the ground,
                                  ///< metres; 0 if nothing hangs over
};

/// Reads the window's cells: slots, sorted row by row, of the observed ones. Heights at or above
/// `params.max_height` (window frame) and what hangs over are left out; extremes are cut as
/// `FusedCell::low` and `high`. Cost: the cells of the window.
/// \param[in,out] cells overwritten; keeps its memory
void read_window(const FusedSnapshot& map, const WindowFrame& frame, const GridParams& params,
                 const FusionParams& fusion, WindowCells& cells);

}  // namespace mrpt_terrain
