// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/free_space.h"
#include "mrpt_terrain/core/fused_tile.h"
#include "mrpt_terrain/core/map_lattice.h"
#include "mrpt_terrain/core/moments.h"
#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/core/tile_tree.h"

/// \file
/// The fused grid: an elevation grid over many scans with poses, anchored to the map. What a cell
/// knows lies in height bins with statistics of their own, so that it can forget; the rules and
/// their reasons are in doc/fusion.md.
namespace mrpt_terrain {

/// What becomes of cells that the robot leaves behind.
enum class FusionExtent : std::uint8_t {
  kRolling = 0,  ///< they are forgotten when they leave the window around the robot
  kGrowing,      ///< they stay
};
constexpr EnumNames<FusionExtent, 2> enum_names(FusionExtent) {
  return {{{FusionExtent::kRolling, "rolling"}, {FusionExtent::kGrowing, "growing"}}};
}

/// Parameters of the fused grid. Cell and layer cannot change while a grid lives.
struct FusionParams {
  double cell_size = 0.2;     ///< side of a cell, metres
  double layer_height = 0.2;  ///< height of a bin, metres: the resolution of the octree beside it
  FusionExtent extent = FusionExtent::kRolling;
  double length = 100.0;     ///< of the rolling window along x, metres
  double width = 100.0;      ///< of the rolling window along y, metres
  double roll_step = 1.0;    ///< metres that the robot may be off the window's centre, along x or y
  double max_range = 70.0;   ///< points farther away along x or y are left out, metres
  double max_height = 4.0;   ///< points so high above the robot's ground are left out, metres
  double min_height = -8.0;  ///< points below are left out, metres
  int renew_scans = 10;      ///< scans after which a layer's newer bin replaces the older; 0: never
  double max_age = 0.0;      ///< bins not seen for so long are forgotten, seconds; 0: never
  double guard_height = 0.25;  ///< metres: see `apply_free_space`
  double ground_reach = 0.8;   ///< metres: see `apply_free_space`
  int guard_scans = 5;         ///< see `apply_free_space`; 0: never
  double clearance = 2.0;      ///< least free height below what hangs over the ground, metres
  double least_share = 0.05;   ///< of the points of the fullest bin: fewer are no ground
  double spread_limit = 3.0;   ///< standard deviations beyond which extremes are cut in the window
  double points_cover = 0.5;   ///< share of a cluster's cells that the current scan must hit

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.cell_size, ParamInfo{"cell_size", "", "m", 0.01, 10.0, "side of a cell"});
    visit(self.layer_height, ParamInfo{"layer_height", "", "m", 0.01, 10.0,
                                       "height of the layers that are forgotten as a whole; the "
                                       "resolution of the octree beside the grid"});
    visit(self.extent, ParamInfo{"extent", "", "", 0, 0,
                                 "rolling: a window around the robot; growing: all that was seen"});
    visit(self.length,
          ParamInfo{"length", "", "m", 1.0, 10000.0, "extent of the rolling window along x"});
    visit(self.width,
          ParamInfo{"width", "", "m", 1.0, 10000.0, "extent of the rolling window along y"});
    visit(self.roll_step, ParamInfo{"roll_step", "", "m", 0.0, 1000.0,
                                    "how far the robot may leave the window's centre before the "
                                    "window follows"});
    visit(self.max_range, ParamInfo{"max_range", "", "m", 1.0, 1000.0,
                                    "points farther from the robot along x or y are left out"});
    visit(self.max_height, ParamInfo{"max_height", "", "m", -100.0, 1000.0,
                                     "points at this height over the robot's ground or above are "
                                     "left out"});
    visit(self.min_height, ParamInfo{"min_height", "", "m", -1000.0, 100.0,
                                     "points below this height over the robot's ground are left "
                                     "out"});
    visit(self.renew_scans, ParamInfo{"renew_scans", "", "", 0, 120,
                                      "a layer knows the last one to two times so many scans that "
                                      "hit it; 0: all"});
    visit(self.max_age, ParamInfo{"max_age", "", "s", 0.0, 1e9,
                                  "heights that were not seen for longer are forgotten; 0: never"});
    visit(
        self.guard_height,
        ParamInfo{"guard_height", "", "m", 0.0, 10.0,
                  "heights so close to the ground of their cell are guarded against grazing rays"});
    visit(self.ground_reach, ParamInfo{"ground_reach", "", "m", 0.0, 10.0,
                                       "how far around a cell without ground of its own the ground "
                                       "is looked for"});
    visit(self.guard_scans, ParamInfo{"guard_scans", "", "", 0, 255,
                                      "scans that have to see the cell and free the layer until a "
                                      "guarded height above the ground is forgotten; 0: never"});
    visit(self.clearance, ParamInfo{"clearance", "", "m", 0.1, 100.0,
                                    "free height from which what is above hangs over the ground "
                                    "and is not part of it"});
    visit(self.least_share,
          ParamInfo{"least_share", "", "", 0.0, 1.0,
                    "layers with a smaller share of the points of the fullest "
                    "layer of the cell, seen by fewer than 3 scans, are not taken "
                    "for its ground"});
    visit(self.spread_limit, ParamInfo{"spread_limit", "", "", 1.0, 1e6,
                                       "standard deviations from the mean of a layer beyond which "
                                       "its extremes do not count in a description"});
    visit(self.points_cover, ParamInfo{"points_cover", "", "", 0.0, 1.0,
                                       "share of a cluster's cells that the current scan has to "
                                       "hit if its slope is to come from points"});
  }
};

/// One scan with its pose.
struct PosedScan {
  PointsView points;  ///< robot frame (x forward, y left, z up, z = 0 on the ground), metres
  Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();
  double time = 0.0;  ///< stamp, seconds; later scans have later ones
};

/// The grid as it was when the snapshot was taken. Copying costs nothing that depends on the size
/// of the map; copies may be read in any thread while the grid goes on.
struct FusedSnapshot {
  MapLattice lattice;
  MapCellRect window;  ///< cells that the grid may hold; all cells of a growing grid
  TileTree tiles;
  double time = 0.0;        ///< stamp of the last scan, seconds
  std::uint64_t scans = 0;  ///< scans fused so far
};

/// The fused grid: one writer's. Not copyable; take a `snapshot()`.
class FusedGrid {
 public:
  explicit FusedGrid(const FusionParams& params)
      : FusedGrid(MapLattice(params.cell_size, params.layer_height)) {}
  explicit FusedGrid(const MapLattice& lattice) { now_.lattice = lattice; }
  FusedGrid(FusedGrid&&) = default;
  FusedGrid& operator=(FusedGrid&&) = default;

  /// The grid as it is now: valid until it is next changed. For readers in the writer's thread.
  [[nodiscard]] const FusedSnapshot& now() const { return now_; }
  /// The grid as it is now, to be kept. Tiles that it shares are copied when they are next written
  /// to: publishing costs the tiles that the following scans touch.
  [[nodiscard]] FusedSnapshot snapshot() const { return now_; }
  /// Forgets everything, the window included; keeps the lattice.
  void clear();

 private:
  friend struct FusedGridAccess;
  FusedSnapshot now_;
  TileStore store_;
};

/// How many points became what when a scan was fused; they add up to the number of points.
struct FusionCounts {
  std::size_t fused = 0;
  std::size_t not_finite = 0;
  std::size_t too_high = 0;
  std::size_t too_low = 0;
  std::size_t outside = 0;  ///< beyond `max_range` or outside the window
  std::size_t no_room = 0;  ///< their tile held more layers than it can
  std::size_t cells = 0;    ///< cells touched; not part of the sum
};

/// Points of one scan in one layer of one cell. Offsets are multiples of 2^-16 m, which makes the
/// sums exact and so independent of the order of the points.
struct ScanBin {
  MapCell cell;
  std::int32_t layer = 0;
  std::int32_t next = -1;  ///< next bin of the same cell, or -1
  float z_min = 0.0F, z_max = 0.0F;
  MomentSums sums;  ///< about the centre of the cell and the bottom of the layer
};

/// Layers that a cell has bins in.
struct CellLayers {
  MapCell cell;
  LayerSpan span;        ///< from its lowest bin to its highest; empty if it has none
  bool several = false;  ///< there are bins in more than one layer
};
[[nodiscard]] CellLayers layers_of(const Tile& tile, MapCell cell);

/// Scratch memory of `fuse_scan`; `head` is empty between calls. What the last scan hit may be read
/// from `hit`: its cells, each once and as the scan left it, in no order that means something.
struct FusionWorkspace {
  std::vector<ScanBin> bins;
  std::vector<std::int32_t> head;        ///< per cell in reach: its first bin, or -1
  std::vector<std::int32_t> cells;       ///< first bins of the cells that were hit
  std::vector<std::int32_t> by_tile;     ///< the same, tile by tile
  std::vector<std::int32_t> tile_begin;  ///< per tile in reach: where its cells begin in `by_tile`
  std::vector<CellLayers> hit;
};

/// Fuses one scan into the grid, and lets the window follow the robot if it is a rolling one.
///
/// Cost: proportional to points and cells touched (and to the cells within `max_range`, at four
/// bytes each, once, when the memory is made); to the strip that the window leaves; not to the map
/// or the way driven. Points that are not finite, too high, too low or outside are counted and
/// otherwise ignored. The result does not depend on the order of the points. The pose has to be
/// finite and within the lattice.
FusionCounts fuse_scan(const PosedScan& scan, const FusionParams& params,
                       FusionWorkspace& workspace, FusedGrid& grid);

/// Moves the window of a rolling grid: cells outside `window` are forgotten. Costs what leaves.
void move_window(const MapCellRect& window, FusedGrid& grid);

/// Forgets all bins not seen since `time`. Looks at every bin of the map.
void forget_before(double time, FusedGrid& grid);

/// Memory that a grid holds, bytes.
struct FusedMemory {
  std::size_t tiles = 0;  ///< bytes of tiles in the map, bins included
  std::size_t spare = 0;  ///< bytes kept to be used again
  std::size_t cells = 0;  ///< number of observed cells
  std::size_t bins = 0;   ///< number of bins
};
/// Looks at every tile of the map.
[[nodiscard]] FusedMemory memory_of(const FusedGrid& grid);

}  // namespace mrpt_terrain
