// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>

#include "exit_code.h"
#include "memory_limit.h"
#include "mrpt_terrain/params/ini.h"
#include "options.h"
#include "program.h"
#include "sim_params.h"
#include "verbosity_option.h"

namespace {

void add_world(CLI::App& app, SimOptions& options) {
  app.add_option("scene", options.scene, "Scene file (.yaml)")->type_name("SCENE");
  app.add_option("--family", options.family,
                 "A world of a family (name in params/families, or a .yaml file) instead of a "
                 "scene")
      ->type_name("NAME|FILE");
  app.add_option("--family-seed", options.family_seed, "Which world of the family")
      ->type_name("N")
      ->capture_default_str();
}

void add_robot(CLI::App& app, SimOptions& options) {
  app.add_option("--sensor", options.sensor,
                 "Sensor (name in params/sensors, or a .yaml file) instead of the scene's")
      ->type_name("NAME|FILE");
  app.add_option(
         "--path", options.path,
         "Waypoints in m instead of the scene's: \"x,y; x,y; ...\", or a text file with one "
         "per line")
      ->type_name("PATH");
  app.add_option("--speed", options.speed, "Of the robot, instead of the scene's")
      ->type_name("M/S")
      ->check(CLI::Range(0.01, 50.0).description(""));
  app.add_option("--set", options.settings,
                 "One parameter of [noise], [vehicle] or [odometry]; may be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--perfect", options.perfect, "Sensor without noise (--set comes after it)");
  app.add_option("--max-range", options.max_range, "Of the sensor, instead of its own")
      ->type_name("M")
      ->check(CLI::Range(0.1, 1000.0).description(""));
}

void add_sweeps(CLI::App& app, SimOptions& options) {
  app.add_option("--seed", options.seed, "Of all noise: same seed, same bytes")
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--sweeps", options.sweeps,
                 "Stop after N sweeps (default: at the end of the path; 1 if the robot stands)")
      ->type_name("N")
      ->check(CLI::PositiveNumber.description(""));
  app.add_option("--duration", options.duration, "Stop after S seconds")
      ->type_name("S")
      ->check(CLI::PositiveNumber.description(""));
  app.add_option("--every", options.every, "Keep one sweep per M metres of way")
      ->type_name("M")
      ->check(CLI::PositiveNumber.description(""));
}

void add_outputs(CLI::App& app, SimOptions& options) {
  app.add_option("-o,--output", options.output,
                 "Rawlog to write; poses (.tum) and truth go beside it")
      ->type_name("OUT.rawlog");
  app.add_option("--sensor-label", options.label, "Label of the observations")
      ->type_name("TEXT")
      ->capture_default_str();
  app.add_flag("--packets", options.packets,
               "Write packets (CObservationVelodyneScan) instead of point clouds");
  app.add_flag("--deskewed", options.deskewed,
               "Write points as if the robot had stood still during each sweep");
  app.add_flag_callback(
      "--no-truth", [&options] { options.truth = false; }, "Write no truth files");
  app.add_option("--cell-size", options.cell_size, "Of the grid in the truth files")
      ->type_name("M")
      ->check(CLI::Range(0.01, 10.0).description(""))
      ->capture_default_str();
  app.add_option("--preview", options.preview, "Picture of the scene from above (PNG)")
      ->type_name("FILE.png");
}

int run(int argc, char** argv) {
  CLI::App app("Simulated range data with exact truth: scene, sensor, path and seed to a rawlog.",
               "terrain-sim");
  app.footer(
      "Exit codes: 0 all well; 2 command line, scene, sensor or path wrong, nothing was done; 4\n"
      "finished, but the path was too short for the sweeps asked for; 5 output cannot be written;\n"
      "130 interrupted, nothing was written.");
  app.set_version_flag("--version", "terrain-sim " MRPT_TERRAIN_VERSION);
  bool print_config = false;
  app.add_flag("--print-default-config", print_config,
               "Print all parameters of --set with their defaults");
  SimOptions options;
  add_world(app, options);
  add_robot(app, options);
  add_sweeps(app, options);
  add_outputs(app, options);
  add_verbosity(app, options.verbosity);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  if (print_config) {
    std::cout << mrpt_terrain::params::dump_ini(SimParams{}) << std::flush;
    return std::cout ? kExitOk : kExitOutput;
  }
  return run_simulation(options);
}

}  // namespace

int main(int argc, char** argv) {
  limit_memory();
  return run_program(run, argc, argv);
}
