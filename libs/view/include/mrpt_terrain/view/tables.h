// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain::view {

/// The clusters of a scan as a table for the terminal: aligned columns, one line per cluster, the
/// largest (by cells) first, at most `limit`, then a line that says how many more there are. All
/// lines end in a newline. A feature that was not needed is "-"; one that failed is named with its
/// reason in the last column.
[[nodiscard]] std::string cluster_table(const Description& description, std::size_t limit = 20);

/// The holes of a scan as such a table, in their order, at most `limit`: number, cluster ("-" if it
/// is in none), place, size, depth below the rim (as far as it was seen), points and rings on the
/// floor, confidence. Empty without holes.
[[nodiscard]] std::string hole_table(const Description& description, std::size_t limit = 20);

/// One line without newline: "12 clusters: 7 obstacle, 2 slope, 1 pothole, 2 other; 31 groups too
/// small".
[[nodiscard]] std::string class_summary(const Description& description);

}  // namespace mrpt_terrain::view
