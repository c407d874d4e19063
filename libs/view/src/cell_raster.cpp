// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cell_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mrpt_terrain::view {
namespace {

constexpr double kLeastRange = 0.1;  // metres

/// Cells [first, last) along one axis that share a pixel.
struct Span {
  int first = 0;
  int last = 0;
};

/// Per pixel of a column or row its cells; pixels count against the axis, which points up or left.
std::vector<Span> spans(int cells, int pixels) {
  std::vector<Span> result(static_cast<std::size_t>(pixels));
  const double cells_per_pixel = static_cast<double>(cells) / pixels;
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const int from_end = pixels - 1 - pixel;
    auto& span = result[static_cast<std::size_t>(pixel)];
    if (cells <= pixels) {
      span.first = std::min(cells - 1, static_cast<int>((from_end + 0.5) * cells_per_pixel));
      span.last = span.first + 1;
    } else {
      span.first = static_cast<int>(from_end * cells_per_pixel);
      span.last = std::min(cells, static_cast<int>(std::ceil((from_end + 1) * cells_per_pixel)));
    }
  }
  return result;
}

/// Calls visit(pixel, cell) for all cells of each pixel, observed or not.
template <class Value, class Visit>
void for_each_place_of_pixels(const GridGeometry& geometry, Raster<Value>& raster, Visit visit) {
  const auto rows = spans(geometry.cells_l(), raster.height);
  const auto columns = spans(geometry.cells_w(), raster.width);
  Value* pixel = raster.values.data();
  for (const Span& row : rows) {
    for (const Span& column : columns) {
      for (int l = row.first; l < row.last; ++l) {
        for (int w = column.first; w < column.last; ++w) visit(*pixel, CellIndex{l, w});
      }
      ++pixel;
    }
  }
}

/// Calls `visit(pixel value, slot)` for every observed cell of every pixel.
template <class Value, class Visit>
void for_each_cell_of_pixels(const ElevationGrid& grid, Raster<Value>& raster, Visit visit) {
  for_each_place_of_pixels(grid.geometry, raster, [&](Value& pixel, CellIndex cell) {
    const Slot slot = grid.slot_of[static_cast<std::size_t>(value_of(grid.geometry.id_of(cell)))];
    if (slot != kUnobserved) visit(pixel, static_cast<std::size_t>(slot));
  });
}

/// kSeen where the cell is observed, whatever was seen in it.
UnseenReason reason_at(const ElevationGrid& grid, const std::vector<UnseenReason>& reasons,
                       CellIndex cell) {
  const auto id = static_cast<std::size_t>(value_of(grid.geometry.id_of(cell)));
  return grid.slot_of[id] != kUnobserved ? UnseenReason::kSeen : reasons[id];
}

CellKind kind_of(TerrainClass terrain_class) {
  switch (terrain_class) {
    case TerrainClass::kSlope:
      return CellKind::kSlope;
    case TerrainClass::kPothole:
      return CellKind::kPothole;
    case TerrainClass::kObstacle:
      return CellKind::kObstacle;
    case TerrainClass::kOther:
      return CellKind::kOther;
    case TerrainClass::kNone:
      break;
  }
  return CellKind::kDropped;
}

}  // namespace

Rgb colour_of(CellKind kind) {
  switch (kind) {
    case CellKind::kGround:
      return kGroundColour;
    case CellKind::kDropped:
      return kDroppedColour;
    case CellKind::kOther:
      return kOtherColour;
    case CellKind::kSlope:
      return kSlopeColour;
    case CellKind::kObstacle:
      return kObstacleColour;
    case CellKind::kPothole:
      return kPotholeColour;
    case CellKind::kUnobserved:
      break;
  }
  return kUnobservedColour;
}

std::vector<CellKind> cell_kinds(const Description& description) {
  std::vector<CellKind> kinds(description.grid.observed());
  for (std::size_t slot = 0; slot < kinds.size(); ++slot) {
    const std::int32_t cluster = description.clusters.cluster_of[slot];
    if (cluster != kNoCluster) {
      kinds[slot] = kind_of(description.things[static_cast<std::size_t>(cluster)].terrain_class);
    } else {
      kinds[slot] = description.ground.is_ground(slot) ? CellKind::kGround : CellKind::kDropped;
    }
  }
  return kinds;
}

Raster<CellKind> kind_raster(const Description& description, int width, int height) {
  const auto kinds = cell_kinds(description);
  Raster<CellKind> raster(width, height);
  for_each_cell_of_pixels(description.grid, raster, [&](CellKind& pixel, std::size_t slot) {
    pixel = std::max(pixel, kinds[slot]);
  });
  return raster;
}

Raster<float> height_raster(const ElevationGrid& grid, int width, int height) {
  struct Sum {
    float sum = 0.0F;
    std::int32_t n = 0;
  };
  Raster<Sum> sums(width, height);
  for_each_cell_of_pixels(grid, sums, [&](Sum& pixel, std::size_t slot) {
    pixel.sum += grid.h_mean[slot];
    ++pixel.n;
  });
  Raster<float> raster(width, height);
  std::transform(sums.values.begin(), sums.values.end(), raster.values.begin(), [](const Sum& sum) {
    return sum.n == 0 ? std::numeric_limits<float>::quiet_NaN()
                      : sum.sum / static_cast<float>(sum.n);
  });
  return raster;
}

Raster<Slot> slot_raster(const ElevationGrid& grid, int width, int height,
                         const std::function<bool(std::size_t a, std::size_t b)>& less) {
  Raster<Slot> raster(width, height);
  std::fill(raster.values.begin(), raster.values.end(), kUnobserved);
  for_each_cell_of_pixels(grid, raster, [&](Slot& pixel, std::size_t slot) {
    if (pixel == kUnobserved || less(static_cast<std::size_t>(pixel), slot)) {
      pixel = static_cast<Slot>(slot);
    }
  });
  return raster;
}

Raster<UnseenReason> unseen_raster(const ElevationGrid& grid,
                                   const std::vector<UnseenReason>& reasons, int width,
                                   int height) {
  constexpr std::array<int, kUnseenReasonCount> kRank{4, 1, 3, 2};  // seen first
  const auto rank = [&](UnseenReason reason) { return kRank[static_cast<std::size_t>(reason)]; };
  Raster<UnseenReason> raster(width, height);
  std::fill(raster.values.begin(), raster.values.end(), UnseenReason::kOutOfView);
  for_each_place_of_pixels(grid.geometry, raster, [&](UnseenReason& pixel, CellIndex cell) {
    const UnseenReason reason = reason_at(grid, reasons, cell);
    if (rank(reason) > rank(pixel)) pixel = reason;
  });
  return raster;
}

Raster<std::uint8_t> marked_raster(const GridGeometry& geometry,
                                   const std::vector<std::int32_t>& cells, int width, int height) {
  Raster<std::uint8_t> raster(width, height);
  std::fill(raster.values.begin(), raster.values.end(), std::uint8_t{0});
  if (cells.empty()) return raster;
  for_each_place_of_pixels(geometry, raster, [&](std::uint8_t& pixel, CellIndex cell) {
    const std::int32_t id = value_of(geometry.id_of(cell));
    if (std::binary_search(cells.begin(), cells.end(), id)) pixel = 1;
  });
  return raster;
}

std::array<std::size_t, kUnseenReasonCount> count_unseen(const ElevationGrid& grid,
                                                         const std::vector<UnseenReason>& reasons) {
  std::array<std::size_t, kUnseenReasonCount> counts{};
  for (int l = 0; l < grid.geometry.cells_l(); ++l) {
    for (int w = 0; w < grid.geometry.cells_w(); ++w) {
      ++counts[static_cast<std::size_t>(reason_at(grid, reasons, {l, w}))];
    }
  }
  return counts;
}

HeightRange robust_range(const ElevationGrid& grid, double share) {
  HeightRange range;
  if (grid.h_mean.empty()) return range;
  std::vector<float> heights = grid.h_mean;
  const auto quantile = [&](double q) {
    const auto last = static_cast<double>(heights.size() - 1);
    const auto place = heights.begin() + static_cast<std::ptrdiff_t>(std::lround(q * last));
    std::nth_element(heights.begin(), place, heights.end());
    return static_cast<double>(*place);
  };
  range.empty = false;
  range.low = quantile(share);
  range.high = quantile(1.0 - share);
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  range.lowest = *lowest;
  range.highest = *highest;
  const double missing = kLeastRange - (range.high - range.low);
  if (missing > 0.0) {
    range.low -= 0.5 * missing;
    range.high += 0.5 * missing;
  }
  return range;
}

}  // namespace mrpt_terrain::view
