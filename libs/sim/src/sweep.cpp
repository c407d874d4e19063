// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/sweep.h"

#include <cmath>
#include <stdexcept>

#include "beams.h"
#include "echo.h"

namespace mrpt_terrain::sim {
namespace {

/// Streams of random numbers apart from those of the sweeps, which are counted from 0.
constexpr std::uint64_t kBiasStream = std::uint64_t{1} << 62U;

/// What stays the same during a turn.
struct Turn {
  const RayCaster& caster;
  const sensors::SensorModel& model;
  BeamTable table;
  std::vector<double> bias;  ///< per ring, metres
};

std::vector<double> ring_biases(const sensors::SensorModel& model) {
  RandomGenerator random(model.noise.unit_seed, kBiasStream);
  std::vector<double> bias(model.elevation.size());
  for (double& b : bias) b = model.noise.ring_bias_sigma * normal_deviate(random);
  return bias;
}

void start_sweep(const sensors::SensorModel& model, double start_time, Sweep& sweep) {
  sweep.rings = model.elevation.size();
  sweep.columns = static_cast<std::size_t>(model.columns);
  sweep.start_time = start_time;
  const std::size_t slots = sweep.rings * sweep.columns;
  sweep.range.assign(slots, 0.0F);
  sweep.true_range.assign(slots, 0.0F);
  sweep.intensity.assign(slots, 0);
  sweep.solid.assign(slots, kNoSolid);
  sweep.kind.assign(slots, SurfaceKind::kObject);
  sweep.time.resize(slots);
  sweep.slot.clear();
  sweep.points.clear();
  sweep.true_points.clear();
  sweep.slot.reserve(slots);
  sweep.points.reserve(slots);
  sweep.true_points.reserve(slots);
}

/// Point in the sensor frame: the beam's nominal direction, whatever ray of it met something.
void add_point(const Turn& turn, const Tile& tile, std::size_t k, std::size_t ring, double range,
               Points& points) {
  const Eigen::Vector3d& beam = turn.table.directions[ring * turn.table.sub_rays];
  const double c = tile.head[k].x(), s = tile.head[k].y();
  points.push_back(static_cast<float>(range * (c * beam.x() - s * beam.y())),
                   static_cast<float>(range * (s * beam.x() + c * beam.y())),
                   static_cast<float>(range * beam.z()));
}

void add_true_point(const Rays& rays, const Echo& echo, Points& points) {
  const std::size_t ray = echo.hit;
  points.push_back(
      static_cast<float>(rays.origin_x[ray] + echo.true_range * rays.direction_x[ray]),
      static_cast<float>(rays.origin_y[ray] + echo.true_range * rays.direction_y[ray]),
      static_cast<float>(rays.origin_z[ray] + echo.true_range * rays.direction_z[ray]));
}

/// Turns the hits of one column into its slots and returns.
void finish_column(const Turn& turn, const Tile& tile, std::size_t k, RandomGenerator& random,
                   const SweepWorkspace& workspace, Sweep& sweep) {
  const sensors::SensorModel& model = turn.model;
  const std::size_t sub_rays = turn.table.sub_rays;
  for (std::size_t ring = 0; ring < sweep.rings; ++ring) {
    const BeamHits beam{workspace.hits, ring * sub_rays * tile.size + k, tile.size, sub_rays};
    const Echo echo = strongest_echo(turn.caster.world(), beam, model.noise.pulse_length);
    const double range = measured_range(model.noise, echo, workspace.hits.cos_incidence[echo.hit],
                                        turn.bias[ring], random);
    const std::size_t slot = (tile.first + k) * sweep.rings + ring;
    sweep.time[slot] = static_cast<float>(model.firing_time(tile.first + k, ring));
    if (!std::isfinite(echo.range)) continue;
    sweep.true_range[slot] = static_cast<float>(echo.true_range);
    sweep.solid[slot] = workspace.hits.solid[echo.hit];
    sweep.kind[slot] = workspace.hits.kind[echo.hit];
    if (range <= 0.0 || range < model.min_range) continue;
    sweep.range[slot] = static_cast<float>(range);
    sweep.intensity[slot] = intensity_of(echo);
    sweep.slot.push_back(static_cast<std::uint32_t>(slot));
    add_point(turn, tile, k, ring, range, sweep.points);
    add_true_point(workspace.rays, echo, sweep.true_points);
  }
}

}  // namespace

void simulate_sweep(const RayCaster& caster, const MountedSensor& sensor, const Motion& motion,
                    double start_time, std::uint64_t seed, std::uint64_t stream,
                    SweepWorkspace& workspace, Sweep& sweep) {
  const sensors::SensorModel& model = sensor.model;
  if (!model.has_timing()) {
    throw std::invalid_argument("sensor " + model.name + ": rate_hz and columns must be given");
  }
  const Turn turn{caster, model, BeamTable(model), ring_biases(model)};
  RandomGenerator random(seed, stream);
  const std::uint64_t media_seed = seed ^ (stream * 0x9E3779B97F4A7C15ULL);
  start_sweep(model, start_time, sweep);
  for (std::size_t first = 0; first < sweep.columns; first += kTileColumns) {
    const Tile tile = make_tile(sensor, motion, start_time, first);
    fill_rays(turn.table, tile, !caster.world().movers.empty(), workspace.rays);
    caster.cast(workspace.rays, model.max_range, workspace.hits);
    caster.scatter(workspace.rays, model.max_range, media_seed, first * turn.table.size(),
                   workspace.hits);
    for (std::size_t k = 0; k < tile.size; ++k) {
      finish_column(turn, tile, k, random, workspace, sweep);
    }
  }
}

}  // namespace mrpt_terrain::sim
