// SPDX-License-Identifier: BSD-3-Clause
#include "scan_cells.h"

#include <algorithm>

namespace mrpt_terrain::octree {
namespace {

constexpr std::size_t kFirstTableSize = 1024;

std::size_t hash(CellCode tile_code) {
  return static_cast<std::size_t>(tile_code * 0x9e3779b97f4a7c15U >> 32);
}

}  // namespace

ScanCells::ScanCells() : free_(1), occupied_(1), occupied_of_(1), table_(kFirstTableSize) {}

void ScanCells::clear() {
  tiles_.clear();
  recent_.fill({});
  free_.resize(1);
  occupied_.resize(1);
  occupied_of_.resize(1);
  std::fill(table_.begin(), table_.end(), 0U);
}

void ScanCells::mark_occupied(CellCode code) {
  CellTile& tile = tiles_[number_of(code >> 18)];
  std::uint32_t block = tile.block[code >> 9 & 511];
  if (block == 0) block = add_block(tile, code);
  tile.occupied[code >> 15 & 7] |= std::uint64_t{1} << (code >> 9 & 63);
  std::uint32_t& place = occupied_of_[block];
  if (place == 0) {
    place = static_cast<std::uint32_t>(occupied_.size());
    occupied_.emplace_back();
  }
  occupied_[place].words[code >> 6 & 7] |= std::uint64_t{1} << (code & 63);
}

bool ScanCells::is_free(CellCode code) const {
  const std::uint32_t block = find_block(code);
  const std::uint64_t word =
      free(block).words[code >> 6 & 7] & ~occupied(block).words[code >> 6 & 7];
  return (word >> (code & 63) & 1) != 0;
}

bool ScanCells::is_occupied(CellCode code) const {
  return (occupied(find_block(code)).words[code >> 6 & 7] >> (code & 63) & 1) != 0;
}

std::uint32_t ScanCells::find_block(CellCode code) const {
  const std::uint32_t number = table_[place_of(code >> 18)];
  return number == 0 ? 0 : tiles_[number - 1].block[code >> 9 & 511];
}

void ScanCells::unmark_free(CellCode code) {
  CellTile& tile = tiles_[table_[place_of(code >> 18)] - 1];
  std::uint32_t& block = tile.block[code >> 9 & 511];
  CellBlock& free = free_[block];
  free.words[code >> 6 & 7] &= ~(std::uint64_t{1} << (code & 63));
  std::uint64_t any = occupied_of_[block];
  for (const std::uint64_t word : free.words) any |= word;
  if (any != 0) return;
  // Nothing is left of the block: who walks through the tile must not meet it.
  block = 0;
  tile.present[code >> 15 & 7] &= ~(std::uint64_t{1} << (code >> 9 & 63));
}

// Where the hash table has a tile, or has room for it.
std::size_t ScanCells::place_of(CellCode tile_code) const {
  std::size_t place = hash(tile_code) & (table_.size() - 1);
  while (table_[place] != 0 && tiles_[table_[place] - 1].code != tile_code) {
    place = (place + 1) & (table_.size() - 1);
  }
  return place;
}

std::size_t ScanCells::tile_number(CellCode tile_code) {
  const std::size_t place = place_of(tile_code);
  if (table_[place] != 0) return table_[place] - 1;
  tiles_.emplace_back();
  tiles_.back().code = tile_code;
  table_[place] = static_cast<std::uint32_t>(tiles_.size());
  if (2 * tiles_.size() > table_.size()) double_table();
  return tiles_.size() - 1;
}

std::uint32_t ScanCells::add_block(CellTile& tile, CellCode code) {
  const auto number = static_cast<std::uint32_t>(free_.size());
  free_.emplace_back();
  occupied_of_.push_back(0);
  tile.block[code >> 9 & 511] = number;
  tile.present[code >> 15 & 7] |= std::uint64_t{1} << (code >> 9 & 63);
  return number;
}

void ScanCells::double_table() {
  table_.assign(2 * table_.size(), 0U);
  for (std::size_t number = 0; number < tiles_.size(); ++number) {
    std::size_t place = hash(tiles_[number].code) & (table_.size() - 1);
    while (table_[place] != 0) place = (place + 1) & (table_.size() - 1);
    table_[place] = static_cast<std::uint32_t>(number + 1);
  }
}

}  // namespace mrpt_terrain::octree
