// SPDX-License-Identifier: BSD-3-Clause
#include "simulation.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "mrpt_terrain/io/velodyne_packets.h"
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/params/set.h"
#include "mrpt_terrain/sim/families.h"
#include "mrpt_terrain/sim/vehicle.h"
#include "mrpt_terrain/view/text.h"
#include "path_option.h"

using namespace mrpt_terrain;

namespace {

constexpr double kMicro = 1e-6;  // seconds, resolution of the stamps

void check_files(const SimOptions& options) {
  if (options.scene.empty() == options.family.empty()) {
    throw std::invalid_argument("give a scene file, or a family with --family");
  }
  if (options.output.empty() && options.preview.empty()) {
    throw std::invalid_argument("nothing to do: give -o OUT.rawlog, or --preview FILE.png");
  }
  if (std::filesystem::path(options.output).extension() == ".tum") {
    throw std::invalid_argument("--output: " + options.output +
                                ": .tum is the ending of the poses beside the rawlog");
  }
  std::error_code different;
  for (const std::string& output : {options.output, options.preview}) {
    if (std::filesystem::equivalent(options.scene, output, different)) {
      throw std::invalid_argument(output + ": is the scene, and would be overwritten");
    }
  }
}

// How messages call the world.
std::string name_of_world(const SimOptions& options) {
  return options.family.empty() ? options.scene
                                : "--family " + options.family + " --family-seed " +
                                      std::to_string(options.family_seed);
}

sim::SceneFile load_scene_or_family(const SimOptions& options) {
  if (options.family.empty()) return sim::load_scene(options.scene);
  const auto folder = params::find_data_folder() / "params" / "families";
  const sim::Family family = sim::resolve_family(options.family, folder.string(), "--family");
  return sim::make_world(family, options.family_seed).file;
}

sim::SceneFile load_world(const SimOptions& options) {
  sim::SceneFile file = load_scene_or_family(options);
  if (!options.path.empty()) file.path.waypoints = parse_path(options.path);
  if (options.speed) file.path.speed = *options.speed;
  return file;
}

sensors::SensorModel load_sensor(const SimOptions& options, const sim::SceneFile& file) {
  const std::string& name = options.sensor.empty() ? file.sensor : options.sensor;
  const std::string source =
      options.sensor.empty() ? name_of_world(options) + ": sensor" : "--sensor";
  if (name.empty()) {
    throw std::invalid_argument(name_of_world(options) +
                                ": names no sensor; give one with --sensor, such as hdl32e");
  }
  const auto folder = params::find_data_folder() / "params" / "sensors";
  sensors::SensorModel model = sensors::resolve_sensor(name, folder.string(), source);
  if (!model.has_timing()) {
    throw std::invalid_argument(source + ": " + model.name +
                                " cannot be simulated: its file gives no rate_hz or no columns");
  }
  return model;
}

void apply_settings(const SimOptions& options, Simulation& simulation) {
  SimParams& params = simulation.params;
  params.vehicle = simulation.file.vehicle;
  if (!options.perfect) params.noise = simulation.sensor.model.noise;
  for (const std::string& setting : options.settings) params::set(params, setting, "--set");
  if (params.noise.sub_rays != 1 && params.noise.sub_rays != 5) {
    throw std::invalid_argument(
        "--set: [noise] sub_rays = " + std::to_string(params.noise.sub_rays) +
        ": must be 1 or 5 (rays per beam)");
  }
  simulation.file.vehicle = params.vehicle;
  simulation.sensor.model.noise = params.noise;
  simulation.sensor.T_robot_sensor = params.vehicle.T_robot_sensor();
  if (options.max_range) simulation.sensor.model.max_range = *options.max_range;
}

SweepForm form_of(const SimOptions& options, const sensors::SensorModel& model) {
  if (!options.packets) return is_planar(model) ? SweepForm::kPlanar : SweepForm::kCloud;
  const std::string problem = io::velodyne_problem(model);
  if (!problem.empty()) throw std::invalid_argument("--packets: " + problem);
  return SweepForm::kPackets;
}

void check_form(const SimOptions& options, SweepForm form) {
  if (options.deskewed && form == SweepForm::kPackets) {
    throw std::invalid_argument(
        "--deskewed and --packets exclude each other: packets hold what the sensor saw");
  }
  if (options.deskewed && form == SweepForm::kPlanar) {
    throw std::invalid_argument("--deskewed: a planar scan holds ranges, which keep the motion");
  }
}

/// Of the sweeps that begin at 0, T, 2 T, ... those that are wanted.
class Schedule {
 public:
  Schedule(const SimOptions& options, const sim::Motion& motion, double sweep_time)
      : options_(options), motion_(motion), sweep_time_(sweep_time) {}

  [[nodiscard]] std::vector<double> starts() const {
    std::vector<double> result;
    Eigen::Vector3d last = motion_.at(0.0).translation();
    double way = 0.0, next = 0.0;
    for (std::size_t k = 0; !is_past_end(k) && !is_enough(result.size()); ++k) {
      const double start = start_of(k);
      const Eigen::Vector3d here = motion_.at(start).translation();
      way += (here - last).head<2>().norm();
      last = here;
      if (way < next - kMicro) continue;
      result.push_back(start);
      next += options_.every;
    }
    return result;
  }

 private:
  [[nodiscard]] double start_of(std::size_t k) const {
    return std::round(static_cast<double>(k) * sweep_time_ / kMicro) * kMicro;
  }
  [[nodiscard]] bool is_past_end(std::size_t k) const {
    const double end = start_of(k + 1) - kMicro;
    if (options_.duration && end > *options_.duration) return true;
    return !motion_.stands_still() && end > motion_.end();
  }
  /// A robot that stands still has no end of its own.
  [[nodiscard]] bool is_enough(std::size_t sweeps) const {
    if (options_.sweeps != 0) return sweeps >= options_.sweeps;
    return motion_.stands_still() && !options_.duration && sweeps >= 1;
  }

  const SimOptions& options_;
  const sim::Motion& motion_;
  double sweep_time_;
};

std::string shortfall_of(const SimOptions& options, const Simulation& simulation) {
  const double end = simulation.motion.end();
  const std::string where = "the path ends after " + view::fixed(end, 2) + " s";
  if (simulation.starts.size() < options.sweeps) {
    return where + " and " + std::to_string(simulation.starts.size()) + " of " +
           std::to_string(options.sweeps) + " sweeps";
  }
  const bool cut = options.duration && options.sweeps == 0 && !simulation.motion.stands_still() &&
                   *options.duration > end + simulation.sweep_time();
  return cut ? where + ", before " + view::shortest(*options.duration) + " s" : "";
}

}  // namespace

std::unique_ptr<Simulation> make_simulation(const SimOptions& options) {
  check_files(options);
  auto simulation = std::make_unique<Simulation>();
  simulation->file = load_world(options);
  simulation->sensor.model = load_sensor(options, simulation->file);
  apply_settings(options, *simulation);
  simulation->form = form_of(options, simulation->sensor.model);
  check_form(options, simulation->form);
  simulation->world = sim::build_world(simulation->file.scene);
  simulation->caster = std::make_unique<sim::RayCaster>(simulation->world);
  const std::string source = options.path.empty() ? name_of_world(options) + ": path" : "--path";
  simulation->motion =
      sim::drive(*simulation->caster, simulation->file.vehicle, simulation->file.path, source);
  simulation->starts = Schedule(options, simulation->motion, simulation->sweep_time()).starts();
  simulation->shortfall = shortfall_of(options, *simulation);
  if (simulation->starts.empty()) {
    throw std::invalid_argument(source + ": there is no time for a single sweep of " +
                                view::fixed(simulation->sweep_time(), 3) + " s");
  }
  return simulation;
}
