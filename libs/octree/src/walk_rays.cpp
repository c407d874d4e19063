// SPDX-License-Identifier: BSD-3-Clause
#include "walk_rays.h"

#include <algorithm>
#include <array>

#include "walk_chunk.h"

namespace mrpt_terrain::octree {
namespace {

template <class Values, class Value>
void load(const Values& from, const std::array<std::uint16_t, kLanes>& rays, Value* to) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) to[lane] = from[rays[lane]];
}

std::uint64_t bit_of(CellCode cell) { return std::uint64_t{1} << (cell & 63); }

std::uint32_t fewest_cells(const RayBatch& batch, const std::array<std::uint16_t, kLanes>& rays) {
  std::uint32_t fewest = batch.cells[rays[0]];
  for (const std::uint16_t ray : rays) fewest = std::min(fewest, batch.cells[ray]);
  return fewest;
}

// Lanes beyond the first `count` stand still.
void load_lanes(const RayBatch& batch, const std::array<std::uint16_t, kLanes>& rays,
                std::size_t count, Lanes& lanes) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    load(batch.crossing[axis], rays, lanes.crossing[axis]);
    load(batch.spacing[axis], rays, lanes.spacing[axis]);
    load(batch.step[axis], rays, lanes.step[axis]);
  }
  load(batch.length, rays, lanes.length);
  load(batch.first, rays, lanes.cell);
  load(batch.last, rays, lanes.last);
  unsigned alive = 0;
  for (std::size_t lane = 0; lane < count; ++lane) {
    if (lanes.cell[lane] != lanes.last[lane]) alive |= 1U << lane;
  }
  // The last cell is this many steps away, however the ray goes.
  if (alive == (1U << kLanes) - 1) lanes.surely_alive = fewest_cells(batch, rays) - 1;
  for (std::size_t lane = 0; lane < kLanes; ++lane) lanes.word[lane] = bit_of(lanes.cell[lane]);
  lanes.alive = static_cast<std::uint16_t>(alive);
}

// Rays that end where they begin do not walk.
void mark_where_they_stand(const Lanes& lanes, std::size_t count, ScanCells& cells) {
  for (std::uint32_t left = ~std::uint32_t{lanes.alive} & ((1U << count) - 1); left != 0;
       left &= left - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
    cells.mark_free(lanes.cell[lane], lanes.word[lane]);
  }
}

void walk_lanes(ChunkWalker walk_chunk, MarkJoiner join_marks, Lanes& lanes, Marks& marks,
                ScanCells& cells) {
  while (lanes.alive != 0) {
    walk_chunk(lanes, marks);
    join_marks(marks);
    for (std::size_t k = 0; k < marks.size; ++k) cells.mark_free(marks.cell[k], marks.word[k]);
  }
}

// Rays in the order of their lengths, so that those side by side arrive together.
void sort_by_cells(const RayBatch& rays, std::array<std::uint16_t, RayBatch::kCapacity>& order) {
  constexpr std::uint32_t kLongest = 511;  // longer rays are few, and take chunks of cells anyway
  std::array<std::uint16_t, kLongest + 2> begin{};
  const auto length_of = [&](std::size_t k) { return std::min(rays.cells[k], kLongest); };
  for (std::size_t k = 0; k < rays.size; ++k) ++begin[length_of(k) + 1];
  for (std::size_t k = 1; k < begin.size(); ++k) {
    begin[k] = static_cast<std::uint16_t>(begin[k] + begin[k - 1]);
  }
  for (std::size_t k = 0; k < rays.size; ++k) {
    order[begin[length_of(k)]++] = static_cast<std::uint16_t>(k);
  }
}

}  // namespace

void walk_rays_by(ChunkWalker walk_chunk, RayBatch& rays, ScanCells& cells) {
  std::array<std::uint16_t, RayBatch::kCapacity> order;
  sort_by_cells(rays, order);
  const MarkJoiner join_marks = mark_joiners()[0];
  Marks marks;
  for (std::size_t begin = 0; begin < rays.size; begin += kLanes) {
    const std::size_t count = std::min(kLanes, rays.size - begin);
    std::array<std::uint16_t, kLanes> group{};
    std::copy_n(order.begin() + static_cast<std::ptrdiff_t>(begin), count, group.begin());
    Lanes lanes;
    load_lanes(rays, group, count, lanes);
    mark_where_they_stand(lanes, count, cells);
    walk_lanes(walk_chunk, join_marks, lanes, marks, cells);
  }
  rays.size = 0;
}

template <Ties kTies>
void walk_rays(RayBatch& rays, ScanCells& cells) {
  walk_rays_by(chunk_walkers<kTies>()[0], rays, cells);
}

template void walk_rays<Ties::kAsOctomap>(RayBatch&, ScanCells&);
template void walk_rays<Ties::kFlipped>(RayBatch&, ScanCells&);

}  // namespace mrpt_terrain::octree
