// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "walk_rays.h"

/// \file
/// The inner loop of the walk, for several processors. All versions give the same bits.
namespace mrpt_terrain::octree {

/// Rays walk side by side, a lane each.
inline constexpr std::size_t kLanes = 16;
/// Steps between two looks at which lanes have arrived.
inline constexpr std::size_t kChunk = 32;

/// State of the rays; what the arrays mean is said at `RayBatch`.
struct Lanes {
  alignas(64) double crossing[3][kLanes];
  alignas(64) double spacing[3][kLanes];
  alignas(64) double length[kLanes];
  alignas(64) CellCode step[3][kLanes];
  alignas(64) CellCode cell[kLanes];
  alignas(64) CellCode last[kLanes];
  std::uint16_t alive;  ///< a bit per lane: it has not arrived yet
};

/// Where the lanes went in one chunk. Cells of a lane that follow each other in one word of 4^3
/// cells are collected, which leaves a quarter of them to be looked up.
struct Trail {
  alignas(64) CellCode cell[kChunk][kLanes];
  alignas(64) std::uint64_t word[kChunk][kLanes];  ///< bits of the word's cells so far
  std::uint32_t complete[kLanes];  ///< per lane, a bit per step: the last one in its word
};

using ChunkWalker = void (*)(Lanes&, Trail&);

/// Versions that this processor can run, the fastest first; the last runs everywhere.
template <Ties kTies>
[[nodiscard]] const std::array<ChunkWalker, 3>& chunk_walkers();

}  // namespace mrpt_terrain::octree
