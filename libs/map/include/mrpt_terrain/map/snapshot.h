// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/fused_grid.h"
#include "mrpt_terrain/core/fused_window.h"
#include "mrpt_terrain/core/points.h"

namespace mrpt_terrain {

/// Whether a map knows something about a place.
enum class PlaceStatus : std::uint8_t {
  kKnown,    ///< something was seen there
  kUnknown,  ///< within the map, but never seen
  kOutside,  ///< beyond the edges of the map
};

/// What a map knows about one cell. Heights are metres in the map frame and, as the rest, mean
/// nothing unless the status is kKnown.
struct CellView {
  PlaceStatus status = PlaceStatus::kOutside;
  double height = 0.0;    ///< of its ground if scans are fused, else mean of its points
  double variance = 0.0;  ///< of the points about that height, m^2
  double lowest = 0.0;
  double highest = 0.0;
  double last_seen = 0.0;  ///< stamp of the last scan that hit it, seconds
  std::int32_t points = 0;
  Support support = Support::kUnknown;
  TerrainClass terrain_class = TerrainClass::kNone;  ///< of its cluster
  std::int32_t cluster = kNoCluster;                 ///< index into `TerrainSnapshot::clusters`
  /// Why the last scan showed no ground here: also where something else is known of the cell, and
  /// where nothing is (status kUnknown). kSeen beyond the window, and where nobody tells: in paper
  /// mode and with `fusion = rolling`.
  UnseenReason unseen = UnseenReason::kSeen;
};

/// Axis-parallel rectangle in the map frame, metres.
struct MapBox {
  Position2 min, max;
};

/// One thing in the terrain as the map knows it.
struct ClusterView {
  ClusterDescription description;  ///< features and class; positions in the window's frame
  /// The same from scan to scan as long as the thing overlaps its place of before; never reused.
  /// In field mode that of a `ThingTracker`, which also finds things again that were hidden for a
  /// while; `description.identity` is the same.
  std::uint64_t identity = 0;
  /// Share of the cluster's points in [0, 1] that is enough for its features: n / (n + 30).
  double confidence = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of its points, map frame, metres
  MapBox box;                                        ///< about its cells, map frame
};

/// Scratch memory for the costs of a map's snapshots, which any thread may compute.
class CostScratch {
 public:
  /// Memory that was used before, if nobody else uses it now.
  [[nodiscard]] std::unique_ptr<CostWorkspace> take();
  void give_back(std::unique_ptr<CostWorkspace> workspace);

 private:
  std::mutex mutex_;
  std::unique_ptr<CostWorkspace> spare_;
};

/// What a map knew after one insertion. It never changes; whoever holds it may read it while the
/// map goes on, in any thread. It is handed on, not copied.
///
/// **Costs** are derived from the description when somebody first asks for them: `costs`,
/// `cost_at`, `footprint_cost_at`, and what a map draws in the colours of costs, saves or converts
/// to an occupancy grid. Who asks first takes the time (doc/costs.md); who asks meanwhile waits for
/// it; insertion, `cell_at`, `clusters_in`, likelihoods and stored maps do without. They are the
/// same whoever asks, and end with the snapshot. Asking may throw std::bad_alloc: the next one to
/// ask tries again. With `fusion = scan` in field mode they need the points' heights, which are
/// known during the insertion alone, and are computed there.
///
/// The description lies in the frame of a *window*. With `fusion = scan` that is the robot's frame
/// at the time of the scan; with `fusion = rolling` it is parallel to the map, with the robot near
/// its origin and z = 0 at the robot's ground.
class TerrainSnapshot {
 public:
  std::uint64_t revision = 0;  ///< number of insertions that the map has taken; 0: empty
  double stamp = 0.0;          ///< of the last scan, seconds since the Unix epoch; NaN: unknown
  Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();  ///< at the last scan
  Eigen::Isometry3d T_map_window = Eigen::Isometry3d::Identity();
  Description description;  ///< of the window
  Points points;            ///< those of the last scan, robot frame
  /// Origins of its rays, robot frame, and per point its origin (empty: all the first one).
  std::vector<std::array<float, 3>> ray_origins;
  std::vector<std::uint32_t> origin_of;
  std::vector<ClusterView> clusters;  ///< one per `description.things`, same numbers
  RobotParams robot;                  ///< that the costs are for

  /// With `fusion = rolling`: all cells of the map, also those beyond the window, how they are
  /// read, and what else is known of the window's (per slot). Empty with `fusion = scan`.
  FusedSnapshot fused;
  FusionParams fusion;
  WindowCells window_cells;

  /// The cell that holds (x, y) of the map. Where the window is tilted, the place is the one of its
  /// plane z = 0 that lies above or below. Fused cells beyond the window are known without support,
  /// class and cluster.
  [[nodiscard]] CellView cell_at(double x, double y) const;

  /// Per slot of the description's grid; `CellCosts::unseen` per cell of it. Computed by the first
  /// call, as said above; later ones only look whether that is done.
  [[nodiscard]] const CellCosts& costs() const;
  /// The same as far as they are computed already, else null.
  [[nodiscard]] const CellCosts* known_costs() const;

  /// Cost of being at (x, y) of the map, looking along `heading` (radians from the map's x).
  [[nodiscard]] Cost cost_at(double x, double y, double heading) const;
  /// The same for the worst heading.
  [[nodiscard]] Cost cost_at(double x, double y) const;
  /// Cost of standing at (x, y) of the map, looking along `heading`: the worst of all cells that
  /// the robot's footprint touches (costs.h).
  [[nodiscard]] Cost footprint_cost_at(double x, double y, double heading) const;

  /// Indices of the clusters whose boxes touch a box, ascending.
  [[nodiscard]] std::vector<std::size_t> clusters_in(const MapBox& box) const;

  /// Slot of the window's cell over (x, y) of the map, kUnobserved where nothing was seen.
  /// \param[out] status
  [[nodiscard]] Slot slot_at(double x, double y, PlaceStatus& status) const;

  /// Place of the window's plane z = 0 over (x, y) of the map, frame of the window, metres. NaN
  /// while the map is empty and for windows on their edge.
  [[nodiscard]] Position2 place_at(double x, double y) const;

  /// For who fills a snapshot: costs are to be computed when they are asked for.
  /// \param scratch memory for that; null: what is needed is allocated
  void expect_costs(std::shared_ptr<CostScratch> scratch);
  /// For who fills a snapshot and knows more than it keeps: the costs, to be overwritten now.
  [[nodiscard]] CellCosts& give_costs();

  /// Fills `clusters` from `description`, without identities.
  void list_clusters();
  /// Gives `clusters` identities, one per cluster, and the things of `description` the same.
  void set_identities(const std::vector<std::uint64_t>& identities);

  /// Fills `clusters` from `description`. Things that overlap one of `before` keep its identity.
  /// \param[in,out] next_identity the one to be given out next
  void name_clusters(const TerrainSnapshot* before, std::uint64_t& next_identity);

 private:
  std::shared_ptr<CostScratch> scratch_;
  mutable std::mutex computing_;  ///< held while the costs are computed
  mutable std::atomic<bool> computed_{false};
  mutable CellCosts costs_;
};

using TerrainSnapshotPtr = std::shared_ptr<const TerrainSnapshot>;

}  // namespace mrpt_terrain
