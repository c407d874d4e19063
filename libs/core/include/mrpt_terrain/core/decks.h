// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What counts as a deck: a raised surface that a wheel can get onto and rest on, such as a ramp, a
/// curb or a terrace.
struct DeckParams {
  double thickness = 0.14;  ///< metres: greatest extent in height of its points within a cell
  double max_slope = 0.5585053606381855;  ///< 32 deg, radians
  double side = 0.025;        ///< metres: points this far below a level deck are of its side
  double unevenness = 0.012;  ///< metres: greatest RMS bend between three cells
  double foot = 0.25;         ///< metres: a ramp begins below this height above the ground
  double least_rise = 0.1;    ///< metres: and rises by this much
  double bent = 0.1;          ///< RMS of its heights about a plane, over its rise, is at most this
  double curb_height = 0.25;  ///< metres: lower decks may be stepped onto...
  double curb_length = 2.6;   ///< metres: ...if they are at least this long
  double terrace_height = 0.5;  ///< metres: lower decks may be got onto somewhere...
  double terrace_area = 12.0;   ///< m^2: ...if they are at least this large

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.thickness, ParamInfo{"thickness", "", "m", 0.001, 5.0,
                                    "greatest extent in height of a deck's points in a cell"});
    visit(self.max_slope,
          ParamInfo{"max_slope_deg", "", "deg", 0.0, 80.0, "steepest deck that can be driven on"});
    visit(self.side, ParamInfo{"side", "", "m", 0.001, 1.0,
                               "points this far below a level deck are of its side"});
    visit(self.unevenness,
          ParamInfo{"unevenness", "", "m", 0.001, 1.0, "greatest RMS bend between three cells"});
    visit(self.foot,
          ParamInfo{"foot", "", "m", 0.0, 5.0, "a ramp begins below this height above the ground"});
    visit(self.least_rise,
          ParamInfo{"least_rise", "", "m", 0.0, 5.0, "and rises by this much at least"});
    visit(self.bent, ParamInfo{"bent", "", "", 0.0, 10.0,
                               "greatest RMS of its heights about a plane, over its rise"});
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

/// Scratch memory of `find_decks`.
struct DeckWorkspace {
  std::vector<std::uint8_t> candidate;  ///< per slot
  std::vector<std::int32_t> number;     ///< per slot: of its deck, or -1
  std::vector<std::int32_t> members;    ///< slots of one deck
};

/// Looks for raised surfaces that can be driven on: cells whose points above the ground are one
/// thin layer, connected without steps, even, and within reach of a wheel.
/// \param ground cells with rule kHigh may be decks
/// \param[in,out] cells `deck` is filled in: number of the deck, or -1; and `deck_low`
void find_decks(const ElevationGrid& grid, const GroundSegmentation& ground,
                const DeckParams& params, DeckWorkspace& workspace, FieldCells& cells);

}  // namespace mrpt_terrain
