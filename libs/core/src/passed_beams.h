// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/field_cells.h"

namespace mrpt_terrain {

/// Tells where no thing can stand, because beams have passed there. Refers to what it is made of.
class PassedBeams {
 public:
  /// \param sensor where the beams begin, frame of the grid, metres
  PassedBeams(const ElevationGrid& grid, const FieldCells& cells,
              const std::array<float, 3>& sensor);

  /// Whether a beam that ends behind a place, up to 12 m away, has passed the place below the top
  /// of a thing that would stand there. The lowest point of every cell behind it, seen from the
  /// sensor, is looked at.
  /// \param ground, top heights in the frame of the grid, metres
  [[nodiscard]] bool have_passed(const Position2& at, float ground, float top) const;

  /// Whether a gap is narrower across the beams than columns of them are apart, so that none can
  /// have passed.
  [[nodiscard]] bool between_columns(const Position2& begin, const Position2& end) const;
  /// Whether a beam has passed between what stands in two cells: from where the beams begin, their
  /// nearest parts with points of things are apart by more than columns of beams are, and a beam
  /// has passed in the middle. False where nothing is known of parts (FieldCells::parts).
  [[nodiscard]] bool divide(std::size_t slot_a, std::size_t slot_b) const;

 private:
  const ElevationGrid& grid_;
  const FieldCells& cells_;
  const std::array<float, 3>& sensor_;
  float cell_;
};

}  // namespace mrpt_terrain
