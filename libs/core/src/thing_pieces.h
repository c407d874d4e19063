// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/field_clusters.h"

namespace mrpt_terrain {

/// The slot that stands for the thing of a slot: its first one. Shortens the way there.
inline std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t slot) {
  const auto up = [&parent](std::int32_t s) -> std::int32_t& {
    return parent[static_cast<std::size_t>(s)];
  };
  while (up(slot) != slot) {
    up(slot) = up(up(slot));
    slot = up(slot);
  }
  return slot;
}

/// Makes one thing of two, each given by its root.
/// \return its root
inline std::int32_t unite_roots(std::vector<std::int32_t>& parent, std::int32_t a, std::int32_t b) {
  parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  return std::min(a, b);
}

/// Makes one thing of those of two slots.
inline void unite(std::vector<std::int32_t>& parent, std::int32_t a, std::int32_t b) {
  unite_roots(parent, root_of(parent, a), root_of(parent, b));
}

/// Lowest and highest point of a thing in a cell, metres above the ground.
inline float low_of(const FieldCells& cells, std::size_t slot) {
  if (cells.raised[slot] == 0) return cells.low[slot];
  return cells.above[slot] == 0 ? cells.raised_low[slot]
                                : std::min(cells.low[slot], cells.raised_low[slot]);
}
inline float high_of(const FieldCells& cells, std::size_t slot) {
  return std::max(cells.high[slot], cells.raised_high[slot]);
}

/// Whether something is a swell of the ground: raised ground for the most part. Where no edge is
/// sharp, or none is seen, nothing tells the two apart.
template <class T>
bool is_swell(T above, T points, T sharp, T edges, const FieldClusterParams& params) {
  return 5 * above < points && (sharp == 0 || sharp < params.sharp * edges);
}

/// The pieces that cells have been brought together to, and what they lie in.
struct ThingPieces {
  const ElevationGrid& grid;
  const GroundSegmentation& ground;
  const FieldCells& cells;
  const FieldClusterParams& params;
  FieldClusterWorkspace& workspace;

  /// Whether a cell is of a thing that is no hole.
  [[nodiscard]] bool is_member(std::size_t slot) const {
    // Without branches, as nothing tells which way the next one goes.
    const auto is = [&](GroundRule rule) { return static_cast<int>(ground.rule[slot] == rule); };
    const int raised = static_cast<int>(cells.raised[slot] > 0);
    return ((is(GroundRule::kLow) ^ 1) & ((is(GroundRule::kGround) ^ 1) | raised)) != 0;
  }
  /// Whether the points of a cell are high above the ground and lie flat, as those of a table do.
  [[nodiscard]] bool hangs(std::size_t slot) const {
    return cells.above[slot] > 0 && cells.low[slot] > static_cast<float>(params.step) &&
           cells.high[slot] - cells.low[slot] <= static_cast<float>(params.flat);
  }
  [[nodiscard]] std::vector<ThingPiece>& all() const { return workspace.pieces; }
  /// The piece of a cell as it was measured; null: none.
  [[nodiscard]] const ThingPiece* of(std::size_t slot) const {
    const std::int32_t number = workspace.number_of[slot];
    return number < 0 ? nullptr : &workspace.pieces[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] bool same_thing(std::int32_t a, std::int32_t b) const {
    return root_of(workspace.parent, a) == root_of(workspace.parent, b);
  }
  void unite(std::int32_t a, std::int32_t b) const { mrpt_terrain::unite(workspace.parent, a, b); }

  /// Makes things of the parts of a piece.
  /// \param slots of the piece, ascending
  /// \param part_of per slot: which part it is of, below `parts`
  void separate(IndexRange slots, const std::vector<std::int32_t>& part_of,
                std::size_t parts) const;

  /// Lists the cells of things. Once, before the others.
  void find_members() const;
  /// Measures the pieces that `parent` has, in the order of their first cells.
  void measure() const;
  /// Lists their cells by piece, once they are measured.
  void list_cells() const;
};

}  // namespace mrpt_terrain
