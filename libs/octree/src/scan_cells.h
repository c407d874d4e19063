// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cell_code.h"

namespace mrpt_terrain::octree {

/// 8^3 cells, a bit each; word w has the w-th octant of 4^3 cells, bits in the order of codes.
struct alignas(64) CellBlock {
  std::uint64_t words[8] = {};
};

/// 64^3 cells as 8^3 blocks, of which only those exist that a ray met.
struct CellTile {
  CellCode code = 0;               ///< of its cells, without the lowest 18 bits
  std::uint64_t present[8] = {};   ///< a bit per block, in the order of codes
  std::uint64_t occupied[8] = {};  ///< blocks in which a ray ends
  std::uint32_t block[512] = {};   ///< number of the block; 0: there is none

  [[nodiscard]] bool is_empty() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : present) any |= word;
    return any == 0;
  }
};

/// The cells that the rays of a scan cross and end in. Memory follows the tiles that were met, not
/// the extent of the scan.
class ScanCells {
 public:
  ScanCells();

  /// Forgets all cells and keeps the memory.
  void clear();

  /// Marks cells of one word as free: the bits of `word`, in the word of cell `code`.
  void mark_free(CellCode code, std::uint64_t word) {
    CellTile& tile = tiles_[number_of(code >> 18)];
    std::uint32_t block = tile.block[code >> 9 & 511];
    if (block == 0) block = add_block(tile, code);
    free_[block].words[code >> 6 & 7] |= word;
  }

  void mark_occupied(CellCode code);

  /// Whether a ray crosses a cell and none ends in it.
  [[nodiscard]] bool is_free(CellCode code) const;
  /// Whether a ray ends in a cell.
  [[nodiscard]] bool is_occupied(CellCode code) const;
  /// Forgets that rays cross a cell, which one does.
  void unmark_free(CellCode code);

  [[nodiscard]] const std::vector<CellTile>& tiles() const { return tiles_; }
  /// Cells that rays cross in a block, by the number that its tile has for it.
  [[nodiscard]] const CellBlock& free(std::uint32_t block) const { return free_[block]; }
  /// Cells that rays end in.
  [[nodiscard]] const CellBlock& occupied(std::uint32_t block) const {
    return occupied_[occupied_of_[block]];
  }

 private:
  // Tiles that were met lately, one for each place in a cube of 4^3 tiles: rays that walk side by
  // side find theirs here.
  struct RecentTile {
    CellCode code = ~CellCode{0};
    std::size_t number = 0;
  };
  static constexpr std::size_t kRecentTiles = 64;

  [[nodiscard]] std::size_t number_of(CellCode tile_code) {
    RecentTile& recent = recent_[tile_code % kRecentTiles];
    if (recent.code != tile_code) recent = {tile_code, tile_number(tile_code)};
    return recent.number;
  }
  [[nodiscard]] std::size_t tile_number(CellCode tile_code);
  [[nodiscard]] std::size_t place_of(CellCode tile_code) const;
  [[nodiscard]] std::uint32_t find_block(CellCode code) const;  // 0: there is none
  std::uint32_t add_block(CellTile& tile, CellCode code);
  void double_table();

  std::vector<CellTile> tiles_;
  std::array<RecentTile, kRecentTiles> recent_;
  std::vector<CellBlock> free_;             // of each block; the first stands for no block
  std::vector<CellBlock> occupied_;         // of a few blocks; the first is empty
  std::vector<std::uint32_t> occupied_of_;  // per block: its number among `occupied_`
  std::vector<std::uint32_t> table_;        // hash table: 1 + number of the tile, 0: empty
};

}  // namespace mrpt_terrain::octree
