// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/map/map_params.h"
#include "mrpt_terrain/map/snapshot.h"

namespace octomap {
class OcTree;
}

namespace mrpt_terrain {

/// A metric map that describes the terrain around a robot: an elevation grid with its clusters,
/// classes and costs, and an OctoMap beside it. Registered as "mrpt_terrain::CTerrainMap" and, for
/// `.ini` files, "terrainMap"; its sections are those of `map_params.h`.
///
/// **Observations.** All that `io::convert_observation` understands (Velodyne scans, point clouds,
/// depth images, rotating and tilted planar scans), with the sensor's pose on the robot. z = 0 of
/// the robot frame lies on the ground. Anything else is passed over: `insertObservation` returns
/// false.
///
/// **Threads.** Any number of threads may insert, clear, take snapshots and OctoMaps, draw, save,
/// serialise, compute likelihoods and convert at the same time. Writers wait for each other;
/// readers wait for nobody but for the time of copying the OctoMap, and for costs of the same
/// snapshot that another one is computing, and work on what the map was when they began. Assigning
/// to a map, deserialising into it, and changing its render or generic parameters is like making
/// it: nobody else may use it meanwhile.
class CTerrainMap : public mrpt::maps::CMetricMap {
  DEFINE_SERIALIZABLE(CTerrainMap, mrpt_terrain)

 public:
  CTerrainMap();
  explicit CTerrainMap(const MapParams& params);
  CTerrainMap(const CTerrainMap& other);
  CTerrainMap& operator=(const CTerrainMap& other);
  ~CTerrainMap() override;

  [[nodiscard]] const MapParams& params() const;
  /// Changes what 3D views show.
  void set_render_params(const MapRenderParams& render);

  // --- Reading -----------------------------------------------------------------------------------

  /// What the map knows now. Never null; revision 0 while the map is empty.
  [[nodiscard]] TerrainSnapshotPtr snapshot() const;
  /// `TerrainSnapshot::cell_at` of what the map knows now; take a snapshot for more than one.
  [[nodiscard]] CellView cell_at(double x, double y) const;
  /// `TerrainSnapshot::cost_at` of what the map knows now. The first question after an insertion
  /// computes the costs of all cells: milliseconds, which insertion does not take.
  [[nodiscard]] Cost cost_at(double x, double y, double heading) const;
  /// Clusters whose boxes touch a box of the map.
  [[nodiscard]] std::vector<ClusterView> clusters_in(const MapBox& box) const;
  /// The OctoMap, as a copy that does not change any more; made when it is first asked for after an
  /// insertion, shared until the next one. Null if the map keeps none.
  [[nodiscard]] std::shared_ptr<const octomap::OcTree> octree() const;
  /// What the OctoMap knows to be free now, as plain numbers: for all cells of a box, also those
  /// that no point was ever in, the free layers between two heights (map frame, metres; layers that
  /// lie across them count as a whole). Cells are those of the grid if voxels go into them, else
  /// single voxels. No cells if the map keeps no OctoMap. Costs the cells of the box.
  [[nodiscard]] FreeSpaceGrid free_space(const MapBox& box, double low, double high) const;

  // --- Writing -----------------------------------------------------------------------------------

  /// Inserts a scan that is already in the robot's frame, such as a de-skewed one. Its own pose is
  /// not looked at.
  /// \return false, and nothing happens, if no point of it is finite
  bool insert_scan(const io::Scan& scan, const mrpt::poses::CPose3D& T_map_robot);
  /// Why the last observation was not inserted; empty if it was.
  [[nodiscard]] std::string last_refusal() const;

  // --- Conversions -------------------------------------------------------------------------------

  /// Points of the last scan in the map frame.
  [[nodiscard]] mrpt::maps::CSimplePointsMap::Ptr as_points_map() const;
  /// Costs as an occupancy grid of the window: 1 - cost is the probability of being free, 0.5 where
  /// nothing is known. Asks for costs.
  [[nodiscard]] mrpt::maps::COccupancyGridMap2D::Ptr as_occupancy_grid() const;
  /// Occupied and free voxels of the OctoMap; empty if the map keeps none.
  [[nodiscard]] mrpt::opengl::COctoMapVoxels::Ptr as_voxels() const;

  // --- mrpt::maps::CMetricMap
  // ----------------------------------------------------------------------

  [[nodiscard]] bool isEmpty() const override;
  [[nodiscard]] std::string asString() const override;
  /// Draws what `[..._renderOpts]` asks for, in the map frame.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& objects) const override;
  /// Writes PREFIX.3Dscene, PREFIX.ot and PREFIX.bt (octovis), PREFIX_classes.png, PREFIX_cost.png,
  /// PREFIX_clusters.csv, PREFIX_cost.pgm with PREFIX_cost.yaml (ROS map_server); in field mode
  /// also PREFIX_holes.csv, PREFIX_cost_layers.png, and PREFIX_cost_PART.pgm with its .yaml for
  /// each part.
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
  /// 0: a terrain map takes no part in matching.
  [[nodiscard]] float compute3DMatchingRatio(
      const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose3D& other_pose,
      const mrpt::maps::TMatchingRatioParams& params) const override;

  MAP_DEFINITION_START(CTerrainMap)
  MapParams params;
  MAP_DEFINITION_END(CTerrainMap)

 private:
  void internal_clear() override;
  bool internal_insertObservation(
      const mrpt::obs::CObservation& observation,
      const std::optional<const mrpt::poses::CPose3D>& robot_pose = std::nullopt) override;
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& observation,
      const mrpt::poses::CPose3D& taken_from) const override;
  bool internal_canComputeObservationLikelihood(
      const mrpt::obs::CObservation& observation) const override;

  struct State;
  std::unique_ptr<State> state_;
};

/// Registers the classes of this library with MRPT; called by itself when the library is loaded.
void register_map_classes();

}  // namespace mrpt_terrain
