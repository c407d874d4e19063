// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain::view {

/// Numbers of the clusters with the most cells, largest first; of equal ones the lower number
/// first. Tables, pictures and scenes show these when they cannot show all.
/// \param at_most length of the result if there are that many clusters
[[nodiscard]] std::vector<std::size_t> largest_clusters(const Description& description,
                                                        std::size_t at_most);

/// Number of the cluster that a hole is part of, or kNoCluster.
[[nodiscard]] std::int32_t cluster_of(const Description& description, const HoleDescription& hole);

}  // namespace mrpt_terrain::view
