// SPDX-License-Identifier: BSD-3-Clause
#include "ray_set.h"

namespace mrpt_terrain::octree {

void RaySet::reset(std::size_t rays) {
  std::size_t places = 16;
  while (places < 2 * rays) places *= 2;
  table_.assign(places, Entry{});
}

bool RaySet::insert(std::uint32_t origin, CellCode end) {
  const std::uint64_t mixed = (end + origin * 0xd1b54a32d192ed03U) * 0x9e3779b97f4a7c15U;
  std::size_t place = static_cast<std::size_t>(mixed >> 32) & (table_.size() - 1);
  while (table_[place].end != kEmpty) {
    if (table_[place].end == end && table_[place].origin == origin) return false;
    place = (place + 1) & (table_.size() - 1);
  }
  table_[place] = {end, origin};
  return true;
}

}  // namespace mrpt_terrain::octree
