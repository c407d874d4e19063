// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog info: what a file holds and what `process` can do with it.
#include <algorithm>
#include <limits>
#include <map>

#include "exit_code.h"
#include "input_support.h"
#include "map_text.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/map/map_file.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;

/// What is known of the observations of one class and label.
struct SensorInfo {
  std::size_t observations = 0;
  double first_stamp = std::numeric_limits<double>::infinity();
  double last_stamp = -std::numeric_limits<double>::infinity();
  io::Conversion conversion;  ///< of the first one
  io::SensorPoints points;    ///< of the first one
};
using SensorKey = std::pair<std::string, std::string>;  // class, label

void add(const mrpt::obs::CObservation& observation, const sensors::SensorModels& models,
         std::map<SensorKey, SensorInfo>& sensors) {
  SensorInfo& sensor = sensors[{observation.GetRuntimeClass()->className, observation.sensorLabel}];
  if (sensor.observations++ == 0) {
    sensor.conversion = io::convert_observation(observation, {}, models, sensor.points);
  }
  const double stamp = mrpt::Clock::toDouble(observation.timestamp);
  sensor.first_stamp = std::min(sensor.first_stamp, stamp);
  sensor.last_stamp = std::max(sensor.last_stamp, stamp);
}

std::string describe_sensor(const SensorKey& key, const SensorInfo& sensor) {
  std::string text = "  " + std::to_string(sensor.observations) + " x " + key.first;
  if (!key.second.empty()) text += " \"" + view::printable(key.second) + "\"";
  const double span = sensor.last_stamp - sensor.first_stamp;
  if (sensor.observations > 1 && span > 0) {
    text += ", " + view::fixed(static_cast<double>(sensor.observations - 1) / span, 2) +
            " Hz over " + view::fixed(span, 1) + " s";
  }
  text += "\n";
  if (sensor.conversion.status != io::ConversionStatus::kOk) {
    return text + "      not described: " + sensor.conversion.reason + "\n";
  }
  text += "      first: " + view::grouped(sensor.points.points.size()) + " points of " +
          view::grouped(sensor.points.source_size) +
          " returns, times per point: " + (sensor.points.time.empty() ? "no" : "yes") + "\n";
  return text + "      sensor pose: " + pose_text(sensor.points.T_robot_sensor) +
         " (x y z m, yaw pitch roll deg)\n";
}

std::string describe_poses(const std::string& file) {
  io::PoseSource source = io::PoseSource::kNone;
  const io::Trajectory poses = io::read_trajectory(file, source);
  if (poses.empty()) return "robot poses: none\n";
  static const std::map<io::PoseSource, std::string> kNames = {
      {io::PoseSource::kRobotPose, "CObservationRobotPose"},
      {io::PoseSource::kOdometry, "CObservationOdometry"},
      {io::PoseSource::kActions, "actions"},
      {io::PoseSource::kKeyframes, "keyframes"}};
  return "robot poses: " + std::to_string(poses.size()) + " from " + kNames.at(source) + ", " +
         view::time_text(poses.stamps().front()) + " to " + view::time_text(poses.stamps().back()) +
         "\n";
}

void print_file(const std::string& file, Messages& messages, int& exit_code) {
  messages.info(file + "\n");
  refuse_pipe(file);
  if (is_map_file(file)) {
    messages.info(map_text(load_map_file(file)));
    return;
  }
  const sensors::SensorModels models = load_sensor_models();
  const std::unique_ptr<io::ObservationReader> reader = open_input(file);
  std::map<SensorKey, SensorInfo> sensors;
  std::string poses, damage;
  try {
    io::ReadObservation read;
    while (!stop_requested() && reader->next(read)) {
      add(*read.observation, models, sensors);
      messages.bar().show(reader->progress(),
                          std::to_string(reader->summary().entries) + " entries");
    }
    poses = describe_poses(file);
  } catch (const io::ReadError& error) {
    exit_code = kExitInput;
    damage = error.what();
  }
  messages.info(std::to_string(reader->summary().entries) + " entries\n");
  for (const auto& [key, sensor] : sensors) messages.info(describe_sensor(key, sensor));
  for (const auto& [name, count] : reader->summary().unknown_classes) {
    messages.info("  " + std::to_string(count) + " x " + view::printable(name) +
                  ": class unknown to MRPT, passed over\n");
  }
  messages.info(poses);
  if (!damage.empty()) messages.error(damage);
}

}  // namespace

int run_info(const InfoOptions& options) {
  Messages messages(Verbosity::kInfo);
  int exit_code = kExitOk;
  for (const std::string& file : options.inputs) {
    try {
      set_externals_dir(options.externals_dir, file);
      print_file(file, messages, exit_code);
    } catch (const std::exception& error) {
      messages.error(error.what());
      exit_code = kExitInput;
    }
  }
  return stop_requested() ? static_cast<int>(kExitInterrupted) : exit_code;
}
