// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <map>

#include "exit_code.h"
#include "memory_limit.h"
#include "options.h"
#include "program.h"
#include "verbosity_option.h"

namespace {

void add_common(CLI::App& command, CommonOptions& options) {
  command
      .add_option("-c,--config", options.config,
                  "Parameters (.ini) as for terrain-rawlog, whose --print-default-config has all")
      ->type_name("FILE");
  command
      .add_option("-s,--set", options.settings, "One parameter, after the file; may be repeated")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--pitch", options.pitch_deg,
                  "Disturbs the pose: points turned about y, forwards down > 0")
      ->type_name("DEG")
      ->check(CLI::Range(-45.0, 45.0).description(""));
  command.add_option("--raise", options.raise, "Disturbs the pose: points moved up")
      ->type_name("M")
      ->check(CLI::Range(-10.0, 10.0).description(""));
  command
      .add_option("--radius", options.radius,
                  "Support and clusters count up to M metres in x and y only (default: all)")
      ->type_name("M")
      ->check(CLI::PositiveNumber.description(""));
  command.add_option("--csv", options.csv, "All numbers, one per line")->type_name("FILE");
  command
      .add_option("--dump", options.dump,
                  "Folder for points (.bin), truth and predictions (.label) of every scan")
      ->type_name("DIR");
  command.add_flag("--details", options.details, "Print tables of every family or file, all lists");
  add_verbosity(command, options.verbosity);
}

void add_robot(CLI::App& command, WorldsOptions& options) {
  command
      .add_option("--sensor", options.sensor, "Name in params/sensors instead of the world's own")
      ->type_name("NAME|FILE");
  command.add_option("--sensor-z", options.sensor_z, "Height of the sensor instead of its own")
      ->type_name("M")
      ->check(CLI::Range(0.05, 10.0).description(""));
  command.add_option("--speed", options.speed, "Of the robot, instead of its own")
      ->type_name("M/S")
      ->check(CLI::Range(0.05, 10.0).description(""));
  command.add_option("--noise-seed", options.noise_seed, "Of the sensor, as terrain-sim --seed")
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--skewed", options.skewed,
                   "Leave the robot's motion during a sweep in the points");
  command.add_flag("--level", options.level,
                   "Points in a frame with vertical z instead of the vehicle's");
}

CLI::App& add_worlds(CLI::App& app, WorldsOptions& options) {
  CLI::App& command = *app.add_subcommand("worlds", "Score descriptions of simulated worlds");
  command.add_option("-f,--families", options.families, "Names in params/families, files, or all")
      ->delimiter(',')
      ->type_name("NAME,...")
      ->capture_default_str();
  command.add_option("--seeds", options.seeds, "From A up to, not including, B")
      ->type_name("A:B")
      ->capture_default_str();
  command.add_flag("--judging", options.judging,
                   "Permit seeds 1000 to 1099, on which nothing may be developed or tuned");
  command.add_option("-n,--scans", options.scans, "Per world, spread evenly over the drive")
      ->type_name("N")
      ->check(CLI::Range(1, 100000).description(""))
      ->capture_default_str();
  command
      .add_option("-j,--threads", options.threads,
                  "Worlds at a time; the results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 256).description(""))
      ->capture_default_str();
  command.add_flag("--approach", options.approach,
                   "Also judge which holes on the path are found 1 m ahead of the wheels");
  command
      .add_option("--follow", options.follow,
                  "Also judge how things keep their identity over N consecutive scans")
      ->type_name("N")
      ->check(CLI::Range(2, 100000).description(""));
  command
      .add_option("--fused", options.fused,
                  "Instead: compare a terrain map (fusion = rolling) that takes N scans per world\n"
                  "with the descriptions of single ones")
      ->type_name("N")
      ->check(CLI::Range(2, 100000).description(""));
  add_robot(command, options);
  command.add_option("--false-potholes", options.false_potholes, "List of all false potholes")
      ->type_name("FILE.csv");
  command
      .add_option("--things", options.things,
                  "List of all true things and of clusters that are none")
      ->type_name("FILE.csv");
  CLI::Option* costs = command.add_option(
      "--costs", options.costs,
      "Also judge the costs of cells for a robot, as in params/robots; implies --level");
  costs->type_name("ROBOT.ini");
  command
      .add_flag("--grid-costs", options.grid_costs,
                "Of these, slope, step and roughness of the grid alone, as in paper mode")
      ->needs(costs);
  add_common(command, options.common);
  return command;
}

CLI::App& add_labelled(CLI::App& app, LabelledOptions& options) {
  using mrpt_terrain::eval::LabelSet;
  CLI::App& command = *app.add_subcommand(
      "labelled", "Score descriptions of labelled scans in SemanticKITTI's layout");
  command.add_option("folders", options.folders, "With velodyne/*.bin and labels/*.label")
      ->required()
      ->type_name("DIR...");
  std::map<std::string, LabelSet> names;
  for (const auto& entry : enum_names(LabelSet{})) names[entry.name] = entry.value;
  command.add_option("--classes", options.classes, "semantickitti, rellis or terrain")
      ->required()
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(names).description(""));
  command
      .add_option("--sensor-height", options.sensor_height,
                  "Of the points' origin above the ground, 0 if z = 0 is on it")
      ->type_name("M")
      ->check(CLI::Range(-100.0, 100.0).description(""));
  command.add_flag("--find-ground", options.find_ground,
                   "Find height and tilt of the sensor in every scan (section ground_plane)");
  add_common(command, options.common);
  return command;
}

int run(int argc, char** argv) {
  CLI::App app("Compares descriptions with the truth: simulated worlds and labelled scans.",
               "terrain-eval");
  app.footer(
      "Exit codes: 0 all well; 2 command line, configuration, family or world wrong; 3 a scan\n"
      "cannot be read; 5 output cannot be written; 130 interrupted, nothing was written.");
  app.set_version_flag("--version", "terrain-eval " MRPT_TERRAIN_VERSION);
  app.require_subcommand(1);
  WorldsOptions worlds;
  LabelledOptions labelled;
  const CLI::App& worlds_command = add_worlds(app, worlds);
  add_labelled(app, labelled);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  if (!worlds_command.parsed()) return run_labelled(labelled);
  return worlds.fused > 0 ? run_fused_worlds(worlds) : run_worlds(worlds);
}

}  // namespace

int main(int argc, char** argv) {
  limit_memory();
  return run_program(run, argc, argv);
}
