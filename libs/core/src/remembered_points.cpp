// SPDX-License-Identifier: BSD-3-Clause
#include "remembered_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mrpt_terrain/core/fused_cell.h"

namespace mrpt_terrain {
namespace {

// Points of the last scan with which a cell needs no others for what the scan has hit.
constexpr std::int32_t kEnough = 4;
// Two points are enough for bins with a lesser standard deviation of heights, metres: ground.
constexpr float kFlat = 0.02F;
// And for those that begin this far above the lowest of their cell, metres: things that stand
// there.
constexpr double kUpright = 0.3;
// Of heights in float, metres.
constexpr double kRounding = 1e-4;

// Flat bins this far above or below the points of the last scan in their cell are of the same
// ground under a wrong pose, if most cells around have such, metres.
constexpr float kLeastShift = 0.03F, kMostShift = 0.25F;
// The cells around: squares of this many to a side, with at least so many that say something.
constexpr int kBlockSide = 8;
constexpr std::int32_t kFewestTold = 6;

void count_hits(const WindowFrame& frame, const Points& points, std::size_t measured,
                std::vector<CellHits>& hits) {
  hits.assign(static_cast<std::size_t>(frame.geometry.array_size()), CellHits{});
  for (std::size_t i = 0; i < measured; ++i) {
    CellIndex cell;
    if (!std::isfinite(points.z[i])) continue;
    if (!frame.geometry.cell_at(points.x[i], points.y[i], cell)) continue;
    CellHits& hit = hits[static_cast<std::size_t>(value_of(frame.geometry.id_of(cell)))];
    hit.low = hit.points == 0 ? points.z[i] : std::min(hit.low, points.z[i]);
    hit.high = hit.points == 0 ? points.z[i] : std::max(hit.high, points.z[i]);
    ++hit.points;
  }
}

bool is_flat(const HeightBin& bin) {
  return bin.m_zz <= kFlat * kFlat * static_cast<float>(bin.count);
}

/// Squares of cells, and in how many of them the ground that is remembered is not where the last
/// scan sees it.
class ShiftedGround {
 public:
  ShiftedGround(const FusedSnapshot& map, const WindowFrame& frame, RememberedWorkspace& workspace)
      : map_(map), frame_(frame), workspace_(workspace) {
    columns_ = (frame.geometry.cells_w() + kBlockSide - 1) / kBlockSide;
    const int rows = (frame.geometry.cells_l() + kBlockSide - 1) / kBlockSide;
    workspace.shifts.assign(static_cast<std::size_t>(rows * columns_), ShiftCounts{});
    for (const CellId id : workspace.grid.cell) count(id);
  }

  /// Whether a remembered bin of a cell is left out.
  [[nodiscard]] bool is_shifted(const HeightBin& bin, CellIndex at, const CellHits& hits) const {
    const ShiftCounts& counts = workspace_.shifts[block_of(at)];
    return counts.told >= kFewestTold && 2 * counts.shifted >= counts.told &&
           contradicts(bin, hits);
  }

 private:
  [[nodiscard]] std::size_t block_of(CellIndex at) const {
    return static_cast<std::size_t>(at.l / kBlockSide * columns_ + at.w / kBlockSide);
  }
  // Whether a flat bin lies a little above or below all points of the scan in its cell.
  [[nodiscard]] bool contradicts(const HeightBin& bin, const CellHits& hits) const {
    if (hits.points < kEnough || bin.last_seen >= map_.time || !is_flat(bin)) return false;
    const auto bottom = static_cast<float>(map_.lattice.bottom_of(bin.layer) - frame_.z);
    const float above = bottom + bin.z_min - hits.high, below = hits.low - bottom - bin.z_max;
    return (above > kLeastShift && above < kMostShift) ||
           (below > kLeastShift && below < kMostShift);
  }
  void count(CellId id) {
    const CellHits& hits = workspace_.hits[static_cast<std::size_t>(value_of(id))];
    if (hits.points < kEnough) return;
    const CellIndex at = frame_.geometry.index_of(id);
    const MapCell where = frame_.map_cell_of(at);
    bool older = false, shifted = false;
    for_each_bin(*map_.tiles.find(tile_of(where)), place_in_tile(where), [&](const HeightBin& bin) {
      older = older || bin.last_seen < map_.time || bin.scans > 1;
      shifted = shifted || contradicts(bin, hits);
    });
    ShiftCounts& counts = workspace_.shifts[block_of(at)];
    counts.told += older ? 1 : 0;
    counts.shifted += shifted ? 1 : 0;
  }

  const FusedSnapshot& map_;
  const WindowFrame& frame_;
  RememberedWorkspace& workspace_;
  int columns_ = 0;
};

/// Lower triangle L of a covariance L L^T; rows of directions without spread are 0.
struct Spread {
  float xx, xy, yy, xz, yz, zz;

  explicit Spread(const HeightBin& bin) {
    const float n = static_cast<float>(bin.count);
    xx = std::sqrt(std::max(bin.m_xx / n, 0.0F));
    xy = xx > 0.0F ? bin.m_xy / n / xx : 0.0F;
    xz = xx > 0.0F ? bin.m_xz / n / xx : 0.0F;
    yy = std::sqrt(std::max(bin.m_yy / n - xy * xy, 0.0F));
    yz = yy > 0.0F ? (bin.m_yz / n - xy * xz) / yy : 0.0F;
    zz = std::sqrt(std::max(bin.m_zz / n - xz * xz - yz * yz, 0.0F));
  }
};

/// A cell of the window and where its points go.
struct Column {
  float x, y;    // its centre, frame of the window
  float half;    // of its side, a little less: points on the edge may belong to the next cell
  double below;  // z of the window in the map

  void add(const HeightBin& bin, const MapLattice& lattice, float dx, float dy, float dz,
           Points& points) const {
    const auto bottom = static_cast<float>(lattice.bottom_of(bin.layer) - below);
    points.push_back(x + std::clamp(bin.mean_x + dx, -half, half),
                     y + std::clamp(bin.mean_y + dy, -half, half),
                     bottom + std::clamp(bin.mean_z + dz, bin.z_min, bin.z_max));
  }
};

// Adds two points, one on each side of the mean along a diagonal of the spread.
void append_pair(const HeightBin& bin, const MapLattice& lattice, const Column& column, float side,
                 Points& points) {
  const Spread s(bin);
  const float dx = s.xx, dy = s.xy + side * s.yy, dz = s.xz + side * s.yz + s.zz;
  column.add(bin, lattice, dx, dy, dz, points);
  column.add(bin, lattice, -dx, -dy, -dz, points);
}

void append_simplex(const HeightBin& bin, const MapLattice& lattice, const Column& column,
                    Points& points) {
  constexpr std::array<std::array<float, 3>, 4> kCorners{
      {{1.0F, 1.0F, 1.0F}, {-1.0F, -1.0F, 1.0F}, {1.0F, -1.0F, -1.0F}, {-1.0F, 1.0F, -1.0F}}};
  const Spread s(bin);
  for (const auto& [a, b, c] : kCorners) {
    column.add(bin, lattice, a * s.xx, a * s.xy + b * s.yy, a * s.xz + b * s.yz + c * s.zz, points);
  }
}

void append(const HeightBin& bin, const MapLattice& lattice, const Column& column, bool in_pairs,
            bool even, Points& points) {
  if (bin.count == 1) {
    column.add(bin, lattice, 0.0F, 0.0F, 0.0F, points);
  } else if (bin.count == 2 || in_pairs || is_flat(bin)) {
    // Two points have all their spread along the line through both. Cells beside each other
    // take turns between the diagonals.
    append_pair(bin, lattice, column, bin.count == 2 || even ? 1.0F : -1.0F, points);
  } else {
    append_simplex(bin, lattice, column, points);
  }
}

}  // namespace

void append_remembered(const FusedSnapshot& map, const WindowFrame& frame,
                       const FusionParams& params, std::size_t measured,
                       RememberedWorkspace& workspace, Points& points) {
  WindowFrame whole = frame;
  whole.max_height = std::numeric_limits<double>::max() / 4.0;
  read_window(map, whole, params, workspace.grid, workspace.cells);
  count_hits(frame, points, measured, workspace.hits);
  const ShiftedGround ground(map, frame, workspace);
  const double oldest =
      params.max_age > 0.0 ? map.time - params.max_age : std::numeric_limits<double>::lowest();
  const auto half = static_cast<float>(0.499 * frame.geometry.cell_size());
  for (std::size_t slot = 0; slot < workspace.grid.observed(); ++slot) {
    const CellId id = workspace.grid.cell[slot];
    const CellIndex at = frame.geometry.index_of(id);
    const Position2 centre = frame.geometry.centre_of(at);
    const Column column{static_cast<float>(centre.x), static_cast<float>(centre.y), half, frame.z};
    const CellHits& hits = workspace.hits[static_cast<std::size_t>(value_of(id))];
    const bool enough = hits.points >= kEnough;
    const MapCell where = frame.map_cell_of(at);
    const Tile& tile = *map.tiles.find(tile_of(where));
    for_each_bin(tile, place_in_tile(where), [&](const HeightBin& bin) {
      const bool now = bin.last_seen >= map.time;
      if (bin.last_seen < oldest || (now && (enough || bin.scans <= 1))) return;
      if (ground.is_shifted(bin, at, hits)) return;
      const double top = map.lattice.bottom_of(bin.layer) + double{bin.z_max} - frame.z;
      if (top < static_cast<double>(workspace.grid.h_min[slot]) - kRounding) return;
      const double bottom = map.lattice.bottom_of(bin.layer) - frame.z;
      const bool upright = bottom > static_cast<double>(workspace.grid.h_min[slot]) + kUpright;
      append(bin, map.lattice, column, upright, ((where.i + where.j) & 1) == 0, points);
    });
  }
}

}  // namespace mrpt_terrain
