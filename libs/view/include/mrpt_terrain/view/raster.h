// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace mrpt_terrain::view {

/// One value per pixel, row by row from the upper left corner.
template <class Value>
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<Value> values;

  Raster(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  [[nodiscard]] Value& at(int column, int row) { return values[index(column, row)]; }
  [[nodiscard]] const Value& at(int column, int row) const { return values[index(column, row)]; }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace mrpt_terrain::view
