// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cluster_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace mrpt_terrain::view {

std::vector<std::size_t> largest_clusters(const Description& description, std::size_t at_most) {
  std::vector<std::size_t> order(description.things.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto shown = std::min(at_most, order.size());
  const auto before = [&](std::size_t a, std::size_t b) {
    return std::make_tuple(-description.things[a].cells, a) <
           std::make_tuple(-description.things[b].cells, b);
  };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    before);
  order.resize(shown);
  return order;
}

std::int32_t cluster_of(const Description& description, const HoleDescription& hole) {
  const auto& clusters = description.clusters.cluster_of;
  const bool known = hole.slot >= 0 && static_cast<std::size_t>(hole.slot) < clusters.size();
  return known ? clusters[static_cast<std::size_t>(hole.slot)] : kNoCluster;
}

}  // namespace mrpt_terrain::view
