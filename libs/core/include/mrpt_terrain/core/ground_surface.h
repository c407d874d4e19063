// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/cell_points.h"
#include "mrpt_terrain/core/height_sums.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/scan_view.h"

/// \file
/// The local ground reference of field mode: a height of the ground for every place around the
/// robot, from one scan. doc/field-mode.md explains the steps with their sources.
namespace mrpt_terrain {

/// How the ground is told from what stands on it. Lengths are metres.
struct GroundSurfaceParams {
  double reach = 102.4;    ///< the reference covers a square of twice this side about the robot
  double cell_size = 0.4;  ///< of the finest level
  double max_tilt = 0.6108652381980153;  ///< of the ground under the robot in its frame, radians
  double max_offset = 0.6;               ///< of the ground under the robot from z = 0
  double low_band = 0.06;    ///< points this far above the lowest of a cell give its low height
  double low_part = 0.4;     ///< points this far above the lowest of a cell tell how rough it is
  double tolerance = 0.05;   ///< of low heights above the reference, on every level
  double bend = 0.12;        ///< the same per metre of a level's cell: how far ground rises in it
  double rough_bend = 0.3;   ///< share of `bend` that rough cells are given
  double dip = 2.0;          ///< tolerance of heights below the reference over that above
  double low_weight = 20.0;  ///< weight of a low height below the reference over one above
  double smooth_sigma = 0.035;   ///< roughness at which a cell counts half
  double firm_sigma = 0.005;     ///< the same among smooth ones, of surfaces that beams graze...
  double beam_sigma = 0.04;      ///< ...and of noise along the beams: what they enter has more
  double grazed_sigma = 0.0025;  ///< roughness of ground, seen along beams that graze it
  double rough_weight = 0.8;     ///< how little rough cells count between smooth ones
  double loose_rise = 0.08;      ///< what scatters along beams, among what does not, rises by less
  double hold = 1.0;             ///< weight of the coarser level, in cells

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.reach, ParamInfo{"reach", "", "m", 5.0, 400.0,
                                "the reference covers this distance to all four sides"});
    visit(self.cell_size,
          ParamInfo{"cell_size", "", "m", 0.1, 2.0, "cells of the reference at its finest"});
    visit(self.max_tilt, ParamInfo{"max_tilt_deg", "", "deg", 0.0, 45.0,
                                   "greatest tilt of the ground under the robot in its frame"});
    visit(self.max_offset, ParamInfo{"max_offset", "", "m", 0.0, 10.0,
                                     "greatest height of the ground under the robot"});
    visit(self.low_band,
          ParamInfo{"low_band", "", "m", 0.001, 1.0,
                    "points this far above the lowest of a cell give its low height"});
    visit(self.low_part,
          ParamInfo{"low_part", "", "m", 0.01, 5.0,
                    "points this far above the lowest of a cell tell how rough it is"});
    visit(self.tolerance, ParamInfo{"tolerance", "", "m", 0.005, 1.0,
                                    "low heights this far above the coarser level are ground"});
    visit(self.bend,
          ParamInfo{"bend", "", "m/m", 0.0, 2.0, "and this much more per metre of a cell"});
    visit(self.rough_bend,
          ParamInfo{"rough_bend", "", "", 0.0, 1.0, "share of bend that rough cells are given"});
    visit(self.dip, ParamInfo{"dip", "", "", 0.1, 100.0,
                              "the same below the coarser level, over that above"});
    visit(self.low_weight, ParamInfo{"low_weight", "", "", 1.0, 1000.0,
                                     "weight of heights below the reference over those above"});
    visit(self.smooth_sigma,
          ParamInfo{"smooth_sigma", "", "m", 0.001, 1.0, "roughness at which a cell counts half"});
    visit(self.firm_sigma, ParamInfo{"firm_sigma", "", "m", 0.001, 1.0,
                                     "the same among smooth cells, where beams graze the ground"});
    visit(self.beam_sigma, ParamInfo{"beam_sigma", "", "m", 0.001, 10.0,
                                     "and this much more along the beams: grass has more"});
    visit(self.grazed_sigma, ParamInfo{"grazed_sigma", "", "m", 0.0, 1.0,
                                       "across the ground, over the sine of the angle at which "
                                       "beams meet it, what it scatters them by"});
    visit(self.rough_weight,
          ParamInfo{"rough_weight", "", "", 0.0, 100.0,
                    "how little rough cells count between smooth ones; 0: as much as smooth ones"});
    visit(self.loose_rise, ParamInfo{"loose_rise", "", "m", 0.0, 10.0,
                                     "what is loose between firm cells, and higher above the "
                                     "coarser level than this, stands on the ground"});
    visit(self.hold, ParamInfo{"hold", "", "", 0.001, 100.0,
                               "weight of the coarser level in the mean, in cells"});
  }
};

/// What the points of an occupied cell say of the ground in it. Metres, frame of the scan.
struct GroundCell {
  float low = 0.0F;        ///< mean height of the points of its low band
  float points = 0.0F;     ///< how many they are
  float smooth = 0.0F;     ///< 0 to 1: of roughness, what beams' noise explains taken off
  float weight = 0.0F;     ///< of `low` in the reference, 0 to 1
  float most_rise = 0.0F;  ///< it lifts no level on which it is more than this above
};

/// The ground as a height over x and y. Frame of the scan, metres.
struct GroundSurface {
  /// Plane of the ground near the robot: z = gradient_x x + gradient_y y + offset.
  float gradient_x = 0.0F, gradient_y = 0.0F, offset = 0.0F;
  /// Variance of noise along the beams over what `beam_sigma` and `grazed_sigma` allow for, at
  /// least 1: noisier sensors have more.
  float beam_noise = 1.0F;
  CellPoints cells;                ///< the points, cell by cell
  std::vector<GroundCell> ground;  ///< per slot of `cells`
  std::vector<float> node;         ///< per cell of the lattice: height at its centre
  std::vector<float> height;       ///< per point of `cells`: above the reference

  [[nodiscard]] const SquareLattice& lattice() const { return cells.lattice; }
  /// Height of the ground; beyond the lattice that of its edge.
  [[nodiscard]] float height_at(float x, float y) const;
};

/// Levels of the reference; each has cells twice as large as those of the one below it.
inline constexpr int kSurfaceLevels = 7;

/// Weighted sum of differences between low heights and a level.
struct WeightedSum {
  float sum = 0.0F, weight = 0.0F;
};

/// Columns of a row, first to last; none where `last < first`.
struct ColumnRange {
  std::int32_t first, last;

  void include(std::int32_t column) {
    first = std::min(first, column);
    last = std::max(last, column);
  }
  void include(const ColumnRange& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

/// What the cells say of the ground, as a level hears it; entries per slot as in `GroundCell`.
struct HeardCells {
  std::vector<float> low, points, smooth, weight;
  std::vector<float> most_rise;
  std::vector<float> doubtful;  ///< 1 beside something tall, where the level minds
};

/// Between which two centres of a level the centre of a cell lies, and how far towards the second.
struct LevelStep {
  std::int32_t first;
  float share;
};

/// Scatter of the points of a cell about their mean.
struct CellScatter {
  FourFloats squares{};   ///< sums of xx, yy and zz; degrees of freedom
  FourFloats products{};  ///< sums of xy, xz and yz; the fourth means nothing

  [[nodiscard]] float freedoms() const { return squares[3]; }
};

/// Points of cells that remain without those below ground that their beams would have passed
/// through.
struct BuriedInCells {
  /// Some points of a cell, `[first, last)` of `kept`.
  struct Cell {
    std::int32_t slot, first, last;
  };
  std::vector<Cell> cells;      ///< in the order of slots
  std::vector<CellPoint> kept;  ///< frame of the scan
};

/// Scratch memory of `find_ground_surface`.
struct GroundSurfaceWorkspace {
  CellPointsWorkspace sort;
  std::vector<HeightSums> sums;  ///< per slot: low points, about the cell's centre and the lowest
  std::vector<CellScatter> scatter;  ///< per slot: the same points
  std::vector<float> lowest;         ///< per slot: height of the lowest point
  std::vector<float> part;           ///< per slot: share of the low band
  std::vector<float> seen;           ///< per slot: height at which it shows ground, if it does
  BuriedInCells buried;
  std::vector<std::uint8_t> beside_tall;  ///< per slot: 1 where something tall stands nearby
  std::vector<std::uint8_t> in_ditch;     ///< per slot: 1 in a ditch, which levels do not follow
  std::vector<float> above_plane;         ///< per slot: low height above the plane
  std::vector<float> block_tops;          ///< per block of cells: highest smooth one
  std::vector<float> block_sides;         ///< per block: how high the sides of a ditch may be
  std::vector<std::uint64_t> layers, layers_in_row;  ///< per block of cells: a bit per height
  std::vector<float> even;                           ///< per slot: smoothness by roughness alone
  std::vector<float> firm;   ///< per slot: smoothness by scatter across the surface
  std::vector<float> solid;  ///< per slot: smoothness by scatter along the beams
  std::array<std::vector<float>, kSurfaceLevels> level;  ///< heights at the centres of cells
  std::vector<LevelStep> step;                           ///< per row, or column, of the lattice
  HeardCells heard;
  std::vector<float> difference, weight;  ///< per slot: low height less the level, how it counts
  /// Per cell of a level and of a frame about it, all zero between levels: sums of the cell alone,
  /// and of it and, less, those around it.
  std::vector<WeightedSum> cell_sums;
  std::vector<float> spread_sum, spread_weight;
  std::vector<std::int32_t> touched;  ///< the first `touched_cells`: where `cell_sums` are not 0
  std::size_t touched_cells = 0;
  std::vector<ColumnRange> ranges;  ///< per row of the sums
  std::vector<float> mixed;         ///< for a moment: a row, shares or tolerances
  std::vector<float> share, count;  ///< per cell of level 4
  std::vector<float> candidate_x, candidate_y, candidate_z;  ///< for the plane
};

/// Finds the ground that the points of a scan show.
///
/// A plane near the robot is refined on seven levels of cells, from 64 cells down to one: on every
/// level, the low heights of the cells that lie within a tolerance of the reference so far are
/// averaged and carried on to the next. Heights below the reference count more than those above
/// it, smooth cells more than rough ones, cells with points over their low band less. Among smooth
/// cells, those count as rough that scatter more than range noise along the beams explains, and
/// those in which beams go on into what they meet lift the reference little.
///
/// Where beams begin is taken to be 1 m above the frame's origin if it is not known; if it is,
/// points do not count that beams could reach only through ground that is seen.
///
/// \param scan metres; z = 0 near the ground under the robot, up to `max_offset` and `max_tilt`
/// \param[in,out] result overwritten; keeps its memory. Without points it is the plane z = 0.
void find_ground_surface(const ScanView& scan, const GroundSurfaceParams& params,
                         GroundSurfaceWorkspace& workspace, GroundSurface& result);

}  // namespace mrpt_terrain
