// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// One scan as `describe` takes it: its points, and where their beams started if that is known.
struct ScanView {
  PointsView points;
  BeamOrigins origins;

  // NOLINTNEXTLINE(google-explicit-constructor): points alone are a scan of unknown origin.
  ScanView(const PointsView& points_of_scan, const BeamOrigins& origins_of_beams = {})
      : points(points_of_scan), origins(origins_of_beams) {}
};

}  // namespace mrpt_terrain
