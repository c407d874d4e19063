// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/scan_record.h"

namespace mrpt_terrain::view {
namespace {

template <class Enum>
std::size_t index_of(Enum value) {
  return static_cast<std::size_t>(value);
}

}  // namespace

DescriptionCounts count(const Description& description) {
  DescriptionCounts counts;
  counts.points = description.labels.support.size();
  for (const Support support : description.labels.support) ++counts.per_support[index_of(support)];
  for (const UnknownReason reason : description.labels.reason) {
    ++counts.per_reason[index_of(reason)];
  }
  counts.observed_cells = description.grid.observed();
  for (const GroundRule rule : description.ground.rule) {
    ++(rule == GroundRule::kGround ? counts.ground_cells : counts.non_ground_cells);
  }
  for (const auto& thing : description.things) ++counts.clusters[index_of(thing.terrain_class)];
  counts.dropped_groups = description.clusters.dropped;
  return counts;
}

}  // namespace mrpt_terrain::view
