// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cell_code.h"

namespace mrpt_terrain::octree {

/// 8^3 cells, a bit each; word w has the w-th octant of 4^3 cells, bits in the order of codes.
struct alignas(64) CellBlock {
  std::uint64_t free[8] = {};
  std::uint64_t occupied[8] = {};
};

/// 64^3 cells as 8^3 blocks, of which only those exist that a ray met.
struct CellTile {
  CellCode code = 0;             ///< of its cells, without the lowest 18 bits
  std::uint64_t present[8] = {};   ///< a bit per block, in the order of codes
  std::uint64_t occupied[8] = {};  ///< blocks with a bit among `CellBlock::occupied`
  std::uint32_t block[512] = {};   ///< number of the block; 0: there is none
};

/// The cells that the rays of a scan cross and end in. Memory follows the tiles that were met, not
/// the extent of the scan.
class ScanCells {
 public:
  ScanCells();

  /// Forgets all cells and keeps the memory.
  void clear();

  /// Marks `count` cells as free; code k is at codes[k * stride]. Fast if neighbours in the list
  /// are neighbours in space.
  void mark_free(const CellCode* codes, std::size_t stride, std::size_t count) {
    CellCode tile_code = ~CellCode{0};
    CellTile* tile = nullptr;
    for (std::size_t k = 0; k < count; ++k) {
      const CellCode code = codes[k * stride];
      if (code >> 18 != tile_code) {
        tile_code = code >> 18;
        tile = &tiles_[tile_number(tile_code)];
      }
      std::uint32_t block = tile->block[code >> 9 & 511];
      if (block == 0) block = add_block(*tile, code);
      blocks_[block].free[code >> 6 & 7] |= std::uint64_t{1} << (code & 63);
    }
  }

  void mark_occupied(CellCode code);

  [[nodiscard]] const std::vector<CellTile>& tiles() const { return tiles_; }
  [[nodiscard]] const CellBlock& block(std::uint32_t number) const { return blocks_[number]; }

 private:
  [[nodiscard]] std::size_t tile_number(CellCode tile_code);
  std::uint32_t add_block(CellTile& tile, CellCode code);
  void double_table();

  std::vector<CellTile> tiles_;
  std::vector<CellBlock> blocks_;     // the first stands for no block
  std::vector<std::uint32_t> table_;  // hash table: 1 + number of the tile, 0: empty
};

}  // namespace mrpt_terrain::octree
