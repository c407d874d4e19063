// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/io/trajectory.h"
#include "program.h"

/// \file
/// Runs of terrain-sim in a yard of level ground with two boxes, read back.
namespace mrpt_terrain::test {

/// The yard; the robot drives 3 m east, turns, and goes 2 m north.
inline const std::string kYard =
    "name: yard\n"
    "ground: {form: plane, length: 40, width: 40}\n"
    "solids:\n"
    "  - {type: box, id: 7, x: 4, y: -2, length: 1, width: 2, height: 0.5}\n"
    "  - {type: box, id: 9, x: -3, y: 1, length: 2, width: 1, height: 1.2}\n"
    "sensor: vlp16\n"
    "vehicle: {sensor_z: 0.81}\n"
    "path: {speed: 1.0, waypoints: [[0, 0], [3, 0], [3, 2]]}\n";

struct YardBox {
  Eigen::Vector3d low, high;
};
inline const YardBox kYardBoxes[] = {{{3.5, -3.0, 0.0}, {4.5, -1.0, 0.5}},
                                     {{-4.0, 0.5, 0.0}, {-2.0, 1.5, 1.2}}};

/// How far a point is from the surface of a box.
inline double off_box(const YardBox& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d outside =
      (box.low - p).cwiseMax(p - box.high).cwiseMax(Eigen::Vector3d::Zero());
  if (outside.norm() > 0.0) return outside.norm();
  return std::min((p - box.low).minCoeff(), (box.high - p).minCoeff());
}

/// How far a point of the map is from the nearest surface of the yard, metres.
inline double off_surface(const Eigen::Vector3d& p) {
  double least = std::abs(p.z());
  for (const YardBox& box : kYardBoxes) least = std::min(least, off_box(box, p));
  return least;
}

inline ProgramResult terrain_sim(const std::filesystem::path& folder,
                                 std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TERRAIN_SIM);
  return Program(folder, std::move(arguments)).wait();
}

/// `terrain-sim FOLDER/yard.yaml -o FOLDER/run.rawlog ...`
inline ProgramResult simulate_yard(const std::filesystem::path& folder,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {write_file(folder / "yard.yaml", kYard), "-o",
                                        (folder / "run.rawlog").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return terrain_sim(folder, std::move(arguments));
}

/// All observations of a class.
template <class Observation>
std::vector<typename Observation::Ptr> observations(const std::filesystem::path& rawlog) {
  std::vector<typename Observation::Ptr> result;
  const auto reader = io::open_observations(rawlog.string());
  io::ReadObservation read;
  while (reader->next(read)) {
    const auto observation = std::dynamic_pointer_cast<Observation>(read.observation);
    if (observation) result.push_back(observation);
  }
  return result;
}

/// The points of one observation in the map, by the poses of a TUM file. Every point of a run lies
/// in the result at its own place, whatever the robot did meanwhile, if `deskew` undoes the motion.
struct MapPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> ranges;  ///< from the sensor at the stamp, metres
  bool deskewed = false;
};
inline MapPoints map_points(const mrpt::obs::CObservation& observation, const io::Trajectory& poses,
                            bool deskew) {
  io::InputParams params;
  params.deskew = deskew;
  io::SensorPoints sensor;
  io::Scan scan;
  EXPECT_EQ(io::convert_observation(observation, params, {}, sensor).status,
            io::ConversionStatus::kOk);
  io::to_robot_frame(sensor, &poses, params, scan);
  EXPECT_TRUE(scan.T_map_robot.has_value());
  MapPoints result;
  result.deskewed = scan.deskewed;
  if (!scan.T_map_robot) return result;
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const Eigen::Vector3d robot(scan.points.x[k], scan.points.y[k], scan.points.z[k]);
    mrpt::math::TPoint3D map;
    scan.T_map_robot->composePoint({robot.x(), robot.y(), robot.z()}, map);
    result.points.emplace_back(map.x, map.y, map.z);
    result.ranges.push_back(robot.norm());
  }
  return result;
}

}  // namespace mrpt_terrain::test
