// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace mrpt_terrain::bench {

/// Calls of any `operator new` of this program so far.
[[nodiscard]] std::size_t allocations();

}  // namespace mrpt_terrain::bench
