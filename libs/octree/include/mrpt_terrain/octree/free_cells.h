// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/octree/trim_tree.h"

/// \file
/// Which cells of a tree are free, as bits: what the nodes know, without the way to them.
namespace mrpt_terrain::octree {

/// The free cells of a tree: those whose node is known and not occupied. `insert_scan` keeps them
/// up to date, and `trim` follows `trim_tree`; after other changes of the tree, `assign`.
///
/// Memory: 64 bytes per 8^3 cells that hold any, and 2 kB per 64^3.
class FreeCells {
 public:
  FreeCells();

  /// Forgets all cells.
  void clear();
  /// The free cells of a tree. Looks at every node.
  void assign(const octomap::OcTree& tree);
  /// Sets a cube of 2^level cells.
  /// \param low key of the cell with the lowest coordinates, multiples of 2^level
  /// \param level 0 to 16
  void set(const std::array<std::uint16_t, 3>& low, int level, bool is_free);
  /// Forgets the cells outside a window. Costs the tiles of 64^3 cells, and the blocks of 8^3 cells
  /// in those that lie across its border.
  void trim(const CellWindow& window);

  /// Cells above each other: bit k is cell (x, y, z + k). Those beyond the highest key are 0.
  /// \param cells how many are looked at, 1 to 64; the bits of the others are 0
  [[nodiscard]] std::uint64_t column(std::uint16_t x, std::uint16_t y, std::uint16_t z,
                                     int cells = 64) const;

 private:
  struct Block {
    std::array<std::uint64_t, 8> words{};  // as in ScanCells
  };
  struct Tile {
    std::uint64_t code = 0;                  // of its cells, without the lowest 18 bits
    std::array<std::uint32_t, 512> block{};  // number of the block; 0: no cell of it is free
  };

  [[nodiscard]] std::size_t find_tile(std::uint64_t tile_code) const;  // kNone if there is none
  [[nodiscard]] Tile& tile_at(std::uint64_t tile_code);
  [[nodiscard]] Block& block_at(std::uint64_t code);
  [[nodiscard]] Block* find_block(std::uint64_t code);
  void set_within_block(std::uint64_t code, int level, bool is_free);
  void trim_tile(const CellWindow& window, Tile& tile);
  void drop_block(std::uint32_t& number);
  void index_tiles();

  std::vector<Tile> tiles_;
  std::vector<Block> blocks_;          // the first stands for no block
  std::vector<std::uint32_t> unused_;  // numbers of blocks
  std::vector<std::uint32_t> table_;   // hash table: 1 + number of the tile, 0: empty
};

}  // namespace mrpt_terrain::octree
