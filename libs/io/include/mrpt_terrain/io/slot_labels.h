// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/io/scan.h"

namespace mrpt_terrain::io {

/// Classes of SemanticKITTI that stand for the support of a point: road, building, other structure.
inline constexpr std::uint16_t kGroundLabel = 40;
inline constexpr std::uint16_t kAboveLabel = 50;
inline constexpr std::uint16_t kBelowLabel = 52;

/// The label of a point (label_file.h): its support in the low 16 bits, as above and 0 unknown; the
/// value of its TerrainClass in the high 16 bits.
[[nodiscard]] std::uint32_t slot_label(Support support, TerrainClass terrain_class);

/// Labels in the order and number of the observation's own slots (`Scan::source_index`): those of
/// the described points, 0 for the slots that were left out.
/// \param labels of `scan.points`
/// \param[out] result one per slot of the observation
void label_slots(const Scan& scan, const PointLabels& labels, std::vector<std::uint32_t>& result);

}  // namespace mrpt_terrain::io
