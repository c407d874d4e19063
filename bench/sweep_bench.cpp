// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <cmath>

#include "allocation_counter.h"
#include "meshes.h"
#include "mrpt_terrain/sim/sweep.h"

namespace mrpt_terrain::bench {
namespace {

constexpr double kSensorHeight = 0.81;

/// A vehicle that moves on uneven ground of 300,000 triangles.
struct Drive {
  sim::World world;
  sim::MountedSensor sensor;
  sim::Motion motion;

  explicit Drive(int sub_rays) {
    world.solids.resize(1);
    worlds::add_height_field(world, 388, 0.1, worlds::uneven_height);
    sensor.model =
        sensors::load_sensor_model(MRPT_TERRAIN_SOURCE_DIR "/params/sensors/hdl32e.yaml");
    sensor.model.noise.sub_rays = sub_rays;
    sensor.T_robot_sensor.translation().z() = kSensorHeight;
    std::vector<double> times;
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k <= 20; ++k) {
      times.push_back(0.01 * k);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      const double x = 0.01 * k;
      pose.translation() = Eigen::Vector3d(x, 0.0, worlds::uneven_height(x, 0.0));
      poses.push_back(pose);
    }
    motion = sim::Motion(times, poses);
  }
};

/// Share of returns that are off the ground by more than its facets are.
double share_off_ground(const sim::Sweep& sweep) {
  std::size_t off = 0;
  for (std::size_t k = 0; k < sweep.true_points.size(); ++k) {
    const double ground = worlds::uneven_height(static_cast<double>(sweep.true_points.x[k]),
                                                static_cast<double>(sweep.true_points.y[k]));
    if (std::abs(static_cast<double>(sweep.true_points.z[k]) - ground) > 0.002) ++off;
  }
  return static_cast<double>(off) / static_cast<double>(sweep.true_points.size());
}

void sweep_of_32_rings(benchmark::State& state) {
  const Drive drive(static_cast<int>(state.range(0)));
  const sim::RayCaster caster(drive.world);
  sim::SweepWorkspace workspace;
  sim::Sweep sweep;
  std::uint64_t stream = 0;
  simulate_sweep(caster, drive.sensor, drive.motion, 0.0, 1, stream, workspace, sweep);
  if (sweep.points.size() < 10000 || share_off_ground(sweep) > 0.0) {
    state.SkipWithError("returns off the ground");
  }
  const std::size_t before = allocations();
  for (auto _ : state) {
    simulate_sweep(caster, drive.sensor, drive.motion, 0.0, 1, ++stream, workspace, sweep);
    benchmark::ClobberMemory();
  }
  state.counters["allocations"] =
      static_cast<double>(allocations() - before) / static_cast<double>(state.iterations());
  state.counters["rays_per_second"] = benchmark::Counter(
      static_cast<double>(sweep.range.size()) * static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(sweep_of_32_rings)->Arg(1)->Arg(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mrpt_terrain::bench
