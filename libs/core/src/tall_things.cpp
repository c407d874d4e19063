// SPDX-License-Identifier: BSD-3-Clause
#include "tall_things.h"

#include <algorithm>

namespace mrpt_terrain {
namespace {

// Things are looked for in nine blocks of this level's cells about a cell.
constexpr int kBlockLevel = 3;
// Layers of height in a block's size: 0.2 m with blocks of 3.2 m. 64 of them have a bit each;
// heights 64 layers apart share one, which are treetops and ground.
constexpr float kLayers = 16.0F;
// Layers from half a block to one block above a cell's own, 8 to 15, and as far below it, 64 - 15
// to 64 - 8.
constexpr std::uint64_t kTall = 0x01FE'0000'0000'FF00;

std::uint64_t rotated_down(std::uint64_t bits, unsigned by) {
  return by == 0 ? bits : bits >> by | bits << (64 - by);
}

std::size_t block_of(LatticeCell cell, int side) {
  return static_cast<std::size_t>((cell.row >> kBlockLevel) * side + (cell.column >> kBlockLevel));
}

// Layer above the plane in which the low height of a cell lies, modulo 64.
unsigned layer_of(const GroundSurface& surface, std::size_t slot, float layers_per_metre) {
  const LatticeCell cell = surface.cells.cell[slot];
  const float plane = surface.gradient_x * surface.lattice().centre(cell.row) +
                      surface.gradient_y * surface.lattice().centre(cell.column) + surface.offset;
  // Shifted by a multiple of 64 layers, so that none is negative; what is wilder is as good there.
  constexpr float kMost = 8192.0F;
  const float height = (surface.ground[slot].low - plane) * layers_per_metre;
  return static_cast<unsigned>(std::clamp(height, -kMost, kMost) + kMost) & 63U;
}

// In place of the layers of each block those of the nine blocks about it.
void spread_layers(int side, GroundSurfaceWorkspace& workspace) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<std::uint64_t>&layers = workspace.layers, &in_row = workspace.layers_in_row;
  in_row.resize(n * n);
  for (std::size_t row = 0; row < n; ++row) {
    const std::uint64_t* from = layers.data() + row * n;
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t left = column == 0 ? 0 : column - 1;
      const std::size_t right = std::min(column + 1, n - 1);
      in_row[row * n + column] = from[left] | from[column] | from[right];
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    const std::size_t before = row == 0 ? 0 : row - 1;
    const std::size_t after = std::min(row + 1, n - 1);
    for (std::size_t column = 0; column < n; ++column) {
      layers[row * n + column] =
          in_row[before * n + column] | in_row[row * n + column] | in_row[after * n + column];
    }
  }
}

}  // namespace

void find_tall_things(const GroundSurface& surface, GroundSurfaceWorkspace& workspace) {
  const SquareLattice& lattice = surface.lattice();
  const std::size_t slots = surface.cells.occupied();
  const int side = lattice.side >> kBlockLevel;
  const float layers_per_metre =
      kLayers / (lattice.cell_size * static_cast<float>(1 << kBlockLevel));
  workspace.layers.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  workspace.beside_tall.resize(slots);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const unsigned layer = layer_of(surface, slot, layers_per_metre);
    workspace.beside_tall[slot] = static_cast<std::uint8_t>(layer);  // for the loop below
    workspace.layers[block_of(surface.cells.cell[slot], side)] |= std::uint64_t{1} << layer;
  }
  spread_layers(side, workspace);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const std::uint64_t around = workspace.layers[block_of(surface.cells.cell[slot], side)];
    const bool tall = (rotated_down(around, workspace.beside_tall[slot]) & kTall) != 0;
    workspace.beside_tall[slot] = tall ? 1 : 0;
  }
}

}  // namespace mrpt_terrain
