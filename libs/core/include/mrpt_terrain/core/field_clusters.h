// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/cell_bits.h"
#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// How cells become things.
struct FieldClusterParams {
  int t_c = 2;                 ///< fewest cells of a thing,
  int t_points = 5;            ///< unless it has this many points
  double link = 0.25;          ///< metres: gap between cells of one thing
  double link_growth = 0.012;  ///< and this much more per metre of distance from the robot
  double step = 0.3;           ///< metres: gap in height between cells of one thing
  double flat = 0.2;           ///< metres: cells with more height are linked only if they touch
  double unseen = 1.0;         ///< metres: gap in raised ground where nothing was seen
  double level = 0.05;  ///< metres: by which the two sides of such a gap may differ in height
  double sharp = 0.3;   ///< share of sharp edges of a thing that is ground

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.t_c, ParamInfo{"t_c", "T_c", "", 1, 1000000,
                              "things of fewer cells and fewer than t_points points are dropped"});
    visit(self.t_points, ParamInfo{"t_points", "", "", 1, 1000000,
                                   "things with this many points are kept in any case"});
    visit(self.link,
          ParamInfo{"link", "", "m", 0.0, 10.0, "widest gap between cells of one thing"});
    visit(self.link_growth, ParamInfo{"link_growth", "", "m/m", 0.0, 1.0,
                                      "and this much more per metre of distance from the robot"});
    visit(self.step, ParamInfo{"step", "", "m", 0.0, 10.0,
                               "greatest gap in height between cells of one thing"});
    visit(self.flat, ParamInfo{"flat", "", "m", 0.0, 100.0,
                               "cells whose points extend over more height have to touch"});
    visit(self.unseen,
          ParamInfo{"unseen", "", "m", 0.0, 10.0,
                    "widest gap between cells of raised ground where nothing was seen"});
    visit(self.level, ParamInfo{"level", "", "m", 0.0, 10.0,
                                "by which the heights of two such cells may differ"});
    visit(self.sharp, ParamInfo{"sharp", "", "", 0.0, 1.0,
                                "least share of sharp edges of a thing that is ground"});
  }
};

/// Cells that were brought together: where they lie, and their rectangle along the direction in
/// which they extend most. Places are those of centres of cells, metres, frame of the grid.
struct ThingPiece {
  std::int32_t slot = 0;                 ///< its first cell
  float first_x = 0.0F, first_y = 0.0F;  ///< where that is; sums are taken about it
  float n = 0.0F;                        ///< cells
  float x = 0.0F, y = 0.0F;              ///< mean
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;
  float ground = 0.0F;                ///< mean height of the ground reference
  float top = 0.0F;                   ///< mean over the cells of their highest points above it
  float low = 1e9F, high = -1e9F;     ///< lowest and highest point above it
  float above = 0.0F, raised = 0.0F;  ///< points above the ground, and of raised ground
  float sharp = 0.0F, edges = 0.0F;   ///< sharp edges of its cells, and all (FieldCells)
  bool hangs = false;                 ///< some of it lies flat above ground that is seen
  float along_x = 1.0F, along_y = 0.0F;
  float begin = 1e9F, end = -1e9F, right = 1e9F, left = -1e9F;  ///< of the rectangle, about x, y

  /// Adds a cell to the sums: centre, height of the reference, lowest and highest point above it.
  void add(float px, float py, float reference, float lowest, float highest);
  /// Makes means and the direction of the sums.
  void finish();
  /// Makes the rectangle hold a centre of a cell.
  void extend(float px, float py);
  [[nodiscard]] float along_of(float px, float py) const {
    return (px - x) * along_x + (py - y) * along_y;
  }
  [[nodiscard]] float across_of(float px, float py) const {
    return (py - y) * along_x - (px - x) * along_y;
  }
  [[nodiscard]] bool holds(float px, float py) const {
    const float u = along_of(px, py), v = across_of(px, py);
    return u >= begin && u <= end && v >= right && v <= left;
  }
  [[nodiscard]] Position2 place(float along, float across) const {
    return {static_cast<double>(x + along * along_x - across * along_y),
            static_cast<double>(y + along * along_y + across * along_x)};
  }
};

/// Scratch memory for strips of a piece; arrays over its cells, or over bins along and across them.
struct StripWorkspace {
  std::vector<float> x, y;             ///< centres, metres
  std::vector<float> u, v;             ///< the same along and across a direction
  std::vector<std::int32_t> strip_of;  ///< number of the strip, or -1
  std::vector<std::int32_t> along, across;
  std::vector<std::int32_t> first, next, order, count;
};

/// Scratch memory of `find_field_clusters`.
struct FieldClusterWorkspace {
  CellBits members;                  ///< cells of things so far
  CellBits flat, raised;             ///< of these, what is no upright surface, and raised ground
  std::vector<std::int32_t> parent;  ///< per slot: another slot of the same thing, or itself
  std::vector<std::int32_t> cells_of;
  std::vector<std::int32_t> points_of;
  std::vector<std::int32_t> number_of;
  std::vector<std::int32_t> sharp_of, smooth_of, above_of;
  std::vector<std::uint8_t> stands;  ///< per slot: 1 if a cell of the thing is not level
  std::vector<std::uint8_t> gentle;  ///< per slot: 1 if the thing is a rise of the ground
  std::vector<ThingPiece> pieces;
  std::vector<std::int32_t> posts;                ///< numbers of pieces
  IndexRows piece_cells;                          ///< per piece: its slots, ascending
  std::vector<std::int32_t> part_of;              ///< per slot: part of its piece
  std::vector<std::int32_t> first_of;             ///< first slots of parts
  std::vector<float> tops;                        ///< metres
  std::vector<std::int32_t> border_of, steps_of;  ///< per part: neighbours, and lower ones
  StripWorkspace strips;
};

/// Brings non-ground cells together that are near each other, in the plane and in height. Cells
/// above the ground and cells below it are never one thing. How near is enough grows with distance,
/// as the gaps between rings and between columns of a sensor do. Then pieces of a thing are brought
/// together that are farther apart: what hangs and its legs, and what goes on behind a gap through
/// which no beam has passed.
/// \param sensor where the beams begin, frame of the grid, metres; null: unknown, gaps stay gaps
void find_field_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                         const FieldCells& cells, const FieldClusterParams& params,
                         FieldClusterWorkspace& workspace, Clusters& result,
                         const std::array<float, 3>* sensor = nullptr);

}  // namespace mrpt_terrain
