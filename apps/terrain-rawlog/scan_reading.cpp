// SPDX-License-Identifier: BSD-3-Clause
// What `process`, `map` and `label` do with their inputs before there is a scan to work on.
#include "scan_reading.h"

#include <mrpt/core/bits_math.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include "input_support.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/view/text.h"
#include "stop_signal.h"

using namespace mrpt_terrain;

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

io::Trajectory trajectory_for(const std::string& file, const InputOptions& options) {
  if (options.scan_files) return {};
  if (!options.poses.empty()) return io::load_tum(options.poses);
  io::PoseSource source = io::PoseSource::kNone;
  // The same damage is met and reported where the scans before it have been worked on.
  std::string damage;
  return io::read_trajectory(file, source, &damage);
}

// Once per run, on the first scan that shows the ground.
void find_ground(const std::string& place, ScanReading& reading) {
  if (!reading.options.find_ground || reading.ground_known) return;
  const GroundPlane plane = level_by_ground(reading.pipeline);
  if (!plane.found) {
    reading.messages.warn(place + ": no ground found; described with the sensor's pose as it is");
    return;
  }
  reading.ground_known = true;
  reading.messages.info(place + ": ground found at z = " + view::fixed(plane.height, 2) +
                        " m of the robot frame, tilted by " +
                        view::fixed(mrpt::RAD2DEG(plane.tilt), 1) +
                        " deg; the sensor's pose is now \"" +
                        pose_text(reading.pipeline.sensor_points.T_robot_sensor) +
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

bool is_wanted_empty(const io::Conversion& conversion, const ScanReading& reading) {
  return reading.empty_scans && conversion.status == io::ConversionStatus::kNoPoints &&
         reading.pipeline.sensor_points.source_size != 0;
}

// Observations that never have points are part of most rawlogs; the others should have been used.
void skip(const mrpt::obs::CObservation& observation, const std::string& place,
          const io::Conversion& conversion, ScanReading& reading) {
  if (conversion.status == io::ConversionStatus::kNoGeometry) {
    ++reading.no_geometry[conversion.reason];
    return;
  }
  // The command counts the returns of scans that it gets.
  if (!is_wanted_empty(conversion, reading)) {
    view::add(reading.summary.left_out, left_out(reading.pipeline.sensor_points.counts));
  }
  reading.pass_over(kind_of(observation, conversion), place, conversion.reason);
}

void take_observation(const io::ReadObservation& read, view::ScanRecord& record,
                      ScanReading& reading, const ScanHandler& handle) {
  const mrpt::obs::CObservation& observation = *read.observation;
  if (!std::regex_match(observation.sensorLabel, reading.sensor_label)) {
    ++reading.summary.scans_skipped["sensor label not asked for"];
    return;
  }
  const Clock::time_point start = Clock::now();
  const std::string place = place_of(record, reading.options);
  const io::Conversion conversion = convert(observation, reading.pipeline);
  const bool usable = conversion.status == io::ConversionStatus::kOk;
  if (!usable) skip(observation, place, conversion, reading);
  if (!usable && !is_wanted_empty(conversion, reading)) return;
  if (read.T_map_robot) {
    reading.pipeline.trajectory = io::Trajectory();
    reading.pipeline.trajectory.add(reading.pipeline.sensor_points.stamp, *read.T_map_robot);
  }
  record.index = reading.summary.scans_processed;
  record.sensor_label = observation.sensorLabel;
  record.milliseconds.io += milliseconds_since(start);
  if (usable) find_ground(place, reading);
  handle(record);
}

void merge_unknown_classes(const std::string& file, const io::ReadSummary& read,
                           ScanReading& reading) {
  for (const auto& [name, count] : read.unknown_classes) {
    reading.summary.unknown_classes[name] += count;
    reading.messages.warn(file + ": " + std::to_string(count) + " objects of the unknown class " +
                          view::printable(name) + " passed over");
    reading.incomplete();
  }
}

void read_all(std::size_t file_number, io::ObservationReader& reader, ScanReading& reading,
              const ScanHandler& handle) {
  const Selection& selection = reading.options.selection;
  io::ReadObservation read;
  while (!reading.enough()) {
    const Clock::time_point start = Clock::now();
    if (!reader.next(read)) break;
    if (read.entry > selection.to_index) break;
    if (read.entry < selection.from_index) continue;
    view::ScanRecord record;
    record.file = reading.options.inputs[file_number];
    record.entry = read.entry;
    record.milliseconds.io = milliseconds_since(start);
    take_observation(read, record, reading, handle);
    reading.messages.bar().show((static_cast<double>(file_number) + reader.progress()) /
                                    static_cast<double>(reading.options.inputs.size()),
                                std::to_string(reading.summary.scans_processed) + " scans");
  }
}

void read_file(std::size_t file_number, ScanReading& reading, const ScanHandler& handle) {
  const std::string& file = reading.options.inputs[file_number];
  std::unique_ptr<io::ObservationReader> reader;
  try {
    set_externals_dir(reading.options.externals_dir, file);
    reader = open_input(file, reading.options.scan_files);
    reading.pipeline.trajectory = trajectory_for(file, reading.options);
    read_all(file_number, *reader, reading, handle);
  } catch (const io::ReadError& error) {
    reading.messages.error(error.what());
    reading.exit_code = kExitInput;
  }
  reading.warnings.finish();
  if (!reader) return;
  reading.entries += reader->summary().entries;
  merge_unknown_classes(file, reader->summary(), reading);
}

}  // namespace

ScanReading::ScanReading(const InputOptions& given, Messages& to, const io::InputParams& input,
                         const GroundPlaneParams& ground_plane)
    : options(given), messages(to), sensor_label(given.selection.sensor_label) {
  pipeline.input = input;
  pipeline.ground_plane = ground_plane;
  pipeline.models = load_sensor_models();
  if (!given.sensor_pose.empty()) pipeline.sensor_pose = parse_pose(given.sensor_pose);
  summary.version = MRPT_TERRAIN_VERSION;
  summary.inputs = given.inputs;
}

void ScanReading::incomplete() {
  if (exit_code == kExitOk) exit_code = kExitIncomplete;
}

void ScanReading::pass_over(const std::string& kind, const std::string& place,
                            const std::string& reason) {
  ++summary.scans_skipped[kind];
  warnings.warn(kind, place, reason);
  incomplete();
}

bool ScanReading::enough() const {
  const std::size_t wanted = options.selection.only_first_n;
  return stop_requested() || (wanted != 0 && summary.scans_processed >= wanted);
}

void check_options(const InputOptions& options) {
  const Selection& selection = options.selection;
  if (selection.from_index > selection.to_index) {
    throw std::invalid_argument("--from-index " + std::to_string(selection.from_index) +
                                " is behind --to-index " + std::to_string(selection.to_index));
  }
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

bool any_readable(const InputOptions& options, Messages& messages) {
  std::vector<std::string> problems;
  for (const std::string& file : options.inputs) {
    try {
      (void)open_input(file, options.scan_files);
      return true;
    } catch (const io::ReadError& error) {
      problems.emplace_back(error.what());
    }
  }
  for (const std::string& problem : problems) messages.error(problem);
  return false;
}

void read_inputs(ScanReading& reading, const ScanHandler& handle) {
  for (std::size_t k = 0; k < reading.options.inputs.size() && !reading.enough(); ++k) {
    read_file(k, reading, handle);
  }
}

std::string place_of(const view::ScanRecord& record, const InputOptions& options) {
  if (options.scan_files) return record.file;
  return record.file + ": entry " + std::to_string(record.entry);
}

void warn_about(const view::ScanRecord& record, const ScanWords& words, ScanReading& reading) {
  const view::DescriptionCounts& counts = record.counts;
  const std::string place = place_of(record, reading.options);
  if (counts.observed_cells == 0) {
    reading.pass_over("no points in the map", place,
                      "none of its " + view::grouped(record.counts.points) +
                          " points lies in the map (see " + words.extent +
                          " and the sensor's pose)");
  } else if (record.index == 0 && counts.ground_cells * 20 < counts.observed_cells) {
    reading.messages.warn(
        place +
        ": hardly any ground at z = 0 of the robot frame; give the sensor's height "
        "with --sensor-pose or try --find-ground");
  }
  const std::string& poses = reading.options.poses;
  if (poses.empty() || reading.pipeline.scan.T_map_robot) return;
  reading.warnings.warn("no pose in " + poses, place,
                        poses + " has no pose for its time " + view::fixed(record.stamp, 6) +
                            " s; " + words.without_pose);
  reading.incomplete();
}

std::string counts_text(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [reason, count] : counts) {
    text += "  " + std::to_string(count) + " x " + view::printable(reason) + "\n";
  }
  return text;
}

void complain_about_nothing(const std::string& complaint, ScanReading& reading) {
  if (!reading.no_geometry.empty()) {
    reading.messages.debug("observations without geometry:\n" + counts_text(reading.no_geometry));
  }
  if (reading.summary.scans_processed != 0 || reading.exit_code == kExitInput || stop_requested()) {
    return;
  }
  const Selection& selection = reading.options.selection;
  std::string reasons =
      counts_text(reading.summary.scans_skipped) + counts_text(reading.no_geometry);
  if (reasons.empty() && reading.entries > 0 && selection.from_index >= reading.entries) {
    reasons = "  --from-index is " + std::to_string(selection.from_index) +
              ", the last entry of the inputs is " + std::to_string(reading.entries - 1) + "\n";
  }
  if (reasons.empty()) reasons = "  there is no observation in what was read\n";
  reasons.pop_back();
  reading.messages.error(complaint + "\n" + reasons);
  reading.incomplete();
}

int run_command(Messages& messages, const std::string& smaller,
                const std::function<void()>& prepare, const std::function<int()>& run) {
  try {
    prepare();
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  try {
    return run();
  } catch (const std::bad_alloc&) {
    messages.error("out of memory (half of the machine's may be used): try a smaller " + smaller);
    return kExitInput;
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitOutput;
  }
}
