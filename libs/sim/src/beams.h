// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "mrpt_terrain/sensors/sensor_model.h"
#include "mrpt_terrain/sim/sweep.h"

namespace mrpt_terrain::sim {

/// Columns that are cast together: few enough for their rays to stay in the cache, whole packets.
inline constexpr std::size_t kTileColumns = 16;

/// Directions of all rays of a column at azimuth 0, the turn of the head between the rings
/// included. Ray of a ring: ring * sub_rays + sub-ray; the central one comes first.
struct BeamTable {
  explicit BeamTable(const sensors::SensorModel& model);
  [[nodiscard]] std::size_t size() const { return directions.size(); }

  std::size_t sub_rays;
  std::vector<Eigen::Vector3d> directions;  ///< unit vectors
};

/// Where the sensor is while some columns fire.
struct Tile {
  std::size_t first = 0;                               ///< column
  std::size_t size = 0;                                ///< columns
  std::array<double, kTileColumns> time;               ///< from the start of the run, seconds
  std::array<Eigen::Vector3d, kTileColumns> origin;    ///< of the rays, map frame
  std::array<Eigen::Matrix3d, kTileColumns> turn_map;  ///< column frame to map frame
  std::array<Eigen::Vector2d, kTileColumns> head;      ///< cosine and sine of the azimuth
};

/// The columns from `first` on, kTileColumns or what is left of the turn.
[[nodiscard]] Tile make_tile(const MountedSensor& sensor, const Motion& motion, double start_time,
                             std::size_t first);

/// Rays of a tile, in the order of the table and, for each of its rays, of the columns: neighbours
/// in a packet then see neighbouring places.
/// \param timed whether to fill in `Rays::time`
void fill_rays(const BeamTable& table, const Tile& tile, bool timed, Rays& rays);

}  // namespace mrpt_terrain::sim
