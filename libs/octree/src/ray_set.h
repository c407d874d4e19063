// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cell_code.h"

namespace mrpt_terrain::octree {

/// Set of rays, each given by the number of its origin and the cell in which it ends.
class RaySet {
 public:
  /// Forgets all rays and makes room for `rays` of them.
  void reset(std::size_t rays);

  /// Adds a ray; false if it is in the set already.
  [[nodiscard]] bool insert(std::uint32_t origin, CellCode end);

 private:
  struct Entry {
    CellCode end = kEmpty;
    std::uint32_t origin = 0;
  };
  static constexpr CellCode kEmpty = ~CellCode{0};
  std::vector<Entry> table_;  // a power of two of places, at most half of them taken
};

}  // namespace mrpt_terrain::octree
