// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/beam_plane.h"
#include "mrpt_terrain/core/cell_bits.h"
#include "mrpt_terrain/core/clusters.h"
#include "mrpt_terrain/core/field_cells.h"
#include "mrpt_terrain/core/grid_geometry.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What counts as a hole in the ground: pothole or ditch.
struct HoleParams {
  double least_depth = 0.03;  ///< metres below the rim from which a cell may belong to a hole
  double mean_depth = 0.035;  ///< metres: least depth of a hole
  int least_points = 6;       ///< fewest points on its floor
  double rim_depth = 0.15;    ///< greatest spread of the rim about its surface, over the depth
  double rings_depth = 0.25;  ///< the same where two rings or more show the floor
  double uneven_depth = 0.2;  ///< greatest spread of the rim without the noise, over the depth
  double wall_share = 0.45;   ///< most points between rim and floor, over those on the floor
  double walled = 0.4;        ///< least share of the floor's points in traces that end at walls
  double closed = 0.95;       ///< least share of the surroundings that are seen and are rim
  double seen = 0.4;          ///< least share of the surroundings that are seen
  double widest = 3.0;        ///< metres: greatest extent across

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.least_depth, ParamInfo{"least_depth", "", "m", 0.005, 5.0,
                                      "depth from which a cell may belong to a hole"});
    visit(self.mean_depth, ParamInfo{"mean_depth", "", "m", 0.005, 5.0,
                                     "least depth of a hole, which a fifth of its points exceed"});
    visit(self.least_points,
          ParamInfo{"least_points", "", "", 1, 1000000, "holes of fewer points are left out"});
    visit(self.rim_depth,
          ParamInfo{"rim_depth", "", "", 0.0, 1.0,
                    "greatest spread of the rim about its surface, over the depth"});
    visit(self.rings_depth, ParamInfo{"rings_depth", "", "", 0.0, 1.0,
                                      "the same where two rings or more show the floor"});
    visit(self.uneven_depth,
          ParamInfo{"uneven_depth", "", "", 0.0, 1.0,
                    "greatest spread of the rim without the noise, over the depth"});
    visit(self.wall_share,
          ParamInfo{"wall_share", "", "", 0.0, 100.0,
                    "where origins of beams are unknown: most points between rim and floor, over "
                    "those on the floor"});
    visit(self.walled,
          ParamInfo{"walled", "", "", 0.0, 1.0,
                    "least share of the floor's points in traces of a ring that end at walls"});
    visit(self.closed, ParamInfo{"closed", "", "", 0.0, 1.0,
                                 "least share of rim in what is seen around a hole"});
    visit(self.seen,
          ParamInfo{"seen", "", "", 0.0, 1.0, "least share of what is seen around a hole"});
    visit(self.widest,
          ParamInfo{"widest", "", "m", 0.1, 100.0, "greatest extent of a hole across"});
  }
};

/// Leaves no rows, and keeps the memory.
inline void clear_rows(IndexRows& rows) {
  rows.first.assign(1, 0);
  rows.items.clear();
}

/// How a hole shows itself.
enum class HoleKind : std::uint8_t {
  kFloor = 0,  ///< its floor is seen between walls
  kGap,        ///< ditch: rings come down farther and lower than the ground before goes on, and
               ///< behind it goes on
  kDrop,       ///< the ground ends: what is behind is lower, or nothing comes back
  kFreeSpace,  ///< beams have passed below the ground
};
constexpr EnumNames<HoleKind, 4> enum_names(HoleKind) {
  return {{{HoleKind::kFloor, "floor"},
           {HoleKind::kGap, "gap"},
           {HoleKind::kDrop, "drop"},
           {HoleKind::kFreeSpace, "free_space"}}};
}

/// A hole as it was found. Metres, frame of the scan.
struct HoleDescription {
  Position2 centre;     ///< mean of its floor's points; of other kinds: of what is missing
  double length = 0.0;  ///< along its longer axis; of a rectangle with the cells' moments
  double width = 0.0;   ///< across: of a drop, how far the ground is known to be missing
  double depth = 0.0;   ///< below the rim, a lower bound: what was seen of it; 0: nothing
  /// 0 to 1: product of the shares of the surroundings that are seen, and of these that are rim, of
  /// the floor's points between walls, and of the depth that the rim's spread is not. Of other
  /// kinds: doc/field-mode.md.
  double confidence = 0.0;
  std::int32_t points = 0;  ///< on the floor
  std::int32_t rings = 0;   ///< that show the floor between two walls; 0: origins unknown
  std::int32_t slot = -1;   ///< one of its cells; -1: none was observed
  HoleKind kind = HoleKind::kFloor;
};

/// Sums over the ground in a cell of the rim's level.
struct RimSums {
  float sum = 0.0F, weight = 0.0F;
};

/// Mean height of the ground about a cell of the rim's level; weight 0: there is none.
struct RimMean {
  float height = 0.0F, weight = 0.0F;
};

/// Height of the rim at the centre of a cell, and how it changes in it.
struct RimBase {
  float height = 0.0F, gradient_x = 0.0F, gradient_y = 0.0F;
};

/// Where a point lies with respect to a hole.
enum class HoleZone : std::uint8_t {
  kFar = 0,  ///< towards the sensor: only rings are followed there
  kRim,      ///< around
  kNear,     ///< in a cell next to one of the hole
  kFloor     ///< in a cell of the hole
};

/// A point in or around a hole.
struct HolePoint {
  float x, y, z;       ///< metres
  std::int32_t index;  ///< in the scan
  std::int32_t slot;   ///< of the grid
  float depth;         ///< metres below the rim
  HoleZone zone;
};

/// A point as its beam has it, for following rings.
struct RingPoint {
  double azimuth, elevation;  ///< radians, azimuth about that of the hole
  float range;                ///< horizontal, metres
  float depth;                ///< metres below the rim
  std::int32_t next;          ///< on the same ring, or -1
  std::uint8_t state;         ///< rim, between, floor or other low ground
  bool has_before;            ///< on the same ring
};

/// Points around a hole for the fit of its rim, about some origin; metres. The arrays are at least
/// as long as there are points.
struct RimPoints {
  std::size_t size = 0;
  std::vector<double> u, v, z;
  std::vector<double> weight;   ///< 0 to 1
  std::vector<double> counted;  ///< weight in the present round; 0 for points that do not count
  std::vector<double> low;      ///< depth below the surface so far

  void reserve(std::size_t n) {
    if (n <= u.size()) return;
    for (auto* values : {&u, &v, &z, &weight, &counted, &low}) values->resize(n);
  }
  /// The weight is still to come.
  /// \param share of it that counts in the first round: 1, or 0
  void add(double pu, double pv, double pz, double share) {
    u[size] = pu;
    v[size] = pv;
    z[size] = pz;
    counted[size] = share;
    ++size;
  }
};

/// Cells that may be of a hole.
struct HoleCandidates {
  std::vector<std::int32_t> slots;  ///< of all that have been added
  CellBits left;                    ///< those that are still to be looked at

  void clear(const GridGeometry& geometry) {
    slots.clear();
    left.clear(geometry);
  }
  void add(std::size_t slot, CellIndex cell) {
    slots.push_back(static_cast<std::int32_t>(slot));
    left.mark(cell);
  }
};

/// Scratch memory of `find_holes`.
struct HoleWorkspace {
  std::vector<RimSums> sums;            ///< per cell of the rim's level
  std::vector<RimMean> around;          ///< per cell of the rim's level
  std::vector<float> height;            ///< per slot of the surface: low height above level 3
  std::vector<RimBase> base;            ///< per slot of the surface
  HoleCandidates floor, edges;          ///< cells of floor, and of the edges of holes
  HoleCandidates deeper;                ///< cells of floor that are to be looked at again
  std::vector<HoleZone> zone;           ///< per slot of the grid; kFar between holes
  std::vector<std::int32_t> zoned;      ///< slots that have another one
  std::vector<std::int32_t> members;    ///< slots of one hole
  std::vector<std::int32_t> deep, all;  ///< per slot: deep points and points, where looked at
  std::vector<std::size_t> places;      ///< of points, in the order of the surface's cells
  std::vector<HolePoint> points;        ///< in and around the members
  RimPoints rim_points;
  std::vector<RingPoint> rings;          ///< the same points by azimuth
  std::vector<RingPoint> sorted_rings;   ///< for sorting these
  std::vector<std::int32_t> first_ring;  ///< the same
  std::vector<float> values;             ///< for medians and the like
  std::vector<std::uint8_t> stray;       ///< per point of the scan: its own beam speaks against it
};

/// What holes are looked for in; all borrowed.
struct HoleInput {
  const FieldWorkspace& field;
  const ElevationGrid& grid;
  const BeamOrigins& origins;  ///< of the scan's points; may be unknown
};

/// Looks for holes whose floor is seen. First, low cells are taken back whose points are few, or
/// reflections: their beams would have passed through ground that was seen.
///
/// The height of the rim is the mean of the ground within about 1.2 m, which the ground reference,
/// that goes down into holes, is compared with; ground that lies low does not count in it. Cells
/// that lie below the rim, up to two cells apart, and where there are none, those of which the
/// lowest point does and the mean half as far, are a hole if they lie deep below a surface
/// through the ground around, if that surface is even, if what is seen around them is rim on all
/// sides, and if their walls are steep: if the traces of the rings over the floor end abruptly at
/// the rim, left and right. Where one does, others may run along a wall. Wide dips of rolling
/// ground end gradually, and the foot of a step has a rim on one side only.
/// \param[in,out] cells `rim` is filled in
/// \param[in,out] ground cells of holes become `GroundRule::kLow`
/// \param[out] holes one entry per hole, in the order of their first cells; after those of cells of
/// floor, those of cells of edges
/// \param[out] hole_cells a row per hole: its cells, `CellId` numbers, ascending
void find_holes(const HoleInput& input, const HoleParams& params, HoleWorkspace& workspace,
                FieldCells& cells, GroundSegmentation& ground, std::vector<HoleDescription>& holes,
                IndexRows& hole_cells);

}  // namespace mrpt_terrain
