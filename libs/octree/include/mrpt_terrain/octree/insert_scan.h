// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mrpt_terrain/octree/free_cells.h"

/// \file
/// Insertion of a whole scan into an `octomap::OcTree`, with the same tree as OctoMap 1.9.7's
/// `insertPointCloud(cloud, origin, max_range, lazy_eval = false, discretize)` leaves.
///
/// A scan frees the cells that its rays cross and occupies the cells that they end in; where both
/// happen, the cell is occupied. Each cell gets one update per scan. With several origins, the
/// cells of all rays are united before, so that this still holds for the scan as a whole. With
/// guarded cells, which OctoMap does not have, the tree is another one.
namespace mrpt_terrain::octree {

/// Where the rays of a scan end: three parallel arrays of coordinates, metres, frame of the tree.
/// Borrowed.
struct RayEnds {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t size = 0;
};

/// Where the rays of a scan start: one place for all, or one of several for each (a moving sensor).
/// Borrowed.
struct RayOrigins {
  const std::array<float, 3>* origins = nullptr;  ///< metres, frame of the tree; at least one
  std::size_t size = 0;                           ///< number of origins
  const std::uint32_t* origin_of = nullptr;       ///< per ray: its origin; null: all the first
};

/// Cells above each other that hold ground. Rays that graze it cross its cells above the surface,
/// and would free them. A scan leaves them as they are, unless it frees all cells from `below` up
/// to `low` too, or they are known to be free: then there is no surface any more. Where a ray ends
/// in a guarded cell that is free, the cell was freed by rays that grazed it before anybody knew of
/// the ground: that is forgotten (log-odds of 0) before the hit counts.
struct GuardedCells {
  std::uint16_t x = 0, y = 0;       ///< OctoMap key of the column
  std::uint16_t low = 0, high = 0;  ///< keys along z of the ground's lowest and highest cell
  std::uint16_t below = 0;          ///< key along z; not guarded if it is not less than `low`
};

struct InsertionOptions {
  /// Metres. Longer rays free cells up to this length and occupy none. Negative: no limit.
  double max_range = -1.0;
  /// Rays with the same origin that end in the same cell become one, to the centre of the cell.
  bool discretize = false;
  /// Borrowed; null: none, as in OctoMap.
  const std::vector<GuardedCells>* guarded = nullptr;
};

/// Who updated the tree.
enum class Inserter : std::uint8_t {
  kOwn,      ///< this library
  kOctomap,  ///< OctoMap's own functions, slowly: see `is_supported`
};

/// What became of a scan. Rays of the first two kinds are left out.
struct InsertionResult {
  Inserter inserter = Inserter::kOwn;
  std::size_t non_finite = 0;  ///< rays with a coordinate that is not finite, at either end
  /// Rays that end outside the 2^16 cells per axis that a tree has. With `discretize` they are left
  /// out; without, they free cells if they are cut at `max_range`, as in OctoMap.
  std::size_t out_of_range = 0;
  std::size_t rays = 0;  ///< rays whose cells were marked, after joining those of one cell
  std::size_t kept = 0;  ///< cells that were crossed and not freed, because they are guarded
};

/// A cube of cells that were occupied before the scan and are not any more.
struct FreedCube {
  std::array<std::uint16_t, 3> key{};  ///< OctoMap key of the cell with the lowest coordinates
  std::uint16_t cells = 1;             ///< length of an edge, cells
};

/// Memory that insertions use again; holds nothing that matters from scan to scan. One per thread.
class InsertionWorkspace {
 public:
  InsertionWorkspace();
  ~InsertionWorkspace();
  InsertionWorkspace(InsertionWorkspace&&) noexcept;
  InsertionWorkspace& operator=(InsertionWorkspace&&) noexcept;

  struct Memory;
  [[nodiscard]] Memory& memory() { return *memory_; }

 private:
  std::unique_ptr<Memory> memory_;
};

/// Whether scans are inserted into the tree by this library. It leaves to OctoMap: trees with a
/// bounding box limit or change detection, classes derived from `octomap::OcTree`, and
/// probabilities of 0 or 1, whose log-odds are infinite.
[[nodiscard]] bool is_supported(const octomap::OcTree& tree);

/// Inserts a scan.
/// \param[out] freed if given: cells that went from occupied to free, in no particular order;
/// cleared first. Needs a supported tree: with OctoMap's own functions it stays empty.
/// \param[in,out] free if given: the free cells of the tree, before and after
InsertionResult insert_scan(const RayEnds& ends, const RayOrigins& origins,
                            const InsertionOptions& options, InsertionWorkspace& workspace,
                            octomap::OcTree& tree, std::vector<FreedCube>* freed = nullptr,
                            FreeCells* free = nullptr);

}  // namespace mrpt_terrain::octree
