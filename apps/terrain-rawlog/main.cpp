// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app_params.h"
#include "exit_code.h"
#include "memory_limit.h"
#include "mrpt_terrain/params/ini.h"
#include "options.h"
#include "program.h"
#include "verbosity_option.h"

namespace {

void add_inputs(CLI::App& command, InputOptions& input) {
  command.add_option("inputs", input.inputs, "Files: .rawlog or .simplemap, also gzipped")
      ->required()
      ->type_name("IN...");
}

void add_settings(CLI::App& command, std::vector<std::string>& settings,
                  const std::string& meaning) {
  command.add_option("--set", settings, meaning)
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
}

void add_selection(CLI::App& command, Selection& selection) {
  command
      .add_option("--sensor-label", selection.sensor_label,
                  "Only observations whose whole label matches")
      ->type_name("REGEX");
  command.add_option("--from-index", selection.from_index, "First entry of each input")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("N");
  command.add_option("--to-index", selection.to_index, "Last entry of each input")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("N");
  command.add_option("--only-first-n", selection.only_first_n, "Stop after N scans")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("N");
}

void add_reading(CLI::App& command, InputOptions& input) {
  add_selection(command, input.selection);
  command.add_option("--poses", input.poses, "Poses of the robot, instead of the rawlog's own")
      ->type_name("FILE.tum");
  command
      .add_option("--sensor-pose", input.sensor_pose,
                  "Sensor on the robot, instead of the observations' own: \"x y z yaw pitch "
                  "roll\" in m and deg; z = 0 of the robot is on the ground")
      ->type_name("POSE");
  command.add_flag("--find-ground", input.find_ground,
                   "Find height and tilt of the sensor in the first scan that shows the ground");
  command
      .add_option("--externals-dir", input.externals_dir,
                  "Folder of externally stored data (default: as rawlog tools find it)")
      ->type_name("DIR");
}

void add_process(CLI::App& app, ProcessOptions& options) {
  CLI::App& command =
      *app.add_subcommand("process", "Describe the scans of rawlogs or simple maps");
  add_inputs(command, options.input);
  command
      .add_option("-c,--config", options.config, "Parameters (.ini); see --print-default-config")
      ->type_name("FILE");
  add_settings(command, options.settings, "One parameter, after the file; may be repeated");
  command.add_option("-o,--output-dir", options.output_dir, "Folder for all results")
      ->type_name("DIR")
      ->capture_default_str();
  command
      .add_option("--every", options.every,
                  "Pictures, scenes and clouds of every N-th scan (default: first, worst, last)")
      ->type_name("N")
      ->check(CLI::PositiveNumber.description(""));
  add_reading(command, options.input);
  command.add_option("--table-rows", options.table_rows, "Clusters per printed table")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("N")
      ->capture_default_str();
  add_verbosity(command, options.verbosity);
}

void add_label(CLI::App& app, LabelOptions& options) {
  CLI::App& command =
      *app.add_subcommand("label", "Write a label per point, in SemanticKITTI's form");
  command
      .add_option("inputs", options.input.inputs,
                  "KITTI / SemanticKITTI folders and .bin files; or .rawlog or .simplemap files")
      ->required()
      ->type_name("IN...");
  command
      .add_option("-c,--config", options.config, "Parameters (.ini); see --print-default-config")
      ->type_name("FILE");
  add_settings(command, options.settings, "One parameter, after the file; may be repeated");
  command.add_option("-o,--output-dir", options.output_dir, "Folder for the label files")
      ->type_name("DIR")
      ->capture_default_str();
  add_reading(command, options.input);
  add_verbosity(command, options.verbosity);
}

void add_map(CLI::App& app, MapOptions& options) {
  CLI::App& command =
      *app.add_subcommand("map", "Build one terrain map out of rawlogs or simple maps");
  add_inputs(command, options.input);
  command
      .add_option("-c,--config", options.config,
                  "The map's definition (.ini), as params/mrpt/terrain_map.ini, or parameters of\n"
                  "process, as params/field.ini")
      ->type_name("FILE");
  add_settings(command, options.settings,
               "One parameter, after the file, such as creationOpts.fusion=rolling; may be "
               "repeated");
  command
      .add_option("-o,--output", options.output,
                  "Beginning of the files' names, or a folder for them")
      ->type_name("PREFIX")
      ->capture_default_str();
  add_reading(command, options.input);
  add_verbosity(command, options.verbosity);
}

void add_export(CLI::App& app, ExportOptions& options) {
  CLI::App& command =
      *app.add_subcommand("export", "Write the files of a stored terrain map (.metricmap) again");
  command.add_option("input", options.input, "The map, as `map` wrote it")
      ->required()
      ->type_name("FILE.metricmap");
  command
      .add_option("-o,--output", options.output,
                  "Beginning of the files' names, or a folder for them")
      ->required()
      ->type_name("PREFIX");
  add_settings(command, options.settings,
               "What the scene shows, such as renderOpts.colouring=cost; may be repeated");
  command
      .add_option("--points", options.points,
                  "Labelled points of the last scan, in the map's frame")
      ->type_name("FILE.ply");
  add_verbosity(command, options.verbosity);
}

void add_info(CLI::App& app, InfoOptions& options) {
  CLI::App& command = *app.add_subcommand("info", "Say what files hold and what can be described");
  command
      .add_option("inputs", options.inputs,
                  "Files: .rawlog, .simplemap or .metricmap, also gzipped")
      ->required()
      ->type_name("IN...");
  command.add_option("--externals-dir", options.externals_dir, "Folder of externally stored data")
      ->type_name("DIR");
}

void add_import(CLI::App& app, ImportCommandOptions& options) {
  CLI::App& command =
      *app.add_subcommand("import", "Make a rawlog of a KITTI folder or of PCD or PLY files");
  command.add_option("inputs", options.inputs, "One KITTI / SemanticKITTI folder, or point clouds")
      ->required()
      ->type_name("IN...");
  command
      .add_option("-o,--output", options.output, "Rawlog to write; poses and labels go beside it")
      ->required()
      ->type_name("OUT.rawlog");
  command.add_option("--format", options.format, "kitti, pcd or ply (default: by the inputs)")
      ->check(CLI::IsMember({"kitti", "pcd", "ply"}).description(""))
      ->type_name("NAME");
  command
      .add_option("--sensor-pose", options.sensor_pose,
                  "Sensor on the robot: \"x y z yaw pitch roll\" in m and deg, such as "
                  "\"0 0 1.73\"")
      ->type_name("POSE");
  command.add_option("--sensor-label", options.sensor_label, "Label of the observations")
      ->capture_default_str();
  command.add_option("--period", options.period, "Seconds between scans without time stamps")
      ->capture_default_str()
      ->check(CLI::PositiveNumber.description(""));
  command.add_option("--only-first-n", options.only_first_n, "Stop after N scans")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("N");
  add_verbosity(command, options.verbosity);
}

/// The options of all commands.
struct Commands {
  ProcessOptions process;
  LabelOptions label;
  MapOptions map;
  ExportOptions export_map;
  InfoOptions info;
  ImportCommandOptions import;

  explicit Commands(CLI::App& app) {
    add_process(app, process);
    add_label(app, label);
    add_map(app, map);
    add_export(app, export_map);
    add_info(app, info);
    add_import(app, import);
  }
  /// Runs the one that was asked for, if one was; returns its exit code.
  [[nodiscard]] std::optional<int> run(const CLI::App& app) const {
    if (app.got_subcommand("process")) return run_process(process);
    if (app.got_subcommand("label")) return run_label(label);
    if (app.got_subcommand("map")) return run_map(map);
    if (app.got_subcommand("export")) return run_export(export_map);
    if (app.got_subcommand("info")) return run_info(info);
    if (app.got_subcommand("import")) return run_import(import);
    return std::nullopt;
  }
};

int run(int argc, char** argv) {
  CLI::App app("Terrain out of recorded range data: heights, ground, obstacles, potholes, slopes.",
               "terrain-rawlog");
  app.footer(
      "Exit codes: 0 all well; 2 command line or configuration wrong; 3 an input is missing or\n"
      "damaged (results up to there are written); 4 not all scans could be used as asked; 5 "
      "output\n"
      "cannot be written; 130 interrupted (results up to there are written).");
  app.set_version_flag("--version", "terrain-rawlog " MRPT_TERRAIN_VERSION);
  bool print_config = false;
  app.add_flag("--print-default-config", print_config, "Print all parameters with their defaults");
  app.require_subcommand(0, 1);
  Commands commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  if (print_config) {
    std::cout << mrpt_terrain::params::dump_ini(AppParams{}) << std::flush;
    return std::cout ? kExitOk : kExitOutput;
  }
  if (const auto exit_code = commands.run(app)) return *exit_code;
  std::cout << app.help();
  return kExitUsage;
}

}  // namespace

int main(int argc, char** argv) {
  limit_memory();
  return run_program(run, argc, argv);
}
