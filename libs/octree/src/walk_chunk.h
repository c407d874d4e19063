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
/// Most steps between two looks at what the lanes have left behind.
inline constexpr std::size_t kChunk = 64;

/// State of the rays; what the arrays mean is said at `RayBatch`.
struct Lanes {
  alignas(64) double crossing[3][kLanes];
  alignas(64) double spacing[3][kLanes];
  alignas(64) double length[kLanes];
  alignas(64) CellCode step[3][kLanes];
  alignas(64) CellCode cell[kLanes];
  alignas(64) CellCode last[kLanes];
  alignas(64) std::uint64_t word[kLanes];  ///< bits of the cells so far in the word of `cell`
  std::uint16_t alive;                     ///< a bit per lane: it has not arrived yet
  /// Steps after which all lanes are alive, unless one leaves its length before.
  std::uint32_t surely_alive = 0;
};

/// Words of 4^3 cells that lanes have left, in no particular order. Cells of a lane that follow
/// each other in one word are collected, which leaves a quarter of them to be looked up.
struct Marks {
  std::size_t size = 0;
  // Whole registers are written at the end, only the first lanes of which count.
  CellCode cell[kChunk * kLanes + 8];  ///< one of the word's cells
  std::uint64_t word[kChunk * kLanes + 8];
};

/// Walks until no lane is alive, `kChunk` steps at most; `marks` gets the words that lanes leave on
/// the way or arrive in. What lanes hold that have arrived means nothing.
using ChunkWalker = void (*)(Lanes&, Marks& marks);

/// Joins marks that follow each other and are of the same word, but not always all of a run: rays
/// of neighbouring beams enter most words together.
using MarkJoiner = void (*)(Marks& marks);

/// Versions that this processor can run, the faster first; the last runs everywhere.
[[nodiscard]] const std::array<MarkJoiner, 2>& mark_joiners();

/// Versions that this processor can run, the fastest first; the last runs everywhere.
template <Ties kTies>
[[nodiscard]] const std::array<ChunkWalker, 3>& chunk_walkers();

}  // namespace mrpt_terrain::octree
