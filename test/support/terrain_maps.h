// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <string>

#include "lidar.h"
#include "mrpt_terrain/map/terrain_map.h"

/// \file
/// Builders of terrain maps and of what is inserted into them.
namespace mrpt_terrain::testing {

/// The paper's parameters on a map of 10 m x 10 m.
inline MapParams small_map(double octree_resolution = 0.1) {
  MapParams params;
  params.description.grid.length = params.description.grid.width = 10.0;
  params.description.grid.cell_size = 0.1;
  params.creation.octree_resolution = octree_resolution;
  return params;
}

/// Level ground with a box of 0.5 m, a ramp and a pothole, as a LiDAR at 0.81 m sees them; points
/// in the robot's frame.
inline Points scene_points(std::uint64_t seed = 1) {
  worlds::Scene scene;
  scene.solids.push_back(worlds::box_solid({2.0, 2.5, 0.5, 1.0}, 0.0, 0.5, 1));
  scene.solids.push_back(worlds::ramp_solid({1.5, 2.7, -1.5, -0.5}, 0.25, 2));
  scene.holes.push_back(worlds::box_solid({-2.0, -1.5, -0.3, 0.3}, -0.12, 0.0, 3));
  RandomGenerator random(seed, 0);
  return worlds::scan(scene, worlds::thirty_two_beams(0.005), random).points;
}

/// Points as an observation of a sensor; they are given in the robot's frame.
inline mrpt::obs::CObservationPointCloud observation_of(
    const Points& points, const mrpt::poses::CPose3D& T_robot_sensor = {}, double stamp = 1000.0) {
  mrpt::obs::CObservationPointCloud observation;
  observation.sensorLabel = "lidar";
  observation.timestamp = mrpt::Clock::fromDouble(stamp);
  observation.sensorPose = T_robot_sensor;
  observation.pointcloud = mrpt::maps::CSimplePointsMap::Create();
  for (std::size_t k = 0; k < points.size(); ++k) {
    double x, y, z;
    T_robot_sensor.inverseComposePoint(points.x[k], points.y[k], points.z[k], x, y, z);
    observation.pointcloud->insertPoint(static_cast<float>(x), static_cast<float>(y),
                                        static_cast<float>(z));
  }
  return observation;
}

/// Where the sensor of `scene_points` is.
inline mrpt::poses::CPose3D lidar_pose() { return {0.0, 0.0, 0.81, 0.0, 0.0, 0.0}; }

/// A map as MRPT stores it.
inline std::string bytes_of(const CTerrainMap& map) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << map;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

inline CTerrainMap map_from(const std::string& bytes) {
  mrpt::io::CMemoryStream stream;
  stream.Write(bytes.data(), bytes.size());
  stream.Seek(0);
  CTerrainMap map;
  mrpt::serialization::archiveFrom(stream) >> map;
  return map;
}

inline mrpt::config::CConfigFileMemory config_of(const std::string& text) {
  mrpt::config::CConfigFileMemory config;
  config.setContent(text);
  return config;
}

}  // namespace mrpt_terrain::testing
