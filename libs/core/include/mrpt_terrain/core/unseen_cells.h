// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/unseen_reason.h"

namespace mrpt_terrain {

/// A thing in a sector as the sensor sees it.
struct SectorThing {
  float range;  ///< horizontal, metres
  float top;    ///< tangent of the elevation of its highest point, or of one before it
};

/// Direction and distance of a place from the sensor.
struct SectorPlace {
  int sector = -1;     ///< of half a degree; -1: none
  float range = 0.0F;  ///< horizontal, metres
};

/// Scratch memory of `explain_unseen_cells`.
struct UnseenWorkspace {
  std::vector<SectorPlace> places;  ///< per point
  // Of the cells, as long as they and the sensor stay the same:
  GridGeometry geometry;
  std::array<float, 3> origin{};
  std::vector<SectorPlace> cells;   ///< cell l * cells_w + w
  std::vector<float> lowest;        ///< per sector: tangent of the lowest beam with a return
  std::vector<std::int32_t> first;  ///< per sector, and one more: its things
  std::vector<std::int32_t> count;  ///< per sector
  std::vector<SectorThing> things;  ///< by sector, then by range
};

/// Tells for every cell of a description of field mode why nothing is known of its ground. The
/// field of view is told from the scan: a sector of half a degree reaches down to the lowest beam
/// that came back within ten degrees; without any, it is out of view. Things that begin within 0.5
/// m of the ground cast shadows as high as their tops.
/// \param scan where the origins of its beams are unknown, cells that are not seen are kNoReturn;
/// the first one stands for all
/// \param reference the workspace with which `describe` has described the scan
/// \param[out] reasons per `CellId` of the description's grid, frame included (kNoReturn there)
void explain_unseen_cells(const ScanView& scan, const DescriptionWorkspace& reference,
                          const Description& description, UnseenWorkspace& workspace,
                          std::vector<UnseenReason>& reasons);

}  // namespace mrpt_terrain
