// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"

/// \file
/// Elevation grids and segmentations written down cell by cell, without going through the points.
/// Rows of the tables are l (along x), columns are w (along y); cells are 1 m wide.
namespace mrpt_terrain::grids {

/// Mark of a cell without points in tables of heights.
inline constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct Heights {
  float min, max, mean;
};
using HeightTable = std::vector<std::vector<Heights>>;
using MeanTable = std::vector<std::vector<float>>;

/// Grid with the heights of `table`; cells whose mean is NaN are unobserved.
[[nodiscard]] inline ElevationGrid grid_of(const HeightTable& table) {
  ElevationGrid grid;
  grid.geometry = GridGeometry(static_cast<double>(table.size()),
                               static_cast<double>(table.front().size()), 1.0);
  grid.slot_of.assign(static_cast<std::size_t>(grid.geometry.array_size()), kUnobserved);
  for (int l = 0; l < grid.geometry.cells_l(); ++l) {
    for (int w = 0; w < grid.geometry.cells_w(); ++w) {
      const Heights& h = table[static_cast<std::size_t>(l)][static_cast<std::size_t>(w)];
      if (std::isnan(h.mean)) continue;
      const CellId id = grid.geometry.id_of({l, w});
      const Position2 centre = grid.geometry.centre_of({l, w});
      grid.slot_of[static_cast<std::size_t>(value_of(id))] = static_cast<Slot>(grid.cell.size());
      grid.cell.push_back(id);
      grid.h_min.push_back(h.min);
      grid.h_max.push_back(h.max);
      grid.h_mean.push_back(h.mean);
      grid.sums.emplace_back();
      grid.sums.back().add(centre.x, centre.y, h.mean);
    }
  }
  return grid;
}

/// Grid whose cells hold one height each: minimum, maximum and mean are the same.
[[nodiscard]] inline ElevationGrid flat_cells(const MeanTable& means) {
  HeightTable table;
  for (const auto& row : means) {
    table.emplace_back();
    for (const float mean : row) table.back().push_back({mean, mean, mean});
  }
  return grid_of(table);
}

/// Grid and segmentation from a drawing: '#' non-ground, '.' ground, ' ' unobserved.
struct Drawing {
  ElevationGrid grid;
  GroundSegmentation ground;
};
[[nodiscard]] inline Drawing drawing(const std::vector<std::string>& rows) {
  MeanTable means;
  Drawing result;
  for (const std::string& row : rows) {
    means.emplace_back();
    for (const char mark : row) {
      means.back().push_back(mark == ' ' ? kNone : (mark == '#' ? 1.0F : 0.0F));
      if (mark != ' ') {
        result.ground.rule.push_back(mark == '#' ? GroundRule::kHigh : GroundRule::kGround);
      }
    }
  }
  result.grid = flat_cells(means);
  result.ground.h_mean = result.grid.h_mean;
  return result;
}

/// All slots of a grid as one row of indices.
[[nodiscard]] inline std::vector<std::int32_t> all_slots(const ElevationGrid& grid) {
  std::vector<std::int32_t> slots;
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    slots.push_back(static_cast<std::int32_t>(slot));
  }
  return slots;
}
[[nodiscard]] inline IndexRange range_of(const std::vector<std::int32_t>& items) {
  return {items.data(), items.data() + items.size()};
}

}  // namespace mrpt_terrain::grids
