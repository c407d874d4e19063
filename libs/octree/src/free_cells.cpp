// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/free_cells.h"

#include <algorithm>
#include <cassert>

#include "cell_code.h"

namespace mrpt_terrain::octree {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};
constexpr std::size_t kFirstTableSize = 256;
constexpr int kBlockLevel = 3;
constexpr std::uint32_t kBlockSide = 1U << kBlockLevel;

std::size_t hash(CellCode tile_code) {
  return static_cast<std::size_t>(tile_code * 0x9e3779b97f4a7c15U >> 32);
}

// Four cells above each other in a word of 4^3, the lowest of them in the lowest layer.
std::uint64_t four_layers(std::uint64_t word, CellCode lowest) {
  const std::uint64_t bits = word >> (lowest & 63);
  return (bits & 1) | (bits >> 3 & 2) | (bits >> 30 & 4) | (bits >> 33 & 8);
}

/// Where a cube of cells lies with respect to a window.
enum class Place { kInside, kAcross, kOutside };
Place place_of(const CellKey& low, std::uint32_t side, const CellWindow& window) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t first = low[axis];
    const std::uint32_t last = first + side - 1;
    if (last < window.low[axis] || first > window.high[axis]) return Place::kOutside;
    inside = inside && first >= window.low[axis] && last <= window.high[axis];
  }
  return inside ? Place::kInside : Place::kAcross;
}

bool contains(const CellWindow& window, const CellKey& key) {
  return place_of(key, 1, window) == Place::kInside;
}

}  // namespace

FreeCells::FreeCells() : blocks_(1), table_(kFirstTableSize) {}

void FreeCells::clear() {
  tiles_.clear();
  blocks_.resize(1);
  unused_.clear();
  std::fill(table_.begin(), table_.end(), 0U);
}

void FreeCells::assign(const octomap::OcTree& tree) {
  clear();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (tree.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey key = leaf.getIndexKey();
    set({key[0], key[1], key[2]}, 16 - static_cast<int>(leaf.getDepth()), true);
  }
}

void FreeCells::set(const CellKey& low, int level, bool is_free) {
  const CellCode code = code_of(low);
  if (level <= kBlockLevel) {
    set_within_block(code, level, is_free);
    return;
  }
  const CellCode blocks = CellCode{1} << 3 * (level - kBlockLevel);
  for (CellCode k = 0; k < blocks; ++k) set_within_block(code + (k << 9), kBlockLevel, is_free);
}

void FreeCells::set_within_block(CellCode code, int level, bool is_free) {
  Block* const block = is_free ? &block_at(code) : find_block(code);
  if (block == nullptr) return;
  if (level == kBlockLevel) {
    block->words.fill(is_free ? ~std::uint64_t{0} : 0);
    return;
  }
  const int cells = 1 << 3 * level;
  const std::uint64_t all = cells == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << cells) - 1;
  std::uint64_t& word = block->words[code >> 6 & 7];
  const std::uint64_t bits = all << (code & 63);
  word = is_free ? word | bits : word & ~bits;
}

std::uint64_t FreeCells::column(std::uint16_t x, std::uint16_t y, std::uint16_t z,
                                int cells) const {
  assert(cells >= 1 && cells <= 64);
  std::uint64_t bits = 0;
  std::size_t tile = kNone;
  CellCode tile_code = ~CellCode{0};
  const int below = z % 4;
  const CellCode corner = spread_bits(x) | spread_bits(y) << 1;
  for (int layer = z - below; layer < z + cells && layer <= 0xFFFF; layer += 4) {
    const CellCode code = corner | spread_bits(static_cast<std::uint16_t>(layer)) << 2;
    if (code >> 18 != tile_code) {
      tile_code = code >> 18;
      tile = find_tile(tile_code);
    }
    if (tile == kNone) continue;
    const Block& block = blocks_[tiles_[tile].block[code >> 9 & 511]];
    const std::uint64_t four = four_layers(block.words[code >> 6 & 7], code);
    const int shift = layer - z;
    bits |= shift < 0 ? four >> -shift : four << shift;
  }
  return cells == 64 ? bits : bits & ((std::uint64_t{1} << cells) - 1);
}

void FreeCells::trim(const CellWindow& window) {
  constexpr std::uint32_t kTileSide = 64;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < tiles_.size(); ++k) {
    const Place place = place_of(key_of(tiles_[k].code << 18), kTileSide, window);
    if (place == Place::kAcross) trim_tile(window, tiles_[k]);
    if (place == Place::kOutside) {
      for (std::uint32_t& number : tiles_[k].block) drop_block(number);
      continue;
    }
    if (kept != k) tiles_[kept] = tiles_[k];
    ++kept;
  }
  if (kept == tiles_.size()) return;
  tiles_.resize(kept);
  index_tiles();
}

void FreeCells::trim_tile(const CellWindow& window, Tile& tile) {
  for (std::size_t k = 0; k < tile.block.size(); ++k) {
    if (tile.block[k] == 0) continue;
    const CellCode first = tile.code << 18 | static_cast<CellCode>(k) << 9;
    const Place place = place_of(key_of(first), kBlockSide, window);
    if (place == Place::kInside) continue;
    if (place == Place::kOutside) {
      drop_block(tile.block[k]);
      continue;
    }
    Block& block = blocks_[tile.block[k]];
    std::uint64_t any = 0;
    for (std::uint64_t& word : block.words) {
      const CellCode of_word = first | static_cast<CellCode>(&word - block.words.data()) << 6;
      for (std::uint64_t left = word; left != 0; left &= left - 1) {
        const auto bit = static_cast<CellCode>(__builtin_ctzll(left));
        if (!contains(window, key_of(of_word | bit))) word &= ~(std::uint64_t{1} << bit);
      }
      any |= word;
    }
    if (any == 0) drop_block(tile.block[k]);
  }
}

void FreeCells::drop_block(std::uint32_t& number) {
  if (number == 0) return;
  blocks_[number] = Block{};
  unused_.push_back(number);
  number = 0;
}

std::size_t FreeCells::find_tile(CellCode tile_code) const {
  for (std::size_t place = hash(tile_code);; ++place) {
    const std::uint32_t entry = table_[place & (table_.size() - 1)];
    if (entry == 0) return kNone;
    if (tiles_[entry - 1].code == tile_code) return entry - 1;
  }
}

FreeCells::Tile& FreeCells::tile_at(CellCode tile_code) {
  const std::size_t found = find_tile(tile_code);
  if (found != kNone) return tiles_[found];
  tiles_.emplace_back();
  tiles_.back().code = tile_code;
  index_tiles();
  return tiles_.back();
}

void FreeCells::index_tiles() {
  std::size_t size = table_.size();
  while (size < 2 * tiles_.size()) size *= 2;
  table_.assign(size, 0U);
  for (std::size_t number = 0; number < tiles_.size(); ++number) {
    std::size_t place = hash(tiles_[number].code) & (size - 1);
    while (table_[place] != 0) place = (place + 1) & (size - 1);
    table_[place] = static_cast<std::uint32_t>(number + 1);
  }
}

FreeCells::Block& FreeCells::block_at(CellCode code) {
  std::uint32_t& number = tile_at(code >> 18).block[code >> 9 & 511];
  if (number == 0) {
    if (unused_.empty()) {
      number = static_cast<std::uint32_t>(blocks_.size());
      blocks_.emplace_back();
    } else {
      number = unused_.back();
      unused_.pop_back();
    }
  }
  return blocks_[number];
}

FreeCells::Block* FreeCells::find_block(CellCode code) {
  const std::size_t tile = find_tile(code >> 18);
  if (tile == kNone) return nullptr;
  const std::uint32_t number = tiles_[tile].block[code >> 9 & 511];
  return number == 0 ? nullptr : &blocks_[number];
}

}  // namespace mrpt_terrain::octree
