// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/holes.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What counts as a ditch or drop where rings miss the ground.
struct GapParams {
  double least_depth = 0.08;  ///< metres: of what is seen in a ditch below the ground before it
  double drop_depth = 0.3;    ///< metres: by which the ground behind an edge lies lower
  double widest = 8.0;        ///< metres: from the ground before a ditch to that behind it
  double least_width = 0.5;   ///< metres across the beams
  double least_fall = 0.08;   ///< of the beams that are looked at, metres per metre
  int missing = 3;            ///< rings that must be missing where nothing comes back

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.least_depth,
          ParamInfo{"least_depth", "", "m", 0.01, 10.0,
                    "least depth of what is seen in a ditch below the ground before it"});
    visit(self.drop_depth, ParamInfo{"drop_depth", "", "m", 0.01, 10.0,
                                     "least depth by which the ground behind an edge lies lower"});
    visit(self.widest, ParamInfo{"widest", "", "m", 0.2, 100.0,
                                 "greatest distance of the ground on both sides of a ditch"});
    visit(self.least_width,
          ParamInfo{"least_width", "", "m", 0.0, 100.0, "least extent across the beams"});
    visit(self.least_fall, ParamInfo{"least_fall", "", "m/m", 0.001, 1.0,
                                     "flatter beams are not looked at: rings are too far apart"});
    visit(self.missing,
          ParamInfo{"missing", "", "", 1, 1000,
                    "rings that must be missing where nothing comes back from behind an edge"});
  }
};

/// What one direction says of a gap in the ground. Ranges are horizontal, from the sensor, metres.
struct GapEvent {
  std::int32_t ray;
  HoleKind kind;
  float near;       ///< of the last ground before it
  float begin;      ///< where the beams behind cross the level of that ground: it is missing there
  float far;        ///< of the last that is seen in it
  float depth;      ///< below the ground before it, metres: a lower bound, 0 if nothing came back
  float tolerance;  ///< metres: what the depth had to exceed; of missing beams: fall to the ground
  float fall;       ///< of the last of the missing beams, where nothing came back
  std::int32_t group;
};

/// A direction in which one looks. Falls are those of beams, metres per metre, downwards.
struct GapRay {
  float x = 0.0F, y = 0.0F;           ///< direction
  float slope = 0.0F;                 ///< of the plane near the robot
  float nearest_thing = 0.0F;         ///< range, metres
  float steepest = 0.0F;              ///< fall of the first beam that came back; 0: none
  float flattest = 0.0F;              ///< fall of the last beam that came back from ground
  double squares = 0.0, cells = 0.0;  ///< of slopes of the ground off `slope`; their number
};

/// An observed cell in a ditch, and the event that says so.
struct GapLow {
  std::int32_t slot;
  std::int32_t event;
};

/// Scratch memory of `find_gaps`.
struct GapWorkspace {
  std::vector<GapRay> rays;
  std::vector<float> values;        ///< for medians
  std::vector<GapEvent> events;     ///< ray by ray
  std::vector<GapLow> low;          ///< event by event
  std::vector<std::int32_t> order;  ///< events by group
};

/// Looks for ditches and drops where the ground itself is not seen.
///
/// In each of 360 directions, one follows what is seen from the sensor outwards. The ground before
/// a place, as a line, tells where the next ring meets the ground if that goes on. A ring that
/// comes down farther away, lower than the line goes on, has passed over ground that is not there:
/// that is the gap longer than the spacing of rings. If ground of the old height is met again
/// within `widest`, it is a ditch. If not, and if the ground behind, followed back, does not meet
/// the ground before, it is a drop; hills do meet. Where nothing comes back at all, and no thing
/// stands there, it is a drop if at least `missing` rings are expected; their spacing is told from
/// the last ones before, so that no sensor has to be known. Things that stand between cast shadows:
/// no gap is seen across them. Nearer than the nearest ring there is no ground to start from, so
/// that the rim of the blind spot is no edge.
/// \param input origins may be unknown: the sensor is then taken to be 1 m above the robot
/// \param[in,out] ground cells seen in ditches become `GroundRule::kLow`
/// \param[in,out] holes and their cells, as in `Description`: those found are appended
void find_gaps(const HoleInput& input, const FieldCells& cells, const GapParams& params,
               GapWorkspace& workspace, GroundSegmentation& ground,
               std::vector<HoleDescription>& holes, IndexRows& hole_cells);

}  // namespace mrpt_terrain
