// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/unseen_reason.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/raster.h"

namespace mrpt_terrain::view {

/// What a cell is in a picture. Where several cells share a pixel the greatest one shows, so that
/// small dangerous things do not vanish.
enum class CellKind : std::uint8_t {
  kUnobserved = 0,
  kGround,
  kDropped,  ///< non-ground, but in no cluster
  kOther,
  kSlope,
  kObstacle,
  kPothole,
};
[[nodiscard]] Rgb colour_of(CellKind kind);

/// Kind of every observed cell; index: slot.
[[nodiscard]] std::vector<CellKind> cell_kinds(const Description& description);

/// The whole grid as kinds, drawn into width x height pixels: x forward is up, y left is left.
[[nodiscard]] Raster<CellKind> kind_raster(const Description& description, int width, int height);

/// Mean heights of the cells the same way, metres; NaN where no cell of the pixel is observed, the
/// mean where several share it.
[[nodiscard]] Raster<float> height_raster(const ElevationGrid& grid, int width, int height);

/// Slots the same way: kUnobserved where no cell of the pixel is observed, the greatest by `less`
/// where several share it.
[[nodiscard]] Raster<Slot> slot_raster(
    const ElevationGrid& grid, int width, int height,
    const std::function<bool(std::size_t a, std::size_t b)>& less);

/// Reasons why cells were not observed the same way; kSeen where a cell of the pixel is observed.
/// Of several, occluded shows before no return and that before out of view. \param reasons per
/// `CellId` of the grid
[[nodiscard]] Raster<UnseenReason> unseen_raster(const ElevationGrid& grid,
                                                 const std::vector<UnseenReason>& reasons,
                                                 int width, int height);

/// 1 where one of a pixel's cells is listed, else 0, the same way. \param cells `CellId` numbers of
/// the grid, sorted
[[nodiscard]] Raster<std::uint8_t> marked_raster(const GridGeometry& geometry,
                                                 const std::vector<std::int32_t>& cells, int width,
                                                 int height);

/// Number of cells that were not observed, by reason (`kSeen`: those that were).
[[nodiscard]] std::array<std::size_t, kUnseenReasonCount> count_unseen(
    const ElevationGrid& grid, const std::vector<UnseenReason>& reasons);

/// Heights that a colour scale spans, metres.
struct HeightRange {
  double low = 0.0;      ///< the first colour
  double high = 0.0;     ///< the last colour
  double lowest = 0.0;   ///< of all cells
  double highest = 0.0;  ///< of all cells
  bool empty = true;     ///< no cell is observed; the numbers mean nothing
};

/// Range of the cells' mean heights without the lowest and the highest `share` of them, so that one
/// wild point does not take the colours of all others. At least 0.1 m, about the same middle.
[[nodiscard]] HeightRange robust_range(const ElevationGrid& grid, double share = 0.02);

}  // namespace mrpt_terrain::view
