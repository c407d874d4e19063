// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/cell_bits.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/height_sums.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/scan_view.h"

namespace mrpt_terrain {

/// What counts as a deck: a raised surface that a wheel can get onto and rest on, such as a ramp, a
/// curb or a terrace.
struct DeckParams {
  double thickness = 0.14;  ///< metres: greatest extent in height of its points within a cell
  double max_slope = 0.5585053606381855;  ///< 32 deg, radians
  double side = 0.025;           ///< metres: points this far below a level deck are of its side
  double unevenness = 0.008;     ///< metres: median RMS of the heights of nine cells about a plane
  double beam_sigma = 0.035;     ///< metres along the beam...
  double surface_sigma = 0.002;  ///< ...and across the surface: scatter of points on it
  double foot = 0.25;            ///< metres: a ramp begins below this height above the ground
  double least_rise = 0.1;       ///< metres: and rises by this much
  double curb_height = 0.25;     ///< metres: lower decks may be stepped onto...
  double curb_length = 2.6;      ///< metres: ...if they are at least this long
  double terrace_height = 0.5;   ///< metres: lower decks may be got onto somewhere...
  double terrace_area = 12.0;    ///< m^2: ...if they are at least this large

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.thickness, ParamInfo{"thickness", "", "m", 0.001, 5.0,
                                    "greatest extent in height of a deck's points in a cell"});
    visit(self.max_slope,
          ParamInfo{"max_slope_deg", "", "deg", 0.0, 80.0, "steepest deck that can be driven on"});
    visit(self.side, ParamInfo{"side", "", "m", 0.001, 1.0,
                               "points this far below a level deck are of its side"});
    visit(self.unevenness, ParamInfo{"unevenness", "", "m", 0.001, 1.0,
                                     "greatest RMS of the heights of nine cells about a plane"});
    visit(self.beam_sigma, ParamInfo{"beam_sigma", "", "m", 0.001, 1.0,
                                     "greatest scatter of points of a deck along the beams"});
    visit(self.surface_sigma, ParamInfo{"surface_sigma", "", "m", 0.001, 1.0,
                                        "and across its surface; the squares of both add up"});
    visit(self.foot,
          ParamInfo{"foot", "", "m", 0.0, 5.0, "a ramp begins below this height above the ground"});
    visit(self.least_rise,
          ParamInfo{"least_rise", "", "m", 0.0, 5.0, "and rises by this much at least"});
    visit(self.curb_height,
          ParamInfo{"curb_height", "", "m", 0.0, 5.0, "lower decks can be stepped onto"});
    visit(self.curb_length,
          ParamInfo{"curb_length", "", "m", 0.0, 100.0, "if they are at least this long"});
    visit(self.terrace_height,
          ParamInfo{"terrace_height", "", "m", 0.0, 5.0, "lower decks can be got onto somewhere"});
    visit(self.terrace_area,
          ParamInfo{"terrace_area", "", "m^2", 0.0, 10000.0, "if they are at least this large"});
  }
};

/// Points of a cell: how many, their mean place, and how far that is above the ground.
struct DeckLayer {
  float points = 0.0F;
  float x = 0.0F, y = 0.0F, z = 0.0F;
  float above = 0.0F;

  void add(float px, float py, float pz, float height) {
    points += 1.0F;
    x += px;
    y += py;
    z += pz;
    above += height;
  }
  /// From sums to means.
  void finish() {
    const float share = 1.0F / (points > 0.0F ? points : 1.0F);
    x *= share;
    y *= share;
    z *= share;
    above *= share;
  }
};

/// A point that is, or may be, of the side of a deck, metres.
struct DeckSidePoint {
  std::int32_t deck = -1;   ///< or a part of the ground, where sides are looked for in that
  std::int32_t point = -1;  ///< its number in the scan
  float x = 0.0F, y = 0.0F, z = 0.0F;
};

/// Scratch memory for bringing such points together by deck.
struct DeckSideBuckets {
  std::vector<DeckSidePoint> points;
  std::vector<std::int32_t> end;  ///< per deck
};

/// An upright side of a deck, seen from above: a stretch of a line, metres.
struct DeckSide {
  std::int32_t deck = -1;
  float x = 0.0F, y = 0.0F;              ///< its middle
  float along_x = 1.0F, along_y = 0.0F;  ///< its direction, a unit vector
  float half_length = 0.0F;

  [[nodiscard]] float along(float px, float py) const {
    return along_x * (px - x) + along_y * (py - y);
  }
  [[nodiscard]] float across(float px, float py) const {
    return along_x * (py - y) - along_y * (px - x);
  }
};

/// Points of a cell of a deck, and those deep below its surface.
struct DeckCellDepth {
  std::int32_t points = 0, deep = 0;
};

/// Cells of a deck that are away from its edges, and those that beams enter.
struct DeckDepth {
  std::int32_t cells = 0, entered = 0;
};

/// Scratch memory of `find_decks` and of the labels of sides.
struct DeckWorkspace {
  CellBits candidate_cells;             ///< the cells of those slots that are `candidate`
  CellBits member_cells;                ///< the cells of `members`, while they are looked at
  std::vector<std::uint8_t> candidate;  ///< per slot
  std::vector<std::int32_t> points;     ///< above the ground in candidate slots
  std::vector<DeckLayer> all, top;      ///< per candidate slot: its points, and the highest
  std::vector<std::int32_t> members;    ///< slots of one deck
  std::vector<DeckPlane> planes;        ///< per member: the surface there
  std::vector<float> bends, slopes;     ///< of the planes
  std::vector<HeightSums> sums;         ///< per slot: points on the surface
  std::vector<HeightSums> remembered;   ///< the same, of remembered points; empty if there are none
  std::vector<DeckCellDepth> depth;     ///< per slot, 0 where there is no deck
  std::vector<DeckDepth> depth_of_deck;                 ///< per deck
  std::vector<std::pair<std::int32_t, float>> scatter;  ///< per cell of a deck: deck, scatter
  std::vector<std::int32_t> deck_number;                ///< per deck: number of those kept, or -1
  std::vector<std::uint64_t> side;      ///< per slot: parts of the cell with points of a side
  std::vector<std::int32_t> on_deck;    ///< points on a deck or near its edge
  std::vector<std::int32_t> low_side;   ///< points below a deck's surface that are ground so far
  std::vector<std::int32_t> deck_cell;  ///< per slot: itself or the cell of a deck beside, or -1
  std::vector<DeckSidePoint> side_points, surface_points;  ///< below a surface, and on one
  DeckSideBuckets side_buckets;
  std::vector<DeckSide> sides;
};

/// Looks for raised surfaces that can be driven on: cells whose points above the ground are one
/// thin layer, connected without steps, even, and within reach of a wheel.
/// \param scan points and origins of their beams, which tell noise from roughness; where they are
/// unknown, the sensor is taken to be 1 m above the robot
/// \param points,point_slots of the same scan, of `find_field_ground` and `build_elevation_grid`
/// \param ground cells with rule kHigh may be decks
/// \param[in,out] cells `deck` is filled in: number of the deck, or -1; and `deck_plane`
void find_decks(const ScanView& scan, const FieldPoints& points, const PointSlots& point_slots,
                const ElevationGrid& grid, const GroundSegmentation& ground,
                const DeckParams& params, DeckWorkspace& workspace, FieldCells& cells);

/// Makes the points on decks ground: those that lie up to `side` below or above the surface, but
/// for those of the deck's sides. These have points further below the surface as near as that
/// beside them, or lie on the line of a side seen from above (deck_sides.h); points of the ground
/// on such a line, well above its foot, are above.
///
/// \param[in,out] support of the points, in the order of the scan
void label_deck_points(const PointsView& scan, const FieldPoints& points,
                       const PointSlots& point_slots, const ElevationGrid& grid,
                       const FieldCells& cells, const DeckParams& params, DeckWorkspace& workspace,
                       std::vector<Support>& support);

}  // namespace mrpt_terrain
