// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog process: describes every scan of rawlogs and simple maps.
#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "exit_code.h"
#include "input_support.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/params/parameter_error.h"
#include "mrpt_terrain/params/set.h"
#include "mrpt_terrain/view/run_summary.h"
#include "mrpt_terrain/view/tables.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "outputs.h"
#include "scan_pipeline.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// State of one run of `process`.
struct Run {
  const ProcessOptions& options;
  std::regex sensor_label;
  Messages messages;
  RepeatedWarnings warnings{messages};
  ScanPipeline pipeline;
  Outputs outputs;
  view::RunSummary summary;
  bool ground_known = false;  ///< `--find-ground` has found it
  DrawableScan worst;         ///< so far; valid if summary.worst_scan
  double worst_share = -1.0;
  view::ScanRecord last;
  std::size_t entries = 0;                         ///< that were read, asked for or not
  std::map<std::string, std::size_t> no_geometry;  ///< observations that never have points
  int exit_code = kExitOk;

  Run(const ProcessOptions& given, const AppParams& params)
      : options(given),
        sensor_label(given.selection.sensor_label),
        messages(given.verbosity),
        outputs(given.output_dir, params) {
    pipeline.params = params;
    pipeline.models = load_sensor_models();
    if (!given.sensor_pose.empty()) pipeline.sensor_pose = parse_pose(given.sensor_pose);
    summary.version = MRPT_TERRAIN_VERSION;
    summary.inputs = given.inputs;
  }

  void incomplete() {
    if (exit_code == kExitOk) exit_code = kExitIncomplete;
  }
  [[nodiscard]] bool enough() const {
    const std::size_t wanted = options.selection.only_first_n;
    return stop_requested() || (wanted != 0 && summary.scans_processed >= wanted);
  }
};

AppParams load_params(const ProcessOptions& options) {
  AppParams result;
  if (!options.config.empty()) params::load_ini(options.config, result);
  for (const std::string& setting : options.settings) params::set(result, setting, "--set");
  check_together(result, options.config.empty() ? "--set" : options.config);
  return result;
}

io::Trajectory trajectory_for(const std::string& file, const Run& run) {
  if (!run.options.poses.empty()) return io::load_tum(run.options.poses);
  io::PoseSource source = io::PoseSource::kNone;
  return io::read_trajectory(file, source);
}

std::string scan_title(const view::ScanRecord& record) {
  std::string title = "scan " + std::to_string(record.index) + ": " + view::base_name(record.file) +
                      " entry " + std::to_string(record.entry);
  if (!record.sensor_label.empty()) title += ", " + view::printable(record.sensor_label);
  return title + ", " + view::time_text(record.stamp);
}

// What a person should know about a scan that gave little or nothing.
void warn_about(const view::ScanRecord& record, Run& run) {
  const view::DescriptionCounts& counts = record.counts;
  const std::string place = record.file + ": entry " + std::to_string(record.entry);
  if (counts.observed_cells == 0) {
    run.warnings.warn("no points in the map", place,
                      "none of its " + view::grouped(record.counts.points) +
                          " points lies in the map (see [grid] and the sensor's pose)");
    ++run.summary.scans_skipped["no points in the map"];
    run.incomplete();
  } else if (record.index == 0 && counts.ground_cells * 20 < counts.observed_cells) {
    run.messages.warn(place +
                      ": hardly any ground at z = 0 of the robot frame; give the sensor's height "
                      "with --sensor-pose or try --find-ground");
  }
  if (!run.options.poses.empty() && !run.pipeline.scan.T_map_robot) {
    run.warnings.warn("no pose in " + run.options.poses, place,
                      run.options.poses + " has no pose for its time " +
                          view::fixed(record.stamp, 6) + " s; described without");
    run.incomplete();
  }
}

void print_scan(const view::ScanRecord& record, Run& run) {
  if (!run.messages.shows(Verbosity::kInfo)) return;
  const Description& description = run.pipeline.description;
  run.messages.info(scan_title(record) + "\n" + view::class_summary(description) + "\n" +
                    view::cluster_table(description, run.options.table_rows) + "\n");
  run.messages.debug("milliseconds: reading " + view::fixed(record.milliseconds.io, 2) +
                     ", total " + view::fixed(record.milliseconds.total, 2) + "\n\n");
}

// Share of the points in the map that are not ground: the larger, the less the method understood.
double trouble(const view::ScanRecord& record) {
  const auto ground = record.counts.per_support[static_cast<std::size_t>(Support::kGround)];
  const auto unknown = record.counts.per_support[static_cast<std::size_t>(Support::kUnknown)];
  const std::size_t in_map = record.counts.points - unknown;
  return in_map == 0 ? 1.0 : 1.0 - static_cast<double>(ground) / static_cast<double>(in_map);
}

void keep_for_views(const view::ScanRecord& record, Run& run) {
  const Description& description = run.pipeline.description;
  const Points& points = run.pipeline.scan.points;
  if (run.options.every != 0) {
    if (record.index % run.options.every == 0) {
      run.outputs.write_views(record, points, description, "scan " + std::to_string(record.index));
    }
  } else if (record.index == 0) {
    run.outputs.write_views(record, points, description, "first scan");
  }
  const double share = trouble(record);
  if (share > run.worst_share) {
    run.worst_share = share;
    if (run.options.every == 0) run.worst = {record, points, description};
    run.summary.worst_scan = view::ScanReference{
        record.file, record.entry, record.index,
        view::fixed(100 * share, 1) + " % of its points in the map are not ground"};
  }
  run.last = record;
}

// Once per run, on the first scan that shows the ground.
void find_ground(const std::string& place, Run& run) {
  if (!run.options.find_ground || run.ground_known) return;
  const GroundPlane plane = level_by_ground(run.pipeline);
  if (!plane.found) {
    run.messages.warn(place + ": no ground found; described with the sensor's pose as it is");
    return;
  }
  run.ground_known = true;
  run.messages.info(
      place + ": ground found at z = " + view::fixed(plane.height, 2) +
      " m of the robot frame, tilted by " + view::fixed(mrpt::RAD2DEG(plane.tilt), 1) +
      " deg; the sensor's pose is now \"" + pose_text(run.pipeline.sensor_points.T_robot_sensor) +
      "\" (give it with --sensor-pose to fix it)\n\n");
}

// What is counted together in the summary. The reasons of single observations (their counts, their
// external files) would make as many kinds as there are observations.
std::string kind_of(const mrpt::obs::CObservation& observation, const io::Conversion& conversion) {
  const std::string status = name_of(conversion.status);
  if (conversion.status != io::ConversionStatus::kNoPoints &&
      conversion.status != io::ConversionStatus::kLoadFailed) {
    return status + ": " + conversion.reason;
  }
  return status + ": " + observation.GetRuntimeClass()->className + " '" + observation.sensorLabel +
         "'";
}

// Observations that never have points are part of most rawlogs; the others should have been used.
void skip(const mrpt::obs::CObservation& observation, const std::string& place,
          const io::Conversion& conversion, Run& run) {
  if (conversion.status == io::ConversionStatus::kNoGeometry) {
    ++run.no_geometry[conversion.reason];
    return;
  }
  const std::string kind = kind_of(observation, conversion);
  ++run.summary.scans_skipped[kind];
  view::add(run.summary.left_out, left_out(run.pipeline.sensor_points.counts));
  run.warnings.warn(kind, place, conversion.reason);
  run.incomplete();
}

void process_observation(const std::string& file, const io::ReadObservation& read, double io_ms,
                         Run& run) {
  const mrpt::obs::CObservation& observation = *read.observation;
  if (!std::regex_match(observation.sensorLabel, run.sensor_label)) {
    ++run.summary.scans_skipped["sensor label not asked for"];
    return;
  }
  const Clock::time_point start = Clock::now();
  const std::string place = file + ": entry " + std::to_string(read.entry);
  const io::Conversion conversion = convert(observation, run.pipeline);
  if (conversion.status != io::ConversionStatus::kOk) {
    skip(observation, place, conversion, run);
    return;
  }
  if (read.T_map_robot) {
    run.pipeline.trajectory = io::Trajectory();
    run.pipeline.trajectory.add(run.pipeline.sensor_points.stamp, *read.T_map_robot);
  }
  view::ScanRecord record;
  record.file = file;
  record.entry = read.entry;
  record.index = run.summary.scans_processed;
  record.sensor_label = observation.sensorLabel;
  record.milliseconds.io = io_ms + 1e3 * seconds_since(start);
  find_ground(place, run);
  describe_scan(run.pipeline, record);
  record.milliseconds.total += record.milliseconds.io;
  run.outputs.add_rows(record, run.pipeline.description);
  view::add_scan(run.summary, record);
  print_scan(record, run);
  warn_about(record, run);
  keep_for_views(record, run);
}

void merge_unknown_classes(const std::string& file, const io::ReadSummary& read, Run& run) {
  for (const auto& [name, count] : read.unknown_classes) {
    run.summary.unknown_classes[name] += count;
    run.messages.warn(file + ": " + std::to_string(count) + " objects of the unknown class " +
                      view::printable(name) + " passed over");
    run.incomplete();
  }
}

void read_all(const std::string& file, std::size_t file_number, io::ObservationReader& reader,
              Run& run) {
  const Selection& selection = run.options.selection;
  io::ReadObservation read;
  while (!run.enough()) {
    const Clock::time_point start = Clock::now();
    if (!reader.next(read)) break;
    if (read.entry > selection.to_index) break;
    if (read.entry < selection.from_index) continue;
    process_observation(file, read, 1e3 * seconds_since(start), run);
    run.messages.bar().show((static_cast<double>(file_number) + reader.progress()) /
                                static_cast<double>(run.options.inputs.size()),
                            std::to_string(run.summary.scans_processed) + " scans");
  }
}

void process_file(const std::string& file, std::size_t file_number, Run& run) {
  std::unique_ptr<io::ObservationReader> reader;
  try {
    set_externals_dir(run.options.externals_dir, file);
    reader = open_input(file);
    try {
      run.pipeline.trajectory = trajectory_for(file, run);
    } catch (const io::ReadError&) {
      // The same damage is met and reported where the scans before it have been described.
      run.pipeline.trajectory = io::Trajectory();
    }
    read_all(file, file_number, *reader, run);
  } catch (const io::ReadError& error) {
    run.messages.error(error.what());
    run.exit_code = kExitInput;
  }
  run.warnings.finish();
  if (!reader) return;
  run.entries += reader->summary().entries;
  merge_unknown_classes(file, reader->summary(), run);
}

void write_last_views(Run& run) {
  if (run.summary.scans_processed == 0 || run.options.every != 0) return;
  run.outputs.write_views(run.worst.record, run.worst.points, run.worst.description, "worst scan");
  run.outputs.write_views(run.last, run.pipeline.scan.points, run.pipeline.description,
                          "last scan");
}

std::string counts_text(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [reason, count] : counts) {
    text += "  " + std::to_string(count) + " x " + view::printable(reason) + "\n";
  }
  return text;
}

// Why a run over readable files described nothing.
std::string nothing_described(const Run& run) {
  const Selection& selection = run.options.selection;
  std::string reasons = counts_text(run.summary.scans_skipped) + counts_text(run.no_geometry);
  if (reasons.empty() && run.entries > 0 && selection.from_index >= run.entries) {
    reasons = "  --from-index is " + std::to_string(selection.from_index) +
              ", the last entry of the inputs is " + std::to_string(run.entries - 1) + "\n";
  }
  if (reasons.empty()) reasons = "  there is no observation in what was read\n";
  reasons.pop_back();
  return "no scan was described\n" + reasons;
}

void report(Run& run, double wall_seconds) {
  const std::size_t scans = run.summary.scans_processed;
  std::string text = std::to_string(scans) + (scans == 1 ? " scan" : " scans") + " described in " +
                     view::fixed(wall_seconds, 2) + " s\n";
  if (scans != 0 && !run.summary.scans_skipped.empty()) {
    text += "not described:\n" + counts_text(run.summary.scans_skipped);
  }
  for (const View& view : run.outputs.views()) text += view.why + ": " + view.picture + "\n";
  text += "tables, scenes, clouds, configuration: " + run.outputs.folder() + "\n";
  run.messages.info(text);
  if (!run.no_geometry.empty()) {
    run.messages.debug("observations without geometry:\n" + counts_text(run.no_geometry));
  }
  if (scans == 0 && run.exit_code != kExitInput && !stop_requested()) {
    run.messages.error(nothing_described(run));
    run.incomplete();
  }
}

int run_all(Run& run) {
  const Clock::time_point start = Clock::now();
  try {
    for (std::size_t k = 0; k < run.options.inputs.size() && !run.enough(); ++k) {
      process_file(run.options.inputs[k], k, run);
    }
    write_last_views(run);
  } catch (const std::exception&) {
    run.outputs.finish(run.summary);  // keeps the rows that there are
    throw;
  }
  run.summary.wall_seconds = seconds_since(start);
  run.outputs.finish(run.summary);
  report(run, run.summary.wall_seconds);
  if (!stop_requested()) return run.exit_code;
  run.messages.warn("interrupted; the files hold the scans up to here");
  return kExitInterrupted;
}

// Wrong use that would otherwise be met with half of the work done, or never.
void check_options(const ProcessOptions& options) {
  const Selection& selection = options.selection;
  if (selection.from_index > selection.to_index) {
    throw std::invalid_argument("--from-index " + std::to_string(selection.from_index) +
                                " is behind --to-index " + std::to_string(selection.to_index));
  }
  if (options.output_dir.empty()) throw std::invalid_argument("--output-dir: needs a name");
  if (!options.externals_dir.empty() && !std::filesystem::is_directory(options.externals_dir)) {
    throw std::invalid_argument("--externals-dir: " + options.externals_dir + " is no folder");
  }
  try {
    (void)std::regex(selection.sensor_label);
  } catch (const std::regex_error& error) {
    throw std::invalid_argument("--sensor-label: not a regular expression: " +
                                std::string(error.what()));
  }
  if (!options.poses.empty()) (void)io::load_tum(options.poses);
  if (!options.sensor_pose.empty()) (void)parse_pose(options.sensor_pose);
}

// A run without any readable input must not replace the results of an earlier one.
bool any_readable(const ProcessOptions& options, Messages& messages) {
  std::vector<std::string> problems;
  for (const std::string& file : options.inputs) {
    try {
      (void)open_input(file);
      return true;
    } catch (const io::ReadError& error) {
      problems.emplace_back(error.what());
    }
  }
  for (const std::string& problem : problems) messages.error(problem);
  return false;
}

}  // namespace

int run_process(const ProcessOptions& options) {
  Messages messages(options.verbosity);
  AppParams params;
  try {
    params = load_params(options);
    check_options(options);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  try {
    if (!any_readable(options, messages)) return kExitInput;
    Run run(options, params);
    return run_all(run);
  } catch (const std::bad_alloc&) {
    messages.error("out of memory (half of the machine's may be used): try a smaller [grid]");
    return kExitInput;
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitOutput;
  }
}
