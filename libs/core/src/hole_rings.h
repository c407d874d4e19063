// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/holes.h"

namespace mrpt_terrain {

/// What the rings of the sensor say about a hole.
struct RingEvidence {
  int rings = 0;     ///< with at least two points of the floor between walls
  int walled = 0;    ///< points of the floor in traces between walls
  int strictly = 0;  ///< of these, in traces of which both ends are seen
  int traces = 0;    ///< over the floor, between walls
  /// Of rings that run along walls at both ends, not more than 0.3 m: not in the numbers above.
  int oblique = 0, oblique_traces = 0, oblique_rings = 0;
  double noise = 0.0;  ///< standard deviation of heights between neighbours on a ring, metres
};

/// Follows the rings over a hole. A ring is found again by the elevation of its beams, which
/// changes slowly with the azimuth. The trace of a ring over the floor ends at a wall where the
/// ring is back on the rim after a few steps; on the gradual sides of a dip, many points lie
/// between. Horizontal distances do not tell this: beyond a wall the beam goes on to the floor.
/// \param points with their depths; those of the zone kFar are towards the sensor, where the rings
/// are on the rim
/// \param origins known
/// \param depth of the hole, metres
[[nodiscard]] RingEvidence follow_rings(const std::vector<HolePoint>& points,
                                        const BeamOrigins& origins, double depth,
                                        HoleWorkspace& workspace);

/// Takes traces between oblique walls as traces between walls. Dips of rolling ground have such
/// traces, too; so another trace has to show that there are walls.
void count_oblique(RingEvidence& rings);

}  // namespace mrpt_terrain
