// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/grid_geometry.h"

#include <cassert>
#include <cmath>

namespace mrpt_terrain {
namespace {

// 1.1 / 0.1 is a hair more than 11 in binary: a quotient that close to a whole number is one.
int cells_along(double extent, double cell_size) {
  return static_cast<int>(std::ceil(extent / cell_size - 1e-9));
}

}  // namespace

GridGeometry::GridGeometry(double length, double width, double cell_size)
    : length_(length),
      width_(width),
      cell_size_(cell_size),
      half_length_(length / 2),
      half_width_(width / 2),
      cells_per_metre_(1 / cell_size),
      cells_l_(cells_along(length, cell_size)),
      cells_w_(cells_along(width, cell_size)),
      by_stride_(stride()) {
  assert(length > 0 && width > 0 && cell_size > 0);
  assert((cells_l_ + 2.0) * (cells_w_ + 2.0) < 2147483647.0);
}

}  // namespace mrpt_terrain
