// SPDX-License-Identifier: BSD-3-Clause
#include "beams.h"

#include <algorithm>
#include <cmath>

namespace mrpt_terrain::sim {
namespace {

/// Central ray and, for beams of several rays, four on the cone of the divergence.
void add_beam(double elevation, double azimuth, const sensors::SensorNoise& noise,
              std::vector<Eigen::Vector3d>& directions) {
  const double ce = std::cos(elevation), se = std::sin(elevation);
  const double ca = std::cos(azimuth), sa = std::sin(azimuth);
  const Eigen::Vector3d centre(ce * ca, ce * sa, se);
  directions.push_back(centre);
  if (noise.sub_rays == 1) return;
  const Eigen::Vector3d up(-se * ca, -se * sa, ce), left(-sa, ca, 0.0);
  const double half = 0.5 * noise.beam_divergence;
  for (const Eigen::Vector3d& aside : {up, left, Eigen::Vector3d(-up), Eigen::Vector3d(-left)}) {
    directions.emplace_back(std::cos(half) * centre + std::sin(half) * aside);
  }
}

}  // namespace

BeamTable::BeamTable(const sensors::SensorModel& model)
    : sub_rays(static_cast<std::size_t>(model.noise.sub_rays)) {
  for (std::size_t ring = 0; ring < model.elevation.size(); ++ring) {
    add_beam(model.elevation[ring], model.azimuth(0, ring) - model.start_azimuth, model.noise,
             directions);
  }
}

Tile make_tile(const MountedSensor& sensor, const Motion& motion, double start_time,
               std::size_t first) {
  const sensors::SensorModel& model = sensor.model;
  Tile tile;
  tile.first = first;
  tile.size = std::min(kTileColumns, static_cast<std::size_t>(model.columns) - first);
  Eigen::Isometry3d T_map_sensor = motion.at(start_time) * sensor.T_robot_sensor;
  for (std::size_t k = 0; k < tile.size; ++k) {
    const double azimuth =
        model.start_azimuth + model.azimuth_step() * static_cast<double>(first + k);
    tile.time[k] = start_time + model.firing_time(first + k, 0);
    if (!motion.stands_still()) T_map_sensor = motion.at(tile.time[k]) * sensor.T_robot_sensor;
    tile.origin[k] = T_map_sensor.translation();
    tile.turn_map[k] = T_map_sensor.linear() * Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ());
    tile.head[k] = {std::cos(azimuth), std::sin(azimuth)};
  }
  return tile;
}

void fill_rays(const BeamTable& table, const Tile& tile, bool timed, Rays& rays) {
  rays.resize(table.size() * tile.size);
  rays.time.resize(timed ? rays.size() : 0);
  std::size_t ray = 0;
  for (const Eigen::Vector3d& beam : table.directions) {
    for (std::size_t k = 0; k < tile.size; ++k, ++ray) {
      const Eigen::Vector3d direction = tile.turn_map[k] * beam;
      rays.origin_x[ray] = tile.origin[k].x();
      rays.origin_y[ray] = tile.origin[k].y();
      rays.origin_z[ray] = tile.origin[k].z();
      rays.direction_x[ray] = direction.x();
      rays.direction_y[ray] = direction.y();
      rays.direction_z[ray] = direction.z();
      if (timed) rays.time[ray] = tile.time[k];
    }
  }
}

}  // namespace mrpt_terrain::sim
