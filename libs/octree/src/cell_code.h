// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mrpt_terrain::octree {

/// Address of a cell: the three 16-bit keys of OctoMap interleaved, x lowest (Morton code). The
/// highest three bits lead from the root to its child, the lowest three to the leaf.
using CellCode = std::uint64_t;
using CellKey = std::array<std::uint16_t, 3>;

/// Bits of a code that belong to x, y, z.
inline constexpr std::array<CellCode, 3> kAxisBits = {0x249249249249U, 0x492492492492U,
                                                      0x924924924924U};

/// Puts two zeros between the bits of a number.
[[nodiscard]] constexpr CellCode spread_bits(std::uint16_t number) {
  CellCode bits = number;
  bits = (bits | bits << 16) & 0xff0000ffU;
  bits = (bits | bits << 8) & 0xf00f00f00fU;
  bits = (bits | bits << 4) & 0xc30c30c30c3U;
  return (bits | bits << 2) & kAxisBits[0];
}

/// Takes every third bit, from the lowest on.
[[nodiscard]] constexpr std::uint16_t gather_bits(CellCode code) {
  CellCode bits = code & kAxisBits[0];
  bits = (bits | bits >> 2) & 0xc30c30c30c3U;
  bits = (bits | bits >> 4) & 0xf00f00f00fU;
  bits = (bits | bits >> 8) & 0xff0000ffU;
  bits = (bits | bits >> 16) & 0xffffU;
  return static_cast<std::uint16_t>(bits);
}

[[nodiscard]] constexpr CellCode code_of(const CellKey& key) {
  return spread_bits(key[0]) | spread_bits(key[1]) << 1 | spread_bits(key[2]) << 2;
}

[[nodiscard]] constexpr CellKey key_of(CellCode code) {
  return {gather_bits(code), gather_bits(code >> 1), gather_bits(code >> 2)};
}

}  // namespace mrpt_terrain::octree
