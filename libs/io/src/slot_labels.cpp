// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/slot_labels.h"

#include <array>
#include <cassert>

#include "mrpt_terrain/io/label_file.h"

namespace mrpt_terrain::io {

std::uint32_t slot_label(Support support, TerrainClass terrain_class) {
  constexpr std::array<std::uint16_t, 4> kOfSupport{0, kGroundLabel, kAboveLabel, kBelowLabel};
  static_assert(enum_names(Support{}).size() == kOfSupport.size());
  return make_label(kOfSupport[static_cast<std::size_t>(support)],
                    static_cast<std::uint16_t>(terrain_class));
}

void label_slots(const Scan& scan, const PointLabels& labels, std::vector<std::uint32_t>& result) {
  assert(labels.support.size() == scan.source_index.size());
  assert(labels.terrain_class.size() == scan.source_index.size());
  result.assign(scan.source_size, 0);
  for (std::size_t k = 0; k < scan.source_index.size(); ++k) {
    assert(scan.source_index[k] < scan.source_size);
    result[scan.source_index[k]] = slot_label(labels.support[k], labels.terrain_class[k]);
  }
}

}  // namespace mrpt_terrain::io
