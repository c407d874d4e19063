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
  double max_height = 0.0;  ///< heights there or above are not read, window frame, metres

  [[nodiscard]] MapCell map_cell_of(CellIndex cell) const {
    return {first.i + cell.l, first.j + cell.w};
  }
};

/// Frame of the window of `params.length` x `params.width` around a robot.
/// \param params its `cell_size` is ignored: that of the map counts
/// \param robot position of the robot in the map, z on its ground, metres; within the lattice
[[nodiscard]] WindowFrame window_around(const MapLattice& lattice, const GridParams& params,
                                        const Eigen::Vector3d& robot);

/// What else is known of the cells of a window; one entry per slot.
struct WindowCells {
  std::vector<float> height;      ///< robust height of the ground, window frame, metres
  std::vector<float> variance;    ///< of the points about it, m^2
  std::vector<double> last_seen;  ///< stamp, seconds
  std::vector<float> clearance;  ///< from the ground to the lowest overhang, metres; 0: no overhang
};

/// Reads the window's cells as the stages of a description take them: slots, sorted row by row, of
/// the observed ones, heights and sums in the frame of the window. Layers that begin at or above
/// `frame.max_height` and what hangs over are left out; extremes are cut as `FusedCell::low` and
/// `high`. Cost: the cells of the window.
/// \param[in,out] grid overwritten; keeps its memory
/// \param[in,out] cells overwritten; keeps its memory
void read_window(const FusedSnapshot& map, const WindowFrame& frame, const FusionParams& params,
                 ElevationGrid& grid, WindowCells& cells);

}  // namespace mrpt_terrain
