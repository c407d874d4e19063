// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "mrpt_terrain/core/elevation_grid.h"
#include "mrpt_terrain/core/ground.h"
#include "mrpt_terrain/core/ground_labels.h"
#include "mrpt_terrain/core/ground_surface.h"
#include "mrpt_terrain/core/labels.h"

namespace mrpt_terrain {

/// What the points of a scan are against the local ground reference, in the order of the scan.
struct FieldPoints {
  std::vector<float> height;  ///< above the reference, metres; NaN for points that are not finite
  std::vector<Support> support;  ///< kUnknown beyond the reference
};

/// The surface of a deck at one of its cells: z = height + gradient_x (x - x0) + gradient_y (y -
/// y0), frame of the scan, metres.
struct DeckPlane {
  float x = 0.0F, y = 0.0F;  ///< x0, y0
  float height = 0.0F;
  float gradient_x = 0.0F, gradient_y = 0.0F;
  float side = 0.0F;  ///< points this far below it are of the deck's side

  [[nodiscard]] float at(float px, float py) const {
    return height + gradient_x * (px - x) + gradient_y * (py - y);
  }
};

/// The observed cells of a grid against the local ground reference; arrays over its slots. Heights
/// are metres above the reference.
struct FieldCells {
  std::vector<float> ground;        ///< height of the reference at the cell's centre, grid frame
  std::vector<std::int32_t> on;     ///< points on the ground
  std::vector<std::int32_t> above;  ///< points above it and below `GridParams::max_height`
  std::vector<std::int32_t> below;  ///< points below it
  std::vector<float> low;           ///< lowest point above the ground; 0 without
  std::vector<float> high;          ///< highest of them; 0 without
  std::vector<float> floor;  ///< mean height of the points on and below the ground, grid frame
  std::vector<std::int32_t> deck;     ///< number of the deck that the points above are, or -1
  std::vector<DeckPlane> deck_plane;  ///< where `deck` >= 0: its surface
  std::vector<float> rim;             ///< height of the ground around the cell, grid frame
  std::vector<std::int32_t>
      raised;                     ///< points on the ground that stand out of it (raised_ground.h)
  std::vector<float> raised_low;  ///< of these, above the ground around, metres; 0 without
  std::vector<float> raised_high;
  /// Of the cells beside that are ground around: how many lie less than half as high as a raised
  /// cell, and how many do not. A smooth swell of the ground has edges of the latter kind only.
  std::vector<std::int8_t> sharp_edges, smooth_edges;
  /// 1: what is above the reference in a cell is no higher than the ground around
  /// (raised_ground.h).
  std::vector<std::uint8_t> level;
  std::vector<std::uint8_t> under;  ///< 1: the points above hang, a robot fits underneath
  /// Cells have kParts x kParts parts: bit kParts i + k stands for the i-th along x and the k-th
  /// along y.
  static constexpr int kParts = 4;
  /// Parts with points above the ground or of raised ground; empty: unknown.
  std::vector<std::uint16_t> parts;

  [[nodiscard]] std::size_t size() const { return ground.size(); }
};

/// Mean point of the ground in a cell.
struct GroundSample {
  float x = 0.0F, y = 0.0F, z = 0.0F;
};

/// Sums over the points of a cell.
struct FieldCellSums {
  float x = 0.0F, y = 0.0F, z = 0.0F;  ///< of the points on the ground, frame of the scan
  float floor = 0.0F;                  ///< heights of the points on and below the ground
  float low = std::numeric_limits<float>::max(), high = 0.0F;  ///< heights of the points above it
  std::int32_t on = 0, above = 0, below = 0;                   ///< how many points they are

  /// Mean point on the ground. Requires one.
  [[nodiscard]] GroundSample mean_on_ground() const {
    const auto n = static_cast<float>(on);
    return {x / n, y / n, z / n};
  }
};

/// Scratch memory of field mode's ground stages.
struct FieldWorkspace {
  GroundSurfaceWorkspace surface_workspace;
  GroundSurface surface;
  GroundLabelWorkspace label_workspace;
  std::vector<float> threshold;
  std::vector<Support> support;  ///< in the order of the surface's cells
  FieldPoints points;
  std::vector<FieldCellSums> sums;  ///< per slot of the grid
};

/// Finds the ground reference and labels the points by it.
void find_field_ground(const ScanView& scan, const GroundSurfaceParams& surface,
                       const GroundLabelParams& labels, FieldWorkspace& workspace);

/// Counts the points of every cell by their support. A cell is non-ground (C_N) if it holds a point
/// above or below the ground.
/// \param points of the scan
/// \param[in,out] workspace what `find_field_ground` found of the scan; the sums are filled in
/// \param point_slots of the grid that `build_elevation_grid` made of the same scan
/// \param[out] ground rule kHigh or kLow in C_N; h_mean above the reference
void measure_field_cells(const PointsView& points, FieldWorkspace& workspace,
                         const ElevationGrid& grid, const PointSlots& point_slots,
                         FieldCells& cells, GroundSegmentation& ground);

}  // namespace mrpt_terrain
