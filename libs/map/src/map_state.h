// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "fusion_half.h"
#include "judged_scan.h"
#include "likelihood.h"
#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/thing_tracker.h"
#include "mrpt_terrain/core/unseen_cells.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "octree_half.h"

namespace mrpt_terrain {

/// Snapshots that nobody holds any more, to be filled again: their arrays keep their memory, so
/// that the pages of it need not be asked for with every scan. Handles may end in any thread.
class SnapshotPool : public std::enable_shared_from_this<SnapshotPool> {
 public:
  /// A snapshot that holds what some earlier one held, but for `fused`: all of it has to be
  /// written.
  [[nodiscard]] std::shared_ptr<TerrainSnapshot> take();

 private:
  void give_back(std::unique_ptr<TerrainSnapshot> snapshot);

  std::mutex mutex_;
  std::unique_ptr<TerrainSnapshot> spare_;
};

/// What one writer works with.
struct MapWriter {
  std::unique_ptr<FusionHalf> fusion;  ///< null: each scan by itself
  io::SensorPoints sensor_points;
  io::Scan scan;
  DescriptionWorkspace workspace;
  std::shared_ptr<CostScratch> costs = std::make_shared<CostScratch>();
  UnseenWorkspace unseen;
  std::shared_ptr<SnapshotPool> snapshots = std::make_shared<SnapshotPool>();
  std::uint64_t next_identity = 1;  ///< paper mode
  ThingTracker tracker;             ///< field mode
  double time = 0.0;  ///< of the last scan, seconds; goes on where scans have no stamps
  std::string refusal;
};

struct CTerrainMap::State {
  explicit State(const MapParams& given);
  State(const State& other);
  State& operator=(const State&) = delete;

  MapParams params;
  /// Held while the map changes; who stores it holds it for the copy of the OctoMap, other readers
  /// do without.
  mutable std::mutex writing;
  MapWriter writer;
  std::unique_ptr<OctreeHalf> octree;  ///< null: the map keeps none; never replaced
  /// Kept between likelihoods; not part of what the map knows.
  JudgedScans judged;
  LikelihoodFields fields;

  [[nodiscard]] TerrainSnapshotPtr snapshot() const;
  void publish(TerrainSnapshotPtr next);
  /// Takes a scan into the OctoMap and the fused grid, describes what there is and publishes it.
  /// Needs `writing`.
  bool insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot);

  /// All that the map knows (serialization.cpp).
  [[nodiscard]] std::string bytes() const;
  /// \param format in which the bytes are
  /// Throws std::runtime_error saying what is wrong with the bytes.
  [[nodiscard]] static std::unique_ptr<State> from_bytes(const std::string& bytes,
                                                         std::uint32_t format);

 private:
  mutable std::mutex swapping_;  ///< held for the time of copying a pointer
  TerrainSnapshotPtr snapshot_;
};

[[nodiscard]] Eigen::Isometry3d isometry_of(const mrpt::poses::CPose3D& pose);
[[nodiscard]] mrpt::poses::CPose3D pose_of(const Eigen::Isometry3d& T);

/// Describes a scan, or the cells that it was fused into: all of a snapshot but its revision, the
/// identities of its clusters, and costs that follow from the description alone.
/// \param time of the scan, seconds
[[nodiscard]] std::shared_ptr<TerrainSnapshot> describe_scan(const io::Scan& scan,
                                                             const Eigen::Isometry3d& T_map_robot,
                                                             double time, const MapParams& params,
                                                             MapWriter& writer);

/// Fills the clusters of a snapshot and gives them their identities: in field mode those of the
/// writer's tracker, in paper mode those of the clusters that lay there before.
void name_clusters(const TerrainSnapshot* before, double time, const MapParams& params,
                   MapWriter& writer, TerrainSnapshot& snapshot);

/// Whether a cost says something.
[[nodiscard]] inline bool is_known(const Cost& cost) {
  return cost.status == CostStatus::kOk || cost.status == CostStatus::kLethal;
}

/// Everything that a snapshot is saved as (map_files.cpp).
void save_files(const CTerrainMap& map, const std::string& prefix);

/// Draws a snapshot (drawing.cpp).
void draw(const CTerrainMap& map, const MapRenderParams& render,
          mrpt::opengl::CSetOfObjects& objects);

}  // namespace mrpt_terrain
